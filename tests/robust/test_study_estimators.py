"""The study of estimators on the scene with an exact stress: a plugin of a user beside a shipped estimator, and what fails"""
import csv, os, shutil, subprocess, sys, tempfile

from abut import PROGRAM, ROOT

SCRIPT = os.path.join(ROOT, "examples", "studies", "estimators", "estimators.py")


def study(folder, *options):
    command = [sys.executable, SCRIPT, "--abut", PROGRAM, "--out", folder, "--scene", "hertz", *options]
    return subprocess.run(command, capture_output=True, text=True)


def rows_of(folder):
    with open(os.path.join(folder, "estimators.csv")) as f:
        return list(csv.DictReader(f))


def template(folder):
    """The template under another name, built outside the tree"""
    place = os.path.join(folder, "mine")
    shutil.copytree(os.path.join(ROOT, "plugins", "template"), place)
    with open(os.path.join(place, "template.c")) as f:
        text = f.read().replace("estimator_template", "estimator_mine").replace('"template"', '"mine"')
    with open(os.path.join(place, "mine.c"), "w") as f:
        f.write(text)
    made = subprocess.run(["make", "-s", "-C", place, "NAME=mine", f"ABUT_DIR={ROOT}"], capture_output=True, text=True)
    assert not made.returncode, made.stdout + made.stderr
    return os.path.join(place, "libestimator_mine.so")


def test_a_plugin_of_a_user_is_judged_beside_the_shipped_ones():
    with tempfile.TemporaryDirectory() as folder:
        plugin = ("--plugin", template(folder))
        result = study(folder, *plugin, "--only", "mine", "--only", "zz")
        assert not result.returncode, result.stdout + result.stderr
        rows = rows_of(folder)
        assert {row["estimator"] for row in rows} == {"mine", "zz"} and {row["body"] for row in rows} == {"lower", "upper"}
        for estimator, low, high, rank in ("zz", 0.95, 1.1, 0.95), ("mine", 0.9, 1.5, 0.8):
            mine = [row for row in rows if row["estimator"] == estimator and int(row["unknowns"]) > 500]
            assert len(mine) > 4 and all(low < float(row["effectivity"]) < high and float(row["spearman"]) > rank for row in mine), mine
        lower, upper = ([row["error"] for row in rows if row["body"] == body] for body in ("lower", "upper"))
        assert all(abs(float(a) / float(b) - 1) < 1e-3 for a, b in zip(lower, upper))  # mirror images
        errors = [float(one) for one in lower]
        assert min(errors) < 0.06, errors
        with open(os.path.join(folder, "estimators.md")) as f:
            assert "| hertz | lower | mine | " in f.read()
        assert all(os.path.getsize(os.path.join(folder, f"{stem}.svg")) > 1e4 for stem in ("estimators", "estimators_meshes"))
        again = study(folder, *plugin, "--only", "mine", "--only", "zz")  # nothing is run twice
        assert not again.returncode and "2 cases, 2 of them in" in again.stdout and len(rows_of(folder)) == len(rows)


def test_a_plugin_that_fails_stays_a_row_and_a_wrong_one_is_named():
    """The order of the scenes is 1, an estimator that wants another is refused by Abut"""
    with tempfile.TemporaryDirectory() as folder:
        library = template(folder)
        with open(os.path.join(folder, "mine", "mine.c")) as f:
            text = f.read().replace("t->order == 1", "t->order == 2")
        with open(os.path.join(folder, "mine", "mine.c"), "w") as f:
            f.write(text)
        made = subprocess.run(["make", "-s", "-C", os.path.dirname(library), "NAME=mine", f"ABUT_DIR={ROOT}"], capture_output=True, text=True)
        assert not made.returncode, made.stderr
        result = study(folder, "--plugin", library, "--only", "mine")
        assert not result.returncode, result.stdout + result.stderr
        (row,) = rows_of(folder)
        assert row["verdict"].startswith("abut: estimator_type: template is for order 1") and not row["effectivity"], row
        result = study(folder, "--plugin", os.path.join(folder, "libnone.so"))
        assert result.returncode == 1 and result.stderr.count("\n") == 1 and "is no file libestimator_NAME.so" in result.stderr, result.stderr
