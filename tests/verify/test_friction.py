"""Coulomb friction: a block that sticks or slides, with uniform stress, and Cattaneo's and Mindlin's partial slip of Hertz' contact.

The block is a patch test: u is linear in both bodies, so that every mesh gives p, tau and the slip to the accuracy of the loop. Mindlin's traction
is that of half-planes, R. D. Mindlin, Compliance of elastic bodies in contact, J. Appl. Mech. 16 (1949): mu p0 (sqrt(1 - x^2/a^2) - c/a sqrt(1 - x^2/c^2))
with c/a = sqrt(1 - Q/(mu P)). Equal materials do not slip under the normal force, so that it and the tangential one may come in one step. It holds for
the forces P and Q of the record; the boxes are seven times as deep as the contact is wide.
"""
import csv, functools, math, os, tempfile

from abut import PROGRAM, case, execute, run

E, NU, MU, DELTA = 2.1e5, 0.3, 0.4, 1e-3
SHEAR = E / (2 * (1 + NU))
EXACT = "-snes_rtol 1e-12 -mid_pair_penalty 0"


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


@functools.lru_cache(None)
def mindlin(shift, order=1, ranks=1, *options):
    """Two boxes with the gap of cylinders; cells of a hundredth on the contact"""
    mu, words = 0.3, "-scene_bodies upper,lower -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap x^2/57.6923077 -mid_pair_friction 0.3 " + EXACT
    for name, y in ("upper", 0), ("lower", -2):
        size = f"max({0.01 * order},0.3*(sqrt(x^2+y^2)-0.31))"
        words += f" -{name}_mesh_box -2,{y},2,{y + 2} -{name}_mesh_cells 8,4 -{name}_mesh_order {order} -{name}_mesh_size {size} -{name}_material_young {E} -{name}_material_poisson {NU}"
    words += f" -lower_bc_bottom_u1 0 -lower_bc_bottom_u2 0 -upper_bc_top_u2 0-4e-3 -upper_bc_top_u1 {shift}"
    with tempfile.TemporaryDirectory() as folder:
        record = run(None, *words.split(), f"-output_profile {folder}/profile.csv", *options, ranks=ranks)
        x, p, t, slip = read_profile(f"{folder}/profile.csv")
    P, Q, a = record["pair.mid.force"], record["pair.mid.tangential"], record["pair.mid.contact_edge"]
    c = a * math.sqrt(1 - Q / (mu * P))
    root = lambda z: math.sqrt(max(0.0, 1 - z**2))
    exact = [mu * 2 * P / (math.pi * a) * (root(z / a) - c / a * root(z / c)) for z in x]
    error = math.sqrt(sum((v - w) ** 2 for v, w in zip(t, exact)) / sum(w**2 for w in exact))
    assert all(abs(v) <= mu * q * (1 + 1e-9) and (s * v >= 0 or abs(s) < 1e-6 * max(slip)) for q, v, s in zip(p, t, slip)), "friction does not resist"
    return record, c / a, record["pair.mid.stick_length"] / (2 * a), error


def test_partial_slip_is_that_of_cattaneo_and_mindlin():
    for order in 1, 2:
        for shift in (2e-4, 5e-4, 1e-3)[order - 1 :]:
            record, exact, stick, error = mindlin(shift, order)
            print(f"order {order}: Q/(mu P) {1 - exact**2:.3f}, c/a {stick:.4f}, exact {exact:.4f}, traction off by {error:.4f} in L2, {record['sweeps']} sweeps")
            case("V18", f"c/a off Cattaneo's at Q = {1 - exact**2:.2f} mu P, order {order}", abs(stick / exact - 1), 0.02)
            case("V18", f"tangential traction off Mindlin's in L2 at Q = {1 - exact**2:.2f} mu P, order {order}", error, 0.03)
            case("V18", f"sweeps, order {order}", record["sweeps"], 20)


def test_partial_slip_is_the_same_on_all_ranks():
    one, *others = (mindlin(5e-4, 1, ranks)[0] for ranks in (1, 2, 3))
    keys = "force", "tangential", "pressure_max", "stick_length", "slip_max"
    case("V18", "forces, stick and slip on 2 and 3 ranks off those on 1", max(abs(r[f"pair.mid.{key}"] / one[f"pair.mid.{key}"] - 1) for r in others for key in keys), 1e-8)
