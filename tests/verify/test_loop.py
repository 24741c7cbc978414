"""The loop on the paper's two layers and on two blocks: when it converges, in how many sweeps, and what it says when it does not.

Both bodies are bilinear with sides 1/n, the meshes match. Sweeps of the literal stop test, the largest relaxation and the sweeps of
accelerators are measured by an independent program on exact interface compliances; the pressure of the blocks is a formula.
"""
import glob, math, os, tempfile

from abut import LAYERS, case, run
from test_output import read_vtu

YOUNG, NU, GAP, CLOSURE = 2.1e5, 0.3, 1e-3, 1.366e-3


def layers(n=16, c=0.05, length=1.0, stress=1.0, closure=CLOSURE, gap=None, first="upper", shape="quad"):
    """The scene in units in which a centimetre is `length` and a megapascal `stress`"""
    gap = f"{GAP / length!r}*x^2" if gap is None else f"{gap * length!r}"
    pair = "upper,lower -mid_pair_sides bottom,top" if first == "upper" else "lower,upper -mid_pair_sides top,bottom"
    box = lambda y0, y1: f"0,{y0 * length!r},{4 * length!r},{y1 * length!r}"
    return f"""-scene_bodies lower,upper -scene_pairs mid -scene_probes A -mid_pair_bodies {pair} -mid_pair_gap {gap} -mid_pair_penalty {c}
    -lower_mesh_box {box(0, 1)} -lower_mesh_cells {4 * n},{n} -lower_material_young {YOUNG * stress!r} -lower_material_poisson {NU}
    -upper_mesh_box {box(1, 2)} -upper_mesh_cells {4 * n},{n} -upper_material_young {YOUNG * stress!r} -upper_material_poisson {NU}
    -upper_mesh_shape {shape} -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_bc_left_u1 0 -upper_bc_top_u2 {-closure * length!r}
    -A_probe_body lower -A_probe_point {0.5 * length!r},{0.75 * length!r}"""


def near(value, exact, tolerance):
    return abs(value - exact) <= tolerance * abs(exact)


def check_finite(record):
    assert record, "no record"
    for key, value in record.items():
        assert isinstance(value, str) and value not in ("nan", "inf") or math.isfinite(value), (key, value)


def check_failed(record, verdict):
    """Exit status 2, a named reason on both channels, no NaN, and nothing on standard error"""
    assert record.status == 2 and record["verdict"] == verdict, (record.status, record.get("verdict"))
    assert record.stdout.splitlines()[-1] == f"verdict: {verdict}" and not record.stderr
    check_finite(record)


def check_no_contact(record, sweeps=None):
    assert record["verdict"] == "converged" and "pair mid: no contact" in record.stdout.splitlines()
    for key in ("force", "pressure_max", "contact_length", "contact_edge", "penetration_max", "active"):
        assert record[f"pair.mid.{key}"] == 0, (key, record[f"pair.mid.{key}"])
    assert sweeps is None or record["sweeps"] == sweeps, record["sweeps"]
    check_finite(record)


# --- the relaxation, and its limit ---------------------------------------------------------------------------------------------


def test_relaxations_below_the_limit_reach_one_answer():
    force = [run(None, layers(), f"-snes_type ddneumann -snes_ddneumann_gamma {gamma}", "-snes_rtol 1e-9")["pair.mid.force"] for gamma in (0.02, 0.05, 0.056)]
    assert all(near(one, force[0], 1e-6) for one in force), force


def test_relaxations_beyond_the_limit_end_as_an_oscillation():
    starts = {0.06: ("winkler", "nocontact", "zero"), 0.1: ("winkler", "zero"), 0.5: ("winkler",), 1: ("zero",)}
    for gamma, start in ((gamma, start) for gamma in starts for start in starts[gamma]):
        record = run(None, layers(), f"-snes_type ddneumann -snes_ddneumann_gamma {gamma} -snes_ddneumann_start {start}", expect=2)
        check_failed(record, "oscillation")
        assert record["sweeps"] <= 200, (gamma, start, record["sweeps"])


def test_at_the_limit_no_answer_is_a_wrong_one():
    exact = run(None, layers())["pair.mid.force"]
    record = run(None, layers(), "-snes_type ddneumann -snes_ddneumann_gamma 0.057", expect=None)
    if record["verdict"] == "converged":
        assert record.status == 0 and near(record["pair.mid.force"], exact, 1e-6)
    else:
        check_failed(record, "oscillation")


def test_a_failed_loop_leaves_its_best_trace():
    exact = run(None, layers())["pair.mid.force"]
    record = run(None, layers(), "-snes_type ddneumann -snes_ddneumann_gamma 0.1 -snes_ddneumann_start zero", expect=2)
    assert near(record["pair.mid.force"], exact, 0.5), record["pair.mid.force"]  # the last trace may have no contact, or thrice the force


def test_the_automatic_relaxation_is_close_to_the_best():
    """mesh-independent sweeps: the best relaxation 0.0553 takes as many within a third"""
    best, automatic = (run(None, layers(), f"-snes_type ddneumann -snes_ddneumann_gamma {gamma}")["sweeps"] for gamma in (0.0553, 0))
    assert automatic <= 1.34 * best, (automatic, best)


# --- the stop tests ------------------------------------------------------------------------------------------------------------


def test_the_stop_test_of_the_paper():
    for n in (16, 32):
        for start, sweeps, tolerance in (("winkler", 3, 0), ("nocontact", 7, 0), ("zero", 146, 2)):
            record = run(None, layers(n), f"-snes_type ddneumann -snes_ddneumann_gamma 0.02 -snes_ddneumann_stop paper -snes_ddneumann_start {start}")
            assert record["verdict"] == "converged" and abs(record["sweeps"] - sweeps) <= tolerance, (n, start, record["sweeps"])
            assert record["error.loop"] > 3 * 0.0015, "it stops far from the answer, and the record must say so"


def test_the_stop_test_on_the_residual_is_an_error_test():
    exact = run(None, layers(), "-snes_rtol 1e-10")["pair.mid.force"]
    for gamma in (0.005, 0.02, 0.05):
        record = run(None, layers(), f"-snes_type ddneumann -snes_ddneumann_gamma {gamma} -snes_rtol 0.0015")
        assert near(record["pair.mid.force"], exact, 5 * 0.0015) and record["error.loop"] <= 0.0015, (gamma, record["pair.mid.force"])


def test_a_body_that_does_not_move_has_not_converged_by_the_test_of_the_paper():
    """0/0: the lower body's trace is zero for ever"""
    for start in ("winkler", "zero"):
        options = f"-snes_type ddneumann -snes_ddneumann_stop paper -snes_ddneumann_start {start} -snes_max_it 300"
        check_failed(run(None, layers(4, gap=1), options, expect=2), "max_iterations")


def test_too_few_iterations():
    record = run(None, layers(8), "-snes_type ddneumann -snes_max_it 5", expect=2)
    check_failed(record, "max_iterations")
    assert record["sweeps"] == 6 and record["error.loop"] > 1e-8
    check_failed(run(None, layers(8), "-snes_type ddneumann -snes_max_it 0", expect=2), "max_iterations")


def test_a_linear_solver_that_fails():
    for body in ("lower", "upper"):
        solver = f"-{body}_pc_type jacobi -{body}_ksp_type cg -{body}_ksp_max_it 1"
        for loop in ("", "-snes_type ddneumann", "-snes_type anderson", "-snes_type anderson -npc_snes_type ddneumann -npc_snes_max_it 1"):
            check_failed(run(None, layers(4), solver, *loop.split(), expect=2), "linear_solver")


# --- accelerators --------------------------------------------------------------------------------------------------------------

NPC = "-npc_snes_type ddneumann -npc_snes_max_it 1"


def test_accelerators_reach_the_same_answer_in_fewer_sweeps():
    anderson = "-snes_type anderson -snes_anderson_m 20"
    limits = ((40, anderson), (40, f"{anderson} {NPC}"), (100, f"-snes_type ngmres {NPC}"), (250, f"-snes_type qn {NPC}"))
    for n in (16, 32):
        plain = run(None, layers(n), "-snes_type ddneumann")
        assert plain["sweeps"] > 250
        for most, options in limits:
            record = run(None, layers(n), options)
            assert record["sweeps"] <= most and record["error.loop"] <= 1e-8, (n, options, record["sweeps"], record["error.loop"])
            assert near(record["pair.mid.force"], plain["pair.mid.force"], 1e-7), (n, options)
            assert record["pair.mid.active"] == plain["pair.mid.active"]


# --- no contact, and contact everywhere ----------------------------------------------------------------------------------------


def test_bodies_pulled_apart_do_not_touch():
    for n, shape in ((4, "quad"), (8, "triangle")):
        for start in ("winkler", "nocontact"):
            check_no_contact(run(None, layers(n, closure=-1e-3, shape=shape), f"-snes_type ddneumann -snes_ddneumann_start {start}"), sweeps=1)
    check_no_contact(run(None, layers(4, closure=-1e-3), "-snes_type ddneumann -snes_ddneumann_start zero"))


def test_a_wide_gap_stays_open():
    for loop in ("-snes_type ddneumann", "-snes_type anderson", f"-snes_type ngmres {NPC}", f"-snes_type qn {NPC}"):
        record = run(None, layers(4, gap=1), *loop.split(" "))
        check_no_contact(record)
        assert near(record["probe.A.u2"] + 1, 1, 1e-12) and abs(record["probe.A.vm"]) < 1e-9 * YOUNG * CLOSURE


def test_iterative_solvers_see_no_contact_either():
    hypre = "-lower_pc_type hypre -upper_pc_type hypre"
    check_no_contact(run(None, layers(4, closure=-1e-3), hypre), sweeps=1)


def test_closing_by_nothing_leaves_no_force():
    """The parabola touches at a point. Its average against the dual function of that node is below zero, so the node presses: by a force that
    vanishes faster than h^2, and nothing else."""
    force = [run(None, layers(n, closure=0))["pair.mid.force"] for n in (4, 8, 16)]
    assert force[0] < 3e-3 * 123 and force[0] > 4 * force[1] > 16 * force[2], force


def test_touching_without_force():
    for start in ("winkler", "nocontact", "zero"):
        check_no_contact(run(None, layers(4, closure=0, gap=0), f"-snes_type ddneumann -snes_ddneumann_start {start}"), sweeps=1)


def test_no_gap_anywhere():
    """Two blocks: p = closure / (theta + C), all nodes in contact from every start"""
    for c, start in ((0.5, "zero"), (0.05, "winkler"), (0.05, "nocontact"), (0.05, "zero"), (0.005, "winkler"), (0.005, "nocontact")):
        exact = 1e-3 / (c / YOUNG + 2 * (1 - NU**2) / YOUNG)
        # pressures magnify the round-off of the traces by C/theta, 364 at c = 0.005: 1e-8 is then within reach of some builds of MUMPS only
        rtol = 1e-7 if c < 0.05 else 1e-8
        record = run(None, layers(4, c, closure=1e-3, gap=0), f"-snes_type ddneumann -snes_ddneumann_start {start} -snes_rtol {rtol}")
        assert near(record["pair.mid.pressure_max"], exact, 10 * rtol) and near(record["pair.mid.force"], 4 * exact, 10 * rtol), (c, start)
        assert record["pair.mid.active"] == 17 and near(record["pair.mid.contact_length"], 4, 1e-9)
        check_finite(record)


# --- units and roles -----------------------------------------------------------------------------------------------------------

UNITS = {"m, Pa": (1e-2, 1e6), "nm, Pa": (1e7, 1e6), "km, kPa": (1e-5, 1e3)}
ROUNDOFF = ("time.", "memory.", "check.", "error.linear", "residual.linear")  # and balance, complementarity: of the size of round-off
DIGIT = 1.5e-9  # the record has ten digits: one unit in the last one


def unit(key, length, stress):
    """What a key of the record is measured in"""
    last = key.rsplit(".", 1)[1] if "." in key else ""
    if last in ("force", "force_penalty"):
        return length * stress
    if last in ("pressure_max", "vm") or last[:1] == "s" and last[1:].isdigit():
        return stress
    if last in ("contact_length", "contact_edge", "penetration_max", "hmin", "h_fe", "h_be", "u1", "u2"):
        return length
    if last == "theta":
        return length / stress
    if key.startswith("energy."):
        return length * length * stress
    return 1


def check_units(small, *options):
    first = run(None, layers(**small), *options)
    for name, (length, stress) in UNITS.items():
        record = run(None, layers(**small, length=length, stress=stress), *options)
        assert record.keys() == first.keys()
        for key, value in first.items():
            if key.startswith(ROUNDOFF) or key.endswith((".balance", ".complementarity")):
                continue
            if isinstance(value, float):
                scaled = record[key] / unit(key, length, stress)
                scale = max(abs(value), YOUNG * CLOSURE * 1e-9 if key.endswith(("s12", "s11")) else 0)
                digit = 1e-7 if key == "error.penalty" or key.endswith(".force_penalty") else DIGIT  # of a model's answer
                same = abs(scaled - value) <= digit * scale
                if key in ("error.loop", "residual.loop"):  # a difference of almost equal traces
                    same = near(scaled, value, 1e-4) or max(scaled, value) < 1e-10
                assert same, (name, key, value, scaled)
            else:
                assert record[key] == value, (name, key, value, record[key])


def fields(*options, **small):
    """The record, and of every body and mesh the field, which has 17 digits"""
    with tempfile.TemporaryDirectory() as folder:
        record = run(None, layers(**small), *options, f"-output {folder}/run.vtu")
        return record, [read_vtu(path) for path in sorted(glob.glob(os.path.join(folder, "*.vtu")))]


def test_fields_are_the_same_in_all_units():
    """Coordinates, displacements and stresses on a fixed mesh, on adapted ones, and on those of order 2, over the largest of their kind.
    Loops that stop early leave what their model of the bodies says, which is not as exact; here they go on to the end on all meshes."""
    off, sweeps, cells = 0, 0, 0
    adapt = "-lower_mesh_cells 8,2 -adaptor_bodies lower,upper -scene_loop_share 0 -adaptor_type"
    for small, options in (
        ({"n": 8}, ""),
        ({"n": 8, "c": 0.5, "shape": "triangle"}, f"{adapt} threshold -adaptor_threshold 0.2 -estimator_type zz"),
        ({"n": 4}, f"{adapt} doerfler -adaptor_target 0.005 -estimator_type fembem -lower_mesh_order 2 -upper_mesh_order 2"),
    ):
        first, field = fields(*options.split(), **small)
        for length, stress in UNITS.values():
            record, scaled = fields(*options.split(), **small, length=length, stress=stress)
            sweeps += record["sweeps"] != first["sweeps"]
            cells += len(field) != len(scaled)
            for one, other in zip(field, scaled):
                cells += one["cells"] != other["cells"] or one["level"] != other["level"]
                for name, unit in ("vertices", length), ("displacement", length), ("stress", stress):
                    pairs = [(a, b / unit) for rows in zip(one[name], other[name]) for a, b in zip(*rows)]
                    off = max(off, max(abs(a - b) for a, b in pairs) / max(abs(a) for a, _ in pairs))
    case("H15", "fields off, in m Pa, nm Pa and km kPa, every mesh solved to the end", off, 1e-10)
    case("H15", "runs with other sweeps than in cm MPa", sweeps, 0)
    case("H15", "bodies and meshes with other cells than in cm MPa", cells, 0)


def test_units_of_a_fixed_mesh():
    check_units({"n": 8})
    check_units({"n": 4, "shape": "triangle"}, "-lower_mesh_cells 12,3", "-snes_type ddneumann -snes_ddneumann_start nocontact")
    check_units({"n": 8, "shape": "triangle"}, "-lower_mesh_cells 12,3", "-snes_type anderson")


def test_units_of_an_adapted_mesh():
    small = {"n": 8, "c": 0.5, "shape": "triangle"}
    for estimator in ("fembem", "zz"):
        adapt = "-lower_mesh_cells 8,2 -adaptor_type threshold -adaptor_threshold 0.2 -adaptor_bodies lower,upper"
        check_units(small, adapt, f"-estimator_type {estimator}")


def test_units_of_one_sweep_and_one_adaptation():
    adapt = "-lower_mesh_cells 8,2 -adaptor_type threshold -adaptor_threshold 0.2 -adaptor_bodies lower -estimator_type zz"
    check_units({"n": 8, "shape": "triangle"}, adapt, "-scene_interleave")


def test_either_body_may_be_the_first():
    for options in ("-snes_type ddneumann", "-lower_mesh_cells 48,12", "-snes_type anderson"):
        one, other = (run(None, layers(8, first=first), options) for first in ("upper", "lower"))
        force = one["pair.mid.force"]
        case("H18", "the same, the paper's loop, other meshes, Anderson", abs(other["pair.mid.force"] / force - 1), 1e-8)
        for key in ("force", "pressure_max", "contact_edge", "active"):
            assert near(other[f"pair.mid.{key}"], one[f"pair.mid.{key}"], 1e-8), (options, key)
        assert one["sweeps"] == other["sweeps"]
    for side, mirrored in (("first", "second"), ("second", "first")):  # and it may carry the pressures
        one = run(None, layers(8), "-lower_mesh_cells 48,12", f"-mid_pair_pressure_side {side}")
        other = run(None, layers(8, first="lower"), "-lower_mesh_cells 48,12", f"-mid_pair_pressure_side {mirrored}")
        assert near(other["pair.mid.force"], one["pair.mid.force"], 1e-8), side


def test_the_order_of_the_bodies_does_not_matter():
    one, other = run(None, layers(8)), run(None, layers(8), "-scene_bodies upper,lower")
    assert one["sweeps"] == other["sweeps"] and near(other["pair.mid.force"], one["pair.mid.force"], 1e-8)


# --- one sweep and one adaptation a cycle --------------------------------------------------------------------------------------


def test_one_sweep_a_cycle_ends_by_the_test_of_the_paper():
    options = ("-upper_mesh_cells 32,8", "-adaptor_threshold 0.3", "-scene_interleave")
    record = run(LAYERS, *options)
    assert record["verdict"] == "converged" and record["sweeps"] == record["cycles"] > 2
    longer = run(LAYERS, *options, "-scene_eps_u 1e-4")
    assert longer["cycles"] > 2 * record["cycles"] and longer["body.lower.cells"] >= record["body.lower.cells"]
