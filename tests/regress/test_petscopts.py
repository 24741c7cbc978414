"""Every file of petscopts/ does what its name says, on a small scene: all of them reach the same answer."""
import glob, os

from abut import LAYERS, ROOT, run

SMALL = ["-upper_mesh_cells 32,8", "-adaptor_threshold 0.25"]


def options(name):
    return ["-options_file", os.path.join(ROOT, "petscopts", name)]


def solve(name):
    return run(LAYERS, *SMALL, *options(name))


def same_answer(names, tolerance):
    force = [solve(name)["pair.mid.force"] for name in names]
    assert max(force) - min(force) <= tolerance * max(force), dict(zip(names, force))


def test_solvers_agree():
    same_answer(["solver/direct.opts", "solver/hypre.opts", "solver/gamg.opts"], 1e-6)


def test_machines_agree():
    names = ["machine/node.opts", "machine/cluster.opts"]
    force = [run(LAYERS, *SMALL, *options(name), "-snes_type ddactive", ranks=2)["pair.mid.force"] for name in names]
    direct = run(LAYERS, *SMALL, "-estimator_type zz -snes_type ddactive")["pair.mid.force"]
    assert all(abs(one / direct - 1) < 1e-6 for one in force), (force, direct)


def test_loops_agree():
    same_answer(["loop/automatic.opts", "loop/anderson.opts", "loop/ngmres.opts", "loop/qn.opts"], 1e-6)


def test_the_fast_loop_agrees_where_it_solves_every_mesh_to_the_end():
    fast = run(LAYERS, *SMALL, *options("loop/ddactive.opts"), "-scene_loop_share 0")
    assert abs(fast["pair.mid.force"] / solve("loop/anderson.opts")["pair.mid.force"] - 1) < 1e-6, fast["pair.mid.force"]


def test_the_loop_of_the_paper_stops_early():
    assert solve("loop/paper.opts")["sweeps"] < 10 * solve("loop/paper.opts")["cycles"]


def test_estimators_refine_at_the_contact():
    for name in ("estimator/fembem.opts", "estimator/zz.opts", "estimator/residual.opts"):
        record = solve(name)
        assert 16 < record["body.lower.cells"] < 256, (name, record["body.lower.cells"])


def test_quick():
    record = run(LAYERS, *options("quick.opts"))
    assert abs(record["pair.mid.force"] / 123.078 - 1) < 0.05 and record["time.total"] < 20


def test_accuracy():
    exact = os.path.join(ROOT, "examples", "studies", "accuracy", "layers_exact.yml")
    coarse, high = (run(exact, *options(name))["pair.mid.force"] for name in ("accuracy.opts", "accuracy_high.opts"))
    assert abs(coarse / high - 1) < 1e-5, (coarse, high)


def test_none_is_forgotten():
    with open(__file__) as f:
        text = f.read()
    for path in glob.glob(os.path.join(ROOT, "petscopts", "**", "*.opts"), recursive=True):
        name = os.path.relpath(path, os.path.join(ROOT, "petscopts"))
        assert f'"{name}"' in text, f"{name} is not run by {__file__}"
