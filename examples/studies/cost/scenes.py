"""The scenes of the study of cost, and what is known of them.

layers  two layers, 4 long and 1 high, pressed together by 1.366 times the gap at x = 1: examples/layers, with quads in both
hertz   two boxes cut out of half-planes under Hertz' pressure, a = 0.47, p0 = 1000, whose displacements are prescribed where they were cut
punch   a stiff punch with sharp corners on an elastic base: examples/punch

All are half models. A scene has `options(case, folder, factor)`, without adaptor and estimator; folder is for its files, factor makes all
cells of the first mesh smaller. `reference(c)` is what the errors of a run with this penalty are taken against.
"""
import cmath, functools, json, math, os, sys

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
sys.path[:0] = [os.path.join(os.path.dirname(STUDIES), "layers"), STUDIES]
import layers  # noqa: E402
from study import chebyshev, pressure_error  # noqa: E402

PENALTIES = (0.5, 0.05, 0.005, 0.0)
YOUNG, POISSON, A, P0 = 2.1e5, 0.3, 0.47, 1000.0  # of hertz
CURVE = 2 * (1 - POISSON**2) * P0 / (YOUNG * A)  # of its gap, curve * x^2
POINTS = 1000  # on a side of hertz, linear between: 5e-7 of the displacements


def body(name, box, cells, factor, order, young):
    cells = ",".join(str(factor * n) for n in cells)
    text = f"-{name}_mesh_box {box} -{name}_mesh_cells {cells} -{name}_mesh_order {order} -{name}_bc_left_u1 0"
    return text + f" -{name}_material_young {young!r} -{name}_material_poisson {POISSON}"


def pair(first, second, sides, gap, c):
    text = f"-scene_bodies {second},{first} -scene_pairs mid -mid_pair_bodies {first},{second} -mid_pair_sides {sides}"
    return f"{text} -mid_pair_gap {gap} -mid_pair_penalty {c!r}"


def stored(name):
    """A case of reference.json, whose profile is polynomials of order 4"""
    with open(os.path.join(HERE, "reference.json")) as f:
        return json.load(f)["cases"][name]


def piecewise(x, p, order=4):
    """The function with these nodal values, zero beyond the last"""
    import numpy as np

    x, p, vertices = np.array(x), np.array(p), np.array(x[::order])

    def pressure(at):
        first = order * np.clip(np.searchsorted(vertices, at, "right") - 1, 0, len(vertices) - 2)
        total = np.zeros_like(at)
        for i in range(order + 1):
            others = [j for j in range(order + 1) if j != i]
            total += p[first + i] * np.prod([(at - x[first + j]) / (x[first + i] - x[first + j]) for j in others], axis=0)
        return np.where(at <= x[-1], total, 0)

    return pressure


class Layers:
    bodies, end = ("lower", "upper"), math.inf

    def options(self, case, _, factor=1):
        text = pair("upper", "lower", "bottom,top", "1e-3*x^2", case.c)
        for name, box in ("lower", "0,0,4,1"), ("upper", "0,1,4,2"):
            text += " " + body(name, box, (8, 2), factor, case.order, YOUNG)
        return text + " -lower_bc_bottom_u2 0 -upper_bc_top_u2 -1.366e-3"

    @functools.lru_cache(None)
    def reference(self, c):
        one = layers.reference(c)
        found = {key: one[key]["value"] for key in ("P", "p0", "a")}
        found["energy"] = sum(one[key]["value"] for key in ("W1", "W2", "Jtheta"))
        if c:
            found["pressure"] = piecewise(*(stored(f"layers, c = {c:g}")[key] for key in "xp"))
        else:
            with open(os.path.join(STUDIES, "accuracy", "reference.json")) as f:
                cases = json.load(f)["cases"]
            found["pressure"] = chebyshev(next(case for case in cases if (case["materials"], case["closure"]) == ("equal", 1.366)))
        return found


class Punch:
    """The largest pressure is at the corner and without bound: p0 is the nodal one at x = 0, and the norm in L2 that of x < 0.9"""

    bodies, end = ("base", "punch"), 0.9

    def options(self, case, _, factor=1):
        text = pair("punch", "base", "bottom,top", "0", case.c)
        text += " " + body("base", "0,-4,4,0", (4, 4), factor, case.order, 2.1e2)
        text += " " + body("punch", "0,0,1,1", (1, 1), factor, case.order, 2.1e6)
        return text + " -base_bc_bottom_u2 0 -punch_bc_top_u2 -1e-3"

    @functools.lru_cache(None)
    def reference(self, c):
        found = stored("punch")
        return dict(found, pressure=piecewise(found["x"], found["p"]), a=1.0)


class Hertz:
    bodies, end = ("lower", "upper"), math.inf

    def options(self, case, folder, factor=1):
        text = pair("lower", "upper", "top,bottom", f"{CURVE!r}*x^2", case.c)
        for name, box, far in ("lower", "0,-2,2,0", "bottom"), ("upper", "0,0,2,2", "top"):
            text += " " + body(name, box, (4, 4), factor, case.order, YOUNG)
            for side in ("right", far):
                for component in (1, 2):
                    text += f" -{name}_bc_{side}_u{component} {boundary(folder, name, side, component)}"
        return text

    @functools.lru_cache(None)
    def reference(self, c):
        return {
            "P": math.pi / 4 * A * P0,
            "p0": P0,
            "a": A,
            "energy": 2 * hertz_energy(A),
            "pressure": lambda at: P0 * (1 - (at / A) ** 2).clip(0) ** 0.5,
        }


def hertz(x, y, a=A):
    """Displacements and stresses of the half-plane y <= 0 at x >= 0, by Westergaard's function"""
    z, mu = complex(x, min(y, -1e-290)), YOUNG / (2 * (1 + POISSON))
    root = cmath.sqrt(a * a - z * z)
    Z, dZ = -P0 / a * (root - 1j * z), P0 / a * (z / root + 1j)
    Zi = -P0 / a * (0.5 * z * root + 0.5 * a * a * cmath.asin(z / a) - 0.5j * z * z)
    u = (((1 - 2 * POISSON) * Zi.real - y * Z.imag) / (2 * mu), (2 * (1 - POISSON) * Zi.imag - y * Z.real) / (2 * mu))
    return u, (Z.real - y * dZ.imag, Z.real + y * dZ.imag, -y * dZ.real)


@functools.lru_cache(None)
def hertz_energy(a):
    """The strain energy of one box, half the work of the tractions on its boundary"""
    import numpy as np

    points, weights = np.polynomial.legendre.leggauss(40)
    work = 0.0
    for angle, w in zip((points + 1) * math.pi / 4, weights * math.pi / 4):  # below the pressure p0 cos(angle)
        work -= w * a * math.cos(angle) ** 2 * P0 * hertz(a * math.sin(angle), 0, a)[0][1]
    for s, w in zip(points + 1, weights):
        u, t = hertz(2, -s, a)
        work += w * (t[0] * u[0] + t[2] * u[1])
        u, t = hertz(s, -2, a)
        work -= w * (t[2] * u[0] + t[1] * u[1])
    return 0.5 * work


def boundary(folder, name, side, component):
    """A file of points of a side with a displacement; the upper box is the mirror image of the lower one"""
    path = os.path.join(folder, f"{name}_{side}_u{component}.csv")
    if not os.path.exists(path):
        up = 1 if name == "upper" else -1
        with open(path, "w") as f:
            f.write("x,y,value\n")
            for s in (2 * i / POINTS for i in range(POINTS + 1)):
                x, depth = (2.0, s) if side == "right" else (s, 2.0)
                value = hertz(x, -depth)[0][component - 1]
                f.write(f"{x!r},{up * depth!r},{-value if up > 0 and component == 2 else value!r}\n")
    return path


SCENES = {"layers": Layers(), "hertz": Hertz(), "punch": Punch()}


def errors(case, run, nodes, pressures):
    """Relative errors of a record and the nodal pressures of its mesh; of the energy it is the root, which for given displacements is the
    error in the energy norm"""
    scene = SCENES[case.scene]
    one, exact, bounded = scene.reference(case.c), scene.reference(0.0), scene.end == math.inf
    values = {"P": run["pair.mid.force"], "p0": run["pair.mid.pressure_max"] if bounded else pressures[0], "a": run["pair.mid.contact_edge"]}
    energy = run["energy.strain"] + run["energy.penalty"]
    off = {f"err_{key}": abs(value / one[key] - 1) for key, value in values.items()}
    off["err_energy"] = abs(energy / one["energy"] - 1) ** 0.5
    off["err_p_L2"] = pressure_error(nodes, pressures, case.order, one["pressure"], one["a"], scene.end)
    off["total_P"], off["total_p0"] = (abs(values[key] / exact[key] - 1) for key in ("P", "p0"))
    off["penalty_P"], off["penalty_p0"] = (abs(one[key] / exact[key] - 1) for key in ("P", "p0"))
    return {**values, "energy": energy}, off
