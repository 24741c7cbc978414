"""-scene_split: every body on ranks of its own. Who solves a body is nobody's business: the record is that of one rank to 1e-10, but for round-off."""
import os, re, tempfile

from abut import LAYERS, ROOT, case, run
from test_ranks import compared

EXAMPLES = os.path.join(ROOT, "examples")
ACTIVE = "-snes_type ddactive -snes_rtol 1e-12"
WEAK = "error.penalty", "force_penalty", "error.loop", "residual.loop", "penetration_max"  # differences of almost equal numbers, or round-off


def split(scene, *options, ranks, **keys):
    with tempfile.TemporaryDirectory() as folder:
        record = run(scene, *options, f"-scene_split -log_view :{folder}/log", ranks=ranks, **keys)
        with open(f"{folder}/log") as log:
            return record, {name: (int(count), float(messages)) for name, count, messages in re.findall(r"^(\w+) +(\d+) [\d.]+ \S+ +\S+ +\S+ +\S+ +(\S+)", log.read(), re.M)}


def off(one, other, where):
    """The largest relative difference; what is no measured number has to be the same"""
    worst = 0
    assert set(one) == {key for key in other if not key.endswith(".ranks")}
    for key in filter(compared, one):
        if key.endswith(WEAK):
            continue
        if isinstance(one[key], str) or one[key] == other[key]:
            assert one[key] == other[key], (where, key)
        else:
            worst = max(worst, abs(one[key] - other[key]) / abs(one[key]))
            assert worst < 1e-6, (where, key, one[key], other[key])
    return worst


def test_the_record_is_that_of_one_rank():
    adapted = "-lower_mesh_shape triangle -adaptor_bodies lower,upper -upper_mesh_cells 16,4 -adaptor_threshold 0.2"
    scenes = {
        "layers": (LAYERS, (ACTIVE,), (2, 3, 7)),
        "layers, both adapted": (LAYERS, (ACTIVE, adapted), (2, 5)),
        "paper": (LAYERS, ("-upper_mesh_cells 16,4 -adaptor_threshold 0.2 -mid_pair_penalty 0.5 -snes_ddneumann_gamma 0",), (2,)),
        "stack": (os.path.join(EXAMPLES, "stack", "stack.yml"), ("-snes_rtol 1e-12",), (2, 3, 7)),
        "gravity": (os.path.join(EXAMPLES, "gravity", "gravity.yml"), (), (3,)),
        "one rank": (LAYERS, (ACTIVE, "-scene_split"), (1,)),
    }
    for name, (scene, options, several) in scenes.items():
        one = run(scene, *options, limit=200)
        worst = max(off(one, split(scene, *options, ranks=n, limit=200)[0], f"{name}, {n} ranks") for n in several)
        case("H24", f"{name}: record of bodies on ranks of their own ({', '.join(map(str, several))} in all) off one rank", worst, 1e-9 if name == "gravity" else 1e-10)


def test_bodies_get_ranks_by_their_unknowns_and_move_when_these_change():
    """Uniform first: 8 x 2 quads and 16 x 4 x 2 triangles, 54 and 170 unknowns. The lower body alone is refined, and 6 of its ranks and 2 of the
    upper one's would be less even: 354 / 5 < 170 / 2."""
    record, events = split(LAYERS, ACTIVE, "-upper_mesh_cells 16,4 -adaptor_threshold 9", ranks=8)
    assert (record["body.lower.ranks"], record["body.upper.ranks"]) == (2, 6), record
    record, events = split(LAYERS, ACTIVE, "-upper_mesh_cells 16,4 -adaptor_threshold 0.1 -mid_pair_pressure_side second -adaptor_max_level 4", ranks=8, expect=None)
    assert (record["body.lower.unknowns"], record["body.upper.unknowns"]) == (354, 170), record
    assert (record["body.lower.ranks"], record["body.upper.ranks"]) == (5, 3) and events["AbutSplit"][0] > 2, record


def test_a_body_on_one_rank_sends_nothing_to_solve_it():
    """Products and solves of two bodies on two ranks, each on its own: no message; on all ranks there are some"""
    words = f"{ACTIVE} -lower_ksp_type cg -upper_ksp_type cg -lower_pc_type jacobi -upper_pc_type jacobi -lower_ksp_rtol 1e-13 -upper_ksp_rtol 1e-13"
    coarse = "-upper_mesh_cells 16,4 -adaptor_threshold 9"
    _, events = split(LAYERS, words, coarse, ranks=2)
    assert events["KSPSolve"][1] == 0 and events["MatMult"][1] == 0 and events["MatMult"][0] > 50, events
    with tempfile.TemporaryDirectory() as folder:
        run(LAYERS, words, coarse, f"-log_view :{folder}/log", ranks=2)
        text = open(f"{folder}/log").read()
    assert float(re.search(r"^MatMult +\d+ [\d.]+ \S+ +\S+ +\S+ +\S+ +(\S+)", text, re.M)[1]) > 0


def test_a_solver_that_fails_on_some_ranks_is_known_to_all():
    """With contact, and without"""
    coarse = "-upper_mesh_cells 16,4 -adaptor_threshold 9 -upper_pc_type jacobi -upper_ksp_type cg -upper_ksp_max_it 2"
    for ranks in 1, 3:
        assert split(LAYERS, ACTIVE, coarse, ranks=ranks, expect=2)[0]["verdict"] == "linear_solver"
        words = "-scene_bodies a,b -b_ksp_type cg -b_pc_type jacobi -b_ksp_max_it 2"
        for name in "ab":
            words += f" -{name}_mesh_box 0,0,4,1 -{name}_mesh_cells 8,2 -{name}_material_young 2e5 -{name}_material_poisson 0.3"
            words += f" -{name}_bc_left_u1 0 -{name}_bc_bottom_u2 0 -{name}_bc_top_u2 -1e-3"
        assert split(None, words, ranks=ranks, expect=2)[0]["verdict"] == "linear_solver"
