"""Curved contact of bodies from gmsh files, through the scenes of examples/: Hertz' lines, Persson's pin, a layer pressed into a block, a re-entrant corner.

Hertz: a = sqrt(4 P R/(pi E*)), p0 = 2P/(pi a) of half-planes. Pin in a hole, same material: A. Persson, On the stress distribution of cylindrical
elastic bodies in contact, Chalmers (1964), with b = tan(eps/2), in an infinite plate:
E' dR/Q = (2 - 2 b^4 - log(1 + b^2))/(pi b^2 (1 + b^2)); the pressure is integrated here against Q before it is believed. Corner of 3 pi/2:
r^0.5445, M. L. Williams (1952).
"""
import functools, math, os, shutil, tempfile

from abut import ROOT, case, run, run_error
from uniform import ADAPTED, UNIFORM, series, share

HERTZ, CYLINDERS, PLANE, PIN, COATING, LSHAPE, RECEDING = (
    os.path.join(ROOT, "examples", name) for name in
    ("hertz/hertz.yml", "hertz/cylinders.yml", "hertz/plane.yml", "pin/pin.yml", "coating/coating.yml", "lshape/lshape.yml", "receding/receding.yml")
)
PRIME, RADIUS, PLAY = 2.1e5 / (1 - 0.3**2), 10.0, 0.01
CORNER = 0.5445


def hertz(P, R, *materials):
    modulus = 1 / sum((1 - nu**2) / E for E, nu in materials)
    a = math.sqrt(4 * P * R / (math.pi * modulus))
    return a, 2 * P / (math.pi * a)


def off(value, exact):
    return abs(value / exact - 1)


def pair(record, key):
    return record[f"pair.{'fit' if 'pair.fit.force' in record else 'mid'}.{key}"]


def persson(eps):
    """E' dR/Q for half the angle of the contact"""
    b2 = math.tan(eps / 2) ** 2
    return (2 - 2 * b2**2 - math.log(1 + b2)) / (math.pi * b2 * (1 + b2))


def persson_angle(ratio):
    low, high = 1e-3, math.radians(84.8)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if persson(middle) > ratio else (low, middle)
    return middle


def persson_pressure(eps, angle):
    """p R/Q"""
    b2, y2 = math.tan(eps / 2) ** 2, math.tan(angle / 2) ** 2
    root, whole = math.sqrt(b2 - y2), math.sqrt(1 + b2)
    return 2 / (math.pi * whole) * root / (1 + y2) + math.log((whole + root) / (whole - root)) / (2 * math.pi * b2 * (1 + b2))


@functools.lru_cache(None)
def pin(ratio, *options, **keys):
    """The example under Q = E' dR/ratio"""
    return run(PIN, f"-pin_bc_core_t2 {-PRIME * PLAY / ratio / math.pi!r}", *options, **keys)  # half of Q on the pi/2 mm of the core


def test_a_cylinder_on_a_block_and_two_cylinders_press_as_hertz_says():
    steel, aluminium = (2.1e5, 0.3), (7e4, 0.3)
    for scene, what, (a, p0) in (
        (HERTZ, "NAFEMS 1", hertz(35e3, 50, steel, aluminium)),
        (CYLINDERS, "radii 8 and 12", hertz(1e3, 1 / (1 / 8 + 1 / 12), steel, steel)),
        (PLANE, "radius 8 on a rigid plane", hertz(1e3, 8, steel)),
    ):
        record = run(scene)
        case("V06", f"p0 off Hertz, {what}", off(pair(record, "pressure_max"), p0), 0.03)
        case("V06", f"a off Hertz, {what}", off(pair(record, "contact_edge"), a), 0.02)
        assert record["unknowns"] < 8000


def test_a_pin_touches_its_hole_as_far_as_persson_says():
    for ratio in 10, 1, 0.1:
        eps = persson_angle(ratio)
        n, weight = 2000, eps / 2000
        whole = sum(2 * weight * persson_pressure(eps, (k + 0.5) * weight) * math.cos((k + 0.5) * weight) for k in range(n))
        assert abs(whole - 1) < 1e-5, whole
        record = pin(ratio, "-adaptor_target 0.01")
        degrees = abs(math.degrees(pair(record, "contact_edge") / RADIUS - eps))
        case("V11", f"half angle of the contact off Persson's {math.degrees(eps):.2f} degrees, degrees", degrees, 0.15)
        peak = PRIME * PLAY / ratio / RADIUS * persson_pressure(eps, 0)
        case("V11", f"largest pressure off Persson's, E'dR/Q = {ratio}", off(pair(record, "pressure_max"), peak), 0.015)


def test_a_thin_hard_layer_changes_hertz_little():
    """By the first order in its thickness over a, a ninth here, weakened by its stiffness; the record has both pairs"""
    a, p0 = hertz(7200, 500, (2.1e5, 0.3), (7e4, 0.3))
    record = run(COATING)
    case("V06", "p0 of a coated block off Hertz", off(record["pair.above.pressure_max"], p0), 0.02)
    case("V06", "mean of a above and below the coating off Hertz", off(0.5 * (record["pair.above.contact_edge"] + record["pair.below.contact_edge"]), a), 0.03)
    assert abs(record["pair.below.force"] / 3600 - 1) < 1e-8


def test_receding_contact_is_that_of_the_integral_equation_under_any_force():
    top = "0-{}*15/(16*0.05)*(1-(x/0.05)^2)^2*(abs(x)<0.05)"
    small, large = (run(RECEDING, "-layer_bc_top_t2", top.format(P))["pair.mid.contact_edge"] for P in ("1", "1000"))
    case("V08", "c/h of the example off the integral equation", off(small, 1.3241654), 0.01)
    assert off(large, small) < 1e-8


def test_forces_on_curved_sides_balance_before_convergence_too():
    for scene, what in ((HERTZ, "hertz"), (CYLINDERS, "cylinders"), (PIN, "pin")):
        for steps in 1, 2:
            for side in "first", "second":
                name = "fit" if scene == PIN else "mid"
                record = run(scene, f"-snes_max_it {steps} -snes_rtol 1e-12 -scene_loop_share 0 -{name}_pair_pressure_side {side}", expect=2)
                assert record["verdict"] == "max_iterations" and record["residual.loop"] > 1e-9, record
                case("H21", f"forces on the two sides, {what}, pressures on the {side}, {steps} steps", pair(record, "balance"), 1e-10)


def test_curved_contact_is_the_same_on_all_ranks():
    for scene in HERTZ, PIN:
        one, *others = (run(scene, "-snes_rtol 1e-11", ranks=n) for n in (1, 2, 3, 4))
        worst = max(off(pair(other, key), pair(one, key)) for other in others for key in ("force", "pressure_max", "contact_length"))
        worst = max([worst] + [off(other["energy.strain"], one["energy.strain"]) for other in others])
        case("H24", f"records of {os.path.basename(scene)} on 2 to 4 ranks off that on one", worst, 1e-10)
        assert all(other["unknowns"] == one["unknowns"] for other in others)


def test_bodies_may_change_places():
    for scene, name, bodies, sides in ((HERTZ, "mid", "block,roller", "face,arc"), (PIN, "fit", "plate,pin", "hole,pin")):
        options = f"-{name}_pair_pressure_side first -adaptor_target 0.01"
        one, other = run(scene, options), run(scene, options, f"-{name}_pair_bodies {bodies} -{name}_pair_sides {sides}")
        case("V06", f"p0 with the pressures on the other body, {name}", off(pair(other, "pressure_max"), pair(one, "pressure_max")), 0.01)
        case("V06", f"a with the pressures on the other body, {name}", off(pair(other, "contact_edge"), pair(one, "contact_edge")), 0.01)


@functools.lru_cache(None)
def corner():
    """The energy of the L, with more digits than the others"""
    return run(LSHAPE, "-ell_mesh_order 2 -block_mesh_order 2 -adaptor_target 2e-3 -adaptor_max_level 24")


def test_the_corner_has_its_order_and_adaptation_that_of_smooth_stress():
    energy = [row["energy.strain"] for row in series(run, LSHAPE, UNIFORM, "-adaptor_max_level 5")]
    falls = [a - b for a, b in zip(energy, energy[1:])]
    order = math.log2(falls[-2] / falls[-1]) / 2
    case("V10", "order of uniform meshes in h", order, CORNER + 0.04, CORNER - 0.02)
    fine = corner()["energy.strain"]
    rows = [row for row in series(run, LSHAPE, ADAPTED, "-adaptor_max_unknowns 4000 -adaptor_max_level 24") if row["unknowns"] > 200]
    x, y = [math.log(row["unknowns"]) for row in rows], [0.5 * math.log(row["energy.strain"] / fine - 1) for row in rows]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    slope = sum((u - mx) * (v - my) for u, v in zip(x, y)) / sum((u - mx) ** 2 for u in x)
    case("V10", "order of adapted meshes in unknowns", -slope, 0.58, 0.45)


def test_adapted_meshes_take_fewer_unknowns_than_uniform_ones():
    """Against each scene's own fine mesh, for the bodies are finite; as a table"""
    hertz_fine, pin_fine = run(HERTZ, "-adaptor_target 2e-3"), run(PIN, "-adaptor_target 4e-3")
    edge = lambda row: off(pair(row, "contact_edge"), pair(hertz_fine, "contact_edge"))
    peak = lambda row: off(pair(row, "pressure_max"), pair(hertz_fine, "pressure_max"))
    energy = lambda fine: lambda row: math.sqrt(off(row["energy.strain"], fine["energy.strain"]))
    for scene, what, error, target, most in (
        (HERTZ, "a", edge, 0.01, 12000),
        (HERTZ, "p0", peak, 0.005, 12000),
        (PIN, "energy norm", energy(pin_fine), 0.05, 12000),
        (LSHAPE, "energy norm", energy(corner()), 0.05, 8000),
    ):
        meshes = [series(run, scene, way, f"-adaptor_max_unknowns {most}") for way in (UNIFORM, ADAPTED)]
        assert share(os.path.basename(scene)[:-4], what, error, target, *meshes) < 1


def test_files_lie_beside_the_scene_or_in_the_current_folder():
    with tempfile.TemporaryDirectory() as folder:
        for name in "hertz.yml", "hertz.msh":
            shutil.copy(os.path.join(os.path.dirname(HERTZ), name), folder)
        scene = os.path.join(folder, "hertz.yml")
        with open(os.path.join(folder, "lid.csv"), "w") as f:
            f.write("x,y,value\n0,50,-350\n50,50,-350\n")
        with open(scene) as f:
            text = f.read().replace("{t2: -350}", "{t2: lid.csv}")
        with open(scene, "w") as f:
            f.write(text)
        record = run(scene, "-adaptor_target 0.1")
        assert abs(record["pair.mid.force"] / 17500 - 1) < 1e-6
        os.remove(os.path.join(folder, "lid.csv"))
        line = run_error(scene)
        assert line.startswith('abut: roller_bc_lid_t2: no file "lid.csv"'), line
        run(scene, "-roller_bc_lid_t2 -350 -adaptor_target 0.1", f"-block_mesh_file {folder}/hertz.msh", ranks=2)
        line = run_error(scene, "-roller_bc_lid_t2 -350 -block_mesh_file hertz.msh")  # of the command line: of the current folder
        assert line == "abut: block_mesh_file: hertz.msh: cannot be read: No such file or directory", line
