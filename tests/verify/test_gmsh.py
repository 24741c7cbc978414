"""Bodies from gmsh files: linear displacements are exact on any mesh, areas of curved bodies converge with order 2, a box is a box."""
import contextlib, math, os, tempfile

from abut import ROOT, case, run, run_error
from msh import box, disc, quarter, ring, shake, write

YOUNG, NU = 1.0, 0.3
LAME, SHEAR = YOUNG * NU / (1 + NU) / (1 - 2 * NU), YOUNG / 2 / (1 + NU)
LINEAR = {"u1": "1e-3*(1+2*x+3*y)", "u2": "1e-3*(2-x+0.5*y)"}  # strains 2e-3, 0.5e-3, shear 3e-3-1e-3
DENSITY = (LAME * 2.5e-3**2 + 2 * SHEAR * (2e-3**2 + 0.5e-3**2 + 0.5 * 2e-3**2)) / 2
STRESS = LAME * 2.5e-3 + 2 * SHEAR * 2e-3, LAME * 2.5e-3 + 2 * SHEAR * 0.5e-3, SHEAR * 2e-3


@contextlib.contextmanager
def file(mesh, **options):
    with tempfile.TemporaryDirectory() as folder:
        yield write(os.path.join(folder, "part.msh"), mesh, **options)


def fixed(path):
    return ["-scene_bodies", "part", "-part_mesh_file", path, "-part_material_young", YOUNG, "-part_material_poisson", NU]


def body(path, sides, conditions, *options, ranks=1, **expect):
    keys = [word for side in sides for key, value in conditions.items() for word in (f"-part_bc_{side}_{key}", value)]
    return run(None, *fixed(path), *keys, *options, ranks=ranks, **expect)


def polygon(n, radius):
    """The area of a regular polygon in a circle"""
    return n / 2 * radius**2 * math.sin(2 * math.pi / n)


MESHES = {
    "quads": shake(quarter(1, 2, 4, 6)),
    "triangles": shake(quarter(1, 2, 4, 6, corners=3)),
}
AREA = polygon(24, 2) / 4 - polygon(24, 1) / 4
SIDES = "bottom", "outer", "left", "inner"
PROBE = ("-scene_probes", "A", "-A_probe_body", "part", "-A_probe_point", "0.9,1.1")


def test_linear_displacements_are_exact():
    worst, sizes = 0, "0.04+0.4*max(abs(x-1),abs(y-0.4))"
    for name, mesh in MESHES.items():
        for orders, ranks in ((1, 1), (1, 2), (1, 3), (1, 4), (2, 1), (3, 3)):
            with file(mesh) as path:
                r = body(path, SIDES, LINEAR, "-part_mesh_size", sizes, f"-part_mesh_order {orders}", *PROBE, ranks=ranks)
            if (orders, ranks) == (1, 1):
                cells = r["body.part.cells"]
            assert r["body.part.cells"] == cells and r["body.part.level_max"] >= 2, (name, ranks, dict(r))
            exact = {"u1": 1e-3 * (1 + 1.8 + 3.3), "u2": 1e-3 * (2 - 0.9 + 0.55), "s11": STRESS[0], "s22": STRESS[1], "s12": STRESS[2]}
            worst = max(worst, abs(r["energy.strain"] / DENSITY / AREA - 1))
            worst = max([worst] + [abs(r[f"probe.A.{key}"] / value - 1) for key, value in exact.items()])
    case("V13", "unstructured meshes with hanging nodes, 1 to 4 ranks: a linear displacement", worst, 1e-9)


def test_every_format_is_read():
    energies = set()
    for version in 2.2, 4.1:
        for binary in False, True:
            with file(MESHES["quads"], version=version, binary=binary) as path:
                energies.add(body(path, SIDES, LINEAR)["energy.strain"])
    for name in sorted(os.listdir(os.path.join(ROOT, "tests", "meshes"))):
        if name.startswith("ring"):
            r = body(f"tests/meshes/{name}", SIDES, LINEAR)
            assert r["body.part.cells"] == 83, dict(r)
            assert abs(r["energy.strain"] / DENSITY / (0.75 * math.pi) - 1) < 0.01  # the polygon of gmsh
    assert len(energies) == 1, energies


def test_a_mesh_is_plane_to_the_digits_of_its_size():
    """As one that a mesher turned into the plane: heights of 1e-12 of its size change nothing, in small and large units; u1 = 1e-3 y is pure shear"""
    for unit in 1e-6, 1, 1e6:
        with file(box((0, 0), (2 * unit, unit), 4, 2), version=2.2) as path:
            with open(path) as f:
                lines = f.read().splitlines()
            first, energies = lines.index("$Nodes") + 2, []
            for height in 0, 1e-12 * unit:
                for k in range(first, first + 15):
                    lines[k] = f"{lines[k].rsplit(' ', 1)[0]} {(-1) ** k * height}"
                with open(path, "w") as f:
                    f.write("\n".join(lines) + "\n")
                energies.append(body(path, ("bottom", "right", "top", "left"), {"u1": "1e-3*y", "u2": 0})["energy.strain"])
        assert energies[0] == energies[1] and abs(energies[0] / (SHEAR * 1e-6 * unit**2) - 1) < 1e-9, (unit, energies)


def area(path, sides, size, *options, **expect):
    """By the energy of a uniform strain; and the number of cells"""
    r = body(path, sides, LINEAR, f"-part_mesh_size {size}", *options, **expect)
    return r["energy.strain"] / DENSITY, r["body.part.cells"]


def test_areas_converge():
    rates, still, ranks = [], [], []
    circles = ("-part_mesh_curve_outer", "circle 0,0,2", "-part_mesh_curve_inner", "x^2+y^2-1")
    for corners in 3, 4:
        parts = (
            (ring(1, 2, 2, 16, corners), ("inner", "outer"), circles, 3 * math.pi, polygon(16, 2) - polygon(16, 1)),
            (disc(1, 2, corners), ("rim",), ("-part_mesh_curve_rim", "circle 0,0,1"), math.pi, polygon(8, 1)),
        )
        for mesh, sides, curve, exact, coarse in parts:
            with file(mesh) as path:
                meshes = [area(path, sides, size, *curve) for size in (0.4, 0.1, 0.05)]
                still.append(abs(area(path, sides, 0.1)[0] / coarse - 1))
                ranks += [abs(area(path, sides, 0.1, *curve, ranks=n)[0] / meshes[1][0] - 1) for n in (2, 3, 4)]
            (first, m), _, (last, n) = meshes
            if corners == 4 or len(sides) == 1:  # of triangles in a ring the errors inside and outside may cancel
                rates.append(2 * math.log(abs((first - exact) / (last - exact))) / math.log(n / m))
    case("V13", "curved bodies: least order of the area of the mesh", -min(rates), -1.9)
    case("V13", "curved bodies without mesh_curve: area of the polygon", max(still), 1e-9)
    case("V13", "curved bodies: area on 2, 3 and 4 ranks", max(ranks), 1e-9)


def test_orders_of_convergence():
    """u1 = sin x cosh y, u2 = -cos x sinh y needs no volume force; without prescribed values but 0 its energy is missed by the square of the error"""
    exact = 2 * SHEAR * moment()
    loads = {"left_u1": 0, "bottom_u2": 0, "right_t1": "cos(x)*cosh(y)", "right_t2": "sin(x)*sinh(y)", "top_t1": "sin(x)*sinh(y)", "top_t2": "0-cos(x)*cosh(y)"}
    keys = [word for key, value in loads.items() for word in (f"-part_bc_{key}", f"{2 * SHEAR}*({value})")]
    for name, mesh in (("quads", shake(box((0, 0), (1, 1), 4, 4))), ("triangles", shake(box((0, 0), (1, 1), 4, 4, corners=3)))):
        for order in 1, 2:
            with file(mesh) as path:
                sizes = (0.3, 0.15, 0.075)
                energies = [body(path, (), {}, *keys, f"-part_mesh_size {size} -part_mesh_order {order}")["energy.strain"] for size in sizes]
            errors = [math.sqrt(1 - e / exact) for e in energies]
            case("V13", f"order {order} on unstructured {name}: order of the energy error", -math.log2(errors[1] / errors[2]), 0.15 - order)


def moment(n=40):
    """Integral of the squares of the strains over the unit square, by Gauss' rule in n parts"""
    g = 0.5 / math.sqrt(3)
    points = [(i + 0.5 + s * g) / n for i in range(n) for s in (-1, 1)]
    both = [(math.cos(x) * math.cosh(y), math.sin(x) * math.sinh(y)) for x in points for y in points]
    return sum(a * a + b * b for a, b in both) / len(both)  # strains a, -a and shear b: (2 a^2 + 2 b^2)/2


def test_a_box_is_a_box():
    scene = """-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 1e-3*x^2
    -mid_pair_penalty 0.05 -mid_pair_height 1 -snes_rtol 1e-11 -scene_loop_share 0 -lower_material_young 2.1e5 -lower_material_poisson 0.3
    -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
    -upper_material_young 2.1e5 -upper_material_poisson 0.3 -upper_bc_left_u1 0 -upper_bc_top_u2 -1.366e-3
    -adaptor_type threshold -adaptor_threshold 0.2 -adaptor_bodies lower -estimator_type zz -adaptor_max_level 4
    -upper_mesh_size 0.05+0.3*abs(x-1)""".split()
    boxes = "-lower_mesh_box 0,0,4,1 -lower_mesh_cells 8,2 -upper_mesh_box 0,1,4,2 -upper_mesh_cells 16,4 -upper_mesh_shape triangle".split()
    meshes = [{**box((0, 0), (4, 1), 8, 2), "surface": "lower"}, {**box((0, 1), (4, 2), 16, 4, corners=3), "surface": "upper"}]
    meshes[1]["lines"] = {f"{name}2": lines for name, lines in meshes[1]["lines"].items()}
    renamed = [word.replace("upper_bc_left", "upper_bc_left2").replace("upper_bc_top", "upper_bc_top2").replace("bottom,top", "bottom2,top") for word in scene]
    ours, worst = run(None, *scene, *boxes), 0
    with file(meshes) as path:
        for ranks in 1, 3:
            files = ["-lower_mesh_file", path, "-lower_mesh_region", "lower", "-upper_mesh_file", path, "-upper_mesh_region", "upper"]
            theirs = run(None, *renamed, *files, ranks=ranks)
            keys = "energy.strain", "pair.mid.force", "pair.mid.pressure_max", "body.lower.cells", "body.upper.cells", "body.upper.level_max", "eta.lower"
            worst = max([worst] + [abs(theirs[key] / ours[key] - 1) for key in keys])
    assert "body.lower.unknowns_uniform" not in theirs
    case("V13", "a contact between two boxes from one file against boxes by keys", worst, 1e-9)


def test_a_curved_body_adapts_and_restarts():
    """Lame's ring under a pressure inside: u_r at the inner side in closed form"""
    inner, outer = 1, 2
    exact = (1 + NU) / YOUNG * inner**2 / (outer**2 - inner**2) * ((1 - 2 * NU) * inner + outer**2 / inner)
    options = "-part_bc_bottom_u2 0 -part_bc_left_u1 0 -part_bc_inner_t1 x/sqrt(x^2+y^2) -part_bc_inner_t2 y/sqrt(x^2+y^2) -adaptor_type doerfler".split()
    options += ["-part_mesh_curve_inner", "circle 0,0,1", "-part_mesh_curve_outer", "x^2+y^2-4", "-scene_probes", "A", "-A_probe_body", "part"]
    options += "-A_probe_point 1,0 -estimator_type zz -adaptor_target 0.02".split()
    for corners in 3, 4:
        with file(quarter(inner, outer, 3, 6, corners=corners)) as path:
            r = body(path, (), {}, *options)
            case("V13", f"a ring of {corners}-cornered cells under pressure, adapted", abs(r["probe.A.u1"] / exact - 1), 2e-3)
            three = body(path, (), {}, *options, ranks=3)
            assert three["body.part.cells"] == r["body.part.cells"] and abs(three["energy.strain"] / r["energy.strain"] - 1) < 1e-9
            saved = os.path.join(os.path.dirname(path), "saved")
            whole = body(path, (), {}, *options, f"-checkpoint {saved}")
            again = body(path, (), {}, *options, f"-restart {saved}")
            assert again["energy.strain"] == whole["energy.strain"] == r["energy.strain"], (again, r)
            write(path, quarter(inner, 1.5 * outer, 3, 6, corners=corners))
            said = run_error(None, *fixed(path), *options[:12], "-restart", saved)
            assert "its mesh" in said, said
