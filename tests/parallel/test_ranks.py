"""The number of ranks is nobody's business: the same meshes, the same sweeps, the same record to 1e-8, also where a rank owns no cell.

Round-off differs, so keys that are round-off themselves are left out, and the residual of the loop, a difference of almost equal traces,
has fewer digits.
"""
import os, tempfile

from abut import LAYERS, case, run
from same import digits_off, farthest, outcome, read_values

CHEAP = "-mid_pair_penalty 0.5 -snes_ddneumann_gamma 0"  # a tenth of the sweeps
TIMES = ("time.", "memory.")
ROUNDOFF = TIMES + ("check.", "error.linear", "residual.linear")


def compared(key):
    return not key.startswith(ROUNDOFF) and not key.endswith((".balance", ".complementarity", ".imbalance"))


def check_same(one, other, where):
    assert one.keys() == other.keys(), where
    for key in filter(compared, one):
        a, b = one[key], other[key]
        if isinstance(a, float) or isinstance(b, float):
            digits, floor = (1e-5, 1e-12) if key in ("error.loop", "residual.loop") else (1e-8, 0)
            assert abs(a - b) <= digits * abs(a) + floor, (where, key, a, b)
        else:
            assert a == b, (where, key, a, b)


def check_ranks(*options, scene=LAYERS, ranks=(2, 3), expect=0):
    record, rows, cells = outcome(scene, options, 1, expect)
    assert len(cells) >= 2 * record["cycles"]
    for n in ranks:
        others = outcome(scene, options, n, expect)
        check_same(record, others[0], f"{n} ranks")
        assert len(rows) == len(others[1])
        for i, (one, other) in enumerate(zip(rows, others[1])):
            check_same(one, other, f"{n} ranks, cycle {i + 1}")
        assert cells == others[2], f"{n} ranks have other meshes"
    return record


def test_quadrilaterals_adapted_by_boundary_elements():
    record = check_ranks("-upper_mesh_cells 32,8", CHEAP, "-adaptor_threshold 0.2 -estimator_type fembem", ranks=(2, 3, 4))
    assert record["cycles"] > 2 and record["body.lower.level_max"] >= 2


def test_quadrilaterals_adapted_by_patch_recovery():
    record = check_ranks("-upper_mesh_cells 32,8", CHEAP, "-adaptor_threshold 0.2 -estimator_type zz")
    assert record["cycles"] > 2 and record["body.lower.level_max"] >= 2


def test_both_bodies_adapted():
    """Triangles both, or one of each shape"""
    for options in ("-lower_mesh_shape triangle -estimator_type fembem -adaptor_threshold 0.2", "-estimator_type zz -adaptor_threshold 0.15"):
        record = check_ranks("-upper_mesh_cells 16,4", CHEAP, "-adaptor_bodies lower,upper", options)
        assert record["cycles"] > 2 and record["body.upper.cells"] > 128


def test_one_sweep_and_one_adaptation_a_cycle():
    record = check_ranks("-upper_mesh_cells 16,4", "-scene_interleave -adaptor_threshold 0.2")
    assert record["sweeps"] == record["cycles"] > 3


def test_a_tolerance_for_all():
    record = check_ranks("-upper_mesh_cells 16,4 -snes_type ddactive -scene_tol 0.05")
    assert record["cycles"] > 2 and record["body.upper.level_max"] >= 2 and record["pair.mid.theta"] == 0


def test_ranks_without_a_cell():
    """Bodies of one cell, and of two triangles, that are never split, or split until every rank has some"""
    tiny = ("-lower_mesh_cells 1,1 -upper_mesh_cells 1,1", CHEAP, "-snes_ddneumann_gamma 0.25")
    record = check_ranks(*tiny, "-adaptor_max_level 0", expect=3)
    assert record["body.lower.cells"] == 1 and record["body.upper.cells"] == 2
    for estimator in ("fembem", "zz"):
        record = check_ranks(*tiny, f"-adaptor_bodies lower,upper -adaptor_max_level 3 -estimator_type {estimator}", expect=3)
        assert record["body.lower.cells"] > 8 and record["body.upper.cells"] > 8, estimator


def fields(options, ranks, expect):
    """Record, and for each mesh displacements and indicators"""
    with tempfile.TemporaryDirectory() as folder:
        record = run(LAYERS, *options, f"-output {folder}/fields.vtu", ranks=ranks, expect=expect, limit=100)
        return record, {name: read_values(f"{folder}/{name}") for name in sorted(os.listdir(folder)) if name.endswith(".vtu")}


def test_values_of_one_to_seven_ranks_differ_by_round_off():
    """Also of more ranks than cells: the bodies have 1 and 2 at first"""
    adapted = "-upper_mesh_cells 16,4 -adaptor_threshold 0.2 -estimator_type fembem -snes_type ddactive -snes_rtol 1e-11"
    solvers = "-lower_pc_type hypre -upper_pc_type hypre -lower_ksp_rtol 1e-12 -upper_ksp_rtol 1e-12"
    tiny = "-lower_mesh_cells 1,1 -upper_mesh_cells 1,1 -adaptor_bodies lower,upper -adaptor_max_level 2 -snes_type ddactive"
    force, moved, eta, others = 0, 0, 0, 0
    for options, expect, several in ((adapted, solvers), 0, (2, 3, 4, 7)), ((tiny,), 3, (3, 7)):
        record, meshes = fields(options, 1, expect)
        for ranks in several:
            again, same = fields(options, ranks, expect)
            others += [record[key] != again[key] for key in ("sweeps", "cycles", "unknowns")] != 3 * [False] or meshes.keys() != same.keys()
            for key in "force", "pressure_max":
                force = max(force, digits_off(record[f"pair.mid.{key}"], again[f"pair.mid.{key}"]))
            for name in meshes:
                moved = max(moved, farthest(meshes[name][0], same[name][0]))
                eta = max(eta, farthest(meshes[name][1], same[name][1]))
    case("H24", "P, p0 beyond one unit of their tenth digit, 1 against 2, 3, 4, 7 ranks", force, 1e-10)
    case("H24", "indicators of all cells of all meshes, over the largest", eta, 1e-10)
    case("H24", "displacements of all meshes, over the largest", moved, 1e-10)
    case("H24", "of 6 runs those with other sweeps, cycles or meshes", others, 0)


def test_accelerated_loops_and_iterative_solvers():
    fixed = "-upper_mesh_shape quad -upper_mesh_cells 32,8 -lower_mesh_cells 32,8 -adaptor_max_level 0"
    check_ranks(fixed, CHEAP, "-snes_type anderson -npc_snes_type ddneumann -npc_snes_max_it 1", ranks=(3,), expect=3)
    one, two = (run(LAYERS, fixed, CHEAP, "-lower_pc_type hypre -lower_ksp_rtol 1e-13", ranks=n, expect=3) for n in (1, 2))
    assert one["sweeps"] == two["sweeps"] and abs(one["pair.mid.force"] / two["pair.mid.force"] - 1) < 1e-8


def test_a_run_repeats_itself_to_the_last_digit():
    """On one rank; on several MUMPS adds in the order in which messages come, and the last digits wander"""
    runs = [run(LAYERS, "-upper_mesh_cells 16,4 -adaptor_threshold 0.2", CHEAP) for _ in range(2)]
    one, other = ({key: value for key, value in record.items() if not key.startswith(TIMES)} for record in runs)
    assert one == other, [(key, one[key], other[key]) for key in one if one[key] != other[key]]
