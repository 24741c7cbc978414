"""Errors of force and peak pressure over unknowns, on two layers in exact contact, both adapted from 8 by 2 quads: the limits of
examples/studies/accuracy, with one estimator and marking each. A target counts if every later mesh meets it too, and there is one."""

import json, math, os, tempfile

from abut import LAYERS, ROOT, read_csv, run

STUDY = os.path.join(ROOT, "examples", "studies", "accuracy")
SCENE = os.path.join(STUDY, "layers_exact.yml")
TIGHT = "-scene_loop_share 1e-4"  # of the error: every mesh counts here, not only the last one


def references():
    with open(os.path.join(STUDY, "reference.json")) as f:
        return {(case["materials"], case["closure"]): case for case in json.load(f)["cases"]}


def series(order, most, *options):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "run.csv")
        orders = f"-lower_mesh_order {order} -upper_mesh_order {order} -adaptor_max_unknowns {most}"
        run(SCENE, orders, TIGHT, "-record_csv", path, *options, expect=None)
        return read_csv(path)


def unknowns(rows, one, target):
    """Of the first mesh from which on all meet the target"""
    errors = [(abs(row["pair.mid.force"] / one["P"] - 1), abs(row["pair.mid.pressure_max"] / one["p0"] - 1)) for row in rows]
    good = [error[0] <= target[0] and error[1] <= target[1] for error in errors]
    first = len(good) - good[::-1].index(False) if False in good else 0
    assert first < len(rows) - 1, (target, [(row["unknowns"], *error) for row, error in zip(rows, errors)])
    return rows[first]["unknowns"]


def reaches(target, most, order, options, layers="equal", closure=1.366):
    rows = series(order, int(1.3 * most), options, f"-upper_bc_top_u2 {-1e-3 * closure!r}")  # of one body, so twice this of both
    rows = [row for row, after in zip(rows, rows[1:] + [{}]) if row["unknowns"] != after.get("unknowns")]  # the last solve of each mesh
    found = unknowns(rows, references()[layers, closure], target)
    assert found <= most, (target, order, options, closure, found, most)


def test_references():
    """Finite elements of order 9 in both bodies agree with the integral equation to their error bounds; the series are what they say"""
    with open(os.path.join(os.path.dirname(LAYERS), "reference.json")) as f:
        finite = json.load(f)["cases"]["0"]
    for key in ("a", "p0", "P"):
        assert abs(references()["equal", 1.366][key] - finite[key]["value"]) <= finite[key]["error"] + 5e-10 * finite[key]["value"], key
    for one in references().values():
        assert abs(sum((-1) ** k * c for k, c in enumerate(one["chebyshev"])) / one["p0"] - 1) < 1e-9, one
        assert abs(one["a"] * math.pi / 4 * one["chebyshev"][0] / one["P"] - 1) < 1e-9, one
        assert all(abs(one[key] / one["without_end"][key] - 1) < 3e-6 for key in ("a", "p0", "P")), one


def test_order_1():
    """As good as the mesh that happens to be next: bulk 0.4, 0.5, 0.7 take 8548, 8584, 11188"""
    reaches((1e-4, 1e-3), 9500, 1, "-estimator_type fembem -adaptor_bulk 0.5 -adaptor_follow no")


def test_order_2():
    reaches((1e-4, 1e-3), 900, 2, "-adaptor_bulk 0.5")
    reaches((1e-5, 1e-4), 2100, 2, "-adaptor_bulk 0.4")
    reaches((1e-5, 1e-4), 1.15 * 2100, 2, "-estimator_type zz -adaptor_bulk 0.4 -adaptor_jump 3 -adaptor_peak 1e-4 -adaptor_settle yes", closure=1.0)


def test_order_3():
    reaches((1e-5, 1e-4), 1700, 3, "-adaptor_bulk 0.5")
    for closure in (1.0, 1.2, 1.6, 2.2):
        reaches((1e-5, 1e-4), 1.15 * 1700, 3, "-adaptor_bulk 0.5", closure=closure)
    aluminium = "-adaptor_bulk 0.5 -lower_material_young 7e4 -lower_material_poisson 0.33"
    reaches((1e-5, 1e-4), 1.5 * 1700, 3, aluminium, layers="steel on aluminium")
    reaches((1e-5, 1e-4), 1.5 * 1700, 3, "-adaptor_bulk 0.5 -adaptor_peak 1e-4 -lower_mesh_cells 6,2")


def test_order_4():
    reaches((1e-7, 1e-5), 3800, 4, "-estimator_type fembem -adaptor_bulk 0.5")
    for closure in (1.0, 1.2, 1.366, 1.6, 2.2):
        reaches((1e-7, 1e-5), 1.15 * 3800, 4, "-adaptor_bulk 0.6 -adaptor_jump 3 -adaptor_peak 5e-6", closure=closure)


def test_order_4_to_eight_digits():
    """By the nodal pressure at x = 0, with which the recovered one has no advantage at order 4"""
    one, found = references()["equal", 1.366], []
    for target in (2e-4, 1e-4, 5e-5):
        with tempfile.TemporaryDirectory() as folder:
            options = f"-lower_mesh_order 4 -upper_mesh_order 4 -adaptor_bulk 0.6 -adaptor_jump 3 -adaptor_target {target}"
            r = run(SCENE, options, "-output_profile", f"{folder}/profile.csv")
            p0 = [row["pressure"] for row in read_csv(f"{folder}/profile.csv") if row["side"] == "pressure" and row["x"] == 0]
        found.append((r["unknowns"], abs(r["pair.mid.force"] / one["P"] - 1), abs(p0[0] / one["p0"] - 1)))
    assert found[0][0] <= 6200 and all(P <= 1e-8 and p0 <= 5e-6 for _, P, p0 in found), found


def test_least_work():
    """Of the presets: meshes, and what they promise"""
    for name, target, meshes in (("accuracy.opts", (1e-5, 1e-4), 4), ("accuracy_high.opts", (1e-7, 1e-5), 6)):
        for closure in (1.366, 1.0, 1.2, 1.6, 2.2):
            preset = os.path.join(ROOT, "petscopts", name)
            r, one = run(SCENE, "-options_file", preset, f"-upper_bc_top_u2 {-1e-3 * closure!r}"), references()["equal", closure]
            assert r["verdict"] == "converged" and r["cycles"] <= meshes, r
            assert abs(r["pair.mid.force"] / one["P"] - 1) <= target[0] and abs(r["pair.mid.pressure_max"] / one["p0"] - 1) <= target[1], r
