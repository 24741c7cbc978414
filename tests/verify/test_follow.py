"""Meshes that move with the edge of the contact: a vertex of both sides lies on the edge that the last meshes gave. Where it is on two layers was computed without Abut,
see examples/layers/reference.json."""
import os, tempfile

from abut import LAYERS, read_csv, run

A, P, P0 = 0.9926420758, 126.5738901, 166.2024335


def follow(*options, adaptor="type: doerfler, target: 0.03", moves=", follow: true", ranks=1):
    """A run of the scene with exact contact: its cycles, and the x of the nodes of both sides on the last meshes, with the pressures"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.yml")
        with open(LAYERS) as old, open(path, "w") as new:
            new.writelines(line for line in old if not line.startswith(("adaptor:", "estimator:", "snes:")))
            new.write(f"adaptor: {{{adaptor}{moves}}}\n")
        files = f"-record_csv {folder}/run.csv -output_profile {folder}/profile.csv"
        r = run(path, "-mid_pair_penalty 0 -upper_mesh_cells 8,2 -upper_mesh_shape quad -estimator_type zz", *options, files, ranks=ranks)
        cycles, profile = read_csv(f"{folder}/run.csv"), read_csv(f"{folder}/profile.csv")
    assert r.get("pair.mid.tied") == cycles[-1].get("pair.mid.tied")
    pressures = sorted((row["x"], row["pressure"]) for row in profile if row["side"] == "pressure")
    return cycles, [sorted(row["x"] for row in profile if str(row["side"]) == side) for side in ("1", "2")], pressures


def test_a_vertex_of_both_sides_lies_on_the_edge():
    for shape in ("quad", "triangle"):
        for penalty in (0, 0.05):
            cycles, sides, _ = follow(f"-lower_mesh_shape {shape} -upper_mesh_shape {shape} -mid_pair_penalty {penalty}")
            assert [row["pair.mid.tied"] for row in cycles] == [0] + [2] * (len(cycles) - 1) and len(cycles) > 4, cycles
            before, last = (row["pair.mid.contact_edge"] for row in cycles[-2:])
            for nodes in sides:
                vertex = min(nodes, key=lambda node: abs(node - before))
                assert abs(vertex - before) < 1e-9, (shape, penalty, nodes, before)
                assert nodes[0] == 0 and nodes[-1] == 4, nodes
                h = min(b - a for a, b in zip(nodes, nodes[1:]))
                assert h < 0.05 and abs(vertex - last) < (1 if penalty else 0.2) * h, (shape, penalty, h, vertex, last)
                assert penalty or abs(last - A) < 0.2 * h, (shape, last)


def test_the_edge_converges():
    cycles, _, _ = follow(adaptor="type: doerfler, target: 0.01, bulk: 0.7, jump: 2")
    error = [abs(row["pair.mid.contact_edge"] - A) for row in cycles]
    assert error[0] > 0.05 and max(error[-2:]) < 5e-4, error


def test_high_orders_follow_by_default_and_gain_by_it():
    """With a few thousand unknowns, errors of the force that meshes which stay leave behind"""
    for order, target, unknowns, force, pressure in ((3, 1.2e-3, 2500, 1e-5, 1e-4), (4, 2.5e-4, 4000, 5e-7, 1e-5)):
        options = f"-lower_mesh_order {order} -upper_mesh_order {order} -estimator_type residual"
        last = []
        for moves in ("", ", follow: false"):
            cycles, _, _ = follow(options, adaptor=f"type: doerfler, target: {target}", moves=moves)
            last.append(cycles[-1])
        assert last[0]["pair.mid.tied"] == 2 and "pair.mid.tied" not in last[1], last
        error = [abs(row["pair.mid.force"] / P - 1) for row in last]
        assert last[0]["unknowns"] < unknowns and error[0] < force, (order, last[0]["unknowns"], error)
        assert error[0] < error[1] / 4 and last[0]["unknowns"] < 1.2 * last[1]["unknowns"], (order, error)
        assert abs(last[0]["pair.mid.pressure_max"] / P0 - 1) < pressure, (order, last[0]["pair.mid.pressure_max"])
        assert abs(last[0]["pair.mid.contact_edge"] - A) < 0.005 * last[0]["body.lower.hmin"], (order, last[0]["pair.mid.contact_edge"])


def test_meshes_that_settle():
    """Every mesh is solved twice, and the vertex of the second one lies where the first one found the edge; the tolerance counts for the
    second. To 3e-3 the second mesh is good enough, and there would be nothing to compare."""
    adaptor = "type: doerfler, target: 2e-3, bulk: 0.7, jump: 3"
    order = "-lower_mesh_order 3 -upper_mesh_order 3"
    once, twice = (follow(order, adaptor=adaptor, moves=f", settle: {settle}") for settle in ("no", "yes"))
    cells = [row["body.lower.cells"] for row in twice[0]]
    assert len(cells) % 2 == 0 and cells[::2] == cells[1::2] and len(set(cells)) == len(cells) // 2 > 2, cells
    assert [row["pair.mid.tied"] for row in twice[0]] == [0] + [2] * (len(cells) - 1), twice
    found = twice[0][-2]["pair.mid.contact_edge"]
    for nodes in twice[1]:
        assert min(abs(node - found) for node in nodes) < 1e-9, (nodes, found)
    # of the second mesh, whose cells at the edge are three levels finer: how far the tied vertex, which the solve before found, is from the edge
    miss = once[0][0]["pair.mid.contact_edge"] - A, twice[0][2]["pair.mid.contact_edge"] - A
    assert abs(miss[1]) < abs(miss[0]) / 10, miss


def test_meshes_that_have_no_edge_to_settle_at_are_solved_once():
    punch = os.path.join(os.path.dirname(LAYERS), "..", "punch", "punch.yml")
    orders = "-base_mesh_order 2 -punch_mesh_order 2"
    once, twice = (run(punch, orders, f"-adaptor_settle {settle}", expect=None) for settle in ("no", "yes"))
    assert once["cycles"] == twice["cycles"], (once["cycles"], twice["cycles"])


def test_several_edges_on_one_side():
    """Two bumps, mirror images at x = 2: four edges on each side"""
    cycles, sides, pressures = follow("-mid_pair_gap", "1e-3*min((x-1.1)^2,(x-2.9)^2)+2e-4", "-upper_bc_top_u2 -0.6e-3", "-upper_mesh_cells 16,4 -lower_mesh_cells 12,3")
    assert [row["pair.mid.tied"] for row in cycles[2:]] == [8] * (len(cycles) - 2), cycles
    runs = []  # of closed nodes: where each ends, on the side with the pressures
    for x, p in pressures:
        if p > 0:
            runs = runs if runs and runs[-1][2] else runs + [[x, x, True]]
            runs[-1][1] = x
        elif runs:
            runs[-1][2] = False
    assert len(runs) == 2, runs
    for nodes in sides:
        assert all(b - a > 2e-3 for a, b in zip(nodes, nodes[1:])), nodes


def test_a_mesh_that_is_not_refined_moves_all_the_same():
    """The upper body is too stiff to have an error that counts"""
    cycles, sides, _ = follow("-upper_material_young 2e8 -upper_mesh_cells 10,3")
    assert cycles[-1]["body.upper.cells"] == 30 and cycles[-1]["pair.mid.tied"] == 2, cycles[-1]
    for nodes in sides:
        assert min(abs(node - cycles[-2]["pair.mid.contact_edge"]) for node in nodes) < 1e-9, (nodes, cycles[-2])


def test_traces_cross_over_to_moved_meshes():
    """A loop that begins with the last trace ends where one does that begins anew, in fewer sweeps"""
    loop = "-snes_type ddneumann -snes_ddneumann_gamma 0 -snes_ddneumann_start zero -mid_pair_penalty 0.5 -adaptor_max_level 3"
    warm, cold = (follow(loop, more, adaptor="type: doerfler, target: 0.06")[0] for more in ("-scene_cold false", "-scene_cold true"))
    assert len(warm) == len(cold) > 3
    for a, b in zip(warm[1:], cold[1:]):
        assert abs(a["pair.mid.force"] / b["pair.mid.force"] - 1) < 1e-6, (a, b)
        assert a["sweeps_cycle"] < b["sweeps_cycle"] - 5, (a["sweeps_cycle"], b["sweeps_cycle"])


def test_any_number_of_ranks_makes_the_same_meshes():
    for shape in ("quad", "triangle"):
        runs = [follow(f"-upper_mesh_shape {shape}", adaptor="type: doerfler, target: 0.06, jump: 2", ranks=ranks) for ranks in (1, 2, 3, 4)]
        for cycles, sides, _ in runs[1:]:
            assert len(cycles) == len(runs[0][0]) and [len(nodes) for nodes in sides] == [len(nodes) for nodes in runs[0][1]]
            assert all(abs(a - b) < 1e-8 for one, other in zip(sides, runs[0][1]) for a, b in zip(one, other)), (sides, runs[0][1])
            assert abs(cycles[-1]["pair.mid.force"] / runs[0][0][-1]["pair.mid.force"] - 1) < 1e-8


def test_by_default_nothing_moves_at_order_1():
    r = run(LAYERS, "-adaptor_threshold 0.3 -upper_mesh_cells 8,2 -estimator_type zz -snes_type ddactive")
    assert "pair.mid.tied" not in r and r["cycles"] > 1, r
