"""Hard cases of the layers of examples/layers, by the default loop unless said otherwise: contrast, penalty, no gap, no
contact, no hold, all contact.

Lengths in cm, stresses in MPa, the half model, per cm of depth. What is expected are closed forms, scaling laws and
values of other programs.
"""
import math

from abut import run, run_error

YOUNG, NU, GAP, CLOSURE = 2.1e5, 0.3, 1e-3, 1.366e-3
FORCE, MIDDLE, EDGE = 126.57389014, 166.20243347, 0.99264208  # of exact contact, see examples/layers/reference.json
LAYERS = 2 * (1 - NU**2) / YOUNG  # compliance of both layers to a uniform pressure


def layers(n=16, c=0.0, closure=CLOSURE, gap="1e-3*x^2", upper=None, young=(YOUNG, YOUNG)):
    """The scene, sides 1/n below and 1/upper above, penalty c; young below and above"""
    upper = upper or n
    return f"""-scene_bodies lower,upper -scene_pairs mid
    -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap {gap} -mid_pair_penalty {c}
    -lower_mesh_box 0,0,4,1 -lower_mesh_cells {4 * n},{n} -lower_material_young {young[0]!r} -lower_material_poisson {NU}
    -upper_mesh_box 0,1,4,2 -upper_mesh_cells {4 * upper},{upper} -upper_material_young {young[1]!r} -upper_material_poisson {NU}
    -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_bc_left_u1 0 -upper_bc_top_u2 {-closure!r}"""


def solve(*options, expect=0):
    record = run(None, *options, expect=expect)
    for key, value in record.items():
        assert isinstance(value, str) or math.isfinite(value), (key, value)
    return record


def relative(value, exact):
    return abs(value / exact - 1)


# --- contrast ------------------------------------------------------------------------------------------------------------------


def test_contact_of_unequal_materials_scales_with_the_sum_of_their_compliances():
    """With the same heights P and p0 are proportional to 1/(1/E1' + 1/E2') and the zone is the same, whatever the materials"""
    equal = solve(layers())
    for contrast in 1e4, 1e6, 1e8:
        for young in (YOUNG, contrast * YOUNG), (contrast * YOUNG, YOUNG):
            record = solve(layers(young=young))
            law = 2 / (1 + 1 / contrast)
            P, p0 = relative(record["pair.mid.force"], law * FORCE), relative(record["pair.mid.pressure_max"], law * MIDDLE)
            print(f"E {young[0]:g}, {young[1]:g}: {record['sweeps']} sweeps, P {P:.1e}, p0 {p0:.1e}, a {record['pair.mid.contact_edge']}")
            assert P < 1e-3 and p0 < 1e-3 and relative(record["pair.mid.contact_edge"], equal["pair.mid.contact_edge"]) < 1e-3
            assert record["pair.mid.active"] == equal["pair.mid.active"] and record["sweeps"] <= 12
            assert record["check.balance"] < 1e-8 and record["error.linear"] < 1e-8


def test_pressures_on_the_softer_side_do_not_oscillate():
    """The stiff layer has the finer mesh; pressures on its nodes would be more than the soft one can feel, and 93 % off at x = 0"""
    law = 2 / (1 + 1 / 100)
    for lower, upper in (16, 32), (8, 32):
        record = solve(layers(lower, upper=upper, young=(YOUNG, 100 * YOUNG)), "-mid_pair_pressure_side second")
        print(f"1/{lower} under 1/{upper}: P {record['pair.mid.force']}, p0 {record['pair.mid.pressure_max']}, {record['sweeps']} sweeps")
        assert relative(record["pair.mid.force"], law * FORCE) < 2e-3 and relative(record["pair.mid.pressure_max"], law * MIDDLE) < 1e-3
        assert record["sweeps"] <= 12


def test_a_fixed_relaxation_on_a_soft_layer_does_not_pass_for_an_answer():
    """theta = 0.05 H/E of the stiff layer; the largest relaxation that converges is 1.8e-5 at a contrast of 1e4"""
    for contrast in 1e4, 1e6:
        record = solve(layers(c=0.05, young=(YOUNG, contrast * YOUNG)), "-snes_type ddneumann -snes_ddneumann_gamma 0.02", expect=2)
        assert record["verdict"] in ("oscillation", "diverged", "stagnation"), record["verdict"]
        assert record.stdout.splitlines()[-1] == f"verdict: {record['verdict']}"


# --- penalty -------------------------------------------------------------------------------------------------------------------


def test_the_force_settles_as_the_penalty_vanishes():
    force = []
    for c in (10.0**-k for k in range(1, 11)):
        record = solve(layers(c=c))
        force.append(record["pair.mid.force"])
        print(f"c {c:.0e}: P {force[-1]} ({force[-1] / FORCE - 1:+.2e}), {record['sweeps']} sweeps, residual {record['error.loop']:.1e}")
        assert record["sweeps"] <= 12 and 0 <= record["error.loop"] <= 1e-7 and record["error.linear"] < 1e-8
        assert c > 1e-4 or relative(force[-1], FORCE) < 2e-4, (c, force[-1])
    assert all(a <= b * (1 + 1e-9) for a, b in zip(force, force[1:])), force  # and the record has ten digits
    assert relative(force[-1], solve(layers())["pair.mid.force"]) < 1e-8


def test_a_tolerance_out_of_reach_is_not_called_reached():
    record = solve(layers(c=1e-10), "-snes_rtol 1e-30", expect=None)
    assert record.status == 2 and record["verdict"] == "stagnation" and relative(record["pair.mid.force"], FORCE) < 2e-4
    record = solve(layers(c=1e-10), "-snes_max_it 1", expect=None)
    assert record.status == 2 and record["verdict"] == "max_iterations"


# --- no gap --------------------------------------------------------------------------------------------------------------------


def test_two_blocks_without_a_gap_are_pressed_uniformly():
    """p = closure/(H1/E1' + H2/E2' + theta), on any two meshes; the zone is right from the start"""
    for c, pressure in (0.5, 90.517241), (0.05, 112.299465), (0.005, 115.068493), (5e-4, 115.352925), (0, 115.384615):
        exact = 1e-3 / (LAYERS + c / YOUNG)
        assert relative(pressure, exact) < 1e-8
        for n, upper, shape in ((4, 4, "quad"), (4, 3, "quad"), (3, 4, "triangle")):
            record = solve(layers(n, c, 1e-3, gap="0", upper=upper), "-lower_mesh_shape", shape)
            assert relative(record["pair.mid.pressure_max"], exact) < 1e-8 and relative(record["pair.mid.force"], 4 * exact) < 1e-8
            assert record["pair.mid.active"] == 4 * max(n, upper) + 1 and relative(record["pair.mid.contact_edge"], 4) < 1e-9
            assert record["sweeps"] <= 3, (c, n, upper, shape, record["sweeps"])


def test_blocks_that_touch_everywhere_and_are_not_pressed_stay_as_they_are():
    for c in 0, 0.05:
        for upper in 4, 3:
            record = solve(layers(4, c, 0.0, gap="0", upper=upper))
            assert record["verdict"] == "converged" and record["sweeps"] <= 2, (c, upper, record["sweeps"])
            assert record["pair.mid.force"] == 0 and record["pair.mid.active"] == 0 and record["energy.strain"] == 0


# --- no contact ----------------------------------------------------------------------------------------------------------------


def test_layers_that_do_not_meet_carry_no_force():
    for c in 0, 0.05:
        for options in {"closure": -1e-3}, {"gap": "1"}, {"gap": "1", "closure": -1e-3}, {"gap": "0", "closure": -1e-3}:
            record = solve(layers(4, c, **options))
            assert "pair mid: no contact" in record.stdout.splitlines(), record.stdout
            for key in "force", "pressure_max", "contact_length", "contact_edge", "active", "penetration_max":
                assert record[f"pair.mid.{key}"] == 0, (c, options, key, record[f"pair.mid.{key}"])
            assert record["sweeps"] <= 2 and record["verdict"] == "converged", (c, options, record["sweeps"])
            assert record["error.loop"] == 0 and record["energy.penalty"] == 0


def test_a_parabola_that_touches_at_a_point_carries_next_to_nothing():
    """Its average against the dual function of that node is below zero, so the node presses: by a force that vanishes faster than h^2"""
    force = [solve(layers(n, closure=0.0))["pair.mid.force"] for n in (4, 8, 16)]
    assert force[0] < 3e-3 * FORCE and force[0] > 4 * force[1] > 16 * force[2], force


# --- no hold -------------------------------------------------------------------------------------------------------------------


def block(*options, c=0, expect=0, gap="0.5"):
    """The upper layer, held on the left only, so free to move up and down, above the lower one"""
    scene = [word for word in layers(4, c, gap=gap).split() if word not in ("-upper_bc_top_u2", repr(-CLOSURE))]
    record = solve(*scene, *options, "-scene_probes A -A_probe_body upper -A_probe_point 2,2", expect=expect)
    for key in "u1", "u2":
        assert abs(record[f"probe.A.{key}"]) <= 4e3, (key, record[f"probe.A.{key}"])
    return record


def check_floating(record, body, motion):
    assert record.status == 2 and record["verdict"] == "floating", (record.status, record.get("verdict"))
    assert any(body in line and motion in line for line in record.stdout.splitlines()), record.stdout


def test_a_block_that_a_load_pushes_onto_its_support_finds_it():
    """Down by the gap, which is no small distance, and by what the layers give way under 10 MPa"""
    for c in 0, 0.05:
        record = block("-upper_bc_top_t2 -10", c=c)
        assert relative(record["pair.mid.force"], 40) < 1e-9 and relative(record["pair.mid.pressure_max"], 10) < 1e-8
        assert relative(record["probe.A.u2"], -0.5 - 10 * (LAYERS + c / YOUNG)) < 1e-9 and record["sweeps"] <= 3
        record = block("-upper_bc_top_t2 -10", c=c, gap="0.5+1e-3*x^2")
        assert relative(record["pair.mid.force"], 40) < 1e-9 and record["pair.mid.active"] < 17 and record["sweeps"] <= 12


def test_a_block_that_a_load_pulls_off_its_support_is_named():
    for c in 0, 0.05:
        for gap in "0.5", "0", "1e-3*x^2":
            check_floating(block("-upper_bc_top_t2 10", c=c, gap=gap, expect=None), "upper", "moving along y")


def test_a_block_without_a_load_above_an_open_gap_is_named():
    """Nothing says how high it is"""
    for gap in "0.5", "0.5+1e-3*x^2":
        check_floating(block(gap=gap, expect=None), "upper", "moving along y")


def test_a_block_that_may_slide_is_refused():
    """Without friction nothing but a prescribed displacement could hold it along x"""
    scene = [word for word in layers(4, gap="0.5").split() if word not in ("-upper_bc_top_u2", repr(-CLOSURE))]
    at = scene.index("-upper_bc_left_u1")
    del scene[at : at + 2]
    line = run_error(None, *scene, "-upper_bc_top_t2 -10")
    assert line.startswith("abut: upper: nothing holds this body along x"), line


def stack(*options):
    """Three layers, that in the middle free to move up and down"""
    scene = layers(4).split()
    scene[scene.index("lower,upper")] = "lower,middle,upper"
    scene[scene.index("mid")] = "mid,top"
    scene[scene.index("upper,lower")] = "middle,lower"
    middle = "-middle_mesh_box 0,1,4,2 -middle_mesh_cells 16,4 -middle_bc_left_u1 0"
    middle += " -middle_material_young 2.1e5 -middle_material_poisson 0.3"
    pair = "-top_pair_bodies upper,middle -top_pair_sides bottom,top -top_pair_gap 1e-3*x^2 -top_pair_penalty 0"
    return solve(*scene, *middle.split(), *pair.split(), "-upper_mesh_box 0,2,4,3", *options, expect=None)


def test_a_layer_that_nothing_reaches_from_below_or_above_is_named():
    record = stack()
    assert record.status == 0 and relative(record["pair.mid.force"], record["pair.top.force"]) < 1e-8
    for options in ("-upper_bc_top_u2 1e-3",), ("-mid_pair_gap 1",), ("-mid_pair_gap 1", "-top_pair_gap 1"):
        check_floating(stack(*options), "middle", "moving along y")


# --- contact everywhere --------------------------------------------------------------------------------------------------------


def test_contact_grows_over_the_whole_side():
    """From a closure of 20 cm gaps on all is closed, and P = (4 closure - gap 4^3/3)/(H1/E1' + H2/E2' + theta) whatever the mesh"""
    for c in 0, 0.05:
        edge, force = [0], [0]
        for closure in 1.366e-3, 5e-3, 10e-3, 15e-3, 20e-3, 25e-3, 40e-3:
            record = solve(layers(8, c, closure), "-snes_rtol 1e-10")
            edge.append(record["pair.mid.contact_edge"])
            force.append(record["pair.mid.force"])
            print(f"c {c}, closure {closure}: P {force[-1]}, a {edge[-1]}, {record['sweeps']} sweeps")
            assert record["sweeps"] <= 15 and record["check.balance"] < 1e-10
            if closure >= 20e-3:
                exact = (4 * closure - GAP * 64 / 3) / (LAYERS + c / YOUNG)
                assert relative(force[-1], exact) < 1e-8 and record["pair.mid.active"] == 33 and edge[-1] == 4, (force[-1], exact)
        assert all(a < b for a, b in zip(force, force[1:])) and all(a <= b for a, b in zip(edge, edge[1:])), edge
    assert relative(force[3], 2368.09) < 1e-4 and abs(edge[3] - 2.9) < 1 / 8  # of another program, bilinear elements of the same size


def test_contact_everywhere_on_meshes_that_do_not_match():
    for c in 0, 0.05:
        for n, upper in (8, 6), (5, 8):
            record = solve(layers(n, c, 25e-3, upper=upper), "-snes_rtol 1e-10")
            exact = (4 * 25e-3 - GAP * 64 / 3) / (LAYERS + c / YOUNG)
            force, edge = record["pair.mid.force"], record["pair.mid.contact_edge"]
            assert relative(force, exact) < 1e-8 and edge == 4, (force, exact, edge)


def test_a_loaded_block_whose_mesh_stays_while_the_other_one_adapts():
    """The loads that contact has to balance are those of the body, not what it carried on the mesh before"""
    blocks = """-scene_bodies lower,upper -scene_pairs mid -lower_mesh_box 0,0,4,1 -lower_mesh_cells 16,4 -upper_mesh_box 0,1,4,2 -upper_mesh_cells 16,4
        -lower_material_young 2.1e5 -lower_material_poisson .3 -upper_material_young 2.1e5 -upper_material_poisson .3 -lower_bc_left_u1 0
        -lower_bc_bottom_u2 0 -upper_bc_left_u1 0 -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 1e-3*x^2
        -mid_pair_penalty 0""".split()
    adapt = "-adaptor_type threshold -estimator_type zz -adaptor_threshold 0.15 -adaptor_max_level 2 -adaptor_bodies lower".split()
    record = run(None, *blocks, *adapt, "-upper_bc_top_t2", "0-10-x", expect=None)
    assert record.status in (0, 3) and record["cycles"] > 1, (record.status, record["verdict"])
    assert abs(record["pair.mid.force"] / 48 - 1) < 1e-9, record["pair.mid.force"]  # the integral of 10 + x over 4


def test_a_long_floating_block_is_solved_as_far_as_its_error_says():
    """The forces that balance a load on a floating body are no measure of its contact: the tolerance is one of the bodies' energy"""
    for length in (10, 50):
        boxes = [f"-{body}_mesh_box 0,{y},{length},{y + 1} -{body}_mesh_cells {4 * length},4" for body, y in (("lower", 0), ("upper", 1))]
        record = run(None, *" ".join(boxes).split(), *"""-scene_bodies lower,upper -scene_pairs mid -lower_material_young 2.1e5 -lower_material_poisson .3
            -upper_material_young 2.1e5 -upper_material_poisson .3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_bc_left_u1 0
            -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 0 -mid_pair_penalty 0""".split(), "-upper_bc_top_t2", "0-1-2*sin(x)")
        assert record["error.loop"] <= 2e-8, (length, record["error.loop"])
        assert abs(record["pair.mid.force"] / (length + 2 - 2 * math.cos(length)) - 1) < 1e-5, (length, record["pair.mid.force"])


def test_blocks_that_are_closed_by_exactly_their_gap_only_touch():
    """What is left between the sides is round-off of the displacements, which no active set can settle"""
    for c in 0, 0.05:
        record = solve(layers(7, c, closure=1e-4, gap="1e-4"))
        assert record["verdict"] == "converged" and record["pair.mid.force"] == 0 and record["sweeps"] <= 2, (c, record["pair.mid.force"])
