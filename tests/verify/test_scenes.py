"""Scenes other than the paper's: what the record says of them is right"""
from abut import run

STEEL = "-{0}_material_young 2.1e5 -{0}_material_poisson 0.3"
FAST = "-snes_type anderson -snes_anderson_m 20"


def body(name, box, cells, *conditions):
    return f"-{name}_mesh_box {box} -{name}_mesh_cells {cells} " + STEEL.format(name) + "".join(f" -{name}_bc_{c}" for c in conditions)


def pressed(lower_box, *more):
    """A wide upper body, held along its top, pressed on a lower one, bonded below"""
    lower = body("lower", lower_box, "16,8", "bottom_u1 0", "bottom_u2 0")
    upper = body("upper", "0,1,4,2", "32,8", "top_u1 0", "top_u2 0-1e-3")
    return run(None, "-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top", lower, upper, *more)


def test_a_narrower_body_is_in_contact_over_its_whole_width():
    for box in ("1,0,3,1", "0,0,2,1", "2,0,4,1", "0.55,0,2.55,1"):
        for side in ("first", "second"):
            r = pressed(box, FAST, f"-mid_pair_pressure_side {side}")
            assert abs(r["pair.mid.contact_edge"] - 2) < 1e-9 and abs(r["pair.mid.contact_length"] - 2) < 1e-9, (box, side, r["pair.mid.contact_edge"])


def test_an_inner_contact_has_a_half_width():
    """Gap (x-2)^2 in the middle of a side: two edges, half of their distance; compared with the half model of the same gap"""
    r = pressed("0,0,4,1", FAST, "-mid_pair_gap (x-2)^2*2e-3")
    assert 0.5 < r["pair.mid.contact_edge"] < 1, r["pair.mid.contact_edge"]
    assert abs(2 * r["pair.mid.contact_edge"] - r["pair.mid.contact_length"]) < 0.25, r  # the edge lies within half a cell of the last active nodes' ends
    shifted = pressed("0,0,4,1", FAST, "-mid_pair_gap (x-2.25)^2*2e-3")
    assert abs(shifted["pair.mid.contact_edge"] - r["pair.mid.contact_edge"]) < 0.06, shifted["pair.mid.contact_edge"]


def test_a_body_in_no_pair_does_not_hinder_the_papers_stop():
    lower = body("lower", "0,0,4,1", "16,4", "left_u1 0", "bottom_u2 0")
    upper = body("upper", "0,1,4,2", "16,4", "left_u1 0", "top_u2 0-1.366e-3")
    alone = body("alone", "10,0,11,1", "4,4", "bottom_u1 0", "bottom_u2 0", "top_u2 0-1e-3")
    pair = "-scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 1e-3*x^2 -snes_type ddneumann -snes_ddneumann_gamma 0.02 -snes_ddneumann_stop paper"
    two = run(None, "-scene_bodies lower,upper", pair, lower, upper)
    three = run(None, "-scene_bodies lower,upper,alone", pair, lower, upper, alone)
    assert two["sweeps"] == three["sweeps"] < 10 and abs(two["pair.mid.force"] / three["pair.mid.force"] - 1) < 1e-9, (two, three)
