"""A million unknowns of two layers, with CG and BoomerAMG: what they take is counted in bytes and iterations, not in seconds"""
import os

from abut import ROOT, run

SCENE = os.path.join(ROOT, "examples", "studies", "shares", "layers_tol.yml")
HYPRE = " ".join(f"-{body}_ksp_type cg -{body}_pc_type hypre" for body in ("lower", "upper"))


def adapted(tolerance):
    options = f"-scene_tol {tolerance} -estimator_type zz -adaptor_max_level 28 -adaptor_max_unknowns 100000000"
    r = run(None, "-options_file", SCENE, *options.split(), *HYPRE.split())
    bodies = [r[f"body.{body}.ksp_its"] for body in ("lower", "upper")]
    memory = r["memory.peak"] / r["unknowns"]
    print(f"{r['unknowns']} unknowns, {r['cycles']} meshes, {r['sweeps']} sweeps, {bodies} iterations, {memory:.0f} bytes an unknown")
    return r, max(bodies) / r["sweeps"]


def test_a_million_unknowns_fit_and_take_few_more_iterations_than_a_hundred_thousand():
    small, its_small = adapted(3.9e-3)
    large, its_large = adapted(1.2e-3)
    assert large["unknowns"] > 1e6 and small["unknowns"] > 1e5
    assert large["verdict"] == small["verdict"] == "converged"
    assert large["memory.peak"] <= 1600 * large["unknowns"]
    assert large["sweeps"] / large["cycles"] <= 1.5 * small["sweeps"] / small["cycles"]
    assert its_large <= 1.3 * its_small, (its_small, its_large)
