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


def test_a_round_column_on_springs_bears_its_weight():
    """Without lateral strain, nu = 0: u2 = -w H/k at the foot, and -w H^2/(2 E) more at the head; the energy is pi R^2 w^2 H^3/(6 E)"""
    w, H, k, R = 3.0, 2.0, 1e4, 0.5
    column = f"-part_mesh_box 0,0,{R},{H} -part_mesh_cells 2,6 -part_mesh_order 2 -part_material_poisson 0 -P_probe_point 0.3,{H}"
    effects = "-scene_effects round,weight,ground -round_effect_type axisymmetric -weight_effect_type gravity -ground_effect_type spring"
    keys = f"-weight_effect_density {w} -weight_effect_acceleration 0,-1 -ground_effect_bodies part -ground_effect_side bottom -ground_effect_normal {k}"
    record = run(None, *BODY.split(), *column.split(), *effects.split(), *keys.split())
    check(record)
    near(record["probe.P.u2"], -w * H / k - w * H**2 / (2 * YOUNG), 1e-9)
    near(record["energy.strain"], pi * R**2 * w**2 * H**3 / (6 * YOUNG), 1e-8)


def test_sheets_pressed_on_each_other_give_way_like_sheets():
    """The same stress everywhere: p = closure/(H1/E1 + H2/E2 + theta); E/(1 - nu^2) in place of E would be 10 per cent more"""
    pair = f"""-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_penalty 0.05
    -lower_mesh_box 0,0,4,1 -lower_mesh_cells 8,2 -lower_material_young {YOUNG} -lower_material_poisson {NU} -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
    -upper_mesh_box 0,1,4,2 -upper_mesh_cells 6,2 -upper_material_young {YOUNG} -upper_material_poisson {NU} -upper_bc_left_u1 0 -upper_bc_top_u2 -1e-3
    -scene_effects thin -thin_effect_type plane_stress -snes_rtol 1e-11"""
    for loop in "ddactive", "ddneumann":
        record = run(None, *pair.split(), "-snes_type", loop)
        check(record)
        near(record["pair.mid.force"], 4 * 1e-3 * YOUNG / 2.05, 1e-8)
