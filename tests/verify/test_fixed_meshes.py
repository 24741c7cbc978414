"""The layers of examples/layers on fixed uniform meshes, against values and pressure curves computed without Abut: see examples/layers/reference.json
and layer_pressure.py. Lengths in cm, stresses in MPa, the half model, per cm of depth; h is one over the cells per cm."""
import bisect, csv, functools, json, math, os, tempfile

from abut import ROOT, case, run

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = """-scene_bodies lower,upper -scene_pairs mid
-lower_mesh_box 0,0,4,1 -lower_material_young 2.1e5 -lower_material_poisson 0.3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
-upper_mesh_box 0,1,4,2 -upper_material_young 2.1e5 -upper_material_poisson 0.3 -upper_bc_left_u1 0 -upper_bc_top_u2 -1.366e-3
-mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 1e-3*x^2"""
ANDERSON = "-snes_type anderson -snes_anderson_m 20 -snes_rtol 1e-10"
# Anderson's iterates wander off for small theta; this converges for all, in some hundreds of sweeps
NGMRES = "-snes_type ngmres -snes_ngmres_m 20 -snes_ngmres_select_type linesearch -npc_snes_type ddneumann -npc_snes_max_it 1"


def reference(c):
    with open(os.path.join(ROOT, "examples", "layers", "reference.json")) as f:
        return json.load(f)["cases"][str(c)]


@functools.lru_cache(None)
def curve(c):
    """s and p of the reference curve, x = a (1 - s^2)"""
    with open(os.path.join(HERE, "layer_pressure.csv")) as f:
        rows = list(csv.DictReader(line for line in f if not line.startswith("#")))[::-1]
    return [float(row["s"]) for row in rows], [float(row[str(c)]) for row in rows]


def exact_pressure(c, x):
    s, p = curve(c)
    at = math.sqrt(max(0, 1 - x / reference(c)["a"]["value"]))
    i = min(bisect.bisect_right(s, at), len(s) - 1)
    return p[i - 1] + (p[i] - p[i - 1]) * (at - s[i - 1]) / (s[i] - s[i - 1])


def interpolate(nodes, x):
    i = min(max(bisect.bisect_right(nodes, (x, math.inf)), 1), len(nodes) - 1)
    (x0, v0), (x1, v1) = nodes[i - 1 : i + 1]
    return v0 + (v1 - v0) * (x - x0) / (x1 - x0)


def integral(f, nodes, cut=()):
    """Of f between the nodes, 40 midpoints in each interval"""
    x = sorted({x for x, _ in nodes} | set(cut))
    return sum((b - a) / 40 * sum(f(a + (b - a) * (k + 0.5) / 40) for k in range(40)) for a, b in zip(x, x[1:]))


class Result:
    """One run: P, p0, a, nodal pressures, and the errors of the pressure and of the energy"""

    def __init__(self, upper, lower, *options, c=0.05, loop=ANDERSON):
        self.c, self.reference = c, reference(c)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "profile.csv")
            cells = f"-upper_mesh_cells {4 * upper},{upper} -lower_mesh_cells {4 * lower},{lower}"
            words = f"{SCENE} {cells} -mid_pair_penalty {c} {loop} -output_profile {path}".split()
            self.record = run(None, *words, *options)
            with open(path) as f:
                rows = list(csv.DictReader(f))
        column = lambda side, name: sorted((float(r["x"]), float(r[name])) for r in rows if r["side"] == side)
        self.pressure, self.traces = column("pressure", "pressure"), [column("1", "u_n"), column("2", "u_n")]
        self.a = self.record["pair.mid.contact_edge"]
        self.dP = self.record["pair.mid.force"] / self.reference["P"]["value"] - 1
        self.dp0 = self.pressure[0][1] / self.reference["p0"]["value"] - 1

    def pressure_error(self):
        """Of the line through the nodal pressures, in L2, relative"""
        square = lambda f: integral(lambda x: f(x) ** 2, self.pressure, [self.reference["a"]["value"]])
        error = square(lambda x: interpolate(self.pressure, x) - exact_pressure(self.c, x))
        return math.sqrt(error / square(lambda x: exact_pressure(self.c, x)))

    def nodal_error(self, end=0.8):
        return max(abs(p / exact_pressure(self.c, x) - 1) for x, p in self.pressure if x < end + 1e-9)

    def energy_error(self):
        """sqrt(F/F_ref - 1), F the strain and penalty energy: the error in the energy norm, relative, for F is least at the solution. The penalty
        energy is that of the traces, not the lumped one of the record, so that F is never below F_ref."""
        penetration = lambda x: max(0, sum(interpolate(trace, x) for trace in self.traces) - 1e-3 * x * x)
        J = integral(lambda x: penetration(x) ** 2, self.traces[0]) / (2 * self.record["pair.mid.theta"])
        return math.sqrt((self.record["energy.strain"] + J) / sum(self.reference[key]["value"] for key in ("W1", "W2", "Jtheta")) - 1)

    def __str__(self):
        force, p0 = self.record["pair.mid.force"], self.pressure[0][1]
        return (f"P {force:.6f} ({self.dP:+.1e})  p0 {p0:.5f} ({self.dp0:+.1e})  a {self.a:.5f} ({self.a - self.reference['a']['value']:+.1e})"
                f"  |p - p_ref| {self.pressure_error():.2e}  nodal to 0.8 {self.nodal_error():.1e}  sweeps {self.record['sweeps']}")


@functools.lru_cache(None)
def uniform(n):
    return Result(n, n)


def orders(values):
    return [math.log2(a / b) for a, b in zip(values, values[1:])]


def test_pressure_and_force_on_matching_meshes():
    for n, tolerance in (16, 7e-4), (32, 2.5e-4):
        print(f"1/{n}  {uniform(n)}")
        assert abs(uniform(n).record["pair.mid.force"] / 123.078421 - 1) < tolerance
        assert abs(uniform(n).pressure[0][1] / 161.6021 - 1) < 1e-4
        assert abs(uniform(n).a - uniform(n).reference["a"]["value"]) < 0.5 / n  # the edge lies between two nodes
    order = orders([uniform(n).pressure_error() for n in (8, 16, 32)])
    print("order of |p - p_ref|:", *(f"{value:.3f}" for value in order))
    assert all(0.8 < value < 1.3 for value in order)


def test_energy_error_is_of_first_order():
    """Against finite elements of another program on the same meshes, whose penalty law acts at Gauss points"""
    error = [uniform(n).energy_error() for n in (8, 16, 32)]
    for n, value, other in zip((8, 16, 32), error, (0.0510, 0.0258, 0.0130)):
        print(f"1/{n}  sqrt(F/F_ref - 1) {value:.5f}, of the other program {other}")
    off = max(abs(value / other - 1) for value, other in zip(error, (0.0510, 0.0258, 0.0130)))
    case("V04", "sqrt(F/F_ref - 1) off that of another program, 1/8 to 1/32", off, 0.02)
    print("order:", *(f"{value:.3f}" for value in orders(error)))
    assert all(abs(value - 1) < 0.1 for value in orders(error))


def test_other_penalties():
    """The error of the mesh at c = 0.05 and h = 1/16 is 5.7e-4 in P and below 1e-4 in p0; for other c it is no larger, so the same bounds hold.
    That of the edge grows as the contact gets stiff, to half a cell at most. c itself moves P and p0 by 22 %, 0.28 % and 0.028 %."""
    for c in 0.5, 0.005, 0.0005:
        result = Result(16, 16, c=c, loop=NGMRES if c < 0.05 else ANDERSON)
        print(f"c {c}  {result}")
        assert abs(result.dP) < 7e-4 and abs(result.dp0) < 1e-4 and abs(result.a - result.reference["a"]["value"]) < 0.5 / 16


def test_non_matching_quadrilaterals():
    for side in "first", "second":
        result = Result(16, 12, f"-mid_pair_pressure_side {side}")
        print(f"{side}  {result}")
        assert len(result.pressure) == (65 if side == "first" else 49)
        assert abs(result.dP) < 1.2e-3 and result.nodal_error() < 5e-3


def test_quadrilaterals_on_triangles():
    for side in "first", "second":
        result = Result(32, 24, "-lower_mesh_shape triangle", f"-mid_pair_pressure_side {side}")
        print(f"{side}  {result}")
        assert len(result.pressure) == (129 if side == "first" else 97)
        assert abs(result.dP) < 7e-4 and result.nodal_error() < 1e-2
