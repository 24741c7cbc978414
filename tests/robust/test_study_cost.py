"""The study of cost: rows of the shipped CSV recomputed; pictures from the CSV; runs that fail; points of other programs"""
import csv, os, subprocess, sys, tempfile

from abut import PROGRAM, ROOT

STUDIES = os.path.join(ROOT, "examples", "studies")
COST = os.path.join(STUDIES, "cost")
COUNTS = "cycle verdict unknowns ndof1 ndof2 cells sweeps work ksp_its".split()
ERRORS = "err_p_L2 err_P err_p0 err_a total_P total_p0".split()
VALUES = "P p0 a energy".split()


def cost(folder, *options):
    command = [sys.executable, os.path.join(COST, "cost.py"), "--abut", PROGRAM, "--out", folder, *options]
    return subprocess.run(command, capture_output=True, text=True)


def rows_of(path):
    with open(path) as f:
        return list(csv.DictReader(f))


def key(row):
    return tuple(row[name] for name in "scene order estimator c loop most".split())


def recompute(text):
    """A case of the shipped table, run again: counts as they are there, values and errors to a part in 1e9 of what they are of"""
    shipped = {(*key(row), row["cycle"]): row for row in rows_of(os.path.join(COST, "cost.csv"))}
    with tempfile.TemporaryDirectory() as folder:
        result = cost(folder, "--repetitions", "1", "--only", text)
        assert not result.returncode, result.stdout + result.stderr
        rows = rows_of(os.path.join(folder, "cost.csv"))
        assert len({key(row) for row in rows}) == 1 and len(rows) == sum(one[:-1] == key(rows[0]) for one in shipped) > 6, rows
        for row in rows:
            old = shipped[(*key(row), row["cycle"])]
            assert [row[name] for name in COUNTS] == [old[name] for name in COUNTS], (row, old)
            assert all(abs(float(row[name]) / float(old[name]) - 1) < 1e-9 for name in VALUES), (row, old)
            assert all(abs(float(row[name]) - float(old[name])) < 1e-9 for name in ERRORS), (row, old)
            assert abs(float(row["err_energy"]) ** 2 - float(old["err_energy"]) ** 2) < 2e-9, (row, old)  # the root of that of the energy
        with open(os.path.join(folder, "cost.md")) as f:
            assert f"1 series, {len(rows)} meshes" in f.read()


def test_rows_are_recomputed_exactly():
    recompute("layers 2 uniform 0 ddactive")
    recompute("punch 1 uniform")


def test_an_adapted_series_is_recomputed_exactly():
    recompute("hertz 3 residual")


def test_pictures_and_tables_come_from_the_csv():
    """Without a run"""
    with tempfile.TemporaryDirectory() as folder:
        result = cost(folder, "--tables", "--abut", "/nowhere")
        assert not result.returncode, result.stdout + result.stderr
        pictures = [f"cost{part}.{kind}" for part in ("", "_estimators", "_split") for kind in ("png", "svg")]
        assert all(os.path.getsize(os.path.join(folder, name)) > 2e4 for name in pictures)
        with open(os.path.join(folder, "cost.md")) as f:
            page = f.read()
        assert page.count("| layers | energy norm | ") >= 2 and page.count("| punch | force | ") >= 3, page[:3000]


def test_the_same_rows_give_the_same_bytes():
    with tempfile.TemporaryDirectory() as folder:
        kept = []
        for name in "one", "two":
            result = cost(os.path.join(folder, name), "--tables", "--abut", "/nowhere", "--only", "punch 2")
            assert not result.returncode, result.stdout + result.stderr
            for kind in "png", "svg":
                with open(os.path.join(folder, name, f"cost_estimators.{kind}"), "rb") as f:
                    kept.append(f.read())
        assert kept[:2] == kept[2:]


def test_a_run_that_fails_stays_a_row():
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "abut")
        with open(program, "w") as f:
            f.write("#!/bin/sh\necho out of order >&2\nexit 1\n")
        os.chmod(program, 0o755)
        for text in "layers 1 zz 0 ddactive", "layers 1 uniform 0":
            result = cost(folder, "--abut", program, "--only", text)
            assert not result.returncode, result.stdout + result.stderr
        rows = rows_of(os.path.join(folder, "cost.csv"))
        assert [row["verdict"] for row in rows] == ["out of order"] * 2 and not any(row["P"] for row in rows), rows
        with open(os.path.join(folder, "cost.md")) as f:
            assert "- layers, order 1, uniform, c = 0, ddactive: out of order" in f.read()
        again = cost(folder, "--abut", program, "--only", "layers 1 zz 0 ddactive")  # nothing is run twice
        assert "1 cases, 1 of them in" in again.stdout and len(rows_of(os.path.join(folder, "cost.csv"))) == 2


def test_other_programs_are_drawn_and_wrong_files_named():
    """The sample of the page has points in every picture of the layers; what is wrong with a file is said in one line"""
    with tempfile.TemporaryDirectory() as folder:
        sample = os.path.join(STUDIES, "compare", "sample.csv")
        result = cost(folder, "--tables", "--compare", sample, "--compare", os.path.join(STUDIES, "accuracy", "peers.csv"))
        assert not result.returncode, result.stdout + result.stderr
        with open(os.path.join(folder, "cost.svg")) as f:
            picture = f.read()
        assert all(f"<!-- {name} -->" in picture for name in ("mine", "ngsolve", "dealii")), "no legend of the programs"
        for text, said in (
            ("program,variant,err_P\nmine,a,1\n", "row 1: wants at least program and unknowns"),
            ("program,unknowns,err_P\nmine,100,small\n", "row 1: could not convert"),
            ("program,unknowns\n", "no rows"),
        ):
            path = os.path.join(folder, "wrong.csv")
            with open(path, "w") as f:
                f.write(text)
            result = cost(folder, "--tables", "--compare", path)
            lines = result.stderr.strip().splitlines()
            assert result.returncode == 1 and len(lines) == 1 and lines[0].startswith(path) and said in lines[0], result.stderr


def test_one_body_of_two_counts_twice():
    sys.path.insert(0, STUDIES)
    from study import points

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "half.csv")
        with open(path, "w") as f:
            f.write("# a remark\nprogram,variant,unknowns,bodies,sweeps,cpu_s,cum_cpu_s,err_P,scene\n")
            f.write("mine,a,100,1,3,0.5,0.75,1e-3,punch\nmine,b,100,,,0.5,,1e-3,\n")
        half, whole = points(path)
    assert (half["unknowns"], half["work"], half["cpu_s"], half["scene"], half["err_P"]) == (200, 600, 1.5, "punch", 1e-3), half
    assert (whole["unknowns"], whole["work"], whole["cpu_s"], whole["scene"]) == (100, None, 0.5, "layers"), whole


def test_references_are_those_of_others():
    """That of Hertz' box is a known number; the pressures of reference.json have the independent forces"""
    sys.path.insert(0, COST)
    import numpy, scenes

    assert abs(2 * scenes.hertz_energy(0.5) / 1.60262186 - 1) < 1e-8
    points, weights = numpy.polynomial.legendre.leggauss(5)
    for c in 0.5, 0.05, 0.005:
        case, force = scenes.stored(f"layers, c = {c:g}"), scenes.layers.reference(c)["P"]["value"]
        pressure, total = scenes.piecewise(case["x"], case["p"]), 0.0
        for low, high in zip(case["x"][::4], case["x"][4::4]):
            total += (high - low) / 2 * weights @ pressure(low + (high - low) * (points + 1) / 2)
        assert abs(total / force - 1) < 1e-6, (c, total, force)
