"""One element at the edge of the contact refined once or more, on one side or on both: nodes hang beside the contact. An even pressure
stays even, and the pressures of the layers of examples/layers do not oscillate.

Lengths in cm, stresses in MPa, the half model, exact contact.
"""
import csv, os, tempfile

from abut import case, run
from test_exact import MIDDLE, exact_pressure
from test_hard import LAYERS, YOUNG, layers

N = 8  # cells per cm


def refine(body, x, levels):
    """The element of the contact side that ends at x, split so many times; its neighbours only as 2:1 asks"""
    h = 1 / N
    middle = x - h / 2, 1 - h / 2 if body == "lower" else 1 + h / 2
    return f"-{body}_mesh_size max({h / 2**levels},max(abs(x-{middle[0]}),abs(y-{middle[1]})))"


def solve(order, shape, sizes, *options, **keys):
    """The record, and the pressures as pairs of x and p"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "profile.csv")
        words = layers(N, **keys).split() + list(sizes) + ["-output_profile", path]
        for body in "lower", "upper":
            words += [f"-{body}_mesh_order", str(order), f"-{body}_mesh_shape", shape]
        record = run(None, *words, *options)
        with open(path) as f:
            nodes = sorted((float(row["x"]), float(row["pressure"])) for row in csv.DictReader(f) if row["side"] == "pressure")
    return record, nodes


def variants(x, levels):
    yield [refine("lower", x, levels)]
    yield [refine("upper", x, levels)]
    yield [refine("lower", x, levels), refine("upper", x - 1 / N, levels)]


def test_an_even_pressure_stays_even():
    """Also at the free end of the side, x = 4"""
    off = []
    for order, shape in (1, "quad"), (2, "quad"), (3, "quad"), (2, "triangle"):
        for x, levels in (1, 1), (4, 3):
            for sizes in variants(x, levels):
                probe = "-scene_probes A -A_probe_body lower -A_probe_point 0.93,0.97".split()
                record, nodes = solve(order, shape, sizes, *probe, "-snes_rtol 1e-12", closure=1e-3, gap="0")
                exact = 1e-3 / LAYERS
                assert max(abs(p / exact - 1) for _, p in nodes) < 1e-9, (order, shape, sizes)
                off.append(abs(record["probe.A.u2"] / (-0.97 * exact * (1 - 0.3**2) / YOUNG) - 1))
                assert abs(record["probe.A.s11"]) < 1e-9 * exact and abs(record["probe.A.s22"] / exact + 1) < 1e-9


    case("H19", "displacement off under an even pressure, nodes that hang beside the contact", max(off), 1e-10)


def test_pressures_at_the_edge_of_the_contact_do_not_oscillate():
    """They fall from node to node, and change by less than 5 % of the largest; that of the node beyond the edge, at 1, comes nearer to none"""
    changes, rises = [], []
    for order in 1, 2, 3:
        for side in "first", "second":
            _, plain = solve(order, "quad", [], f"-mid_pair_pressure_side {side}")
            for sizes in (sizes for levels in (1, 3) for sizes in variants(1, levels)):
                record, nodes = solve(order, "quad", sizes, f"-mid_pair_pressure_side {side}")
                at = dict(nodes)
                change = max(abs(at[x] - p) for x, p in plain if x < 0.99 and x in at) / MIDDLE
                error = [max(abs(p - exact_pressure(x)) for x, p in all if x < 0.99) / MIDDLE for all in (plain, nodes)]
                beyond = [max(p for x, p in all if x > 0.9927) / MIDDLE for all in (plain, nodes)]
                steps = [after[1] - before[1] for before, after in zip(nodes, nodes[1:])]
                print(f"order {order}, {side}, {len(nodes)} nodes: change {change:.1e}, error, beyond", error, beyond, max(steps))
                assert error[1] < 0.05 and beyond[1] < beyond[0] + 0.02, (order, side, sizes)
                assert max(steps) < 1e-3 * MIDDLE and record["check.balance"] < 1e-8, (order, side, sizes)
                changes.append(change)
                rises.append(max(steps) / MIDDLE)
    case("H19", "change of nodal pressures against the plain mesh, over the largest", max(changes), 0.05)
    case("H19", "their rise from one node to the next one out, over the largest", max(rises), 0.05)
