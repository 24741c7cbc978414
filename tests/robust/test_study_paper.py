"""examples/studies/paper: runs give what the shipped CSV files say, these make the tables of docs/paper.md and the figures"""
import csv, os, subprocess, sys, tempfile, unittest

from abut import LAYERS, PROGRAM, ROOT, read_csv, run, run_error

FOLDER = os.path.join(ROOT, "examples", "studies", "paper")
SCRIPT = os.path.join(FOLDER, "paper.py")
EXACT = ("run", "cycle", "verdict", "unknowns", "cells", "marked", "level", "bem", "uniform", "what")


def rows(path):
    with open(path) as f:
        return list(csv.DictReader(f))


def script(*arguments):
    result = subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    if "ModuleNotFoundError" in result.stderr:
        raise unittest.SkipTest(result.stderr.splitlines()[-1])
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def recompute(folder, *names):
    """These runs again, beside what is shipped: counts are equal, numbers to seven digits, figures of the meshes too"""
    script("--abut", PROGRAM, "--out", folder, "--only", *names)
    for name in ("cycles", "meshes", "profiles"):
        shipped = [r for r in rows(os.path.join(FOLDER, f"{name}.csv")) if r["run"] in names]
        path = os.path.join(folder, f"{name}.csv")
        found = rows(path) if os.path.exists(path) else []
        key = lambda r: (r["run"], int(r["cycle"]))  # noqa: E731
        shipped.sort(key=key), found.sort(key=key)
        assert len(found) == len(shipped), (name, len(found), len(shipped))
        for was, now in zip(shipped, found):
            for column in was:
                if column in EXACT or not was[column]:
                    assert now[column] == was[column], (name, column, was, now)
                elif column != "seconds":
                    assert abs(float(now[column]) - float(was[column])) <= 1e-7 * abs(float(was[column])) + 1e-12, (name, column, was, now)


def test_fig_8_and_10():
    with tempfile.TemporaryDirectory() as folder:
        recompute(folder, "delta 0.3", "delta 0.1", "uniform 8")


def test_fig_7_and_9():
    with tempfile.TemporaryDirectory() as folder:
        recompute(folder, "paper, first mesh 16,4")
        assert len(rows(os.path.join(folder, "cycles.csv"))) == 6


def test_fig_5_and_6_counts_without_the_rule_and_with_it():
    """Split cells of an independent prototype, in Python, of the same scene"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "cycles.csv")
        words = f"-estimator_fembem_solve none -record_csv {path}"
        scene = os.path.join(FOLDER, "given.yml")
        assert run(scene, words)["verdict"] == "converged"
        with_rule = read_csv(path)
        assert [r["body.lower.cells"] for r in with_rule] == [16, 37, 85, 130, 166, 190]
        record = run(scene, words, "-lower_mesh_balance no -adaptor_max_unknowns 20000", expect=3)
        without = read_csv(path)
        cells = [r["body.lower.cells"] for r in without]
        assert [(b - a) // 3 for a, b in zip(cells, cells[1:])] == [7, 16, 13, 13, 17, 51, 191, 750], cells
        eta = [r["eta_max.lower"] for r in without]
        assert [round(e, 3) for e in eta[3:6]] == [0.175, 0.189, 0.209] and sorted(eta[3:]) == eta[3:], eta
        assert record["verdict"] == "limit_unknowns" and record["check.balance"] < 1e-6


def test_what_works_with_balanced_meshes_only_says_so():
    words = "-lower_mesh_balance no -snes_type ddactive -upper_mesh_cells 16,4"
    assert "leave out lower_mesh_balance" in run_error(LAYERS, words, "-estimator_type residual")
    said = [line for line in run(LAYERS, words, ranks=2, expect=1).stderr.splitlines() if line.startswith("abut: ")]  # mpiexec adds its own
    assert said == ["abut: lower_mesh_balance: no is for one rank only; leave it out, or run on one"], said


def test_the_page_has_the_tables_of_the_shipped_numbers_and_the_figures():
    with tempfile.TemporaryDirectory() as folder:
        for name in ("cycles", "meshes", "profiles"):
            with open(os.path.join(FOLDER, f"{name}.csv")) as f, open(os.path.join(folder, f"{name}.csv"), "w") as g:
                g.write(f.read())
        lines = script("--tables", "--out", folder).splitlines()
        with open(os.path.join(ROOT, "docs", "paper.md")) as f:
            page = f.read().splitlines()
        table = [line for line in lines if line.startswith("|")]
        assert len(table) > 40 and not [line for line in table if line not in page], [line for line in table if line not in page]
        for name in ("4", "5-6", "7", "8", "9", "10"):
            assert f"](paper/figure_{name}.png)" in "".join(page), name
            for kind in ("png", "svg"):
                assert os.path.getsize(os.path.join(folder, f"figure_{name}.{kind}")) > 1e4, name
            assert os.path.getsize(os.path.join(ROOT, "docs", "paper", f"figure_{name}.png")) <= 150e3, name


def test_a_run_that_fails_stays_in_the_table():
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "abut")
        with open(program, "w") as f:
            f.write("#!/bin/sh\necho out of order >&2\nexit 1\n")
        os.chmod(program, 0o755)
        said = script("--abut", program, "--out", folder, "--only", "delta 0.3")
        assert "out of order" in said and rows(os.path.join(folder, "cycles.csv"))[0]["verdict"] == "out of order", said
        assert "1 runs, 1 of them" in script("--abut", program, "--out", folder, "--only", "delta 0.3")  # nothing is run twice
