"""Scenes other than the paper's: what the record says of them is right"""
import os, tempfile

from abut import LAYERS, ROOT, run

EXACT = os.path.join(ROOT, "examples", "studies", "accuracy", "layers_exact.yml")

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


def test_points_of_a_file_are_joined_by_lines():
    """And held beyond the first and the last one: the answers are those of the same function as a formula"""
    files = {"gap.csv": "x,y,value\n0,1,0\n1,1,2e-4\n4,1,3.2e-3\n", "top.csv": "1,2,-1e-3\n3 , 2 , -2e-3\n"}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            with open(os.path.join(folder, name), "w") as f:
                f.write(text)
        points = f"-mid_pair_gap {folder}/gap.csv -upper_bc_top_u2 {folder}/top.csv"
        formulas = '-mid_pair_gap "x < 1 ? 2e-4*x : 2e-4+1e-3*(x-1)" -upper_bc_top_u2 0-1e-3-5e-4*max(0,min(2,x-1))'
        one, other = (run(LAYERS, "-snes_type ddactive -upper_mesh_cells 32,8 -adaptor_max_level 0", options, expect=None) for options in (points, formulas))
    assert one["pair.mid.active"] == other["pair.mid.active"] > 3
    for key in "pair.mid.force", "pair.mid.pressure_max", "probe.A.vm":
        assert abs(one[key] / other[key] - 1) < 1e-9, (key, one[key], other[key])


def test_the_view_says_what_is_in_force():
    said = {
        "-snes_ddneumann_gamma 0.031 -estimator_type fembem,residual": ("relaxation gamma = 0.031", "fembem,residual", "the largest counts", "type: residual"),
        "-adaptor_threshold 0.23 -adaptor_max_level 3 -adaptor_max_unknowns 12345": ("cells above 0.23", "at most level 3, 12345 unknowns", "adapts lower"),
        f"-options_file {EXACT} -adaptor_type equal -adaptor_target 0.17 -adaptor_bodies upper,lower": ("have at most 0.17", "adapts upper, lower"),
        f"-options_file {EXACT} -adaptor_target 0.17 -adaptor_bulk 0.37": ("hold 0.37 of", "at most 0.17", "adapts all bodies"),
        "-snes_type ddactive -snes_rtol 3e-7 -mid_pair_theta 2.5e-7": ("relative=3e-07", "theta 2.5e-07"),
    }
    for options, words in said.items():
        r = run(None if EXACT in options else LAYERS, "-scene_view -upper_mesh_cells 8,2 -snes_max_it 1", options, expect=None)
        view = r.stdout.split("\ncycle ")[0]
        assert all(word in view for word in words), (options, words, view)


def test_a_run_costs_more_than_its_last_linear_problems():
    r = run(LAYERS, "-snes_type ddactive -adaptor_threshold 0.3 -record_time_ratio")
    assert 1 < r["time.ratio"] < 1000, r["time.ratio"]
