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
        assert error[3] < min(5e-5, error[0] / 20) and unknowns[3] < 4 * unknowns[0], (closure, error, unknowns)


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
    assert r["verdict"] == "limit_level", r


def test_a_loop_that_leaves_more_is_refused():
    line = run_error(os.path.join(STUDY, "layers_exact.yml"), "-adaptor_peak 1e-6 -snes_rtol 1e-5")
    assert "adaptor_peak: 1e-06 is below what the loop leaves; give at least 0.0001, or snes_rtol below 1e-07" in line, line
