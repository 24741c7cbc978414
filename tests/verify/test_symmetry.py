"""The layers of examples/layers as a whole, [-4,4], not its right half alone: cells and displacements come in pairs that are mirror images,
however often the meshes are adapted."""
import glob, os, tempfile

from abut import case, run
from test_output import read_vtu

FULL = """-scene_bodies lower,upper -scene_pairs mid -mid_pair_gap 1e-3*x^2 -mid_pair_penalty 0 -lower_mesh_box -4,0,4,1
-upper_mesh_box -4,1,4,2 -lower_mesh_cells 16,2 -upper_mesh_cells 16,2 -lower_material_young 2.1e5 -lower_material_poisson 0.3
-upper_material_young 2.1e5 -upper_material_poisson 0.3 -lower_bc_bottom_u1 0 -lower_bc_bottom_u2 0
-upper_bc_top_u1 0 -upper_bc_top_u2 -1.366e-3"""
UPPER, LOWER = "-mid_pair_bodies upper,lower -mid_pair_sides bottom,top", "-mid_pair_bodies lower,upper -mid_pair_sides top,bottom"
ADAPT = "-adaptor_type {} -adaptor_{} -estimator_type {}"
CLOSURE, DIGITS = 1.366e-3, 9  # digits by which points are told apart


def solve(*options, first=UPPER, expect=0):
    """The record, and of every body and cycle its field"""
    with tempfile.TemporaryDirectory() as folder:
        record = run(None, *FULL.split(), first, *options, f"-output {folder}/run.vtu", expect=expect)
        return record, {os.path.basename(path): read_vtu(path) for path in sorted(glob.glob(f"{folder}/*.vtu"))}


def place(x, y):
    return round(x, DIGITS) + 0.0, round(y, DIGITS)


def lonely(field):
    """Cells whose mirror image is no cell, by their centres"""
    points = [[field["vertices"][i] for i in cell] for cell in field["cells"]]
    centres = {place(sum(p[0] for p in cell) / len(cell), sum(p[1] for p in cell) / len(cell)) for cell in points}
    assert len(centres) == len(points)
    return len(centres - {(-x + 0.0, y) for x, y in centres})


def skew(field):
    """The largest |u(x,y) - mirror image of u(-x,y)| of the vertices, over the closure"""
    at = {place(*x[:2]): u for x, u in zip(field["vertices"], field["displacement"])}
    return max(max(abs(u[0] + at[-x + 0.0, y][0]), abs(u[1] - at[-x + 0.0, y][1])) for (x, y), u in at.items()) / CLOSURE


KINDS = [
    *(ADAPT.format("threshold", "threshold 0.1", estimator) for estimator in ("zz", "residual", "fembem")),
    ADAPT.format("doerfler", "target 0.003", "zz") + " -lower_mesh_order 2 -upper_mesh_order 2",
    ADAPT.format("doerfler", "target 0.02", "fembem"),
]


def test_meshes_and_displacements_stay_symmetric_for_six_adaptations():
    alone, off = 0, 0
    for options in KINDS:
        record, fields = solve(options)
        assert record["cycles"] >= 7, record["cycles"]
        for name, field in fields.items():
            if int(name[-8:-4]) <= 6:
                alone += lonely(field)
                off = max(off, skew(field))
        print(options, record["cycles"], record["unknowns"], alone, off)
    case("H18", "cells without a mirror image after up to 6 adaptations", alone, 0)
    case("H18", "displacement off its mirror image, over the closure", off, 1e-9)


def test_either_body_may_be_the_first_on_adapted_meshes():
    one, other = (solve(KINDS[0], first=first)[0] for first in (UPPER, LOWER))
    assert one["unknowns"] == other["unknowns"] and one["cycles"] == other["cycles"]
    case("H18", "force off that with the bodies in the other order", abs(one["pair.mid.force"] / other["pair.mid.force"] - 1), 1e-8)
