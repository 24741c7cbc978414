"""Cells below the largest pressure, refined until they resolve it: -adaptor_peak. The pressure on two layers was computed without Abut, see
examples/studies/accuracy."""

import json, os, tempfile

from abut import ROOT, read_csv, run, run_error

STUDY = os.path.join(ROOT, "examples", "studies", "accuracy")
with open(os.path.join(STUDY, "reference.json")) as f:
    P0 = {case["closure"]: case["p0"] for case in json.load(f)["cases"] if case["materials"] == "equal"}


def pressed(*options, ranks=1):
    """The two layers of the study, at order 3 and with an error of the energy that 8 by 2 cells nearly have: cycles, and x of the vertices of both sides"""
    with tempfile.TemporaryDirectory() as folder:
        files = f"-record_csv {folder}/run.csv -output_profile {folder}/profile.csv"
        energy = "-lower_mesh_order 3 -upper_mesh_order 3 -adaptor_target 0.02"
        r = run(os.path.join(STUDY, "layers_exact.yml"), energy, *options, files, ranks=ranks)
        profile, cycles = read_csv(f"{folder}/profile.csv"), read_csv(f"{folder}/run.csv")
    assert r["verdict"] == "converged", r
    return cycles, [sorted(row["x"] for row in profile if str(row["side"]) == side)[::3] for side in ("1", "2")]


def test_the_peak_is_resolved_whatever_the_energy_says():
    for closure in (1.0, 1.366, 2.2):
        error, unknowns = [], []
        for peak in ("0", "1e-3", "1e-4", "1e-5"):
            cycles, sides = pressed(f"-adaptor_peak {peak} -upper_bc_top_u2 {-1e-3 * closure!r}")
            error.append(abs(cycles[-1]["pair.mid.pressure_max"] / P0[closure] - 1))
            unknowns.append(cycles[-1]["unknowns"])
            assert sides[0][:2] == sides[1][:2], sides  # both bodies alike
        assert all(e <= most for e, most in zip(error, (1e-2, 1e-3, 1.5e-4, 5e-5))) and error[3] < error[0] / 15, (closure, error)
        assert unknowns == sorted(unknowns) and unknowns[2] < 2 * unknowns[0] and unknowns[3] < 4 * unknowns[0], (closure, unknowns)


def test_a_peak_anywhere_is_found_and_not_only_on_nodes():
    """The middle of the gap between the vertices of all meshes of the first run, and on a vertex of the first mesh of the second one"""
    order = "-lower_mesh_order 4 -upper_mesh_order 4 -adaptor_target 1e-4 -adaptor_bulk 0.7 -adaptor_jump 3"
    for place in (2.1, 1.9):
        gap = f'-mid_pair_gap "1e-3*(x-{place})^2"'
        found, on_vertex = (pressed(order, gap, more)[0] for more in ("-adaptor_peak 1e-5", "-lower_mesh_cells 40,2 -upper_mesh_cells 40,2"))
        assert abs(found[-1]["pair.mid.pressure_max"] / on_vertex[-1]["pair.mid.pressure_max"] - 1) < 1e-5 and len(found) < 9, (place, found, on_vertex)


def test_noise_of_the_loop_is_no_peak():
    """Few meshes, with any adaptor and gap, where the tolerance of the loop would show on small cells"""
    for options in (
        "-adaptor_type equal -adaptor_peak 1e-5",
        "-lower_mesh_order 2 -upper_mesh_order 2 -adaptor_peak 1e-5",
        '-lower_mesh_order 2 -upper_mesh_order 2 -adaptor_peak 1e-4 -mid_pair_gap "1e-3*(x-2.18)^2"',
        "-lower_mesh_order 4 -upper_mesh_order 4 -adaptor_peak 2e-7",
    ):
        cycles, _ = pressed(options)
        assert len(cycles) <= 10, (options, [row["unknowns"] for row in cycles])


def test_corners_are_left_alone():
    """The pressure below a punch, or beside a body that ends, is unbounded"""
    punch = os.path.join(ROOT, "examples", "punch", "punch.yml")
    with_peak, without = (run(punch, f"-adaptor_peak {peak}") for peak in ("1e-3", "0"))
    assert with_peak["unknowns"] < 1.2 * without["unknowns"] and with_peak["verdict"] == "converged", with_peak
    pressed("-lower_mesh_box -0.3,0,4,1 -adaptor_peak 1e-4")


def test_shapes_and_orders():
    """Triangles; order 1, which has no last coefficient; bodies of different orders and cells"""
    for options, error in (
        ("-lower_mesh_shape triangle -upper_mesh_shape triangle -adaptor_follow no -adaptor_peak 1e-4", 5e-4),
        ("-lower_mesh_order 1 -upper_mesh_order 1 -adaptor_target 0.1 -adaptor_peak 1e-3", 3e-3),
        ("-lower_mesh_order 2 -lower_mesh_cells 6,2 -upper_mesh_order 4 -adaptor_peak 1e-4", 5e-4),
    ):
        cycles, _ = pressed(options)
        assert abs(cycles[-1]["pair.mid.pressure_max"] / P0[1.366] - 1) < error, (options, cycles[-1])


def test_any_number_of_ranks_makes_the_same_meshes():
    runs = [pressed("-adaptor_peak 1e-5", ranks=ranks) for ranks in (1, 2, 3, 4)]
    for cycles, sides in runs[1:]:
        assert [row["unknowns"] for row in cycles] == [row["unknowns"] for row in runs[0][0]], cycles
        assert all(abs(a - b) < 1e-8 for one, other in zip(sides, runs[0][1]) for a, b in zip(one, other)), (sides, runs[0][1])


def test_a_limit_ends_it():
    r = run(
        os.path.join(STUDY, "layers_exact.yml"),
        "-lower_mesh_order 3 -upper_mesh_order 3 -adaptor_target 0.02 -adaptor_max_level 1 -adaptor_peak 1e-6",
        expect=3,
    )
    assert r["verdict"] == "limit_level" and "the largest pressure not resolved: raise" in r.stdout.splitlines()[-1], r.stdout


def test_a_loop_that_leaves_more_is_refused():
    line = run_error(os.path.join(STUDY, "layers_exact.yml"), "-adaptor_peak 1e-6 -snes_rtol 1e-5")
    assert "adaptor_peak: 1e-06 is below what the loop leaves; give at least 0.00333333, or snes_rtol at most 3e-09" in line, line


def test_what_cannot_be():
    scene = os.path.join(STUDY, "layers_exact.yml")
    assert "upper is in contact and not in adaptor_bodies" in run_error(scene, "-adaptor_peak 1e-4 -adaptor_bodies lower")
    assert "adaptor_peak: needs a loop that converges on each mesh" in run_error(
        scene, "-adaptor_peak 1e-4 -scene_interleave yes -snes_type ddneumann -mid_pair_penalty 0.05")
    run(scene, "-adaptor_peak 1e-4 -scene_tol 0.05")  # the loop of the tolerance goes as far as the peak wants
