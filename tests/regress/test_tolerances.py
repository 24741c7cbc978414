"""No absolute tolerance: every small number of the code is in tolerances.txt, with what it is relative to. A new one is written there, or made relative."""

import glob, os, re

from abut import ROOT

LIST = os.path.join(os.path.dirname(os.path.abspath(__file__)), "tolerances.txt")
SMALL = re.compile(r"(?<![\w.])\d+\.?\d*[eE]-\d+")


def small_numbers(path):
    """Of a source without its comments and texts, in order"""
    with open(path) as f:
        text = re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\])*"', " ", f.read(), flags=re.S)
    return SMALL.findall(text)


def found():
    for pattern in ("src/*/*.c", "plugins/*/*.[ch]", "include/*.h", "include/abut/private/*.h"):
        for path in sorted(glob.glob(os.path.join(ROOT, pattern))):
            for number in small_numbers(path):
                yield f"{os.path.relpath(path, ROOT)} {number}"


def test_every_small_number_is_relative_to_something():
    with open(LIST) as f:
        lines = [line.rstrip("\n").split(None, 2) for line in f if line.strip() and not line.startswith("#")]
    assert all(len(line) == 3 for line in lines), [line for line in lines if len(line) != 3]
    listed, there = sorted(" ".join(line[:2]) for line in lines), sorted(found())
    assert listed == there, ("not listed", [x for x in there if x not in listed], "gone", [x for x in listed if x not in there], len(listed), len(there))
