"""Cells that are merged again, -adaptor_coarsen: on two layers whose first meshes are so coarse that the first jump goes to a place far from the edge of the contact. The
force was computed without Abut, see examples/studies/accuracy."""

import os, tempfile

from abut import ROOT, read_csv, run

EXACT = os.path.join(ROOT, "examples", "studies", "accuracy", "layers_exact.yml")
P, FAR = 126.5738901, "-lower_mesh_cells 3,1 -upper_mesh_cells 3,1 -adaptor_jump 8"
SHAPES = "quad", "triangle"


def adapt(shape, adaptor, coarsen, *options, ranks=1):
    """The cycles of a run with an adaptor of its own"""
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.yml")
        with open(EXACT) as old, open(scene, "w") as new:
            new.writelines(line for line in old if not line.startswith("adaptor:"))
            new.write(f"adaptor: {{{adaptor}, coarsen: {coarsen}}}\n")
        shapes = f"-lower_mesh_shape {shape} -upper_mesh_shape {shape}"
        r = run(scene, shapes, *options, f"-record_csv {folder}/run.csv", ranks=ranks)
        assert r["verdict"] == "converged", r
        return read_csv(f"{folder}/run.csv")


def error(row):
    return abs(row["pair.mid.force"] / P - 1)


def test_cells_that_a_jump_left_behind_go():
    """The same accuracy on as many meshes, with fewer unknowns"""
    for shape, part in zip(SHAPES, (0.88, 0.8)):
        off, on = (adapt(shape, "type: doerfler, target: 0.01", coarsen, FAR) for coarsen in (0, 0.1))
        assert len(on) == len(off), (shape, len(on), len(off))
        assert on[-1]["unknowns"] < part * off[-1]["unknowns"], (shape, on[-1]["unknowns"], off[-1]["unknowns"])
        assert error(on[-1]) < 1.1 * error(off[-1]) < 1e-4, (shape, error(on[-1]), error(off[-1]))
        assert on[1]["unknowns"] == off[1]["unknowns"] and on[2]["unknowns"] < off[2]["unknowns"], (shape, on, off)


def test_where_no_cell_is_left_behind_nothing_is_merged():
    for shape in SHAPES:
        off, on = (adapt(shape, "type: doerfler, target: 3e-3", coarsen) for coarsen in (0, 0.1))
        assert [row["unknowns"] for row in on] == [row["unknowns"] for row in off], shape


def test_every_type_merges_and_ends():
    """With a hysteresis so small that cells are merged which have to be split again"""
    for shape in SHAPES:
        for adaptor in ("type: threshold, threshold: 0.05", "type: equal, target: 5e-3, max_level: 20", "type: doerfler, target: 3e-3, max_level: 20"):
            off, on = (adapt(shape, adaptor, coarsen, FAR, "-estimator_type zz") for coarsen in (0, 0.5))
            assert any(row["unknowns"] != before["unknowns"] for row, before in zip(on, off)), (shape, adaptor)
            assert len(on) < 3 * len(off) and error(on[-1]) < 3 * error(off[-1]) + 1e-4, (shape, adaptor, len(on), len(off), error(on[-1]), error(off[-1]))


def test_cells_at_the_edge_stay():
    """However small their errors are; those beside them go"""
    *_, before, last = adapt("quad", "type: threshold, threshold: 0.02, max_level: 8", 0.5, FAR, "-estimator_type zz")
    assert last["unknowns"] < before["unknowns"] and last["body.lower.level_max"] == before["body.lower.level_max"] == 8, (before, last)


def test_any_number_of_ranks_makes_the_same_meshes():
    keys = "unknowns", "body.lower.cells", "body.upper.cells", "body.lower.level_max", "pair.mid.tied"
    for shape in SHAPES:
        one, *others = (adapt(shape, "type: doerfler, target: 0.01", 0.2, FAR, ranks=ranks) for ranks in (1, 2, 3, 4))
        for rows in others:
            assert [[row[key] for key in keys] for row in rows] == [[row[key] for key in keys] for row in one], (shape, rows, one)
            assert abs(rows[-1]["pair.mid.force"] / one[-1]["pair.mid.force"] - 1) < 1e-8, shape
