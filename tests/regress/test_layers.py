"""The scripts of examples/layers read what a run writes: table, picture. The scene is made coarse, its numbers are looked at elsewhere."""
import os, subprocess, sys, tempfile, unittest

from abut import LAYERS, PROGRAM, ROOT, run

SMALL = ["-upper_mesh_cells", "32,8", "-snes_rtol", "1e-4"]


def script(name, *arguments):
    command = [sys.executable, os.path.join(ROOT, "examples", "layers", name), *arguments]
    result = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    if "ModuleNotFoundError" in result.stderr:
        raise unittest.SkipTest(result.stderr.splitlines()[-1])
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def run_to(folder, *more):
    names = {"-record_csv": "layers.csv", "-output": "layers.xdmf", "-output_profile": "layers_profile.csv"}
    files = [word for option, name in names.items() for word in (option, os.path.join(folder, name))]
    record = run(LAYERS, *SMALL, "-adaptor_threshold 0.3", *files, *more)
    with open(os.path.join(folder, "layers.record"), "w") as f: # run() keeps its own record
        f.writelines(f"{key} {value}\n" for key, value in record.items())


def test_table():
    with tempfile.TemporaryDirectory() as folder:
        run_to(folder)
        lines = script("compare.py", folder).splitlines()
        force = next(line.split() for line in lines if line.startswith("P, its integral"))
        assert abs(float(force[-7]) / 123.078 - 1) < 0.05 and force[-6] == "123.078" and force[-3] == "126.574", lines
        assert lines[-1].endswith("verdict: converged"), lines


def test_table_knows_the_penalty():
    with tempfile.TemporaryDirectory() as folder:
        run_to(folder, "-mid_pair_penalty 0.5", "-snes_ddneumann_gamma 0.3")
        assert "ref. c = 0.5" in script("compare.py", folder)


def test_picture():
    with tempfile.TemporaryDirectory() as folder:
        run_to(folder)
        script("plot.py", folder)
        assert os.path.getsize(os.path.join(folder, "layers.png")) > 20000 and os.path.exists(os.path.join(folder, "layers.svg"))
