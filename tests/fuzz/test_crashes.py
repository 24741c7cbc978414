"""What once crashed a reader, or made it say more than one line: found by `make fuzz`, see readers.py"""
import glob, os, sys

from abut import PROGRAM, ROOT, execute

sys.path.insert(0, os.path.join(ROOT, "tests", "errors"))
from test_errors import ends_well  # noqa: E402

HERE = os.path.join(ROOT, "tests", "fuzz")
SCENE = os.path.join(HERE, "restart.yml")


def check(reader, options):
    """options(path): the words with which the program reads it"""
    paths = sorted(glob.glob(os.path.join(HERE, "crashes", reader, "*")))
    assert paths, reader
    for path in paths:
        result = execute([PROGRAM, *options(path)], 60)
        assert ends_well(result), f"{path}: exit status {result.returncode}\n{result.stdout}{result.stderr}"


def test_scenes_that_once_crashed():
    check("scene", lambda path: [path, "-snes_max_it", "2"])


def test_formulas_that_once_crashed():
    check("formula", lambda path: [SCENE, "-mid_pair_gap", open(path, newline="").read()])


def test_checkpoints_that_once_crashed():
    check("restart", lambda path: [SCENE, "-restart", path])
