"""Stacks of layers, all between the lowest and the highest held by contact alone: see examples/stack.

Lengths in cm, stresses in MPa, the half model, per cm of depth; bilinear, n cells per cm.
"""
import functools, os, subprocess, sys, tempfile

from abut import ROOT, case, run, run_error

STACK = os.path.join(ROOT, "examples", "stack")
sys.path.insert(0, STACK)
from stack import CLOSURE, scene  # noqa: E402


def solve(text, *options, **keys):
    with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
        file.write(text)
        file.flush()
        return run(file.name, *options, **keys)


@functools.lru_cache(None)
def stack(layers, cells=16, penalty=0, *options):
    record = solve(scene(layers, cells, penalty), *options)
    print(f"{layers} layers, h = 1/{cells}, c = {penalty}: {record['sweeps']} sweeps, P {record['pair.between1.force']}")
    return record


def forces(record):
    return [value for key, value in record.items() if key.startswith("pair.") and key.endswith(".force")]


def same(values, tolerance):
    return max(values) - min(values) <= tolerance * max(abs(value) for value in values)


def test_sweeps_do_not_grow_with_the_number_of_layers():
    for penalty in 0, 0.05:
        assert same(forces(stack(20, 16, penalty)), 1e-8)
        sweeps = {layers: stack(layers, 16, penalty)["sweeps"] for layers in (2, 3, 5, 10, 20)}
        assert all(sweeps[layers] <= 12 for layers in (2, 3, 5, 10)) and sweeps[20] <= 16, sweeps
        assert sweeps[20] <= 1.5 * sweeps[3], sweeps


def test_all_interfaces_carry_the_same_force():
    for layers in 3, 5, 10:
        record = stack(layers)
        assert len(forces(record)) == layers - 1 and same(forces(record), 1e-8), forces(record)
        assert record["check.balance"] < 1e-8 and record["check.energy"] < 1e-8


def test_a_stack_of_two_is_the_scene_of_the_layers():
    assert abs(stack(2)["pair.between1.force"] / 126.57389014 - 1) < 3e-4
    assert abs(stack(2, 16, 0.05)["pair.between1.force"] / 123.078421 - 1) < 7e-4


def test_forces_of_three_and_five_layers():
    """From a program of its own, with dense compliances and lumped gaps on the same meshes"""
    for layers, penalty, force in (3, 0.05, 161.207), (5, 0.05, 190.987), (3, 5e-4, 167.161), (5, 5e-4, 199.435):
        record = stack(layers, 32, penalty)
        assert abs(record["pair.between1.force"] / force - 1) < 1e-3, (layers, penalty, record["pair.between1.force"])


def test_many_layers_approach_a_stack_without_end():
    """There one interface is that of two layers of half the height; what the supports take away is shared by N"""
    text = scene(2)
    for old, new in ("0,0,4,1", "0,0,4,0.5"), ("0,1,4,2", "0,0.5,4,1"), ("64,16", "64,8"):
        assert old in text
        text = text.replace(old, new)
    end = solve(text)["pair.between1.force"]
    missing = [layers * (1 - stack(layers)["pair.between1.force"] / end) for layers in (5, 10)]
    print(f"{end}: N (1 - P/P_end)", missing)
    assert same(missing, 0.02), missing


def thin_middle(n, penalty=0):
    """Layers of 1, 0.5 and 1; the middle one floats"""
    text = scene(3, n, penalty)
    changes = ("0,1,4,2", "0,1,4,1.5"), ("0,2,4,3", "0,1.5,4,2.5"), (f"{-2 * CLOSURE:.10g}", "-2e-3")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    height = "-between1_pair_height 1" if penalty else ""  # of c H/E: that of the first layer of the pair, layer2, would be 0.5
    return solve(text, f"-layer2_mesh_cells {4 * n},{n // 2} {height}")


def test_a_thin_layer_in_the_middle_is_half_of_it_on_a_support():
    """By symmetry: layers of 1 and 0.25 and half the closure, on the halves of the same meshes"""
    for penalty in 0, 0.05:
        whole = thin_middle(16, penalty)
        text = scene(2, 16, penalty)
        for old, new in ("0,0,4,1", "0,0.75,4,1"), (f"{-CLOSURE:.10g}", "-1e-3"):
            assert old in text
            text = text.replace(old, new)
        half = solve(text, "-layer1_mesh_cells", "64,4")
        both = [*forces(whole), *forces(half)]
        print(f"c = {penalty}:", both, "sweeps", whole["sweeps"], half["sweeps"])
        assert len(both) == 3
        case("V14", f"forces of both sides and of the half off each other, c {penalty}", max(both) / min(both) - 1, 1e-8)
        for key in "pressure_max", "contact_edge", "active":
            assert same([whole[f"pair.between1.{key}"], whole[f"pair.between2.{key}"], half[f"pair.between1.{key}"]], 1e-7), key


def test_the_order_of_bodies_and_pairs_does_not_matter():
    turned = ["-scene_bodies layer2,layer4,layer5,layer1,layer3", "-scene_pairs between3,between1,between4,between2"]
    record = solve(scene(5, 8), *turned)
    assert same([*forces(record), *forces(stack(5, 8))], 1e-8)


def test_ranks_do_not_matter():
    record = solve(scene(5, 8), ranks=3)
    assert same([*forces(record), *forces(stack(5, 8))], 1e-8) and record["sweeps"] == stack(5, 8)["sweeps"]


def test_meshes_that_differ_from_layer_to_layer():
    """The layers in the middle are balanced whatever the meshes are"""
    record = solve(scene(4, 16), "-layer2_mesh_cells 48,12", "-layer3_mesh_cells 80,20 -layer3_mesh_shape triangle")
    assert same(forces(record), 1e-8) and abs(forces(record)[0] / stack(4)["pair.between1.force"] - 1) < 3e-3


def test_other_loops_refuse_a_layer_that_nothing_holds():
    with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
        file.write(scene(3, 4, 0.05))
        file.flush()
        for loop in "ddneumann", "anderson":
            line = run_error(file.name, "-snes_type", loop)
            assert "layer2 is free in moving along y" in line and "ddactive" in line, line


def test_the_scene_of_the_example_is_what_its_script_writes():
    with open(os.path.join(STACK, "stack.yml")) as file:
        committed = file.read()
    script = os.path.join(STACK, "stack.py")
    written = subprocess.run([sys.executable, script, "3"], capture_output=True, text=True, check=True).stdout
    assert committed == written == scene(3)
    assert subprocess.run([sys.executable, script, "1"], capture_output=True).returncode
