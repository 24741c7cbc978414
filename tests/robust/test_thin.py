"""Two very thin layers, cells up to 40 times as long as high: a Winkler foundation, whose pressure is the penetration over
1.82 H/E + theta. Lengths in cm, stresses in MPa, the half model, gap 1e-3 x^2, closure 1e-3.

An independent program of order 2 on 320 x 3 cells gave P over Winkler's 1.000055, 0.999992 and 0.9999999 at H = 0.1, 0.01 and 0.001.
"""
from abut import case, run
from test_gamma import said, with_slepc

YOUNG, GAP, COMPLIANCE = 2.1e5, 1e-3, 2 * (1 - 0.3**2)
MEASURED = {0.1: 5.5e-5, 0.01: -8e-6, 0.001: -1e-7}
MESHES = ("quad", 1, "480,4", 5e-4), ("quad", 2, "320,3", 5e-4), ("quad", 2, "320,3", 0), ("quad", 3, "160,2", 0), ("triangle", 2, "320,3", 5e-4)


def layers(H, shape, order, cells, c):
    scene = f"""-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top
        -mid_pair_gap {GAP}*x^2 -mid_pair_penalty {c} -lower_mesh_box 0,0,4,{H} -upper_mesh_box 0,{H},4,{2 * H}
        -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_bc_left_u1 0 -upper_bc_top_u2 {-GAP}"""
    for body in "lower", "upper":
        scene += f""" -{body}_mesh_cells {cells} -{body}_mesh_shape {shape} -{body}_mesh_order {order}
            -{body}_material_young {YOUNG} -{body}_material_poisson 0.3"""
    return scene.split()


def test_thin_layers_are_a_winkler_foundation():
    worst = [0, 0]
    for H, measured in MEASURED.items():
        for shape, order, cells, c in MESHES:
            record = run(None, *layers(H, shape, order, cells, c))
            compliance = (COMPLIANCE + c) * H / YOUNG
            force = record["pair.mid.force"] / (2 / 3 * GAP / compliance) - 1
            middle = record["pair.mid.pressure_max"] / (GAP / compliance) - 1
            edge = record["pair.mid.contact_edge"]
            print(f"H {H}, {shape} {order}, c {c}: P {force:+.1e}, p0 {middle:+.1e}, a {edge}, {record['sweeps']} sweeps")
            worst[order > 1] = max(worst[order > 1], abs(force))
            assert abs(force) < 1e-4 and abs(force - measured) < 3e-5, (H, shape, order, c, force)
            assert abs(middle) < 2e-4 and abs(edge - 1) < 0.3 * H + 0.01, (H, shape, order, c, middle, edge)
            assert record["sweeps"] <= 20 and record["check.balance"] < 1e-8
    case("H14", "force off Winkler's, heights 0.1 to 0.001, order 1", worst[0], 1e-3)
    case("H14", "the same, orders 2 and 3", worst[1], 1e-3)


def relaxed(*options):
    scene = layers(0.1, "quad", 1, "160,4", 0.5)
    return run(None, *scene, "-snes_type ddneumann", "-snes_max_it 2", *options, expect=2)


def test_the_range_of_the_relaxation_of_thin_layers():
    """theta = 0.05/E: converges for certain below 2/(1 + 1.82 H/0.05), on the contact zone that is found below 0.4325"""
    (warning,) = said(relaxed("-snes_ddneumann_gamma 0.45"))
    assert f"not below 2/(1+C/theta) = {2 / (1 + COMPLIANCE * 0.1 / 0.05):.6g}" in warning, warning


def test_the_range_from_the_eigenvalues_of_the_contact_zone():
    _, _, largest = with_slepc(" ".join(layers(0.1, "quad", 1, "160,4", 0.5)))
    print(2 / largest)
    case("H14", "largest relaxation off 0.4325, height 0.1, theta = 0.05/E", abs(2 / largest / 0.4325 - 1), 1e-2)
