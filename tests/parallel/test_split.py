"""-scene_split: every body on ranks of its own. Who solves a body is nobody's business: the record is that of one rank to 1e-10, but for round-off."""
import collections, os, re, tempfile

from abut import LAYERS, ROOT, case, run
from same import farthest_key

EXAMPLES = os.path.join(ROOT, "examples")
ACTIVE = "-snes_type ddactive -snes_rtol 1e-12"
def split(scene, *options, ranks, way=("-scene_split",), **keys):
    """The record, and of every event its calls and messages in all phases"""
    with tempfile.TemporaryDirectory() as folder:
        record = run(scene, *options, *way, f"-log_view :{folder}/log", ranks=ranks, **keys)
        calls, messages = collections.Counter(), collections.Counter()
        with open(f"{folder}/log") as log:
            for name, count, sent in re.findall(r"^(\w+) +(\d+) [\d.]+ \S+ +\S+ +\S+ +\S+ +(\S+)", log.read(), re.M):
                calls[name] += int(count)
                messages[name] += float(sent)
    return record, calls, messages


def test_the_record_is_that_of_one_rank():
    """Beside what test_many_ranks.py runs: more bodies than ranks, triangles, friction and load steps"""
    adapted = "-lower_mesh_shape triangle -adaptor_bodies lower,upper -upper_mesh_cells 16,4 -adaptor_threshold 0.2"
    scenes = {
        "layers, both adapted": (LAYERS, (ACTIVE, adapted), (2, 5), 1e-10),
        "stack": (os.path.join(EXAMPLES, "stack", "stack.yml"), ("-snes_rtol 1e-12",), (2, 3), 1e-10),
        "gravity": (os.path.join(EXAMPLES, "gravity", "gravity.yml"), ("-snes_rtol 1e-12",), (3,), 1e-9),
    }
    for name, (scene, options, several, most) in scenes.items():
        one = run(scene, *options, limit=200)
        worst = max(farthest_key(one, split(scene, *options, ranks=n, limit=200)[0]) for n in several)
        case("H24", f"{name}: record of bodies on ranks of their own ({', '.join(map(str, several))} in all) off one rank", worst[0], most)


def test_bodies_get_ranks_by_their_unknowns_and_move_when_these_change():
    """Uniform first: 8 x 2 quads and 16 x 4 x 2 triangles, 54 and 170 unknowns. The lower body alone is refined, and 6 of its ranks and 2 of the
    upper one's would be less even: 354 / 5 < 170 / 2."""
    record, calls, _ = split(LAYERS, ACTIVE, "-upper_mesh_cells 16,4 -adaptor_threshold 9", ranks=8)
    assert (record["body.lower.ranks"], record["body.upper.ranks"]) == (2, 6), record
    record, calls, _ = split(LAYERS, ACTIVE, "-upper_mesh_cells 16,4 -adaptor_threshold 0.1 -mid_pair_pressure_side second -adaptor_max_level 4", ranks=8, expect=None)
    assert (record["body.lower.unknowns"], record["body.upper.unknowns"]) == (354, 170), record
    assert (record["body.lower.ranks"], record["body.upper.ranks"]) == (5, 3) and calls["AbutSplit"] > 2, record


def test_a_body_on_one_rank_sends_nothing_to_solve_it():
    """Products and solves of two bodies on two ranks, each on its own: no message; on all ranks there are some"""
    words = f"{ACTIVE} -lower_ksp_type cg -upper_ksp_type cg -lower_pc_type jacobi -upper_pc_type jacobi -lower_ksp_rtol 1e-13 -upper_ksp_rtol 1e-13"
    coarse = "-upper_mesh_cells 16,4 -adaptor_threshold 9"
    _, calls, messages = split(LAYERS, words, coarse, ranks=2)
    assert messages["KSPSolve"] == 0 and messages["MatMult"] == 0 and calls["MatMult"] > 50, (calls, messages)
    assert split(LAYERS, words, coarse, ranks=2, way=())[2]["MatMult"] > 50


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


def test_a_run_goes_on_from_a_checkpoint_after_bodies_have_moved():
    """One sweep a cycle: the last checkpoint has the trace of meshes that stand still, and bodies on other ranks than first meshes get"""
    words = "-scene_interleave -scene_eps_u 1e-4 -adaptor_threshold 0.1 -adaptor_max_level 4 -mid_pair_pressure_side second -upper_mesh_cells 16,4"
    with tempfile.TemporaryDirectory() as folder:
        whole = split(LAYERS, words, f"-checkpoint {folder}/checkpoint -checkpoint_every 30", ranks=8, expect=None)[0]
        again = split(LAYERS, words, f"-restart {folder}/checkpoint", ranks=8, expect=None)[0]
    assert (whole["body.lower.ranks"], whole["cycles"] > 30, whole["verdict"]) == (again["body.lower.ranks"], True, again["verdict"])
    assert whole["body.lower.ranks"] > 2, whole
    case("H23", "restart of bodies on ranks of their own, after they moved, off the run without", farthest_key(whole, again)[0], 1e-9)
