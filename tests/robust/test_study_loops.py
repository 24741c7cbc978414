"""The table of all loops, examples/studies/loops: two meshes and three penalties of one pair of layers"""
import csv, os, subprocess, sys, tempfile

from abut import PROGRAM, ROOT

SCRIPT = os.path.join(ROOT, "examples", "studies", "loops", "loops.py")


def study(folder, *options):
    command = [sys.executable, SCRIPT, "--abut", PROGRAM, "--out", folder, "--quick", "--cap", "60", "--layers", "steel on aluminium"]
    return subprocess.run(command + list(options), capture_output=True, text=True)


def test_the_quick_table_keeps_what_the_default_loop_promises():
    with tempfile.TemporaryDirectory() as folder:
        result = study(folder)
        assert not result.returncode, result.stdout + result.stderr
        print(result.stdout[-900:])
        with open(os.path.join(folder, "loops.csv")) as f:
            rows = list(csv.DictReader(f))
        assert len(rows) == 2 * 3 * 7
        default = [row for row in rows if row["loop"].startswith("ddactive")]
        assert len(default) == 12 and all(row["verdict"] == "converged" and int(row["sweeps"]) <= 8 for row in default), default
        for row in rows:  # failures stay in the table, with what was wrong
            refused = float(row["c"]) == 0 and not row["loop"].startswith("ddactive")
            assert (row["verdict"] == "refused") == refused and row["verdict"], row
        assert {row["verdict"] for row in rows if row["loop"] == "paper"} == {"refused", "max_iterations"}
        with open(os.path.join(folder, "loops.md")) as f:
            page = f.read()
        assert page.count("| 0.0005 | ") == 2 and "*max iterations, 61*" in page and page.count(" refused |") == 2 * 5
        with open(os.path.join(folder, "loops.svg")) as f:  # failures and all loops are in the picture
            picture = f.read()
        assert all(f"<!-- {loop} -->" in picture for loop in {row["loop"] for row in rows}) and os.path.getsize(os.path.join(folder, "loops.png")) > 3e3
        again = study(folder)  # nothing is run twice
        assert not again.returncode and "42 runs, 42 of them in" in again.stdout, again.stdout
        with open(os.path.join(folder, "loops.csv"), "a") as f:  # what is in the file counts
            f.write("steel on aluminium,1/16,0.05,ddactive,60,0,converged,21,1e-9,123.1,1,1,1,1\n")
        assert study(folder).returncode == 1
