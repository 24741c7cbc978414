"""A stiff punch with sharp corners, examples/punch: the pressure at its corner is r^(-1/2), so that uniform meshes give half an order in h,
and adapted ones that of their elements. The half model; E of punch and base 2.1e6 and 2.1e2.

The error is that of the strain energy F, which for given displacements is never below the exact one: the root of F_h/F - 1 is the relative
error in the energy norm. F is from meshes of order 4, graded to 1e-7 at the corner.

Not here: an L-shaped body under a punch, with a corner r^0.54 where nothing touches; bodies are boxes until meshes can be read from files.
"""
import csv, functools, math, os, tempfile

from abut import ROOT, case, read_csv, run

PUNCH = os.path.join(ROOT, "examples", "punch", "punch.yml")
SIZE = "max({h},{slope}*(abs(x-1)+abs(y)))"


def press(*options, adaptor="", **keys):
    """The scene with other keys for its adaptor and estimator, without any if there are none"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.yml")
        with open(PUNCH) as old, open(path, "w") as new:
            new.writelines(line for line in old if not line.startswith(("adaptor:", "estimator:")))
            new.write(adaptor)
        return run(path, *options, **keys)


def both(text):
    return [f"-{body}_{text}" for body in ("base", "punch")]


def graded(order, h, slope, *options):
    """Cells at the corner are of size h"""
    return press(*both(f"mesh_order {order}"), *both(f"mesh_size {SIZE.format(h=h, slope=slope)}"), "-snes_rtol 1e-10", *options)


@functools.lru_cache(None)
def exact_energy():
    return graded(4, 1e-7, 0.3)["energy.strain"]


def error(record):
    return math.sqrt(record["energy.strain"] / exact_energy() - 1)


def test_the_energy_of_reference_is_settled():
    """From order 3 and coarser meshes too, and from uniform meshes by their law F_h - F = C h"""
    F = exact_energy()
    assert abs(graded(3, 1e-6, 0.3)["energy.strain"] / F - 1) < 1e-4
    assert abs(graded(4, 1e-5, 0.5)["energy.strain"] / F - 1) < 1e-4
    coarse, fine = (press(*both("mesh_order 2"), f"-base_mesh_cells {4 * n},{4 * n} -punch_mesh_cells {n},{n}")["energy.strain"] for n in (4, 8))
    assert abs((2 * fine - coarse) / F - 1) < 1e-3, (coarse, fine, F)


def test_the_pressure_is_that_under_a_rigid_punch():
    """On a half-plane P/(pi sqrt(a^2 - x^2)) for a force P, twice that of the half model; the base is 40 times as deep as the punch is wide"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "profile.csv")
        record = graded(3, 1e-6, 0.2, "-base_mesh_box 0,-80,80,0 -output_profile", path)
        with open(path) as f:
            nodes = sorted((float(row["x"]), float(row["pressure"])) for row in csv.DictReader(f) if row["side"] == "pressure")
    P = 2 * record["pair.mid.force"]
    off = [abs(p * math.pi * math.sqrt(1 - x * x) / P - 1) for x, p in nodes if x < 0.95]
    case("V09", "p off P/(pi sqrt(a^2 - x^2)), up to 0.95 a", max(off), 1e-2)
    case("V09", "p(0) off P/(pi a)", off[0], 5e-3)
    assert len([x for x, _ in nodes if x < 0.95]) > 10
    assert abs(record["energy.strain"] / (0.5e-3 * record["pair.mid.force"]) - 1) < 1e-6


def test_uniform_meshes_have_half_an_order():
    for order in 1, 2:
        e = [error(press(*both(f"mesh_order {order}"), f"-base_mesh_cells {4 * n},{4 * n} -punch_mesh_cells {n},{n}")) for n in (2, 4, 8)]
        print(order, e)
        rates = [math.log2(coarse / fine) for coarse, fine in zip(e, e[1:])]
        case("V09", f"order in h of uniform meshes of order {order} off 1/2", max(abs(rate - 0.5) for rate in rates), 0.06)


def adapt(estimator, order, target):
    """Unknowns, errors and effectivities of all cycles; each converges its contact"""
    with tempfile.TemporaryDirectory() as folder:
        adaptor = f"adaptor: {{type: doerfler, bulk: 0.5, target: {target}, max_level: 28}}\nestimator: {{type: {estimator}}}\n"
        press("-scene_loop_share 0", f"-record_csv {folder}/run.csv", *both(f"mesh_order {order}"), adaptor=adaptor)
        rows = read_csv(f"{folder}/run.csv")
    e = [error(row) for row in rows]
    for row, one in zip(rows, e):
        print(f"{estimator}, order {order}: {row['unknowns']} unknowns, error {one:.5f}, effectivity {row['error.discretisation'] / one:.2f}")
    return [row["unknowns"] for row in rows], e, [row["error.discretisation"] / one for row, one in zip(rows, e)]


def rate(n, e, span):
    """Exponent of 1/N over the last cycles, by a factor of at least `span`"""
    start = max(i for i in range(len(n)) if n[i] <= n[-1] / span)
    return math.log(e[start] / e[-1]) / math.log(n[-1] / n[start])


def test_adapted_meshes_of_order_1_have_the_order_of_smooth_solutions():
    """N^(-1/2), uniform meshes N^(-1/4)"""
    uniform = error(press("-base_mesh_cells 64,64 -punch_mesh_cells 16,16"))
    for estimator, low in ("zz", 0.75), ("fembem", 0.75), ("residual", 0.5):
        n, e, effectivity = adapt(estimator, 1, 0.02)
        if estimator == "fembem":
            case("V09", "exponent of 1/N, adapted meshes of order 1, fembem", rate(n, e, 30), 0.6, 0.48)
        assert rate(n, e, 30) > 0.48 and e[-1] < 0.3 * uniform, (estimator, rate(n, e, 30), e[-1], uniform)
        assert all(low < ratio < 1.15 for ratio in effectivity[-5:]), effectivity


def test_adapted_meshes_of_order_2_and_3_have_theirs():
    for order, target in (2, 4e-3), (3, 3e-3):
        n, e, effectivity = adapt("zz", order, target)
        assert rate(n, e, 5) > 0.48 * order, (order, rate(n, e, 5))
        assert all(0.75 < ratio < 1.15 for ratio in effectivity[-3:]), effectivity


def test_a_target_out_of_reach_ends_at_a_cap():
    """Exit status 3, a verdict that names the cap and what to raise, and the forces of the last mesh, within 5 % of those of a fine one"""
    wrong, over, off = 0, [], []
    force = graded(3, 1e-6, 0.3)["pair.mid.force"]
    for kind in "{type: doerfler, target: 1e-6", "{type: equal, target: 1e-6", "{type: threshold, threshold: 1e-6":
        for cap, most in ("max_level", 5), ("max_unknowns", 3000):
            levels = "" if cap == "max_level" else ", max_level: 28"
            adaptor = f"adaptor: {kind}, {cap}: {most}{levels}}}\nestimator: {{type: zz}}\n"
            record = press(adaptor=adaptor, expect=None)
            line = record.stdout.splitlines()[-1]
            named = record["verdict"] == {"max_level": "limit_level", "max_unknowns": "limit_unknowns"}[cap] and f"-adaptor_{cap}" in line
            wrong += record.status != 3 or not named
            reached = max(record[f"body.{body}.{'level_max' if cap == 'max_level' else 'unknowns'}"] for body in ("base", "punch"))
            over.append(reached / most)
            off.append(abs(record["pair.mid.force"] / force - 1))
            print(kind, cap, record["verdict"], record["cycles"], record["unknowns"], reached, off[-1])
    case("H17", "runs that do not end at their cap with status 3 and a line that names it", wrong, 0)
    case("H17", "levels or unknowns of a body over the cap", max(over), 1)
    case("H17", "force of the answer that is left off that of a fine mesh", max(off), 0.05)
