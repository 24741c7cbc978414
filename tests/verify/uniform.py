"""Unknowns that adapted meshes need, beside those of uniform ones, for the same error of the same quantity"""
import tempfile

from abut import read_csv

UNIFORM, ADAPTED = "-adaptor_bulk 1 -adaptor_target 1e-9", "-adaptor_target 1e-9"


def series(solve, *options):
    """The cycles of run(), or of a function that ends in it, up to the limit that the options set"""
    with tempfile.TemporaryDirectory() as folder:
        solve(*options, f"-scene_loop_share 0 -record_csv {folder}/cycles.csv", expect=3)
        return read_csv(f"{folder}/cycles.csv")


def needed(rows, error, target):
    """Unknowns of the first mesh from which on all are good enough: an edge that lies well between two nodes makes a coarse mesh good by chance"""
    good = None
    for row in sorted(rows, key=lambda row: row["unknowns"]):
        good = (good or row["unknowns"]) if error(row) <= target else None
    return good


def share(name, what, error, target, uniform, adapted):
    """A line of the table, and the unknowns in adapted meshes as a part of those in uniform ones, or of their most if none was good enough.
    Adapted meshes have to be good up to twice as many, or the last one may be so by chance."""
    most = max(row["unknowns"] for row in uniform)
    both = [needed(rows, error, target) for rows in (uniform, adapted)]
    print(f"{name:28s} error of {what:12s} at most {target:g}: {both[0] or f'more than {most}'} unknowns in uniform meshes, {both[1]} in adapted ones")
    assert both[1] and 2 * both[1] <= max(row["unknowns"] for row in adapted), [(row["unknowns"], error(row)) for row in adapted]
    return both[1] / (both[0] or most)
