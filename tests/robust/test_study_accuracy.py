"""The tables of examples/studies/accuracy: one order, estimator and marking"""

import csv, os, subprocess, sys, tempfile

from abut import PROGRAM, ROOT

SCRIPT = os.path.join(ROOT, "examples", "studies", "accuracy", "accuracy.py")


def study(folder, *options):
    command = [sys.executable, SCRIPT, "--abut", PROGRAM, "--out", folder, "--quick", "--order", "3"]
    return subprocess.run(command + list(options), capture_output=True, text=True)


def test_the_quick_table():
    with tempfile.TemporaryDirectory() as folder:
        result = study(folder)
        assert not result.returncode, result.stdout + result.stderr
        with open(os.path.join(folder, "accuracy.csv")) as f:
            rows = list(csv.DictReader(f))
        assert len(rows) > 6 and all(row["P"] and row["cpu"] and float(row["pressure_error"]) < 0.1 for row in rows), rows
        assert [int(row["cycle"]) for row in rows] == list(range(1, len(rows) + 1)), rows
        unknowns = [int(row["unknowns"]) for row in rows]
        assert unknowns == sorted(unknowns), rows
        with open(os.path.join(folder, "accuracy.md")) as f:
            page = f.read()
        assert "| the scene | 3 | (1e-5, 1e-4) | 1700 | " in page and page.count("| met |") == 1, page
        assert all(os.path.getsize(os.path.join(folder, f"accuracy.{kind}")) > 1e4 for kind in ("png", "svg"))
        again = study(folder, "--tables")  # nothing is run twice
        assert not again.returncode and again.stdout.count("| the scene |") == 1, again.stdout + again.stderr


def test_a_run_that_fails_stays_in_the_table():
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "abut")
        with open(program, "w") as f:
            f.write("#!/bin/sh\necho out of order >&2\nexit 1\n")
        os.chmod(program, 0o755)
        result = study(folder, "--abut", program)
        assert not result.returncode and "*out of order*" in result.stdout, result.stdout + result.stderr
