"""The layers of examples/layers, next to incompressible.

Frictionless layers on smooth bases: the force depends on Poisson's ratio by E/(1 - nu^2) alone, so P (1 - nu^2) stays the same if
theta scales as the compliances do, and so does exact contact. P at nu = 0.3, theta = 0.05 H/E, is from a semi-analytic program.
"""
from abut import case, run
from test_hard import layers, relative

NU, FORCE = 0.3, 123.07842
RATIOS = 0.499, 0.4999, 0.49999
MEAN = "Poisson's ratio %g is above 0.49: quads of order 1 take the mean dilatation of each cell"


def solve(nu, n, order, shape, *options, c=0.05, mesh=()):
    scale = (1 - nu**2) / (1 - NU**2)
    words = layers(n, c * scale).split()
    for body in "lower", "upper":
        words[words.index(f"-{body}_material_poisson") + 1] = repr(nu)
        words += f"-{body}_mesh_order {order} -{body}_mesh_shape {shape}".split()
    record = run(None, *words, *options)
    record["error"] = relative(record["pair.mid.force"] * scale, FORCE)
    print(f"nu {nu}, {shape} of order {order}, h = 1/{n}: P wrong by {record['error']:.2e}, {record['sweeps']} sweeps")
    return record


def errors(n, order, shape):
    return [solve(nu, n, order, shape)["error"] for nu in RATIOS]


def test_quads_of_order_1_take_the_mean_dilatation_and_do_not_lock():
    """Without it P is 4 %, 30 % and 143 % too large; with it the error is the same for all"""
    error = errors(16, 1, "quad")
    case("H01", "force off, quads of order 1 of mean dilatation, 1/16, nu to 0.49999", max(error), 1e-3)
    case("H01", "its error at one nu over that at another, nu 0.499 to 0.49999", max(error) / min(error), 1.5)


def test_triangles_of_order_2_do_not_lock():
    error = errors(16, 2, "triangle")
    case("H01", "force off, triangles of order 2, 1/16, nu to 0.49999", max(error), 1e-3)
    case("H01", "its error at one nu over that at another, triangles of order 2", max(error) / min(error), 1.5)


def test_quads_of_order_2_hardly_lock():
    """They take the dilatation as it is: what the last digits of nu cost vanishes with the cells"""
    coarse, fine = errors(8, 2, "quad"), errors(16, 2, "quad")
    case("H01", "force off, quads of order 2, 1/16, nu to 0.49999", max(fine), 1e-3)
    assert max(fine) < 0.5 * max(coarse), (coarse, fine)


def test_quads_of_higher_orders_do_not_lock():
    for order in 3, 4:
        assert max(errors(8, order, "quad")) < 1e-4


def test_hanging_nodes_do_not_bring_locking_back():
    graded = "-lower_mesh_size 0.25*(abs(x-1)+abs(y-1))+0.06 -upper_mesh_size 0.25*(abs(x-1)+abs(y-1))+0.06".split()
    for order in 1, 2:
        assert max(solve(nu, 8, order, "quad", *graded)["error"] for nu in RATIOS) < 1e-3


def test_the_mean_dilatation_is_announced():
    for nu, name in (0.48, "full"), (0.4999, "mean_dilatation"):
        record = solve(nu, 4, 1, "quad", "-scene_view")
        for body in "lower", "upper":
            assert record[f"body.{body}.integration"] == name
            assert record.stdout.count(f"{body}: {MEAN % nu}") == (2 if name != "full" else 0), record.stdout  # in the view and at the start
    record = solve(0.4999, 4, 2, "quad")
    assert record["body.lower.integration"] == "full" and "mean dilatation" not in record.stdout


def test_triangles_of_order_1_are_warned_of():
    """Without a cure: P is 35 % too large, and the line names one"""
    record = solve(0.4999, 16, 1, "triangle")
    assert record["error"] > 0.1
    case("H01", "bodies of triangles of order 1 that lock without a warning", 2 - record.stdout.count("triangles of order 1 lock"), 0)
    for body in "lower", "upper":
        line = f"warning: {body}: triangles of order 1 lock at Poisson's ratio 0.4999: take -{body}_mesh_order 2 or -{body}_mesh_shape quad"
        assert line in record.stdout.splitlines(), record.stdout
        assert record[f"body.{body}.integration"] == "full"
    assert "warning" not in solve(0.4999, 4, 2, "triangle").stdout


def test_the_solver_by_default_takes_no_more_iterations():
    for order in 1, 2:
        near, far = (solve(nu, 8, order, "quad") for nu in (0.49999, 0.3))
        for body in "lower", "upper":
            ratio = near[f"body.{body}.ksp_its"] / near["sweeps"] / (far[f"body.{body}.ksp_its"] / far["sweeps"])
            case("H01", "linear iterations of a sweep at nu = 0.49999 over those at 0.3", ratio, 5)


def test_direct_and_iterative_solvers_agree():
    """CG with BoomerAMG takes 20 times the iterations of nu = 0.3 at 0.499 and 50 times at 0.49999: the direct solver is the default"""
    block = """-scene_bodies block -block_mesh_box 0,0,4,1 -block_mesh_cells 64,16 -block_material_young 1 -block_bc_left_u1 0 -block_bc_bottom_u2 0 -block_bc_top_t2 0-x
        -scene_probes A -A_probe_body block -A_probe_point 4,1""".split()
    for order in 1, 2:
        value = [
            run(None, *block, "-block_material_poisson 0.4999", f"-block_mesh_order {order}", *solver)["probe.A.u1"]
            for solver in ([], ["-block_ksp_type cg", "-block_pc_type hypre", "-block_ksp_rtol 1e-10"])
        ]
        assert relative(*value) < 1e-6, value
