"""Effects against formulas: weight, body forces, pressures, springs and overlaps

Where a body is a column, the axis x runs across it and y up.
"""
import math, os, tempfile

from abut import case, run, run_error
from msh import grid, write

YOUNG, NU = 2.1e5, 0.3
WEIGHT = 2e-2 * 9.81  # density times acceleration
EFFECT = "-scene_effects weight -weight_effect_type gravity -weight_effect_density 2e-2"
MESHES = [("quad", order) for order in (1, 2, 3, 4)] + [("triangle", order) for order in (1, 2, 3)]


def body(name, x0, y0, x1, y1, cells, *options, young=YOUNG):
    words = f"-{name}_mesh_box {x0},{y0},{x1},{y1} -{name}_mesh_cells {cells} -{name}_material_young {young} -{name}_material_poisson {NU}"
    return words.split() + [word for option in options for word in option.split()]


def probes(name, *points):
    words = ["-scene_probes", ",".join(f"P{i}" for i in range(len(points)))]
    for i, (x, y) in enumerate(points):
        words += [f"-P{i}_probe_body", name, f"-P{i}_probe_point", f"{x},{y}"]
    return words


def off(record, i, key, exact, scale):
    return abs(record[f"probe.P{i}.{key}"] - exact) / scale


def column(shape, order, cells="2,4", *options, effect=EFFECT, ranks=1):
    """A column, free at its right side, held at the left one and at the bottom, 1 wide and 4 high: how far off are u2 in the middle of its top,
    u2 elsewhere, and s22? s22 = -w (4-y), s11 = s12 = 0; the bottom moves as the lateral strain asks for."""
    a, b = (1 - NU**2) / YOUNG * WEIGHT, NU * (1 + NU) / YOUNG * WEIGHT
    points = [(0.5, 4), (0.3, 1.3), (0.8, 3.1)]
    scene = body("col", 0, 0, 1, 4, cells, f"-col_mesh_shape {shape} -col_mesh_order {order}", f"-col_bc_left_u1 0 -col_bc_bottom_u2 {b / 2}*x^2")
    record = run(None, "-scene_bodies col", *scene, *effect.split(), *probes("col", *points), *options, ranks=ranks)
    tip = 8 * a  # a (4 y - y^2/2) at y = 4
    u2 = [off(record, i, "u2", b * x**2 / 2 - a * (4 * y - y**2 / 2), tip) for i, (x, y) in enumerate(points)]
    s22 = max(off(record, i, "s22", -WEIGHT * (4 - y), 4 * WEIGHT) for i, (x, y) in enumerate(points))
    assert record["check.balance"] < 1e-9 and record["check.energy"] < 1e-9, record
    return u2[0], max(u2), s22


def test_a_column_under_its_weight_is_exact_from_order_2_on():
    """With hanging nodes where there are quads; on 1 to 4 ranks"""
    u2, s22 = [], []
    for shape, order in MESHES:
        if order > 1:
            for ranks in 1, 4:
                one = column(shape, order, "2,4", "-col_mesh_size max(0.2,0.3*y)", ranks=ranks)
                u2.append(one[1])
                s22.append(one[2])
    for ranks in 2, 3:
        u2.append(column("quad", 2, "2,4", ranks=ranks)[1])
    print(max(u2), max(s22))
    assert max(u2) < 1e-10 and max(s22) < 1e-10


def test_of_order_1_the_deflection_converges_with_order_2_and_the_stress_with_order_1():
    for shape in "quad", "triangle":
        errors = [column(shape, 1, f"{n},{4 * n}") for n in (8, 16, 32)]
        rate = math.log2(errors[1][0] / errors[2][0])
        print(shape, errors, rate)
        assert abs(rate - 2) < 0.1, errors
        assert errors[2][2] < 0.6 * errors[1][2] < 0.6**2 * errors[0][2]


def test_a_constant_force_is_a_weight():
    """The same numbers by another type, and two halves make a whole"""
    force = f"-scene_effects half,rest -half_effect_type force -half_effect_f2 {-WEIGHT / 2} -rest_effect_type force -rest_effect_f2 0-{WEIGHT / 2}"
    one, two = column("quad", 1, "2,8"), column("quad", 1, "2,8", effect=force)
    assert one[0] > 1e-4 and abs(one[0] / two[0] - 1) < 1e-8 and abs(one[2] / two[2] - 1) < 1e-8, (one, two)


def test_a_pressure_on_a_side_is_a_stress_along_its_normal():
    """Every side in turn, the one opposite held; a pressure that is above 0 pushes"""
    axis = {"left": 0, "right": 0, "bottom": 1, "top": 1}
    opposite = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}
    errors = []
    for n, (side, d) in enumerate(axis.items()):
        scene = body("b", 0, 0, 2, 1, "3,2", f"-b_bc_{opposite[side]}_u{d + 1} 0 -b_bc_{'left' if d else 'bottom'}_u{2 - d} 0")
        effect = f"-scene_effects p -p_effect_type pressure -p_effect_bodies b -p_effect_side {side} -p_effect_pressure 7"
        record = run(None, "-scene_bodies b", *scene, *effect.split(), *probes("b", (0.7, 0.6)), ranks=n + 1)
        for i, key in enumerate(("s11", "s22", "s12")):
            errors.append(off(record, 0, key, -7 if i == d else 0, 7))
    assert max(errors) < 1e-11, errors


def test_a_block_on_springs_sinks_by_pressure_over_stiffness():
    """Nothing else holds it along y. A body force on a rigid block that springs alone hold moves it by f A/(k L) along x and y, and turns it"""
    k, kt, p = 3e3, 5e3, 20.0
    errors = []
    for shape, order in MESHES:
        mesh = f"-b_mesh_shape {shape} -b_mesh_order {order}"
        effects = f"""-scene_effects ground,press -ground_effect_type spring -ground_effect_bodies b -ground_effect_side bottom
            -ground_effect_normal {k} -press_effect_type pressure -press_effect_bodies b -press_effect_side top -press_effect_pressure {p}"""
        record = run(None, "-scene_bodies b", *body("b", 0, 0, 2, 1, "3,2", mesh, "-b_bc_left_u1 0"), *effects.split(), *probes("b", (1.3, 0), (0.4, 1)))
        errors.append(off(record, 0, "u2", -p / k, p / k))
        errors.append(off(record, 1, "u2", -p / k - p * (1 - NU**2) / YOUNG, p / k))
        assert record["check.balance"] < 1e-10 and record["check.energy"] < 1e-9
    print(max(errors))
    assert max(errors) < 1e-10, errors
    rigid = body("b", 0, 0, 2, 1, "3,2", "-b_mesh_order 2", young=1e10)
    effects = f"""-scene_effects ground,push -ground_effect_type spring -ground_effect_bodies b -ground_effect_side bottom
        -ground_effect_normal {k} -ground_effect_tangential {kt} -push_effect_type force -push_effect_f1 30 -push_effect_f2 -12"""
    for ranks in 1, 2, 3:
        record = run(None, "-scene_bodies b", *rigid, *effects.split(), *probes("b", (1, 0), (2, 0), (0, 0)), ranks=ranks)
        turn = 30 * 2 * 0.5 / (k * 2**3 / 12)  # moment of the force about the bottom over that of the springs, clockwise
        found = [record["probe.P0.u1"] - 30 / kt, record["probe.P0.u2"] + 12 / k, record["probe.P1.u2"] + 12 / k + turn, record["probe.P2.u2"] + 12 / k - turn]
        assert max(map(abs, found)) < 1e-5 * 30 / kt, found


def test_a_long_beam_on_a_foundation_has_hetenyi_s_deflection():
    """M. Hetenyi, Beams on Elastic Foundation (1946): w = P b/(2k) exp(-b x) (cos b x + sin b x), b^4 = k/(4 E I), E/(1-nu^2) for E in plane strain;
    the half of it, 300 long and 1 high, b = 0.02, under P = 1"""
    beta, height = 0.02, 1.0
    k = 4 * beta**4 * YOUNG / (1 - NU**2) * height**3 / 12
    effect = f"-scene_effects ground -ground_effect_type spring -ground_effect_bodies b -ground_effect_side bottom -ground_effect_normal {k}"
    at = [0, 20, 50, 100, 200]
    scene = body("b", 0, 0, 300, height, "150,1", "-b_mesh_order 3 -b_bc_left_u1 0 -b_bc_left_t2 -0.5")
    record = run(None, "-scene_bodies b", *scene, *effect.split(), *probes("b", *((x, height / 2) for x in at)))
    exact = [-beta / (2 * k) * math.exp(-beta * x) * (math.cos(beta * x) + math.sin(beta * x)) for x in at]
    errors = [off(record, i, "u2", w, beta / (2 * k)) for i, w in enumerate(exact)]
    print(errors)
    assert max(errors) < 1e-3, errors  # shear and (b h)^2 are left out of the formula
    assert record["check.balance"] < 1e-8


def press(c, *options, ranks=1):
    scene = body("lower", 0, 0, 4, 1, "8,2", "-lower_bc_left_u1 0 -lower_bc_bottom_u2 0")
    scene += body("upper", 0, 1, 4, 2, "6,2", "-upper_bc_left_u1 0 -upper_bc_top_u2 0 -upper_mesh_shape triangle")
    pair = f"-scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_penalty {c} -snes_rtol 1e-11"
    return run(None, "-scene_bodies lower,upper", *scene, *pair.split(), *options, ranks=ranks)


def fit(name, body, side, depth):
    return f"-{name}_effect_type overlap -{name}_effect_bodies {body} -{name}_effect_side {side} -{name}_effect_depth {depth}".split()


def test_an_overlap_is_a_gap_below_0_without_a_warning():
    """Two blocks between walls: p = overlap/(2 (1-nu^2)/E + theta), theta = c/E"""
    errors = []
    for c in 0.05, 0:
        exact = 1e-3 / ((2 * (1 - NU**2) + c) / YOUNG)
        for ranks in 1, 2, 3:
            one = press(c, "-scene_effects fit", *fit("fit", "lower", "top", 1e-3), ranks=ranks)
            errors.append(abs(one["pair.mid.force"] / (4 * exact) - 1))
            assert "warning" not in one.stdout
        two = press(c, "-scene_effects fit,back", *fit("fit", "lower", "top", "1.4e-3+0*x"), *fit("back", "upper", "bottom", -4e-4))
        errors.append(abs(two["pair.mid.pressure_max"] / exact - 1))
        assert "warning: pair mid: at first the sides overlap, by 0.001 at" in press(c, "-mid_pair_gap 0-1e-3").stdout
    case("H10", "the same by an effect that says how far a side stands out", max(errors), 1e-8)


COS, SIN = math.cos(math.pi / 6), math.sin(math.pi / 6)


def turned(x, y):
    return x * COS - y * SIN, x * SIN + y * COS


def test_on_inclined_sides_pressures_are_normal_and_springs_sink_by_them():
    """A box of 2 x 1 from a file, turned by 30 degrees: p on its top and k under its bottom, and at its ends what keeps it from growing along itself"""
    p, k, q = 20.0, 3e3, 20.0 * NU / (1 - NU)
    effect = lambda name, kind, side, keys: f"-{name}_effect_type {kind} -{name}_effect_bodies b -{name}_effect_side {side} {keys} "
    effects = "-scene_effects ground,top,left,right " + effect("ground", "spring", "bottom", f"-ground_effect_normal {k} -ground_effect_tangential 7e3")
    for name, pressure in ("top", p), ("left", q), ("right", q):
        effects += effect(name, "pressure", name, f"-{name}_effect_pressure {pressure}")
    stress, moved = {"s11": -q * COS**2 - p * SIN**2, "s22": -q * SIN**2 - p * COS**2, "s12": (p - q) * SIN * COS}, []
    for corners, ranks in (4, 1), (3, 2), (4, 3):
        mesh = grid(lambda s, t: turned(2 * s, t), 6, 3, ("bottom", "right", "top", "left"), corners=corners)
        with tempfile.TemporaryDirectory() as folder:
            scene = f"-scene_bodies b -b_mesh_file {write(os.path.join(folder, 'part.msh'), mesh)} -b_material_young {YOUNG} -b_material_poisson {NU}"
            points = probes("b", turned(1.3, 0.6), turned(1.1, 1e-9))
            record = run(None, *scene.split(), *effects.split(), *points, "-estimator_type residual", ranks=ranks)
        errors = [off(record, 0, key, value, p) for key, value in stress.items()]
        errors += [off(record, 1, "u1", p / k * SIN, p / k), off(record, 1, "u2", -p / k * COS, p / k)]
        assert max(errors) < 1e-8 and record["check.balance"] < 1e-9 and record["check.energy"] < 1e-9, (errors, dict(record))
        assert record["eta.b"] < 1e-8
        moved.append(max(errors))
    alone = "-ground_effect_tangential 0"
    with tempfile.TemporaryDirectory() as folder:
        scene = f"-scene_bodies b -b_mesh_file {write(os.path.join(folder, 'part.msh'), mesh)} -b_material_young {YOUNG} -b_material_poisson {NU}"
        line = run_error(None, *scene.split(), *effects.split(), *alone.split())
    assert line == "abut: ground_effect_tangential: missing; bottom of b runs along no axis, there give both stiffnesses", line
    print(moved)
