"""Up to sixteen ranks, more than cores and more than cells of a body: the same meshes, and the same record to the tenth digit"""
import os, sys, tempfile

from abut import LAYERS, ROOT, case, run
from same import farthest_key, outcome

sys.path.append(os.path.join(ROOT, "examples", "stack"))
import stack

EXACT = "-snes_rtol 1e-12"
WAYS = ("", "-scene_split")  # all bodies on all ranks, and each on ranks of its own
SHARED = "-scene_split -snes_ddactive_share 0"  # and all ranks have a part of the contact model
RANKS = (7, 16)
ALL = (2, 3, 4, 7, 13, 16)


def check_many(scene, *options, ranks=RANKS, ways=(WAYS[0], SHARED)):
    """The rows of the cycles on one rank"""
    record, rows, cells = outcome(scene, (EXACT, *options), 1, 0)
    assert record["cycles"] > 1
    worst, others = (0, ""), 0
    for n in ranks:
        for way in ways:
            again, more, same = outcome(scene, (EXACT, *options, *way.split()), n, 0)
            others += cells != same or len(rows) != len(more)
            worst = max(worst, farthest_key(record, again), *map(farthest_key, rows, more))
    assert worst[0] <= 1e-10, worst
    case("H24", f"records of all meshes on {', '.join(map(str, ranks))} ranks off those on one", worst[0], 1e-10)
    case("H24", f"of {len(ranks) * len(ways)} runs on {ranks[-1]} ranks or fewer those with other meshes", others, 0)
    return rows


def paper(ranks=RANKS):
    check_many(LAYERS, "-upper_mesh_cells 16,4 -mid_pair_penalty 2 -snes_ddneumann_gamma 0 -adaptor_threshold 0.28", ranks=ranks, ways=WAYS)


def layers(ranks=RANKS):
    check_many(LAYERS, "-upper_mesh_cells 16,4 -snes_type ddactive -adaptor_threshold 0.2", ranks=ranks)


def stacked(ranks=RANKS):
    """Five bodies, first of four cells each, of fewer cells than ranks to the end"""
    with tempfile.NamedTemporaryFile("w", suffix=".yml") as f:
        f.write(stack.scene(5, 1))
        f.flush()
        rows = check_many(f.name, "-adaptor_type doerfler -adaptor_target 0.28 -estimator_type zz", ranks=ranks)
    assert rows[0]["body.layer1.cells"] == 4 and rows[-1]["body.layer1.cells"] < 16


def hertz(ranks=RANKS):
    """Triangles of order 2 from gmsh, one side curved, meshes that follow the edge of the contact"""
    check_many(os.path.join(ROOT, "examples", "hertz", "hertz.yml"), "-adaptor_target 0.03", ranks=ranks)


def test_the_paper_s_loop():
    paper()


def test_layers():
    layers()


def test_a_stack_of_five():
    stacked()


def test_hertz_from_gmsh():
    hertz()


ALIKE = """scene: {bodies: block, pairs: foot}
block:
  mesh: {box: "0,0,16,1", cells: "32,2", shape: quad, order: 1, size: "0.04+0.25*max(0,min(x,16-x)-1)+0.5*y"}
  material: {young: 2.1e5, poisson: 0.3}
  bc_left: {u1: 0}
  bc_top: {u2: "-1.e-3*(1+0.05*x)"}
foot:
  pair: {bodies: block, sides: bottom, penalty: 0, height: 1, obstacle: y}
"""


def test_a_side_refined_alike_at_both_ends():
    """The contact model's modes have pairs of eigenvalues that are the same to round-off, here and there on two ranks: as many sweeps as on one"""
    with tempfile.NamedTemporaryFile("w", suffix=".yml") as f:
        f.write(ALIKE)
        f.flush()
        one = run(f.name, EXACT)
        for ranks, shared in (4, ""), (5, "-snes_ddactive_share 0"), (8, "-snes_ddactive_share 0"), (8, ""):
            other = run(f.name, EXACT, *shared.split(), ranks=ranks)
            worst = farthest_key(one, other)
            assert worst[0] <= 1e-9 and other["sweeps"] == one["sweeps"], (ranks, shared, worst)
