"""One body against a rigid obstacle: the closed forms of one elastic body and of Hertz.

Lengths in mm, stresses in MPa, the half model, per mm of depth.
"""
import math, os, tempfile

from abut import case, run

YOUNG, NU, CLOSURE = 2.1e5, 0.3, 1e-3
STIFF = YOUNG / (1 - NU**2)
BODY = f"""-scene_bodies block -scene_pairs foot -block_material_young {YOUNG} -block_material_poisson {NU} -block_bc_left_u1 0
-foot_pair_bodies block""".split()
LAYER = "-block_mesh_box 0,0,4,1 -block_mesh_cells 6,3 -foot_pair_sides bottom -foot_pair_height 1 -block_bc_top_u2".split()
PUSHED = """-block_mesh_box 0,-4,4,0 -block_mesh_cells 8,8 -block_mesh_order 2 -foot_pair_sides top -foot_pair_penalty 0
-block_bc_bottom_u2""".split()
ADAPTED = "-adaptor_type doerfler -adaptor_target 3e-3 -estimator_type zz -adaptor_jump 4".split()
RADIUS = 8
DISC = "-foot_pair_obstacle", f"sqrt(x^2+(y-{RADIUS})^2)-{RADIUS}"


def test_a_layer_on_a_rigid_plane_has_the_pressure_of_the_formula():
    """p = (closure - gap)/(H/E' + theta), whether the plane is an obstacle or a gap"""
    off = []
    for c in 0.5, 0.05, 0:
        for gap, how in (0, "obstacle y"), (2e-4, "obstacle y+2e-4"), (2e-4, "gap 2e-4"):
            key, text = how.split(" ", 1)
            record = run(None, *BODY, *LAYER, -CLOSURE, "-foot_pair_penalty", c, f"-foot_pair_{key}", text, "-snes_rtol", 1e-12)
            exact = (CLOSURE - gap) / (1 / STIFF + c / YOUNG)
            off += [abs(record["pair.foot.pressure_max"] / exact - 1), abs(record["pair.foot.force"] / (4 * exact) - 1)]
    case("V01", "pressure of one body on a rigid plane off the closed form", max(off), 1e-8)


def test_the_loops_agree_on_an_obstacle():
    options = *BODY, *LAYER, -CLOSURE, "-foot_pair_obstacle", "y+1e-4*x^2", "-snes_rtol", 1e-10
    forces = [run(None, *options, *loop.split())["pair.foot.force"] for loop in ("-snes_type ddactive", "-snes_type ddneumann")]
    assert abs(forces[1] / forces[0] - 1) < 1e-7, forces


def disc(*options, up=0.02, **how):
    return run(None, *BODY, *PUSHED, up, *ADAPTED, *options, **how)


def test_a_rigid_disc_presses_as_hertz_says():
    """a^2 = 4PR/(pi E'), p0 = 2P/(pi a), P of both halves; a/R is 0.05"""
    record = disc(*DISC)
    a = math.sqrt(4 * 2 * record["pair.foot.force"] * RADIUS / (math.pi * STIFF))
    case("V06", "half width of the contact with a rigid disc off Hertz", abs(record["pair.foot.contact_edge"] / a - 1), 0.01)
    peak = 2 * 2 * record["pair.foot.force"] / (math.pi * a)
    case("V06", "largest pressure under a rigid disc off Hertz", abs(record["pair.foot.pressure_max"] / peak - 1), 0.01)


def test_an_obstacle_is_the_gap_it_leaves_along_the_normal():
    records = [disc(*key) for key in (DISC, ("-foot_pair_gap", f"{RADIUS}-sqrt({RADIUS**2}-x^2)"))]
    for key in "pair.foot.force", "pair.foot.pressure_max", "body.block.unknowns":
        assert abs(records[1][key] / records[0][key] - 1) < 1e-9, (key, records)


def test_an_obstacle_is_the_same_on_all_ranks():
    one, three = (disc(*DISC, ranks=ranks) for ranks in (1, 3))
    for key in "pair.foot.force", "pair.foot.contact_edge", "unknowns":
        assert abs(three[key] / one[key] - 1) < 1e-9, key


def test_restart_goes_on_against_an_obstacle():
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "run.abut")
        whole = disc(*DISC, "-checkpoint", file)
        again = disc(*DISC, "-restart", file)
    assert again["pair.foot.force"] == whole["pair.foot.force"] and again["cycles"] == whole["cycles"]


ROUND = "-scene_effects", "round", "-round_effect_type", "axisymmetric"


def test_a_rigid_ball_presses_as_hertz_says():
    """a^3 = 3FR/(4E'), p0 = 3F/(2 pi a^2), F of the whole turn; a/R is 0.036"""
    off = []
    for order, target in (1, 0.04), (2, 0.01):
        record = disc(*ROUND, *DISC, "-block_mesh_order", order, "-estimator_type", "residual", "-adaptor_target", target, up=0.01)
        force = record["pair.foot.force"]
        a = (3 * force * RADIUS / (4 * STIFF)) ** (1 / 3)
        peak = 3 * force / (2 * math.pi * a * a)
        off.append((record["pair.foot.contact_edge"] / a - 1, record["pair.foot.pressure_max"] / peak - 1))
    case("V07", "radius of the contact with a rigid ball off Hertz, orders 1 and 2", max(abs(a) for a, p in off), 0.01)
    case("V07", "largest pressure under a rigid ball off Hertz, orders 1 and 2", max(abs(p) for a, p in off), 0.01)
