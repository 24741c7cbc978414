"""Bulk marking and jumps at the edge of the contact, on two layers in exact contact: the run ends at its target, with fewer unknowns than equal errors, and a jump
saves meshes. F as in test_tolerance.py."""
import math, os, tempfile

from abut import LAYERS, read_csv, run

F, A = 0.07121310216549717, 0.9926420758
EXACT = "-mid_pair_penalty 0 -upper_mesh_cells 8,2 -upper_mesh_shape quad -estimator_type zz"


def adapt(adaptor, *options, **more):
    """The scene without the keys of its own adaptor, estimator and loop"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.yml")
        with open(LAYERS) as old, open(path, "w") as new:
            new.writelines(line for line in old if not line.startswith(("adaptor:", "estimator:", "snes:")))
            new.write(f"adaptor: {{{adaptor}}}\n")
        return run(path, EXACT, *options, **more)


def test_it_ends_at_the_target_with_few_unknowns():
    equal, bulk = adapt("type: equal, target: 0.03"), adapt("type: doerfler, target: 0.03")
    assert 0.02 < bulk["error.discretisation"] <= 0.03, bulk
    for r in (equal, bulk):
        r["product"] = r["unknowns"] * (r["energy.strain"] / F - 1)  # order 1: the energy falls like 1/unknowns
    assert bulk["product"] < 1.05 * equal["product"], (equal["product"], bulk["product"])
    assert bulk["cycles"] > equal["cycles"], (equal["cycles"], bulk["cycles"])


def test_with_a_tolerance_the_bulk_stays():
    r = adapt("type: doerfler, bulk: 0.7", "-scene_tol 0.05")
    error = math.sqrt(r["energy.strain"] / F - 1)
    assert 0.01 < error < 0.05 and 0.025 < r["error.discretisation"] <= 0.75 * 0.05, (error, r["error.discretisation"])
    assert r["cycles"] > adapt("type: equal", "-scene_tol 0.05")["cycles"]


def levels(adaptor, *options):
    """The highest level of both bodies in each cycle"""
    with tempfile.TemporaryDirectory() as folder:
        adapt(adaptor, "-record_csv", f"{folder}/run.csv", *options, expect=None)
        return [(row["body.lower.level_max"], row["body.upper.level_max"]) for row in read_csv(f"{folder}/run.csv")]


def test_jumps_reach_small_cells_at_the_edge_at_once():
    """The marked cells of a first mesh of 16 by 4 cells touch the edge; the cap on the level holds"""
    for shape in ("quad", "triangle"):
        for kind in ("type: doerfler, target: 0.05", "type: threshold, threshold: 0.15"):
            for jump, cap in ((1, 8), (3, 8), (4, 2)):
                options = [f"-{body}_mesh_{key}" for body in ("lower", "upper") for key in (f"shape {shape}", "cells 16,4")]
                first, second, *others = levels(f"{kind}, jump: {jump}, max_level: {cap}", *options)
                assert first == (0, 0) and second == 2 * (min(jump, cap),), (shape, kind, jump, cap, first, second)
                assert all(level <= cap for pair in others for level in pair), (shape, kind, jump, cap, others)


def test_jumps_save_meshes():
    """Where it is the level at the edge that the target waits for: to 0.02, order 1, the cells elsewhere take as many meshes"""
    r = []
    for order, target in (1, 0.01), (2, 0.002):
        orders = f"-lower_mesh_order {order} -upper_mesh_order {order}"
        r += [adapt(f"type: doerfler, target: {target}, jump: {jump}", orders) for jump in (1, 3)]
        assert r[-1]["cycles"] < r[-2]["cycles"] and r[-1]["unknowns"] < r[-2]["unknowns"], [(one["cycles"], one["unknowns"]) for one in r]
    assert all(abs(one["pair.mid.contact_edge"] - A) < one["body.lower.hmin"] for one in r), r


def test_any_number_of_ranks_makes_the_same_meshes():
    keys = ("cycles", "unknowns", "body.lower.cells", "body.upper.cells", "body.lower.level_max")
    for shape in ("quad", "triangle"):
        options = f"-upper_mesh_shape {shape} -lower_mesh_shape {shape}"
        runs = [adapt("type: doerfler, target: 0.06, bulk: 0.7, jump: 2", options, ranks=ranks) for ranks in (1, 2, 3, 4)]
        assert all(abs(r["pair.mid.force"] / runs[0]["pair.mid.force"] - 1) < 1e-8 for r in runs), runs
        assert len({tuple(r[key] for key in keys) for r in runs}) == 1, [[r[key] for key in keys] for r in runs]


def test_the_loop_has_a_tolerance_where_the_estimate_is_above_one():
    """The first meshes are so coarse that the estimate says more than the whole"""
    r = adapt("type: doerfler, target: 0.1", "-lower_mesh_cells 2,1 -upper_mesh_cells 2,1 -scene_loop_share 0.9")
    assert r["error.discretisation"] <= 0.1 and abs(r["pair.mid.force"] / 126.57389 - 1) < 0.02, r
