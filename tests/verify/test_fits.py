"""The examples shrink, lame, thermal and gravity against their formulas, and friction over load steps that turn back.

Fits and tubes: G. Lame's solution, S. P. Timoshenko and J. N. Goodier, Theory of Elasticity (1970), section 28. A ring b < r < c on a shaft 0 < r < b of
the same material, too thick by d, in plane strain: p = d E'/(2 b) (c^2 - b^2)/c^2, E' = E/(1 - nu^2); on a hollow one, a < r < b,
p = d E'/(2 b^3) (b^2 - a^2) (c^2 - b^2)/(c^2 - a^2). Turning friction: K. L. Johnson, Contact Mechanics (1985), section 7.4.
"""
import csv, functools, math, os, tempfile

from abut import case, read_csv, run

SHRINK, SHRINK_PLANE = "examples/shrink/shrink.yml", "examples/shrink/plane.yml"
LAME, LAME_PLANE = "examples/lame/lame.yml", "examples/lame/plane.yml"
THERMAL, GRAVITY = "examples/thermal/thermal.yml", "examples/gravity/gravity.yml"
YOUNG, NU = 2.1e5, 0.3
STIFF = YOUNG / (1 - NU**2)
B, C, DEPTH = 20.0, 40.0, 0.02
FIT = DEPTH * STIFF / (2 * B) * (C**2 - B**2) / C**2


def off(record, **exact):
    return max(abs(record[key.replace("__", ".")] / value - 1) for key, value in exact.items())


def fit_off(record, p=FIT):
    return off(record, pair__fit__pressure_max=p, pair__fit__force=2 * math.pi * B * 10 * p)


def on_both(key, value):
    return f"-shaft_mesh_{key} {value} -ring_mesh_{key} {value}"


def test_a_ring_presses_on_its_shaft_as_lame_says():
    record = run(SHRINK)
    print(f"shrink: adapted, {record['unknowns']} unknowns")
    case("V19", "pressure and force of a shrink fit, bodies of revolution, off Lame", fit_off(record), 1e-4)
    for order, least in (1, 1.9), (2, 3.8), (3, 5.5):
        uniform = [run(SHRINK, "-adaptor_target 0.99", on_both("order", order), on_both("size", size)) for size in (10, 5, 2.5)]
        errors = [fit_off(one) for one in uniform]
        print(f"shrink: order {order}, uniform: {[(one['unknowns'], f'{error:.1e}') for one, error in zip(uniform, errors)]}")
        case("V19", f"order of the pressure, displacements of order {order}", math.log2(errors[1] / errors[2]), 8, least)


def test_a_hollow_shaft_gives_way_more():
    a = 10.0
    record = run(SHRINK, f"-shaft_mesh_box {a},0,{B},10")
    p = DEPTH * STIFF / (2 * B**3) * (B**2 - a**2) * (C**2 - B**2) / (C**2 - a**2)
    case("V19", "pressure of a ring on a hollow shaft off Lame", fit_off(record, p), 1e-4)


def test_a_fit_stays_while_loads_come_in_steps_on_all_ranks():
    """A load factor changes no gap. A pressure q around the ring is all over a solid body, so that p is that of the fit and q"""
    squeeze = "-scene_effects round,press,squeeze -squeeze_effect_type pressure -squeeze_effect_bodies ring -squeeze_effect_side right -squeeze_effect_pressure 50"
    for ranks in 1, 2, 3, 4:
        with tempfile.TemporaryDirectory() as folder:
            steps = "-scene_load_steps", "0,1,-1,0.5", "-record_csv", f"{folder}/rows"
            run(SHRINK, squeeze, *steps, "-adaptor_target 0.99", on_both("order", 3), ranks=ranks)
            rows = read_csv(f"{folder}/rows")
        assert [row["load_factor"] for row in rows] == [0, 1, -1, 0.5]
        case("V19", f"pressure of a fit that is squeezed in load steps, {ranks} ranks", max(fit_off(row, FIT + 50 * row["load_factor"]) for row in rows), 1e-4)


def test_the_same_fit_in_the_plane():
    """The sides are polygons that do not match: nodal pressures vary by what the corners do, of first order; their mean is of second order"""
    arc, mean = math.pi / 2 * B, []
    for size in 3.5, 1.75:
        record = run(SHRINK_PLANE, "-adaptor_target 0.99", on_both("size", size))
        mean.append(off(record, pair__fit__force=arc * FIT))
        print(f"plane: {record['unknowns']} unknowns, mean pressure off {mean[-1]:.1e}, largest {record['pair.fit.pressure_max'] / FIT - 1:.1e}")
    case("V19", "mean pressure of the fit in the plane off that of the bodies of revolution", mean[-1], 1e-3)
    assert mean[1] < 0.4 * mean[0], mean
    record = run(SHRINK_PLANE)
    case("V19", "the same on an adapted mesh", off(record, pair__fit__force=arc * FIT), 1e-3)
    case("V19", "largest nodal pressure there", record["pair.fit.pressure_max"] / FIT - 1, 0.05)


def tube(r, p=100.0, a=10.0, b=20.0):
    """u_r, s_rr and hoop stress"""
    k = p * a**2 / (b**2 - a**2)
    return (1 + NU) / YOUNG * k * ((1 - 2 * NU) * r + b**2 / r), k * (1 - b**2 / r**2), k * (1 + b**2 / r**2)


def test_a_tube_under_pressure_has_lame_s_displacement_and_hoop_stress():
    at = {"bore": tube(10), "rim": tube(20)}
    record = run(LAME)
    print(f"lame: adapted, {record['unknowns']} unknowns")
    exact = {f"probe__{name}__{key}": value for name, (u, _, hoop) in at.items() for key, value in (("u1", u), ("s33", hoop))}
    case("V20", "displacement and hoop stress of a tube, bodies of revolution, off Lame", off(record, **exact), 1e-4)
    for size in 1.25, 0.625:
        one = run(LAME, "-adaptor_target 0.99", "-tube_mesh_size", size)
        print(f"lame: order 3, uniform, {one['unknowns']} unknowns, off by {off(one, **exact):.1e}")
    case("V20", "the same on a uniform mesh", off(one, **exact), 1e-4)
    moves = {key: value for key, value in exact.items() if key.endswith("u1")}
    hoops = {key.replace("s33", "s22"): value for key, value in exact.items() if key.endswith("s33")}
    record = run(LAME_PLANE, "-adaptor_target 0.99 -tube_mesh_size 0.3")
    print(f"lame, plane: {record['unknowns']} unknowns, displacement off by {off(record, **moves):.1e}, hoop stress by {off(record, **hoops):.1e}")
    case("V20", "displacement of a tube in the plane, with curved sides from gmsh", off(record, **moves), 1e-4)
    case("V20", "hoop stress there", off(record, **hoops), 1e-4)


def test_a_cooling_ring_grips_the_shaft():
    """Ends are free and nothing rubs: both bodies have no stress along the axis, and p b (1/K of the shaft + 1/K of the ring) = alpha dT b"""
    with tempfile.TemporaryDirectory() as folder:
        run(THERMAL, "-record_csv", f"{folder}/rows")
        rows = read_csv(f"{folder}/rows")
    p = 1.2e-5 * 100 / ((1 - 0.35) / 1e5 + ((C**2 + B**2) / (C**2 - B**2) + 0.3) / YOUNG)
    ends = {row["load_factor"]: row for row in rows}  # the last mesh of each step
    case("V19", "pressure of a cooling ring on a shaft of another material off Lame", fit_off(ends[1], p), 1e-4)
    case("V19", "the same while it cools", max(fit_off(row, factor * p) for factor, row in ends.items()), 1e-3)
    strain = "-shaft_bc_top_u2 0 -ring_bc_top_u2 0 -shaft_material_young 2.1e5 -shaft_material_poisson 0.3"
    heat, overlap = run(THERMAL, strain, "-adaptor_target 1e-4"), run(SHRINK, "-press_effect_depth", (1 + NU) * 1.2e-5 * 100 * B, "-adaptor_target 1e-4")
    error = abs(heat["pair.fit.pressure_max"] / overlap["pair.fit.pressure_max"] - 1)
    case("V19", "a cold ring off one with an overlap of (1 + nu) alpha dT b, plane strain", error, 1e-4)


def tilted(degrees, *options, **keys):
    w = math.radians(degrees)
    return run(GRAVITY, "-weight_effect_acceleration", f"{9.81 * math.sin(w)!r},{-9.81 * math.cos(w)!r}", *options, **keys)


def test_a_stack_on_a_tilted_table_holds_until_its_tangent_is_the_friction():
    weight, errors = 2500 * 9.81 * 2, []
    for degrees, ranks in (0, 1), (10, 2), (20, 3), (math.degrees(math.atan(0.4)) - 0.02, 4):
        record = tilted(degrees, ranks=ranks)
        for above, name in (3, "table"), (2, "joint1"), (1, "joint2"):
            force, along = above * weight * math.cos(math.radians(degrees)), above * weight * math.sin(math.radians(degrees))
            errors.append(abs(record[f"pair.{name}.force"] / force - 1))
            errors.append(abs(record[f"pair.{name}.tangential"] - along) / force)
    case("V17", "forces of a tilted stack off the weight above, across and along", max(errors), 1e-8)
    record = tilted(math.degrees(math.atan(0.4)) + 0.02, expect=2)
    assert record["verdict"] == "floating" and "it is free in moving along x" in record.stdout, record.stdout
    assert tilted(22, "-table_pair_friction 0.41")["verdict"] == "converged"


def test_the_pressures_of_a_stack_without_lateral_strain_are_the_weight_above():
    """Poisson's ratio 0 and level: s22 = -w (H - y) and nothing else, so that every nodal pressure is that of the formula"""
    flat = " ".join(f"-{name}_material_poisson 0" for name in ("bottom", "middle", "top"))
    record = tilted(0, flat, "-snes_rtol 1e-12")
    errors = [abs(record[f"pair.{name}.pressure_max"] / (above * 2500 * 9.81) - 1) for above, name in ((3, "table"), (2, "joint1"), (1, "joint2"))]
    case("V17", "pressures of a level stack off the weight above", max(errors), 1e-8)


STEPS = 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0, 0.5, 1


def slider(ranks):
    """A stiff block 2 x 1 pressed on a rigid table by springs above, and pushed by a force that turns; one row a step"""
    words = """-scene_bodies b -scene_pairs foot -scene_effects up,push -scene_probes A -b_mesh_box 0,0,2,1 -b_mesh_cells 4,2 -b_material_young 1e8
        -b_material_poisson 0 -foot_pair_bodies b -foot_pair_sides bottom -foot_pair_gap 0-1e-3 -foot_pair_penalty 0 -foot_pair_friction 0.3
        -up_effect_type spring -up_effect_side top -up_effect_normal 5e3 -up_effect_tangential 3e3 -push_effect_type force -push_effect_f1 4
        -A_probe_body b -A_probe_point 1,0.5 -snes_rtol 1e-10"""
    with tempfile.TemporaryDirectory() as folder:
        run(None, *words.split(), "-scene_load_steps", ",".join(map(str, STEPS)), "-record_csv", f"{folder}/rows", ranks=ranks)
        return read_csv(f"{folder}/rows")


def test_a_block_on_a_spring_goes_round_its_loop_of_friction():
    """The gap presses, and no load factor changes it: P = 2 depth/(1/k_n + H/E). The block slides where |F - K U| would exceed mu P, K = 2 k_t"""
    P, K, u, forces, moves = 2e-3 / (1 / 5e3 + 1 / 1e8), 6e3, 0.0, [], []
    rows = slider(1)
    for factor, row in zip(STEPS, rows):
        t = 8 * factor - K * u
        slides = abs(t) > 0.3 * P
        if slides:
            t = math.copysign(0.3 * P, t)
            u = (8 * factor - t) / K
            forces.append(abs(row["pair.foot.tangential"] / t - 1))
        forces.append(abs(row["pair.foot.force"] / P - 1))
        moves.append(max(abs(row["pair.foot.tangential"] - t) / P, abs(row["probe.A.u1"] - u) * K / P))
        assert (row["pair.foot.stick_length"] > 0) != slides, (factor, row)
    case("V18", "forces of a block that slides forth, back and forth", max(forces), 1e-8)
    case("V18", "its loop of force over way; 1e-4 is what it gives way elastically", max(moves), 1e-4)
    others = [max(abs(a["pair.foot.tangential"] - b["pair.foot.tangential"]) / P for a, b in zip(rows, slider(ranks))) for ranks in (2, 3, 4)]
    case("V18", "the same on 2, 3 and 4 ranks", max(others), 1e-8)


def root(z):
    return math.sqrt(max(0.0, 1 - z**2))


@functools.lru_cache(None)
def turning(ranks):
    """Two boxes with the gap of cylinders that overlap by a depth no factor changes, pushed aside and partly back: rows and tractions of all steps"""
    words = "-scene_bodies upper,lower -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap x^2/57.6923077-4e-3 -mid_pair_friction 0.3"
    for name, y in ("upper", 0), ("lower", -2):
        words += f" -{name}_mesh_box -2,{y},2,{y + 2} -{name}_mesh_cells 8,4 -{name}_mesh_size max(0.01,0.3*(sqrt(x^2+y^2)-0.31))"
        words += f" -{name}_material_young {YOUNG} -{name}_material_poisson {NU}"
    words += " -mid_pair_penalty 0 -snes_rtol 1e-10 -lower_bc_bottom_u1 0 -lower_bc_bottom_u2 0 -upper_bc_top_u2 0 -upper_bc_top_u1 5e-4 -scene_load_steps 1,0.6,0.2"
    with tempfile.TemporaryDirectory() as folder:
        run(None, *words.split(), f"-output_profile {folder}/p.csv -record_csv {folder}/rows", ranks=ranks)
        profiles = []
        for step in 1, 2, 3:
            with open(os.path.join(folder, f"p_step_{step:04d}.csv")) as f:
                profiles.append([(float(row["x"]), float(row["traction_t"])) for row in csv.DictReader(f) if row["side"] == "pressure"])
        return read_csv(f"{folder}/rows"), profiles


def test_partial_slip_that_turns_back_is_that_of_mindlin_and_deresiewicz():
    """q = mu p0 (-f(a) + 2 b/a f(b) - c/a f(c)), f(d) = sqrt(1 - x^2/d^2), c of the largest force Q*, (b/a)^2 = 1 - (Q* - Q)/(2 mu P)"""
    rows, profiles = turning(1)
    largest = rows[0]["pair.mid.tangential"]
    for k in 1, 2:
        P, Q, a = (rows[k][f"pair.mid.{key}"] for key in ("force", "tangential", "contact_edge"))
        c, b = (a * math.sqrt(1 - q) for q in (largest / (0.3 * P), (largest - Q) / (0.6 * P)))
        full = 0.3 * 2 * P / (math.pi * a)
        exact = [full * (2 * b / a * root(x / b) - root(x / a) - c / a * root(x / c)) for x, _ in profiles[k]]
        error = math.sqrt(sum((t - e) ** 2 for (_, t), e in zip(profiles[k], exact)) / sum((full * root(x / a)) ** 2 for x, _ in profiles[k]))
        case("V18", f"traction after turning back to {Q / largest:.2f} of the largest force, in L2, off Mindlin's and Deresiewicz'", error, 0.02)
        case("V18", "half width that sticks there", abs(rows[k]["pair.mid.stick_length"] / (2 * b) - 1), 0.02)
    three = turning(3)[0]
    keys = "force", "tangential", "stick_length"
    case("V18", "the same on 3 ranks", max(abs(a[f"pair.mid.{key}"] / b[f"pair.mid.{key}"] - 1) for a, b in zip(rows, three) for key in keys), 1e-7)
