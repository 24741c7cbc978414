"""Scenes with the effects thermal, plane_stress and axisymmetric, against formulas: G. Lame's tube, clamped bars, a strip that bends"""
from math import pi

from abut import run

YOUNG, NU, ALPHA = 2.1e5, 0.3, 1.2e-5
BODY = f"-scene_bodies part -scene_probes P -part_material_young {YOUNG} -part_material_poisson {NU} -P_probe_body part"
ROUND = "-scene_effects round -round_effect_type axisymmetric"
SHEET = "-scene_effects heat,sheet -sheet_effect_type plane_stress"
HEAT = f"-heat_effect_type thermal -heat_effect_expansion {ALPHA} -heat_effect_temperature"


def near(value, exact, tolerance, scale=None):
    assert abs(value - exact) <= tolerance * (scale or abs(exact)), (value, exact)


def check(record):
    assert record["verdict"] == "converged" and record["check.balance"] < 1e-8 and record["check.energy"] < 1e-8, record


def lame(options, ranks=1):
    """The tube 1 <= r <= 2 of length 1/2 under a pressure of 100 inside, no strain along it, at r = 1.3; errors of u_r, s_rr, s_tt"""
    r, k = 1.3, 100 / 3
    tube = "-part_mesh_box 1,0,2,0.5 -part_bc_left_t1 100 -part_bc_bottom_u2 0 -part_bc_top_u2 0 -P_probe_point 1.3,0.2"
    record = run(None, *BODY.split(), *ROUND.split(), *tube.split(), *options.split(), ranks=ranks)
    check(record)
    exact = {"u1": (1 + NU) / YOUNG * k * ((1 - 2 * NU) * r + 4 / r), "s11": k * (1 - 4 / r**2), "s33": k * (1 + 4 / r**2), "s22": 2 * NU * k}
    return {key: abs(record[f"probe.P.{key}"] / value - 1) for key, value in exact.items()}, record


def test_a_tube_under_pressure_is_that_of_lame():
    for shape, order in ("quad", 2), ("quad", 4), ("triangle", 3):
        error, record = lame(f"-part_mesh_shape {shape} -part_mesh_order {order} -part_mesh_cells {64 if order < 4 else 8},{16 if order < 4 else 2}")
        assert max(error.values()) < (2e-4 if order == 2 else 1e-5), (shape, order, error)
        assert error["u1"] < 1e-6, error
        # Clapeyron: half the work of the pressure, 2 pi a p u(a) times the length
        u = (1 + NU) / YOUNG * 100 / 3 * ((1 - 2 * NU) + 4)
        near(record["energy.strain"], 0.5 * 2 * pi * 100 * u * 0.5, 1e-5)


def test_the_residual_refines_a_tube_until_its_target_is_met():
    error, record = lame("-part_mesh_cells 2,1 -part_mesh_order 2 -adaptor_type doerfler -adaptor_target 1e-4 -estimator_type residual", ranks=2)
    assert record["cycles"] > 3 and record["eta.part"] < 1e-4, record
    assert max(error.values()) < 1e-3, error


def test_bars_that_may_not_grow_have_the_stress_of_the_formula():
    bar = "-part_mesh_box 0,0,2,1 -part_mesh_cells 4,2 -part_mesh_order 2 -part_bc_left_u1 0 -part_bc_bottom_u2 0 -part_bc_top_u2 0 -P_probe_point 1,0.5"
    s = YOUNG * ALPHA * 100
    for effects, s22, s33, volume in (
        ("-scene_effects heat", -s / (1 - NU), -s / (1 - NU), 2),
        (SHEET, -s, 0, 2),
        (ROUND.replace("round ", "round,heat "), -s, 0, 4 * pi),
    ):
        record = run(None, *BODY.split(), *bar.split(), *effects.split(), *HEAT.split(), "100")
        check(record)
        for key, value in ("s11", 0), ("s22", s22), ("s12", 0), ("s33", s33), ("vm", -s22):
            near(record[f"probe.P.{key}"], value, 1e-9, s)
        near(record["energy.strain"], volume * s22**2 / (2 * YOUNG) * ((2 - 2 * NU) if s33 else 1), 1e-9)


def test_a_linear_temperature_bends_a_sheet_and_leaves_no_stress():
    """u2 = alpha b (y^2 - x^2)/2 for T = b y: the curvature is alpha dT/dy"""
    strip = f"-part_mesh_box 0,-0.1,4,0.1 -part_mesh_cells 16,2 -part_mesh_order 2 -part_bc_left_u1 0 -part_bc_left_u2 {25 * ALPHA}*y^2 -P_probe_point 4,0"
    record = run(None, *BODY.split(), *strip.split(), *SHEET.split(), *HEAT.split(), "50*y")
    check(record)
    near(record["probe.P.u2"], -25 * ALPHA * 16, 1e-9)
    for key in "s11", "s22", "s12", "s33":
        near(record[f"probe.P.{key}"], 0, 1e-8, YOUNG * ALPHA * 50)
    near(record["energy.strain"], 0, 1e-12, YOUNG * (ALPHA * 50) ** 2)


def test_estimators_that_can_judge_hot_sheets_adapt_them():
    hot = "-part_mesh_box 0,0,1,1 -part_mesh_cells 4,4 -part_bc_left_u1 0 -part_bc_left_u2 0 -P_probe_point 0.5,0.5 -adaptor_type doerfler -adaptor_target 0.05"
    stress = []
    for estimator in "zz", "fembem", "residual":
        record = run(None, *BODY.split(), *hot.split(), *SHEET.split(), *HEAT.split(), "50*y+20", "-estimator_type", estimator, "-part_mesh_order", "2")
        check(record)
        assert record["cycles"] > 1, record
        stress.append(record["probe.P.s22"])
    assert max(stress) - min(stress) < 0.02 * YOUNG * ALPHA * 50, stress
