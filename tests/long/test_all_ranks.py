"""The scenes of tests/parallel/test_many_ranks.py on 2, 3, 4, 7, 13 and 16 ranks, and multigrid at 1.6 10^5 unknowns on one rank and on 16"""
import os, sys

from abut import LAYERS, ROOT

sys.path.append(os.path.join(ROOT, "tests", "parallel"))
import test_many_ranks, test_traffic  # noqa: E402


def test_the_paper_s_loop():
    test_many_ranks.paper(test_many_ranks.ALL)


def test_layers():
    test_many_ranks.layers(test_many_ranks.ALL)


def test_a_stack_of_five():
    test_many_ranks.stacked(test_many_ranks.ALL)


def test_hertz_from_gmsh():
    test_many_ranks.hertz(test_many_ranks.ALL)


def test_multigrid_of_a_hundred_thousand_unknowns():
    test_traffic.check_iterations("nine adapted meshes", test_traffic.TOL, "-scene_tol 3.9e-3 -estimator_type zz -adaptor_max_level 28")
    test_traffic.check_iterations("fine uniform mesh", LAYERS, test_traffic.UNIFORM, "-upper_mesh_cells 320,80 -lower_mesh_cells 320,80")
