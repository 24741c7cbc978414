"""Every way in which a loop can fail has its name, exit status 2, and leaves its best answer. Two layers, h = 1/n; see test_gamma.py."""
import csv, math, os, tempfile

from abut import case, run
from test_gamma import NPC, exact_force, layers, near


def fails(verdict, scene, *options, ranks=1):
    """Exit status 2; the name on both channels; nothing on standard error; finite numbers in the record and in the profile"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "profile.csv")
        record = run(None, scene, *options, f"-output_profile {path}", ranks=ranks, expect=2)
        with open(path) as f:
            profile = [row[name] for row in csv.DictReader(f) for name in ("u_n", "pressure") if row[name]]
    print(*options, record["verdict"], record["sweeps"])
    assert str(record.pop("verdict")) == verdict, options  # nan reads as a number
    assert record.stdout.splitlines()[-1].startswith(f"verdict: {verdict}"), record.stdout
    assert ranks > 1 or not record.stderr, record.stderr
    assert all(isinstance(value, str) and value not in ("nan", "inf") or math.isfinite(value) for value in record.values()), dict(record)
    assert profile and all(math.isfinite(float(value)) for value in profile)
    return record


def test_oscillation():
    record = fails("oscillation", layers(8), "-snes_type ddneumann", "-snes_ddneumann_gamma 0.06")
    assert record["sweeps"] <= 200 and near(record["pair.mid.force"], exact_force(layers(8)), 0.2)
    fails("oscillation", layers(8), "-snes_type ddneumann", "-snes_ddneumann_gamma 0.06", ranks=2)


INEXACT = "-lower_pc_type hypre -upper_pc_type hypre -lower_ksp_rtol {0} -upper_ksp_rtol {0}"
LOOPS = "-snes_type ddactive", "-snes_type ddneumann", "-snes_type anderson", f"-snes_type anderson {NPC}", f"-snes_type ngmres {NPC}"


def test_stagnation_where_bodies_are_solved_to_1e_3_and_the_loop_is_to_reach_1e_8():
    """A body's solver starts from its last displacement and is content with it: traces stand still, the residual alone sees convergence"""
    scene = layers(8)
    exact = exact_force(scene)
    for loop in LOOPS:
        record = fails("stagnation", scene, loop, INEXACT.format(1e-3))
        assert near(record["pair.mid.force"], exact, 0.05), (loop, record["pair.mid.force"])


def test_stagnation_where_bodies_are_solved_to_1e_5_and_mixing_keeps_the_noise():
    fails("stagnation", layers(8), f"-snes_type qn {NPC}", INEXACT.format(1e-5))


def test_no_stagnation_where_bodies_are_solved_to_1e_10():
    scene = layers(8)
    exact = exact_force(scene)
    for loop in LOOPS:
        record = run(None, scene, loop, INEXACT.format(1e-10))
        assert record["verdict"] == "converged" and near(record["pair.mid.force"], exact, 1e-6), loop


def test_no_stagnation_where_a_body_only_moves():
    """Its energy is zero, and the errors of its solver are not"""
    for loop in LOOPS:
        record = run(None, layers(4, closure="1e-3"), loop, INEXACT.format(1e-10))
        assert record["verdict"] == "converged" and record["pair.mid.force"] == 0, loop


def test_divergence():
    fails("diverged", layers(8), "-snes_type ddneumann", "-snes_ddneumann_gamma 3")
    record = fails("diverged", layers(8), "-snes_type ddneumann", "-snes_ddneumann_gamma 0.5 -snes_divergence_tolerance 2")
    assert record["sweeps"] < 20


def test_nan():
    fails("nan", layers(8), "-snes_type ddneumann", "-snes_ddneumann_gamma 1e200")


def test_max_iterations():
    for loop, sweeps in zip(LOOPS, (3, 4, 4, 4, None)):
        record = fails("max_iterations", layers(8, 0.005), loop, "-snes_max_it 3 -snes_rtol 1e-14")
        assert sweeps is None or abs(record["sweeps"] - sweeps) <= 1, (loop, record["sweeps"])


def test_a_linear_solver_that_may_take_1_iteration_in_one_body():
    ways = [(body, loop, 1) for body in ("lower", "upper") for loop in LOOPS] + [("lower", LOOPS[1], 2)]
    other = 0
    for body, loop, ranks in ways:
        try:
            fails("linear_solver", layers(4), loop, f"-{body}_pc_type jacobi -{body}_ksp_type cg -{body}_ksp_max_it 1", ranks=ranks)
        except AssertionError as error:
            other += 1
            print(error)
    case("H28", f"of {len(ways)} runs with ksp_max_it 1 those without linear_solver as verdict", other, 0)


def test_an_answer_that_does_not_agree_with_itself_is_named_with_the_check():
    """Linear problems solved to 1e-3 only, which is enough for a loop that may stop at 1e-2: the reactions do not balance the forces"""
    inexact = "-snes_rtol 1e-2 -lower_pc_type hypre -lower_ksp_type cg -lower_ksp_rtol 1e-3"
    record = fails("inconsistent", layers(8), "-snes_type ddactive", inexact)
    assert record["check.balance"] > 1e-6 > record["check.contact"], record
    assert record.stdout.splitlines()[-1] == f"verdict: inconsistent (check.balance is {record['check.balance']:.2g}, and may be 1e-06)", record.stdout


def test_every_run_has_every_check():
    names = ["balance", "energy", "contact", "tension", "complementarity", "penetration"]
    record = run(None, layers(8), "-snes_type ddactive")
    assert all(0 <= record[f"check.{name}"] <= 1e-6 for name in names) and record["residual.linear"] <= 1e-6, record
    alone = run(None, "-scene_bodies one -one_mesh_box 0,0,1,1 -one_mesh_cells 2,2 -one_material_young 1 -one_material_poisson 0.3 "
                "-one_bc_bottom_u1 0 -one_bc_bottom_u2 0 -one_bc_top_t2 -1")
    assert [key for key in alone if key.startswith("check.")] == ["check.balance", "check.energy"], alone
