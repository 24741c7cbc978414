"""Receding contact: a layer of height 1 on a half-plane, pressed by a line force P; at first it touches everywhere, then nowhere but in
|x| < c. The layer is held by the contact alone, along x by symmetry.

c and p(0) are from a program of its own that solves the integral equation of the layer without end on the half-plane, after L. M. Keer,
J. Dundurs, K. C. Tsai, Problems involving a receding contact between a layer and a half space, J. Appl. Mech. 39 (1972), with Chebyshev's
polynomials. Here the half-plane is a box of 60 heights, and P a pressure over a twentieth of a height on each side.
"""
import functools

from abut import case, run
from uniform import ADAPTED, series, share

DEEP, WIDTH = 60, 0.05
EDGES = {0.9: 3.30458, 0.5: 1.83630, 0: 1.3241654, -0.5: 1.03714, -0.9: 0.88696}  # by (E1' - E2')/(E1' + E2'), of layer and half-plane
MIDDLE = 0.71308  # p(0) h/P of equal materials


def half(alpha, P, order, deep, width, mesh, **keys):
    """The half model: a box of `deep` heights and a layer of that length, P spread over `width` on each side"""
    words = f"""-scene_bodies base,layer -scene_pairs mid -mid_pair_bodies layer,base -mid_pair_sides bottom,top -mid_pair_penalty 0
    -base_mesh_box 0,{-deep},{deep},0 -base_mesh_order {order}
    -base_material_young {2.1e5 * (1 - alpha) / (1 + alpha)!r} -base_material_poisson 0.3 -base_bc_left_u1 0 -base_bc_bottom_u2 0
    -layer_mesh_box 0,0,{deep},1 -layer_mesh_order {order}
    -layer_material_young 2.1e5 -layer_material_poisson 0.3 -layer_bc_left_u1 0 {mesh}"""
    pressure = f"0-{P!r}*15/(16*{width})*(1-(x/{width})^2)^2*(abs(x)<{width})"
    return run(None, *words.split(), "-layer_bc_top_t2", pressure, **keys)


@functools.lru_cache(None)
def press(alpha, P=1.0, order=2):
    """Cells of a fiftieth at the edge of the contact and below the force"""
    near, load = (f"0.15*sqrt((x-{x})^2+(y-{y})^2)" for x, y in ((EDGES[alpha], 0), (0, 1)))
    cells = f"-base_mesh_cells 15,15 -base_mesh_size max(0.02,{near}) -layer_mesh_cells {DEEP},1 -layer_mesh_size max(0.02,min({near},{load}))"
    record = half(alpha, P, order, DEEP, WIDTH, cells)
    assert record["verdict"] == "converged" and abs(record["pair.mid.force"] / (P / 2) - 1) < 1e-5, record
    return record


def test_the_contact_ends_where_the_integral_equation_says():
    error = {alpha: abs(press(alpha)["pair.mid.contact_edge"] / c - 1) for alpha, c in EDGES.items()}
    print(error)
    case("V08", "c/h of equal materials off the integral equation", error[0], 0.01)
    case("V08", "c/h off it, alpha -0.9 to 0.9", max(error.values()), 0.01)


def test_the_pressure_below_the_force_is_that_of_the_integral_equation():
    """The force is spread over a twentieth of a height, so that the pressure is a little lower"""
    record = press(0, order=3)
    middle = record["pair.mid.pressure_max"] / (2 * record["pair.mid.force"])
    case("V08", "p(0) h/P of equal materials off it", abs(middle / MIDDLE - 1), 0.01)


def test_the_contact_is_the_same_under_any_force():
    """To the last digit under 1024 P, whose round-off is the same; that under 1000 P is another, which a layer that floats feels"""
    edge, binary, decimal = (press(0, P)["pair.mid.contact_edge"] for P in (1.0, 1024.0, 1000.0))
    case("V08", "c under 1024 P off that under P", abs(binary / edge - 1), 1e-12)
    assert abs(decimal / edge - 1) < 1e-8, (decimal, edge)


def even(n, order, *options, **keys):
    """Uniform meshes of both boxes, n cells in a height. In a box of 60 heights uniform meshes would lose by the box alone; 8, and P spread over an eighth
    of a height on each side, leave an error of 0.23 per cent"""
    cells = f"-base_mesh_cells {8 * n},{8 * n} -layer_mesh_cells {8 * n},{n}"
    return half(0, 1.0, order, 8, 0.125, " ".join((cells, *options)), **keys)


def test_the_end_of_the_contact_takes_fewer_unknowns_in_adapted_meshes():
    """From several first meshes, for the error goes up and down with the place of the edge between the nodes"""
    off = lambda record: abs(record["pair.mid.contact_edge"] / EDGES[0] - 1)
    for order, first, cells, most in (1, (1, 2, 3), range(1, 17), 13000), (2, (1, 2), range(1, 9), 8000):
        uniform = [even(n, order) for n in cells]
        for estimator in "zz", "residual", "fembem":
            words = f"-adaptor_type doerfler -estimator_type {estimator} -adaptor_max_unknowns {most}", ADAPTED
            adapted = [row for n in first for row in series(even, n, order, *words)]
            part = share(f"layer, order {order}, {estimator}", "c/h", off, 0.01, uniform, adapted)
            case("V08", f"unknowns for c/h to 1 per cent, adapted over uniform, order {order}, {estimator}", part, 0.5)
