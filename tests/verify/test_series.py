"""-output as a series in time, as VTK reads it: every cycle of every load step with meshes of its own, bodies and pairs, and after a crash the cycles so far."""
import json, math, os, random, re, signal, subprocess, sys, tempfile, time, unittest, xml.etree.ElementTree as xml

from abut import PROGRAM, ROOT, execute, read_csv, run

HERE = os.path.dirname(os.path.abspath(__file__))
LAYERS = os.path.join(ROOT, "examples", "studies", "accuracy", "layers_exact.yml")
STEPS = "-adaptor_target 1e-1 -lower_mesh_order 1 -upper_mesh_order 1 -scene_load_steps 0.5,1,0.25"
LINES, QUAD = {3, 4}, 9  # of VTK; polylines of two points are lines


def read_vtk(path, *reader):
    """By the first Python that has VTK: .venv/bin/python has what config/setup.sh put there, /usr/bin/python3 Debian's packages"""
    for python in dict.fromkeys((os.path.join(ROOT, ".venv", "bin", "python"), sys.executable, "/usr/bin/python3")):
        if os.path.exists(python):
            result = execute([python, os.path.join(HERE, "vtk_series.py"), path, *reader], 250)
            if result.returncode != 77:
                assert result.returncode == 0, result.stderr
                return json.loads(result.stdout)
    raise unittest.SkipTest(f"no Python has VTK with {reader[0] if reader else 'vtkXMLUnstructuredGridReader'}")


def read_h5(path):
    """The same by the standard library and h5py: of every time and grid the datasets by name, their shapes as the index says"""
    try:
        import h5py
    except ImportError:
        raise unittest.SkipTest("no h5py")
    series = []
    for one in xml.parse(path).getroot().findall("Domain/Grid/Grid"):
        grids = {}
        for grid in one.findall("Grid"):
            data = grids.setdefault(grid.get("Name"), {})
            for item in grid.iter("DataItem"):
                if item.get("Format") == "HDF":
                    file, place = item.text.split(":")
                    with h5py.File(os.path.join(os.path.dirname(path), file)) as f:
                        values = f[place][()]
                    assert list(values.shape) == [int(n) for n in item.get("Dimensions").split()], item.text
                    data[place.split("/")[-1]] = values.tolist()
        series.append((float(one.find("Time").get("Value")), grids))
    return series


def written(folder, kind, options, ranks=1):
    """Rows of the cycles, as text too, and the path of the index"""
    run(LAYERS, options, f"-output {folder}/f.{kind} -record_csv {folder}/cycles.csv", ranks=ranks)
    with open(f"{folder}/cycles.csv") as f:
        names, *text = [line.rstrip("\n").split(",") for line in f]
    return read_csv(f"{folder}/cycles.csv"), [dict(zip(names, row)) for row in text], f"{folder}/f." + {"xdmf": "xdmf", "vtu": "pvd"}[kind]


def check(series, rows, text):
    assert [time for time, _ in series] == list(range(len(rows))) and len({row["step"] for row in rows}) == 3 and len(rows) > 6
    for (_, grids), row, said in zip(series, rows, text):
        assert sorted(grids) == ["lower", "mid", "upper"]
        for name, grid in grids.items():
            assert grid["field"]["step"] == [[row["step"]]] and grid["field"]["load_factor"] == [[row["load_factor"]]]
        for name in "lower", "upper":
            grid = grids[name]
            assert len(grid["cells"]) == row[f"body.{name}.cells"] and set(grid["type"]) == {QUAD}
            assert max(level for (level,) in grid["cell"]["level"]) == row[f"body.{name}.level_max"]
        check_pair(grids, said, row["load_factor"])


def check_pair(grids, said, factor):
    """The pressure side of the pair is the bottom of the upper body; to all digits of the record"""
    pair, upper = grids["mid"], grids["upper"]
    assert set(pair["type"]) <= LINES and [end for line in pair["cells"] for end in line] == [(i + 1) // 2 for i in range(2 * len(pair["cells"]))]
    assert len(pair["cells"]) == len(pair["points"]) - 1
    data = {name: [value for (value,) in rows] for name, rows in pair["point"].items()}
    assert "%.10g" % max(data["pressure"]) == said["pair.mid.pressure_max"], (max(data["pressure"]), said["pair.mid.pressure_max"])
    assert min(data["pressure"]) == 0 and max(data["pressure"]) > 0
    at = {tuple(point): u for point, u in zip(upper["points"], upper["point"]["displacement"])}
    for (x, y, z), gap, u in zip(pair["points"], data["gap"], data["normal_displacement"]):
        assert y == 1 and z == 0 and abs(gap - 1e-3 * x**2) < 1e-17
        assert abs(u + at[x, y, z][1]) < 1e-15 * factor


def test_vtk_reads_the_series_of_vtu_files():
    for ranks in 1, 3:
        with tempfile.TemporaryDirectory() as folder:
            rows, text, index = written(folder, "vtu", STEPS, ranks)
            check(read_vtk(index), rows, text)


def check_xdmf(reader, ranks):
    with tempfile.TemporaryDirectory() as folder:
        rows, text, index = written(folder, "xdmf", STEPS, ranks)
        assert sorted(os.listdir(folder)) == ["cycles.csv", "f.xdmf", *(f"f_step_{k:04}.h5" for k in (1, 2, 3))]
        check(read_vtk(index, reader), rows, text)


def test_vtk_reads_the_series_of_xdmf():
    for ranks in 1, 3:
        check_xdmf("vtkXdmfReader", ranks)


def test_the_other_reader_of_paraview_reads_the_series_of_xdmf():
    check_xdmf("vtkXdmf3Reader", 1)


def apart(one, other):
    """The largest difference of two lists of rows or numbers, over the largest number"""
    flat = [[value for row in rows for value in (row if isinstance(row, list) else [row])] for rows in (one, other)]
    assert len(flat[0]) == len(flat[1])
    return max(abs(a - b) for a, b in zip(*flat)) / (max(map(abs, flat[0])) or 1)


def test_xdmf_and_vtu_hold_the_same_numbers():
    """All bits of them on one rank; on three, where two runs differ by round-off, nearly"""
    for ranks, most in (1, 0), (3, 1e-9):
        with tempfile.TemporaryDirectory() as folder:
            _, _, pvd = written(folder, "vtu", STEPS, ranks)
            _, _, xdmf = written(folder, "xdmf", STEPS, ranks)
            vtk, h5 = read_vtk(pvd), read_h5(xdmf)
        assert len(vtk) == len(h5)
        for (time, one), (same, other) in zip(vtk, h5):
            assert time == same and one.keys() == other.keys()
            for name, grid in one.items():
                data = {**grid["point"], **grid["cell"], "vertices": [point[:2] for point in grid["points"]], "cells": grid["cells"]}
                for j, component in enumerate(("s11", "s22", "s33", "s12") if "stress" in data else ()):
                    data[component] = [row[j] for row in data["stress"]]
                data.pop("stress", None)
                assert data.keys() == other[name].keys() and len(data) in (5, 10, 11), data.keys()
                for field in data:
                    assert apart(data[field], other[name][field]) <= (0 if field == "cells" else most), (time, name, field)


def test_a_pair_of_order_two_has_the_consistent_pressure():
    """Its nodes are those of the side, those in the middle of elements, too; it is largest near a node. Two even layers have the same pressure everywhere."""
    with tempfile.TemporaryDirectory() as folder:
        rows, _, index = written(folder, "xdmf", "-adaptor_target 1e-3")
        _, grids = read_h5(index)[-1]
        pressure = grids["mid"]["pressure"]
        assert 0.98 < max(pressure) / rows[-1]["pair.mid.pressure_max"] < 1 + 1e-9
        assert len(pressure) == len(grids["mid"]["cells"]) + 1 == 2 * sum(y == 1 for _, y in grids["upper"]["vertices"]) - 1
        _, _, index = written(folder, "xdmf", "-adaptor_target 0.9 -mid_pair_gap 0 -upper_mesh_cells 5,2")
        _, grids = read_h5(index)[-1]
        exact = 1.366e-3 / (2 * (1 - 0.3**2) / 2.1e5)
        assert all(abs(p / exact - 1) < 1e-6 for p in grids["mid"]["pressure"]), grids["mid"]["pressure"]


FRICTION = """-scene_bodies upper,lower -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_friction 0.3 -mid_pair_penalty 0
    -upper_mesh_box 0,0,2,1 -upper_mesh_cells 5,3 -upper_material_young 2.1e5 -upper_material_poisson 0.3 -upper_bc_top_u1 1e-3 -upper_bc_top_u2 -1e-3
    -lower_mesh_box -1,-1,3,0 -lower_mesh_cells 6,2 -lower_material_young 2.1e5 -lower_material_poisson 0.3 -lower_bc_bottom_u1 0 -lower_bc_bottom_u2 0"""
CYLINDERS = os.path.join(ROOT, "examples", "hertz", "cylinders.yml")
ARC = "-small_mesh_order 1 -large_mesh_order 1 -adaptor_target 0.1 -mid_pair_pressure_side first"


def profile(path):
    """Of the only pair: x, y and u_n along the first body, and x, y, gap and pressure"""
    with open(path) as f:
        rows = [line.rstrip("\n").split(",") for line in f][1:]
    moved = [list(map(float, row[3:6])) for row in rows if row[1] == "1"]
    return moved, [list(map(float, row[3:5] + row[6:8])) for row in rows if row[1] == "pressure"]


def grid_of(folder, kind, name):
    """Of the last time, by both formats: points, and fields at them"""
    if kind == "xdmf":
        grid = read_h5(f"{folder}/f.xdmf")[-1][1][name]
        return grid["vertices"], {key: value for key, value in grid.items() if key != "vertices"}
    grid = read_vtk(f"{folder}/f.pvd")[-1][1][name]
    return [point[:2] for point in grid["points"]], {key: [row[0] if len(row) == 1 else row for row in rows] for key, rows in grid["point"].items()}


def test_pairs_with_two_components_have_the_fields_of_the_profile():
    """With friction and along arcs, where traces are vectors: gap and pressure as in the CSV, and the displacement of the body along its normal. That of an
    arc with radius R is off the circle's by at most the angle of half an element, h/2R"""
    flat, arc = (lambda x, y: (0, -1)), (lambda x, y: (x / 8, (y - 8) / 8))
    cases = ((None, FRICTION, "upper", flat, 0), (CYLINDERS, ARC, "small", arc, 1 / 8), (CYLINDERS, f"{ARC} -mid_pair_friction 0.2", "small", arc, 1 / 8))
    for kind in "xdmf", "vtu":
        for scene, words, body, normal, curvature in cases:
            with tempfile.TemporaryDirectory() as folder:
                run(scene, words, f"-output {folder}/f.{kind} -output_profile {folder}/p.csv", ranks=2)
                (points, mid), (vertices, part) = (grid_of(folder, kind, name) for name in ("mid", body))
                moved, pressed = profile(f"{folder}/p.csv")
            near = lambda a, b: math.dist(a, b) < 1e-8
            at, largest = dict(zip(map(tuple, vertices), part["displacement"])), max(abs(un) for _, _, un in moved)
            longest = 1.01 * max(map(math.dist, points, points[1:]))
            pressed.reverse()
            assert max(mid["pressure"]) > 0 and len(points) == len(moved) >= len(pressed) > 5
            for place, p, gap, un, (x, y, expected) in zip(points, mid["pressure"], mid["gap"], mid["normal_displacement"], moved):
                n, u = normal(x, y), at[tuple(place)]
                assert near(place, (x, y)) and abs(un - expected) <= 1e-9 * largest, (place, x, y, un, expected)
                assert abs(un - u[0] * n[0] - u[1] * n[1]) <= 1e-9 * largest + math.hypot(*u[:2]) * curvature * longest / 2, (place, un, u, n)
                if pressed and near(place, pressed[-1][:2]):
                    assert abs(gap - pressed[-1][2]) <= 1e-9 and abs(p - pressed[-1][3]) <= 1e-9 * max(mid["pressure"]), (place, gap, p)
                    pressed.pop()
            assert not pressed


def test_profiles_of_every_step():
    with tempfile.TemporaryDirectory() as folder:
        run(LAYERS, STEPS, f"-output_profile {folder}/p.csv")
        names = sorted(os.listdir(folder))
        assert names == ["p.csv", *(f"p_step_{k:04}.csv" for k in (1, 2, 3))]
        profile = {name: open(f"{folder}/{name}").read() for name in names}
        assert profile["p.csv"] == profile["p_step_0003.csv"] and len(set(profile.values())) == 3
        one = run(LAYERS, STEPS.replace("0.5,1,0.25", "0.5"), f"-output_profile {folder}/q.csv")
        assert open(f"{folder}/q.csv").read() == profile["p_step_0001.csv"] and one["steps"] == 1


def test_a_run_that_is_killed_leaves_a_series_of_the_cycles_so_far():
    """At random moments: of the cycles that were said to be finished at most the last one is missing, and all that is listed is there"""
    options = ["-options_file", LAYERS, *STEPS.replace("0.25", "0.25,0.6,0.3,0.8,0.2").replace("1e-1", "5e-2").split()]
    begun = time.time()
    subprocess.run([PROGRAM, *options], stdout=subprocess.DEVNULL, check=True)
    length, moments, read = time.time() - begun, random.Random(3), 0
    for k in range(12):
        kind = ("xdmf", "vtu")[k % 2]
        with tempfile.TemporaryDirectory() as folder:
            with open(f"{folder}/said", "w") as said:
                command = ["stdbuf", "-oL", PROGRAM, *options, "-output", f"{folder}/f.{kind}"]
                process = subprocess.Popen(command, stdout=said, env={**os.environ, "TMPDIR": folder})
                time.sleep(length * (0.3 + moments.random()))
                process.send_signal(signal.SIGKILL)
                process.wait()
            with open(f"{folder}/said") as said:
                finished = sum(bool(re.match(r" +\d+ +\d+ .*\d\n", line)) for line in said)
            index = f"{folder}/f." + {"xdmf": "xdmf", "vtu": "pvd"}[kind]
            if not os.path.exists(index):
                assert finished <= 1, finished
                continue
            series = read_h5(index) if kind == "xdmf" else read_vtk(index)
            assert finished - 1 <= len(series) <= finished + 1 and all(len(grids) == 3 for _, grids in series), (finished, len(series))
            read += len(series) > 1
    assert read > 3, read
