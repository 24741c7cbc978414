"""Coulomb friction: a block that sticks or slides, with uniform stress, and Cattaneo's and Mindlin's partial slip of Hertz' contact.

The block is a patch test: u is linear in both bodies, so that every mesh gives p, tau and the slip to the accuracy of the loop. Mindlin's traction
is that of half-planes, R. D. Mindlin, Compliance of elastic bodies in contact, J. Appl. Mech. 16 (1949): mu p0 (sqrt(1 - x^2/a^2) - c/a sqrt(1 - x^2/c^2))
with c/a = sqrt(1 - Q/(mu P)). Equal materials do not slip under the normal force, so that it and the tangential one may come in one step. It holds for
the forces P and Q of the record; the boxes are seven times as deep as the contact is wide.
"""
import csv, functools, math, tempfile

from abut import case, read_csv, run
from uniform import ADAPTED, series, share

E, NU, MU, DELTA = 2.1e5, 0.3, 0.4, 1e-3
SHEAR = E / (2 * (1 + NU))


def block(shift, *options, theta=0.0, order=1, shape="quad", ranks=1, cells=("4,4", "4,4"), **keys):
    """Upper box pressed by DELTA and shifted along the lower one; sides have the tractions of the uniform stress. The record, p, tau and slip."""
    p = DELTA / (2 * (1 - NU**2) / E + theta)
    tau = math.copysign(min(MU * p, abs(shift) / (2 / SHEAR + theta)), shift)
    wide = f"{NU * (1 + NU) / E * p!r}*x"
    words = ["-scene_bodies upper,lower -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top", f"-mid_pair_friction {MU} -mid_pair_theta {theta!r}"]
    for name, y, n in ("upper", 0, cells[0]), ("lower", -1, cells[1]):
        words.append(f"-{name}_mesh_box 0,{y},2,{y + 1} -{name}_mesh_cells {n} -{name}_mesh_order {order} -{name}_mesh_shape {shape}")
        words.append(f"-{name}_material_young {E} -{name}_material_poisson {NU} -{name}_bc_right_t2 {tau!r} -{name}_bc_left_t2 0-({tau!r})")
    words.append(f"-upper_bc_top_u1 {shift!r}+{wide} -upper_bc_top_u2 0-{DELTA!r} -lower_bc_bottom_u1 {wide} -lower_bc_bottom_u2 0 -snes_rtol 1e-12")
    record = run(None, *words, *options, ranks=ranks, **keys)
    return record, p, tau, abs(shift - 2 * tau / SHEAR)


def off(shift, *options, **keys):
    """By how much force, largest pressure, tangential force and slip are off"""
    record, p, tau, slip = block(shift, *options, **keys)
    assert record["verdict"] == "converged", record.stdout
    length = 2.0 if abs(tau) < MU * p else 0.0
    assert abs(record["pair.mid.stick_length"] - length) < 1e-9, (record["pair.mid.stick_length"], length)
    pairs = (("force", 2 * p), ("pressure_max", p), ("tangential", 2 * tau))
    return max([abs(record[f"pair.mid.{key}"] / value - 1) for key, value in pairs] + [abs(record["pair.mid.slip_max"] - slip) / DELTA])


def test_a_block_slides_with_mu_times_its_force_and_sticks_below():
    meshes = {"matching": {}, "not matching": {"cells": ("3,2", "4,4")}, "triangles": {"shape": "triangle", "cells": ("4,2", "3,3")}, "order 2": {"order": 2, "cells": ("3,2", "4,2")}}
    for words in "sticks", "slides":
        shift = 2e-4 if words == "sticks" else 5e-3
        errors = {(mesh, theta): off(shift, theta=theta, **keys) for mesh, keys in meshes.items() for theta in (0.0, 5e-2 / E)}
        print(errors)
        case("V17", f"force, pressure, tangential force and slip of a block that {words}, four meshes, with and without penalty", max(errors.values()), 1e-9)
    case("V17", "the same backwards, pressures on the second side, three ranks", off(-5e-3, "-mid_pair_pressure_side second", ranks=3, cells=("3,2", "4,4")), 1e-9)


def test_all_loops_find_the_same_friction():
    for shift in 2e-4, 5e-3:
        sweeps, errors = {}, {}
        for loop in "ddactive", "ddneumann -snes_ddneumann_gamma_spectrum", "anderson -snes_anderson_m 20":
            words = f"-snes_type {loop}", "-upper_bc_right_t2 0 -upper_bc_left_t2 0 -lower_bc_right_t2 0 -lower_bc_left_t2 0 -snes_rtol 1e-9 -snes_max_it 2000"
            record = block(shift, *words, theta=0.5 / E, cells=("5,3", "6,4"))[0]
            sweeps[loop.split()[0]] = record["sweeps"]
            errors[loop] = [record[f"pair.mid.{key}"] for key in ("force", "tangential", "pressure_max")]
        first = errors["ddactive"]
        case("V17", f"other loops off ddactive, shift {shift}", max(abs(v / w - 1) for values in errors.values() for v, w in zip(values, first)), 1e-7)
        print(f"shift {shift}: sweeps {sweeps}")
        case("V17", f"sweeps of ddactive, shift {shift}", sweeps["ddactive"], 15)


def test_no_friction_and_a_coefficient_of_zero_are_the_same():
    """A coefficient of zero still takes the two components of the traces, so that only round-off may differ; without the key nothing of friction is there"""
    words = "-upper_bc_right_t2 0 -upper_bc_left_t2 0 -lower_bc_right_t2 0 -lower_bc_left_t2 0", "-mid_pair_friction 0"
    with tempfile.TemporaryDirectory() as folder:
        log = f"{folder}/log"
        zero = block(5e-3, *words, f"-log_view :{log}")[0]
        assert "AbutPairFriction" in open(log).read()
        command = ["-scene_bodies upper,lower -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_theta 0 -snes_rtol 1e-12"]
        for name, y in ("upper", 0), ("lower", -1):
            command.append(f"-{name}_mesh_box 0,{y},2,{y + 1} -{name}_mesh_cells 4,4 -{name}_material_young {E} -{name}_material_poisson {NU}")
        wide = f"{NU * (1 + NU) * DELTA / (2 * (1 - NU**2))!r}*x"
        command.append(f"-upper_bc_top_u1 5e-3+{wide} -upper_bc_top_u2 0-{DELTA!r} -lower_bc_bottom_u1 {wide} -lower_bc_bottom_u2 0 -log_view :{log}")
        none = run(None, *command)
        assert "AbutSweep" in open(log).read() and "AbutPairFriction" not in open(log).read()
    assert not any("tangential" in key or "slip" in key or "stick" in key or "friction" in key for key in none)
    error = max(abs(zero[key] / none[key] - 1) for key in ("pair.mid.force", "pair.mid.pressure_max", "energy.strain"))
    case("V17", "a coefficient of zero off no friction", error, 1e-9)
    assert zero["pair.mid.tangential"] == 0


def pushed(traction, *options, **keys):
    """A block that only friction holds along x, pressed by 100 on its top of length 2"""
    words = "-scene_bodies block,base -scene_pairs mid -mid_pair_bodies block,base -mid_pair_sides bottom,top -mid_pair_penalty 0 -mid_pair_friction 0.3"
    for name, box, cells in ("block", "1,0,3,1", "8,4"), ("base", "0,-1,4,0", "16,4"):
        words += f" -{name}_mesh_box {box} -{name}_mesh_cells {cells} -{name}_material_young {E} -{name}_material_poisson {NU}"
    return run(None, *words.split(), f"-base_bc_bottom_u1 0 -base_bc_bottom_u2 0 -block_bc_top_t2 0-100 -block_bc_top_t1 {traction}", *options, **keys)


def test_friction_holds_a_body_up_to_mu_times_its_force():
    for traction in 5, 20, 29.9:
        record = pushed(traction)
        case("V17", f"tangential force of a block that friction alone holds against {traction} of 30", abs(record["pair.mid.tangential"] / (2 * traction) - 1), 1e-8)
        assert abs(record["pair.mid.force"] / 200 - 1) < 1e-8 and record["sweeps"] <= 15, record
    record = pushed(31, expect=None)
    assert record.status and record["verdict"] == "floating" and "block: contact does not hold this body, it is free in moving along x" in record.stdout, record.stdout


def read_profile(path):
    with open(path) as f:
        rows = [row for row in csv.DictReader(f) if row["side"] == "pressure"]
    return [[float(row[key]) for row in rows] for key in ("x", "pressure", "traction_t", "slip")]


def cylinders(shift, *options, order=1, **keys):
    """Two boxes with the gap of cylinders, pressed together by 4e-3 that the gap lacks; cells of a hundredth on the contact"""
    words = "-scene_bodies upper,lower -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_friction 0.3 -mid_pair_penalty 0"
    words += " -mid_pair_gap x^2/57.6923077-4e-3 -snes_rtol 1e-12"
    for name, y in ("upper", 0), ("lower", -2):
        size = f"max(0.01,0.3*(sqrt(x^2+y^2)-0.31))"
        words += f" -{name}_mesh_box -2,{y},2,{y + 2} -{name}_mesh_cells 8,4 -{name}_mesh_order {order} -{name}_mesh_size {size}"
        words += f" -{name}_material_young {E} -{name}_material_poisson {NU}"
    words += f" -lower_bc_bottom_u1 0 -lower_bc_bottom_u2 0 -upper_bc_top_u2 0 -upper_bc_top_u1 {shift}"
    return run(None, *words.split(), *options, **keys)


def traction(record, path, mu, parts):
    """The tangential tractions of a profile off mu p0 times the sum of factor (b/a) sqrt(1 - x^2/b^2), in L2; they resist the slip"""
    x, p, t, slip = read_profile(path)
    a = record["pair.mid.contact_edge"]
    exact = [sum(factor * b / a * math.sqrt(max(0.0, 1 - (z / b) ** 2)) for factor, b in parts) for z in x]
    exact = [mu * 2 * record["pair.mid.force"] / (math.pi * a) * v for v in exact]
    assert all(abs(v) <= mu * q * (1 + 1e-9) for q, v in zip(p, t)), "more than mu p"
    assert all(s * v >= 0 or abs(s) < 1e-6 * max(map(abs, slip)) for v, s in zip(t, slip)), "friction does not resist"
    return math.sqrt(sum((v - w) ** 2 for v, w in zip(t, exact)) / sum(w**2 for w in exact))


@functools.lru_cache(None)
def mindlin(shift, order=1, ranks=1):
    mu = 0.3
    with tempfile.TemporaryDirectory() as folder:
        record = cylinders(shift, f"-output_profile {folder}/profile.csv", order=order, ranks=ranks)
        a = record["pair.mid.contact_edge"]
        c = a * math.sqrt(1 - record["pair.mid.tangential"] / (mu * record["pair.mid.force"]))
        error = traction(record, f"{folder}/profile.csv", mu, ((1, a), (-1, c)))
    return record, c / a, record["pair.mid.stick_length"] / (2 * a), error


def test_partial_slip_is_that_of_cattaneo_and_mindlin():
    for order in 1, 2:
        for shift in (2e-4, 5e-4, 1e-3)[order - 1 :]:
            record, exact, stick, error = mindlin(shift, order)
            print(f"order {order}: Q/(mu P) {1 - exact**2:.3f}, c/a {stick:.4f}, exact {exact:.4f}, traction off by {error:.4f} in L2, {record['sweeps']} sweeps")
            case("V18", f"c/a off Cattaneo's at Q = {1 - exact**2:.2f} mu P, order {order}", abs(stick / exact - 1), 0.02)
            case("V18", f"tangential traction off Mindlin's in L2 at Q = {1 - exact**2:.2f} mu P, order {order}", error, 0.03)
            case("V18", f"sweeps, order {order}", record["sweeps"], 20)


def even(n):
    """Uniform meshes of both boxes of cylinders(), n by n/2 cells"""
    return " ".join(f"-{name}_mesh_cells {n},{n // 2} -{name}_mesh_size 9" for name in ("upper", "lower"))


def stick_off(record):
    """c/a off Cattaneo's under the forces of the record; as far off as can be where everything slips"""
    a, P, Q, stick = (record[f"pair.mid.{key}"] for key in ("contact_edge", "force", "tangential", "stick_length"))
    square = 1 - Q / (0.3 * P)
    return abs(stick / (2 * a) / math.sqrt(square) - 1) if square > 1e-6 else math.inf


def test_partial_slip_takes_fewer_unknowns_in_adapted_meshes():
    """The length that sticks is one of whole nodes: its error goes up and down with the place of the edge, so there are many uniform meshes, and two
    first meshes to adapt."""
    for order, first, cells in (1, (16, 24), range(16, 120, 8)), (2, (8, 12), range(8, 60, 4)):
        uniform = [cylinders(5e-4, even(n), order=order) for n in cells]
        for estimator in "zz", "residual", "fembem":
            words = f"-adaptor_type doerfler -estimator_type {estimator} -adaptor_max_unknowns 6000", ADAPTED
            adapted = [row for n in first for row in series(functools.partial(cylinders, order=order), 5e-4, even(n), *words)]
            part = share(f"cylinders, order {order}, {estimator}", "c/a", stick_off, 0.02, uniform, adapted)
            case("V18", f"unknowns for c/a to 2 per cent, adapted over uniform, order {order}, {estimator}", part, 0.5)


def test_partial_slip_is_the_same_on_all_ranks():
    one, *others = (mindlin(5e-4, 1, ranks)[0] for ranks in (1, 2, 3))
    keys = "force", "tangential", "pressure_max", "stick_length", "slip_max"
    case("V18", "forces, stick and slip on 2 and 3 ranks off those on 1", max(abs(r[f"pair.mid.{key}"] / one[f"pair.mid.{key}"] - 1) for r in others for key in keys), 1e-8)


def test_a_force_that_comes_and_goes_leaves_what_mindlin_and_deresiewicz_say():
    """After Q* the force Q slips backwards from the edge to b/a = sqrt(1 - (Q* - Q)/(2 mu P)), and inside b the traction is less by one constant slip:
    J. Appl. Mech. 20 (1953). At -Q* nothing is left of the way."""
    mu, factors = 0.3, (1, 0.6, 0.2, -0.3, -1)
    with tempfile.TemporaryDirectory() as folder:
        steps = f"-scene_load_steps {','.join(map(str, factors))}"
        cylinders(1e-3, steps, f"-output_profile {folder}/profile.csv -record_csv {folder}/steps.csv -snes_rtol 1e-10")
        rows = read_csv(f"{folder}/steps.csv")
        assert [row["load_factor"] for row in rows] == list(factors)
        for k, row in enumerate(rows):
            a, P, Q = (row[f"pair.mid.{key}"] for key in ("contact_edge", "force", "tangential"))
            c = a * math.sqrt(1 - rows[0]["pair.mid.tangential"] / (mu * P))
            b = a * math.sqrt(1 - (rows[0]["pair.mid.tangential"] - Q) / (2 * mu * P))
            parts = ((1, a), (-1, c)) if k == 0 else ((-1, a), (2, b), (-1, c))
            error, stick = traction(row, f"{folder}/profile_step_{k + 1:04d}.csv", mu, parts), row["pair.mid.stick_length"] / (2 * a)
            print(f"factor {row['load_factor']}: Q/(mu P) {Q / (mu * P):.3f}, stick {stick:.4f}, exact {(b if k else c) / a:.4f}, traction off by {error:.4f}")
            case("V18", f"stick over contact off the exact one at factor {row['load_factor']}", abs(stick * a / (b if k else c) - 1), 0.02)
            case("V18", f"tangential traction off the exact one in L2 at factor {row['load_factor']}", error, 0.06)
    case("V18", "force at factor -1 off minus that at 1", abs(rows[-1]["pair.mid.tangential"] / rows[0]["pair.mid.tangential"] + 1), 1e-6)


def test_load_steps_with_friction_go_on_from_a_checkpoint():
    words = "-upper_mesh_size 9 -lower_mesh_size 9 -upper_mesh_cells 80,6 -lower_mesh_cells 96,6"
    with tempfile.TemporaryDirectory() as folder:
        whole = cylinders(2e-3, words, "-scene_load_steps 1,0.6,-0.2")
        cylinders(2e-3, words, f"-scene_load_steps 1,0.6 -checkpoint {folder}/checkpoint")
        assert whole["pair.mid.slip_max"] > 1e-5, whole
        for ranks in 1, 2:
            again = cylinders(2e-3, words, f"-scene_load_steps 1,0.6,-0.2 -restart {folder}/checkpoint", ranks=ranks)
            worst = max(abs(again[key] / whole[key] - 1) for key in ("pair.mid.force", "pair.mid.tangential", "pair.mid.slip_max"))
            case("H23", f"friction after a restart on {ranks} ranks off the run without", worst, 1e-8)


def test_estimators_know_the_tangential_tractions():
    """Where the stress is uniform there is no error; without the tractions the estimate would be as large as the shear stress"""
    for estimator, most in ("zz", 1e-10), ("residual", 1e-10), ("fembem", 1e-4):
        worst = max(block(shift, f"-estimator_type {estimator}", order=order, cells=("3,2", "4,4"))[0]["error.discretisation"] for shift in (2e-4, 5e-3) for order in (1, 2))
        case("V17", f"error that {estimator} finds in uniform stress with friction", worst, most)
