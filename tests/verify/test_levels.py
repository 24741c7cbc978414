"""Meshes refined three times at one place of the contact side: where it ends, and at the corners of the bodies."""
import glob, tempfile

from abut import case, run
from test_loop import layers
from test_output import read_vtu

N = 8  # cells per cm
SIZE = "-{}_mesh_size max({},max(abs(x-{}),abs(y-1)))"


def differences(field):
    """Of the levels of cells, quads along the axes, that share a part of a side; at a point alone they may differ by more"""
    boxes = []
    for cell, (level,) in zip(field["cells"], field["level"]):
        x, y = zip(*(field["vertices"][i][:2] for i in cell))
        boxes.append((min(x), max(x), min(y), max(y), level))
    for n, (left, right, bottom, top, level) in enumerate(boxes):
        for other in boxes[:n]:
            common = min(right, other[1]) - max(left, other[0]), min(top, other[3]) - max(bottom, other[2])
            if min(common) > -1e-9 and max(common) > 1e-9:
                yield abs(level - other[4])


def test_neighbours_differ_by_one_level():
    most = []
    for x in 0, 1, 4:
        with tempfile.TemporaryDirectory() as folder:
            sizes = [SIZE.format(body, 1 / N / 8, x) for body in ("lower", "upper")]
            run(None, layers(N, closure=0.0), *sizes, f"-output {folder}/run.vtu")
            fields = [read_vtu(path) for path in glob.glob(f"{folder}/*.vtu")]
        assert len(fields) == 2 and all(max(field["level"]) == [3] for field in fields)
        most += [max(differences(field)) for field in fields]
    case("H19", "levels between cells that share a side, also at corners of the bodies", max(most), 1)
