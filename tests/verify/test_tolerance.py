"""One number, -scene_tol T, for a relative error T in the energy norm: the true error is below it and not far below, and the run says what it is made of.

The bodies are loaded by displacements alone, so with exact contact the energy F_h of the meshes lies above the true one F, and the relative error in the energy
norm is sqrt(F_h/F - 1). F and the force P were computed without Abut, see examples/layers/reference.json.
"""
import math

from abut import LAYERS, run

F, P = 0.07121310216549717, 126.57389014
FAST = "-snes_type ddactive"


def true_error(record, exact=F):
    return math.sqrt(record["energy.strain"] / exact - 1)


def check(tol, *options):
    """T/5 < error < T, the budget adds up to it, and P is right to T/5"""
    r = run(LAYERS, f"-scene_tol {tol}", *options)
    error = true_error(r)
    assert r["verdict"] == "converged" and r["error.discretisation"] <= tol and "error.unestimated" not in r, r
    assert tol / 5 < error < tol, (tol, options, error)
    assert error / 3 < r["error.discretisation"] < 3 * error, (tol, options, error, r["error.discretisation"])
    assert r["error.penalty"] == 0 and r["pair.mid.theta"] == 0 and r["pair.mid.force_penalty"] == 0, r
    assert max(r["error.loop"], r["error.linear"]) <= tol**2 / 10, (r["error.loop"], r["error.linear"])
    assert abs(r["pair.mid.force"] / P - 1) <= tol / 5, (tol, options, r["pair.mid.force"])
    assert f"scene_tol {tol:g}: theta 0 (exact contact), loop " in r.stdout and "error in the energy norm: discretisation " in r.stdout, r.stdout
    return r


def test_a_tenth():
    for estimator in ("fembem", "zz"):
        check(0.1, FAST, f"-estimator_type {estimator}")
        check(0.1, FAST, f"-estimator_type {estimator} -upper_mesh_cells 8,2")


def test_three_per_cent():
    for estimator in ("fembem", "zz"):
        check(0.03, FAST, f"-estimator_type {estimator}")
        check(0.03, FAST, f"-estimator_type {estimator} -upper_mesh_cells 8,2 -upper_mesh_shape quad")


def test_one_per_cent():
    r = check(0.01, FAST)
    assert r["body.upper.level_max"] >= 1 and r["body.lower.level_max"] >= 5, r


def test_one_per_cent_by_patch_recovery():
    check(0.01, FAST, "-estimator_type zz -upper_mesh_cells 8,2 -upper_mesh_shape quad")


def test_the_solvers_stop_where_their_part_is_small():
    """Iterative solvers in both bodies, far looser than by default"""
    for tol in (0.1, 0.03):
        r = check(tol, FAST, "-upper_mesh_cells 32,8 -lower_pc_type hypre -upper_pc_type hypre")
        assert r["error.linear"] > 1e-8 and f"linear {1e-3 * tol**2:.2g} of lower" in r.stdout, r.stdout


def test_other_loops_get_a_penalty_that_is_a_part_of_the_tolerance():
    for loop in ("-snes_type anderson -snes_anderson_m 20", "-snes_type ddneumann"):
        r = run(LAYERS, "-scene_tol 0.1 -upper_mesh_cells 32,8", loop)
        assert r["verdict"] == "converged" and r["error.discretisation"] <= 0.075, r
        assert abs(r["pair.mid.theta"] / (0.0125 * 2 * 0.91 / 2.1e5) - 1) < 1e-9, r["pair.mid.theta"]
        assert 0.01 < r["error.penalty"] < 0.025 and r["error.loop"] < 0.002, r
        assert abs(r["pair.mid.force"] / P - 1) < 0.1 / 5, r["pair.mid.force"]
        assert abs(r["pair.mid.force"] + r["pair.mid.force_penalty"] / 1.25 - P) < 4e-3 * P, r  # what the meshes cost is left
        assert "put aside mid_pair_penalty, snes_ddneumann_gamma, adaptor_threshold, adaptor_bodies" in r.stdout, r.stdout


def test_tolerances_of_the_user_win():
    r = run(LAYERS, FAST, "-scene_tol 0.1 -upper_mesh_cells 32,8 -snes_rtol 1e-7 -lower_pc_type hypre -lower_ksp_rtol 1e-9 -scene_loop_share 0")
    assert r["residual.loop"] <= 1e-7 and "loop 1e-07 (snes_rtol), linear 1e-09 of lower (its ksp_rtol)" in r.stdout, r.stdout


def test_the_caps_still_hold():
    r = run(LAYERS, FAST, "-scene_tol 0.01 -upper_mesh_cells 32,8 -adaptor_max_level 2", expect=3)
    assert r["verdict"] == "limit_level" and r["error.discretisation"] > 0.01 and "above its part of scene_tol" in r.stdout, r.stdout
    r = run(LAYERS, FAST, "-scene_tol 0.01 -upper_mesh_cells 32,8 -adaptor_max_unknowns 800", expect=3)
    assert r["verdict"] == "limit_unknowns" and max(r["body.lower.unknowns"], r["body.upper.unknowns"]) < 1200, r


BONDED = """-scene_bodies block -block_mesh_box 0,0,2,1 -block_mesh_cells 4,2 -block_material_young 1 -block_material_poisson 0.3
-block_bc_bottom_u1 0 -block_bc_bottom_u2 0 -block_bc_top_u2 -0.01 -block_bc_left_u1 0"""


def test_a_singular_corner_does_not_keep_it_from_ending():
    """A block without contact, its stress infinite at a corner: a threshold on the pointwise indicator would never end there"""
    exact = run(None, BONDED, "-scene_tol 0.004 -adaptor_max_level 20")["energy.strain"]
    for tol in (0.1, 0.05, 0.02):
        r = run(None, BONDED, f"-scene_tol {tol} -adaptor_max_level 20")
        assert tol / 5 < true_error(r, exact) < tol, (tol, true_error(r, exact))
        assert "error.loop" not in r and "error.penalty" not in r and r["error.linear"] < 1e-10, r


def test_every_record_has_a_budget_and_says_what_is_not_in_it():
    r = run(LAYERS, FAST, "-upper_mesh_cells 32,8 -adaptor_threshold 0.3")
    assert r["error.unestimated"] == "upper" and abs(r["error.discretisation"] / r["eta.lower"] - 1) < 1e-9 and r["error.penalty"] > 0.02, r
    assert "(without upper), penalty 0.0" in r.stdout, r.stdout
    r = run(None, BONDED)
    assert r["error.unestimated"] == "block" and "error.discretisation" not in r and "discretisation not estimated, linear " in r.stdout, r
