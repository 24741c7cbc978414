"""Load steps: factors of all that is prescribed, one after the other. Without friction contact keeps no memory: every step has the answer that its factor alone has.

Two blocks pressed evenly have p = (f closure - gap)/(H1/E1' + H2/E2' + theta) or none at factor f; layers are compared with runs of one step.
"""
import os, tempfile

from abut import ROOT, case, read_csv, run

YOUNG, NU, CLOSURE, GAP, PENALTY = 2.1e5, 0.3, 1e-3, 2e-4, 0.05
BLOCKS = f"""-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top
-lower_mesh_box 0,0,4,1 -lower_mesh_cells 8,2 -lower_material_young {YOUNG} -lower_material_poisson {NU} -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
-upper_mesh_box 0,1,4,2 -upper_mesh_cells 6,2 -upper_material_young {YOUNG} -upper_material_poisson {NU} -upper_bc_left_u1 0
-upper_mesh_shape triangle -mid_pair_penalty {PENALTY} -snes_rtol 1e-12"""
LAYERS = os.path.join(ROOT, "examples", "studies", "accuracy", "layers_exact.yml")
FACTORS = 0.5, 1, 0.1, 0, -1, 2, 1, 0.25


def steps(scene, factors, *options, ranks=1, expect=0):
    """The record, and the last cycle of every step"""
    with tempfile.TemporaryDirectory() as folder:
        given = f"-scene_load_steps {','.join(map(str, factors))} -record_csv {folder}/cycles.csv"
        record = run(scene, *options, given, ranks=ranks, expect=expect)
        rows = read_csv(f"{folder}/cycles.csv")
    last = list({row["step"]: row for row in rows}.values())
    assert [row["load_factor"] for row in last] == list(factors[: len(last)]) and record["steps"] == len(factors)
    assert (record["step"], record["load_factor"]) == (last[-1]["step"], last[-1]["load_factor"])
    return record, last


def test_blocks_have_the_pressure_of_the_formula_at_every_factor():
    """Pressed by a displacement, across a gap that stays; and by a traction, on a block that floats"""
    scale = CLOSURE / ((2 * (1 - NU**2) + PENALTY) / YOUNG)
    worst = 0
    for ranks in 1, 3:
        _, rows = steps(None, FACTORS, BLOCKS, f"-upper_bc_top_u2 {-CLOSURE} -mid_pair_gap {GAP}", ranks=ranks)
        for row in rows:
            exact = max(0, row["load_factor"] - GAP / CLOSURE) * scale
            worst = max(worst, abs(row["pair.mid.force"] / 4 - exact) / scale, abs(row["pair.mid.pressure_max"] - exact) / scale)
            assert exact > 0 or row["pair.mid.force"] == 0, row
        _, rows = steps(None, (0.5, 2, 0.1, 3), BLOCKS, "-upper_bc_top_t2 -1 -mid_pair_gap 0", ranks=ranks)
        for row in rows:
            worst = max(worst, abs(row["pair.mid.force"] / 4 - row["load_factor"]), abs(row["pair.mid.pressure_max"] - row["load_factor"]))
    case("V01", "pressures off the closed form at every load factor", worst, 1e-8)


def test_the_path_does_not_matter():
    """Layers, up, down, to zero and up; every factor as in a run of its own, with every loop"""
    common = "-adaptor_target 0.9 -adaptor_follow no -mid_pair_penalty 0.05 -snes_rtol 1e-11"
    worst = 0
    for loop in "ddactive", "anderson":
        _, rows = steps(LAYERS, (0.5, 1, 0.1, 0, 1, -1, 0.5), common, f"-snes_type {loop}")
        for row in rows:
            factor = row["load_factor"]
            alone = run(LAYERS, common, f"-upper_bc_top_u2 {-1.366e-3 * factor}") if factor > 0 else {}
            for key in "force", "pressure_max", "contact_edge", "penetration_max":
                exact = alone.get(f"pair.mid.{key}", 0)
                worst = max(worst, abs(row[f"pair.mid.{key}"] - exact) / (abs(exact) or 1))
            assert factor > 0 or loop != "ddactive" or row["pair.mid.force"] == 0, row
            assert factor or loop != "ddactive" or row["energy.strain"] == 0, row
    case("H27", "force, pressure and edge at each factor off those of a run of its own", worst, 1e-8)


def test_the_path_does_not_matter_on_meshes_that_adapt():
    """The first round makes the meshes, on which the later ones reach the same factors from above and from below"""
    worst = 0
    for options, ranks in ("-adaptor_target 1e-2", 1), ("-adaptor_target 1e-2", 3), ("-adaptor_target 2e-3 -adaptor_follow no", 1):
        record, rows = steps(LAYERS, (0.5, 1, 0.5, 1, 0, 1, 0.5, 0, 0.5), options, "-snes_rtol 1e-10", ranks=ranks)
        by_factor = {}
        for row in rows[2:]:
            assert row["unknowns"] == rows[2]["unknowns"] and row["verdict"] == "converged", row
            first = by_factor.setdefault(row["load_factor"], row)
            for key in "force", "pressure_max", "contact_edge":
                worst = max(worst, abs(row[f"pair.mid.{key}"] - first[f"pair.mid.{key}"]) / (abs(first[f"pair.mid.{key}"]) or 1))
            assert row["load_factor"] or row["pair.mid.force"] == row["energy.strain"] == row["error.discretisation"] == 0, row
        assert rows[0]["unknowns"] > 340 and record["cycles"] > len(rows)
    case("H27", "the same on meshes that adapt, from above and from below", worst, 1e-8)


def test_meshes_settle_at_the_edges_of_every_step():
    """Also where a step refines nothing: its first solve finds the edges, its second one has a vertex there"""
    with tempfile.TemporaryDirectory() as folder:
        run(LAYERS, "-adaptor_target 2e-3 -adaptor_settle", f"-scene_load_steps 1,0.8,1,0.8 -record_csv {folder}/cycles.csv")
        rows = read_csv(f"{folder}/cycles.csv")
    for step in 1, 2, 3, 4:
        first, last = [row for row in rows if row["step"] == step][-2:]
        assert first["unknowns"] == last["unknowns"] and first["pair.mid.contact_edge"] != last["pair.mid.contact_edge"], step


def test_one_step_of_factor_one_is_the_scene_without_steps():
    options = "-adaptor_target 1e-2"
    alone, (one, _) = run(LAYERS, options), steps(LAYERS, (1,), options)
    added = {"steps", "step", "load_factor"}
    assert set(one) == set(alone) | added and not added & set(alone)
    assert all(one[key] == value for key, value in alone.items() if not key.startswith(("time.", "memory")))


def test_relative_estimates_do_not_depend_on_the_factor():
    """A body without contact under tractions and displacements: all is linear, and every estimator is told of the tractions that act"""
    body = f"""-scene_bodies lower -lower_mesh_box 0,0,2,1 -lower_mesh_cells 6,3 -lower_material_young {YOUNG} -lower_material_poisson {NU}
    -lower_bc_left_u1 1e-3*y -lower_bc_left_u2 0 -lower_bc_right_t1 40*y^2 -lower_bc_top_t2 -30*x^3"""
    for estimator in "fembem", "zz", "residual":
        _, rows = steps(None, (1, 2, -3, 1e-3), body, f"-estimator_type {estimator}")
        for row in rows:
            assert abs(row["eta.lower"] / rows[0]["eta.lower"] - 1) < 1e-8 and row["eta.lower"] > 0.01, (estimator, row["eta.lower"])
            assert abs(row["energy.strain"] / rows[0]["energy.strain"] / row["load_factor"] ** 2 - 1) < 1e-8


def test_a_step_that_fails_ends_the_run():
    record, rows = steps(LAYERS, (0.5, 1, 0.25), "-adaptor_target 0.9 -snes_max_it 3 -mid_pair_penalty 0.05 -snes_type ddneumann", expect=2)
    assert record["verdict"] == rows[-1]["verdict"] == "max_iterations" and len(rows) == record["step"] == 1
    assert record["pair.mid.force"] > 0


def test_a_limit_is_said_at_the_end():
    record, rows = steps(LAYERS, (1, 0, 0.5), "-adaptor_target 1e-2 -adaptor_max_level 1 -adaptor_follow no", expect=3)
    assert [row["verdict"] for row in rows] == ["limit_level", "converged", "limit_level"] and record["verdict"] == "limit_level"
    record, rows = steps(LAYERS, (1, 0), "-adaptor_target 1e-2 -adaptor_max_level 1 -adaptor_follow no", expect=3)
    assert record["verdict"] == "limit_level"
