"""Hard cases of the layers of examples/layers, by the default loop unless said otherwise: contrast, penalty, no gap, no
contact, no hold, all contact.

Lengths in cm, stresses in MPa, the half model, per cm of depth. What is expected are closed forms, scaling laws and
values of other programs.
"""
import csv, math, os, tempfile

from abut import case, run, run_error

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
    equal, worst = solve(layers()), [0, 0, 0, 0, 0]
    for contrast in 1e4, 1e6, 1e8:
        for young in (YOUNG, contrast * YOUNG), (contrast * YOUNG, YOUNG):
            record = solve(layers(young=young))
            law = 2 / (1 + 1 / contrast)
            P, p0 = relative(record["pair.mid.force"], law * FORCE), relative(record["pair.mid.pressure_max"], law * MIDDLE)
            print(f"E {young[0]:g}, {young[1]:g}: {record['sweeps']} sweeps, P {P:.1e}, p0 {p0:.1e}, a {record['pair.mid.contact_edge']}")
            a = relative(record["pair.mid.contact_edge"], equal["pair.mid.contact_edge"])
            worst = [max(pair) for pair in zip(worst, (P, p0, a, record["error.linear"], record["sweeps"]))]
            assert record["pair.mid.active"] == equal["pair.mid.active"] and record["check.balance"] < 1e-8
    case("H03", "force off the scaling law, contrast 1e4 to 1e8, h = 1/16", worst[0], 1e-3)
    case("H03", "pressure at x = 0 off the scaling law", worst[1], 1e-3)
    case("H03", "end of the contact off that of equal layers", worst[2], 1e-3)
    case("H03", "error of the linear solvers, relative", worst[3], 1e-8)
    case("H03", "sweeps of the default loop", worst[4], 12)


def test_the_automatic_relaxation_knows_the_softer_layer():
    """theta = 0.05 H/E as both layers together feel it: the force is that of equal layers with c = 0.05, 123.07842, by the scaling law"""
    for contrast in 1e4, 1e8:
        theta = 0.025 * (1 + 1 / contrast) / YOUNG
        record = solve(layers(young=(YOUNG, contrast * YOUNG)), f"-snes_type ddneumann -mid_pair_theta {theta!r}")
        error = relative(record["pair.mid.force"], 123.07842 * 2 / (1 + 1 / contrast))
        print(f"contrast {contrast:g}: {record['sweeps']} sweeps, P {error:.1e}")
        assert record["verdict"] == "converged" and error < 1e-3
        case("H03", "sweeps of the paper's loop, automatic gamma, theta of the soft layer", record["sweeps"], 1000)


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
    passed = 0
    for contrast in 1e4, 1e6:
        record = solve(layers(c=0.05, young=(YOUNG, contrast * YOUNG)), "-snes_type ddneumann -snes_ddneumann_gamma 0.02", expect=None)
        passed += record.status != 2 or record["verdict"] not in ("oscillation", "diverged", "stagnation")
        assert record.stdout.splitlines()[-1] == f"verdict: {record['verdict']}"
    case("H03", "runs with gamma = 0.02 on a soft layer that end as an answer", passed, 0)


# --- penalty -------------------------------------------------------------------------------------------------------------------


def test_the_force_settles_as_the_penalty_vanishes():
    force, plateau, sweeps, linear = [], [], [], []
    for c in (10.0**-k for k in range(1, 11)):
        record = solve(layers(c=c))
        force.append(record["pair.mid.force"])
        print(f"c {c:.0e}: P {force[-1]} ({force[-1] / FORCE - 1:+.2e}), {record['sweeps']} sweeps, residual {record['error.loop']:.1e}")
        assert 0 <= record["error.loop"] <= 1e-7
        sweeps.append(record["sweeps"])
        linear.append(record["error.linear"])
        plateau += [relative(force[-1], FORCE)] if c < 2e-4 else []
    assert len(plateau) == 7
    assert all(a <= b * (1 + 1e-9) for a, b in zip(force, force[1:])), force  # and the record has ten digits
    case("H04", "force off that of exact contact, c 1e-4 to 1e-10", max(plateau), 2e-4)
    case("H04", "sweeps, c 0.1 to 1e-10", max(sweeps), 12)
    case("H04", "error of the linear solvers, relative", max(linear), 1e-8)
    assert relative(force[-1], solve(layers())["pair.mid.force"]) < 1e-8


def test_a_tolerance_out_of_reach_is_not_called_reached():
    ends = [solve(layers(c=1e-10), options, expect=None).status for options in ("-snes_rtol 1e-30", "-snes_max_it 1")]
    case("H04", "tolerances out of reach that are called reached", sum(status == 0 for status in ends), 0)
    record = solve(layers(c=1e-10), "-snes_rtol 1e-30", expect=None)
    assert record.status == 2 and record["verdict"] == "stagnation" and relative(record["pair.mid.force"], FORCE) < 2e-4
    record = solve(layers(c=1e-10), "-snes_max_it 1", expect=None)
    assert record.status == 2 and record["verdict"] == "max_iterations"


# --- no gap --------------------------------------------------------------------------------------------------------------------


def test_two_blocks_without_a_gap_are_pressed_uniformly():
    """p = closure/(H1/E1' + H2/E2' + theta), on any two meshes; the zone is right from the start"""
    error, sweeps = [], []
    for c, pressure in (0.5, 90.517241), (0.05, 112.299465), (0.005, 115.068493), (5e-4, 115.352925), (0, 115.384615):
        exact = 1e-3 / (LAYERS + c / YOUNG)
        assert relative(pressure, exact) < 1e-8
        for n, upper, shape in ((4, 4, "quad"), (4, 3, "quad"), (3, 4, "triangle")):
            record = solve(layers(n, c, 1e-3, gap="0", upper=upper), "-lower_mesh_shape", shape)
            error += [relative(record["pair.mid.pressure_max"], exact), relative(record["pair.mid.force"], 4 * exact)]
            sweeps.append(record["sweeps"])
            assert record["pair.mid.active"] == 4 * max(n, upper) + 1 and relative(record["pair.mid.contact_edge"], 4) < 1e-9
    case("H07", "pressure and force off the closed form, five penalties, three meshes", max(error), 1e-8)
    case("H07", "sweeps of the default loop, which has the zone from the start", max(sweeps), 3)


def test_a_side_that_is_held_throughout_carries_no_pressures_for_the_other_one():
    """A block pressed onto a finer one whose upper side is prescribed: p = closure E'/H, either body first"""
    scene = "-scene_bodies a,b -scene_pairs mid -mid_pair_penalty 0 -b_bc_top_u2 0 -a_bc_top_u2 -1e-3"
    for name, y, cells in ("a", 1, "6,3"), ("b", 0, "8,4"):
        scene += f" -{name}_mesh_box 0,{y},4,{y + 1} -{name}_mesh_cells {cells} -{name}_material_young {YOUNG} -{name}_material_poisson 0.3 -{name}_bc_left_u1 0"
    exact = 1e-3 * YOUNG / (1 - 0.3**2)
    for pair in "-mid_pair_bodies a,b -mid_pair_sides bottom,top", "-mid_pair_bodies b,a -mid_pair_sides top,bottom":
        record = run(None, *scene.split(), *pair.split(), "-b_bc_bottom_u2 0")
        assert relative(record["pair.mid.force"], 4 * exact) < 1e-9 and relative(record["pair.mid.pressure_max"], exact) < 1e-9, record


def zone(*options):
    """The record, and where its nodes are closed"""
    with tempfile.TemporaryDirectory() as folder:
        record = run(None, *options, "-output_profile", f"{folder}/profile.csv", expect=None)
        with open(os.path.join(folder, "profile.csv")) as f:
            rows = [row for row in csv.DictReader(f) if row["side"] == "pressure"]
    return record, {float(row["x"]) for row in rows if float(row["pressure"]) > 0}


def test_the_zone_does_not_chatter():
    """Of the last iterations of the paper's loop, which are those of runs that stop one or two iterations earlier"""
    changes = 0
    for start in "zero", "nocontact":
        loop = f"-snes_type ddneumann -snes_ddneumann_start {start}"
        record, closed = zone(layers(4, 0.05, 1e-3, gap="0", upper=3), loop)
        iterations = record["sweeps"] - 1  # the first sweep is that of the start
        assert record.status == 0 and len(closed) == 17
        for less in 1, 2, 3:
            record, before = zone(layers(4, 0.05, 1e-3, gap="0", upper=3), loop, f"-snes_max_it {iterations - less}")
            assert record["verdict"] == "max_iterations"
            changes += len(before ^ closed)
    case("H07", "nodes that open or close in the last 3 sweeps of the paper's loop", changes, 0)


def test_blocks_that_touch_everywhere_and_are_not_pressed_stay_as_they_are():
    force = []
    for c in 0, 0.05:
        for upper in 4, 3:
            record = solve(layers(4, c, 0.0, gap="0", upper=upper))
            force.append(record["pair.mid.force"])
            assert record["verdict"] == "converged" and record["sweeps"] <= 2, (c, upper, record["sweeps"])
            assert record["pair.mid.active"] == 0 and record["energy.strain"] == 0
    case("H07", "force of blocks that touch everywhere and are not pressed", max(force), 0)


# --- overlap -------------------------------------------------------------------------------------------------------------------


def test_sides_that_overlap_at_first_are_pushed_apart():
    """By 1e-4 everywhere, or on the inner half, and everywhere in contact: P = (4 closure - integral of the gap)/(compliance + theta)"""
    error, warned = [], 0
    for c in 0, 0.05:
        for gap, closure, depth in ("0-1e-4", 0.0, 4e-4), ("0-1e-4", 1e-3, 4e-4), ("0-1e-4*(x<2)", 1e-3, 2e-4):
            words = layers(4, c, closure, gap="GAP").split()
            record = solve(*[gap if word == "GAP" else word for word in words], "-snes_rtol 1e-10")
            error.append(relative(record["pair.mid.force"], (4 * closure + depth) / (LAYERS + c / YOUNG)))
            assert record["pair.mid.active"] == 17 and record["check.balance"] < 1e-8, (c, gap, closure)
            warned += record.stdout.count("warning: pair mid: at first the sides overlap, by 0.0001 at (0, 1), and contact")
            if depth == 4e-4:
                error.append(relative(record["pair.mid.pressure_max"], (closure + 1e-4) / (LAYERS + c / YOUNG)))
    case("H10", "force and pressure off the closed form, overlap of 1e-4", max(error), 1e-8)
    case("H10", "of six runs those without one warning with depth and place", 6 - warned, 0)
    assert "warning" not in solve(layers(4, 0.05, 1e-3)).stdout


# --- contact in a point --------------------------------------------------------------------------------------------------------


def test_a_wedge_that_presses_with_one_node():
    """Gap 1e-3 x, closure 1e-4: cells of 1/4 to 1/16 have one node in contact, and finer meshes come to one force"""
    force, active, warned, ends = [], [], [], 0
    for n in 4, 8, 16, 32, 64:
        record = run(None, *layers(n, 0, 1e-4, gap="1e-3*x").split(), expect=None)
        ends += record.status == 0
        force.append(record["pair.mid.force"])
        active.append(record["pair.mid.active"])
        warned.append(record.stdout.count("warning: pair mid: one node in contact is too few"))
    print(force, active)
    case("H11", "runs with one node in contact that do not say so, and others that do", sum(w != (a == 1) for w, a in zip(warned, active)), 0)
    assert active[0] == 1 and active[-1] > 1, active
    case("H11", "runs of a wedge that do not end as converged, 1 to 3 nodes in contact", 5 - ends, 0)
    changes = [abs(a - b) for a, b in zip(force, force[1:])]
    case("H11", "change of the force from one mesh to the next over that before", max(b / a for a, b in zip(changes, changes[1:])), 1)
    case("H11", "last change of the force, h = 1/32 to 1/64", changes[-1] / force[-1], 0.03)


def test_a_corner_that_presses_on_a_plane():
    """A block 4 by 1 whose side comes down on a wide layer inclined by 1/100 touches with its corner alone"""
    words = layers(8, 0, 1e-4, gap="1e-2*(4-x)").split()
    words[words.index("-lower_mesh_box") + 1] = "0,0,8,1"
    words[words.index("-lower_mesh_cells") + 1] = "64,8"
    record = solve(*words)
    print(record["pair.mid.force"], record["pair.mid.active"])
    assert record["pair.mid.active"] == 1 and record["pair.mid.force"] > 0 and record["check.balance"] < 1e-8
    case("H11", "complementarity where a corner presses on a layer with one node", record["pair.mid.complementarity"], 1e-8)


# --- load up and down ----------------------------------------------------------------------------------------------------------


def test_the_way_to_a_load_does_not_matter():
    """Without friction the force depends on the closure alone. Loads have no steps; what is left of a way to a load is where the loop
    begins: without contact, with all of it, with that of springs, or with a layer model. From all of them it must end at one force."""
    spread = []
    for closure in 1.366e-3, 5e-4, 5e-3:
        force = [solve(layers(8, 0.05, closure), "-snes_type ddactive -snes_rtol 1e-11")["pair.mid.force"]]
        for start in "zero", "nocontact", "winkler":
            loop = f"-snes_type ddneumann -snes_ddneumann_start {start} -snes_rtol 1e-11"
            force.append(solve(layers(8, 0.05, closure), loop)["pair.mid.force"])
        print(closure, force)
        spread.append(max(force) / min(force) - 1)
    case("H27", "force from one start of the loop off that from another", max(spread), 1e-8)
    case("H27", "force that is left with a closure of -1e-3", solve(layers(8, 0.05, -1e-3))["pair.mid.force"], 0)


# --- no contact ----------------------------------------------------------------------------------------------------------------


def test_layers_that_do_not_meet_carry_no_force():
    force, sweeps, silent, strain = [], [], 0, []
    for c in 0, 0.05:
        for options in {"closure": -1e-3}, {"gap": "1"}, {"gap": "1", "closure": -1e-3}, {"gap": "0", "closure": -1e-3}:
            record = solve(layers(4, c, **options))
            silent += "pair mid: no contact" not in record.stdout.splitlines()
            force.append(abs(record["pair.mid.force"]))
            sweeps.append(record["sweeps"])
            strain.append(record["energy.strain"] / (LAYERS**-1 * options.get("closure", CLOSURE) ** 2))
            for key in "force", "pressure_max", "contact_length", "contact_edge", "active", "penetration_max":
                assert record[f"pair.mid.{key}"] == 0, (c, options, key, record[f"pair.mid.{key}"])
            assert record["verdict"] == "converged" and record["error.loop"] == 0 and record["energy.penalty"] == 0
    case("H08", "force of layers that do not meet", max(force), 0)
    case("H08", "sweeps, and verdict converged", max(sweeps), 2)
    case("H08", "runs that do not say: no contact", silent, 0)
    case("H08", "strain energy of the bodies, only moved, over that of a closure", max(strain), 1e-9)


def test_a_parabola_that_touches_at_a_point_carries_next_to_nothing():
    """Its average against the dual function of that node is below zero, so the node presses: by a force that vanishes faster than h^2"""
    force = [solve(layers(n, closure=0.0))["pair.mid.force"] for n in (4, 8, 16)]
    assert force[0] < 3e-3 * FORCE and force[0] > 4 * force[1] > 16 * force[2], force


# --- no hold -------------------------------------------------------------------------------------------------------------------


def block(*options, c=0, expect=0, gap="0.5"):
    """The upper layer, held on the left only, so free to move up and down, above the lower one"""
    scene = [word for word in layers(4, c, gap=gap).split() if word not in ("-upper_bc_top_u2", repr(-CLOSURE))]
    record = solve(*scene, *options, "-scene_probes A -A_probe_body upper -A_probe_point 2,2", expect=expect)
    assert max(abs(record[f"probe.A.{key}"]) for key in ("u1", "u2")) <= 4e3, record  # thousand lengths of the block
    return record


def check_floating(record, body, motion):
    named = any(body in line and motion in line for line in record.stdout.splitlines())
    print(record.stdout)
    unnamed = record.status != 2 or record["verdict"] != "floating" or not named
    case("H09", "floating bodies without status 2 and a line with body and motion", unnamed, 0)


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
    refused = line.startswith("abut: upper: nothing holds this body along x")
    case("H09", "bodies that may slide and are not refused in a line", not refused, 0)


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
    closed, falls = [], 0
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
                closed.append(relative(force[-1], exact))
                assert record["pair.mid.active"] == 33 and edge[-1] == 4, (force[-1], exact)
        assert all(a < b for a, b in zip(force, force[1:])), force
        falls += sum(a > b for a, b in zip(edge, edge[1:]))
    assert relative(force[3], 2368.09) < 1e-4 and abs(edge[3] - 2.9) < 1 / 8  # of another program, bilinear elements of the same size
    case("H12", "force off the closed form where the whole side is closed", max(closed), 1e-8)
    case("H12", "closures at which the contact ends before that of a smaller one", falls, 0)
    case("H12", "force off another program's, closure of 10 gaps, c = 0.05", relative(force[3], 2368.09), 1e-4)


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
