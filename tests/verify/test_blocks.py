"""Two blocks without a gap, pressed evenly: p = closure/(H1/E1' + H2/E2' + theta), stress and strain are the same everywhere, on any
meshes.

Lengths in cm, stresses in MPa, the half model, per cm of depth.
"""
import csv, os, tempfile

from abut import case, run

YOUNG, NU, CLOSURE = 2.1e5, 0.3, 1e-3
MEASURED = (0.5, 90.517241), (0.05, 112.299465), (0.005, 115.068493), (5e-4, 115.352925), (0, 115.384615)  # by c, to 9 digits
MESHES = (
    "-lower_mesh_cells 8,2 -upper_mesh_cells 6,2 -upper_mesh_shape triangle",
    "-lower_mesh_cells 3,2 -upper_mesh_cells 8,3 -lower_mesh_order 2",
)


def press(meshes, c, *options):
    """The record, and the nodal pressures"""
    scene = f"""-scene_bodies lower,upper -scene_pairs mid -scene_probes A,B -mid_pair_bodies upper,lower -mid_pair_sides bottom,top
    -lower_mesh_box 0,0,4,1 -lower_material_young {YOUNG} -lower_material_poisson {NU} -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
    -upper_mesh_box 0,1,4,2 -upper_material_young {YOUNG} -upper_material_poisson {NU} -upper_bc_left_u1 0
    -mid_pair_gap 0 -mid_pair_penalty {c} -A_probe_body lower -A_probe_point 1.1,0.7 -B_probe_body upper -B_probe_point 3.3,1.6"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "profile.csv")
        record = run(None, *scene.split(), *meshes.split(), "-output_profile", path, *options)
        with open(path) as f:
            return record, [float(row["pressure"]) for row in csv.DictReader(f) if row["side"] == "pressure"]


def test_a_closure_gives_the_pressure_of_the_formula():
    pressure, stress, displacement = [], [], []
    for meshes in MESHES:
        for c, rounded in MEASURED:
            exact = CLOSURE / ((2 * (1 - NU**2) + c) / YOUNG)
            assert abs(rounded / exact - 1) < 1e-8
            record, p = press(meshes, c, f"-upper_bc_top_u2 {-CLOSURE} -snes_rtol 1e-11")
            pressure += [abs(value / exact - 1) for value in (*p, record["pair.mid.force"] / 4)]
            for name, x, y, moved in ("A", 1.1, 0.7, 0), ("B", 3.3, 1.6 - 2, -CLOSURE):
                u1, u2 = NU * (1 + NU) / YOUNG * exact * x, moved - (1 - NU**2) / YOUNG * exact * y
                stress += [abs(record[f"probe.{name}.s11"]) / exact, abs(record[f"probe.{name}.s22"] / exact + 1)]
                displacement += [abs(record[f"probe.{name}.u1"] - u1) / CLOSURE, abs(record[f"probe.{name}.u2"] - u2) / CLOSURE]
    case("V01", "nodal pressures and force off the closed form, c 0.5 to 0", max(pressure), 1e-8)
    case("V01", "displacements off the linear ones, over the largest", max(displacement), 1e-10)
    assert max(stress) < 1e-8, stress


def test_a_pressure_on_a_block_that_only_the_other_one_holds_goes_through():
    """Meshes 3 to 4, of triangles and quads, and of order 2; exact contact and next to none of a penalty"""
    pressure, displacement = [], []
    for meshes in ("-lower_mesh_cells 3,2 -upper_mesh_cells 4,2", *MESHES):
        for c in 0, 1e-6:
            record, p = press(meshes, c, "-upper_bc_top_t2 -1 -snes_rtol 1e-12")
            pressure += [abs(value - 1) for value in p]
            for name, y in ("A", 0.7), ("B", 1.6 + c / (1 - NU**2)):  # the top moves by that of y = 2
                displacement.append(abs(record[f"probe.{name}.u2"] / ((1 - NU**2) / YOUNG) + y) / 2)
    case("V02", "pressures off 1 under a block that floats", max(pressure), 1e-9)
    assert max(displacement) <= 1e-10, displacement
