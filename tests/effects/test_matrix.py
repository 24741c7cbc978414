"""Only the effects that a scene calls for: every effect, switched on in a base scene, brings its own event to PETSc's log, which then counts above 0, and
no other; one that amounts to nothing leaves the record as it was, to the last bit.

One row of EFFECTS an effect: its type, its event, its keys, and keys with which it amounts to nothing, if there are any. What only says how a body is to be
read has no event. A new effect adds a row.
"""
import collections, os, re, subprocess, tempfile

from abut import PROGRAM, ROOT, run_error

BLOCKS = """-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -snes_rtol 1e-9
    -lower_mesh_box 0,0,4,1 -lower_mesh_cells 8,2 -lower_material_young 2e5 -lower_material_poisson 0.3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
    -upper_mesh_box 0,1,4,2 -upper_mesh_cells 6,2 -upper_material_young 2e5 -upper_material_poisson 0.3 -upper_bc_left_u1 0 -upper_bc_top_u2 -1e-3"""
Effect = collections.namedtuple("Effect", "type event keys nothing")
EFFECTS = [
    Effect("gravity", "AbutGravity", "-e_effect_density 2e-3", "-e_effect_acceleration 0,0"),
    Effect("force", "AbutForce", "-e_effect_f1 1e-3*y", "-e_effect_f1 0*y"),
    Effect("pressure", "AbutPressure", "-e_effect_bodies lower -e_effect_side right -e_effect_pressure 3", "-e_effect_pressure 0*x"),
    Effect("spring", "AbutSpring", "-e_effect_bodies lower -e_effect_side right -e_effect_normal 1e3", None),
    Effect("overlap", "AbutOverlap", "-e_effect_bodies upper -e_effect_side bottom -e_effect_depth 1e-4", "-e_effect_depth 0"),
    Effect("thermal", "AbutThermal", "-e_effect_temperature 3+y -e_effect_expansion 1e-5", "-e_effect_temperature 0"),
    Effect("plane_stress", None, "-e_effect_bodies lower", None),
    Effect("axisymmetric", None, "", None),
]
TIMES = re.compile("^(time|memory)[.]")


def solve(*options):
    """Events with their counts, objects with theirs, the most bytes at a time, and the record without its times"""
    with tempfile.TemporaryDirectory() as folder:
        log, record = os.path.join(folder, "log"), os.path.join(folder, "record")
        command = [PROGRAM, *BLOCKS.split(), *(word for option in options for word in option.split()), "-record", record, "-log_view", f":{log}"]
        done = subprocess.run([*command, "-malloc_debug", "-memory_view"], cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        with open(log) as f:
            text = f.read()
        with open(record) as f:
            record = [line for line in f if not TIMES.match(line)]
    events = {name: int(count) for name, count in re.findall(r"^(\w+) +(\d+) 1\.0 ", text, re.M)}
    objects = {name.strip(): int(count) for name, count in re.findall(r"^ +(\w[\w ]*?) +(\d+) +\d+ *$", text, re.M)}
    (memory,) = re.findall(r"Maximum .* space PetscMalloc\(\)ed: +total (\S+)", done.stdout)
    return events, objects, float(memory), record


def difference(one, other):
    """What is in one and not in the other, or counts otherwise there"""
    return {key: (other.get(key, 0), one.get(key, 0)) for key in {**one, **other} if one.get(key, 0) != other.get(key, 0)}


def name(effect):
    return f"-scene_effects e -e_effect_type {effect.type} {effect.keys}"


def test_an_effect_brings_its_own_event_and_no_other_effect():
    base = solve()
    print(f"{'effect':14} {'its event':18} {'count':>6} {'bytes':>8}  objects that it makes beside itself")
    assert not {effect.event for effect in EFFECTS} & set(base[0]) and "Abut Effect" not in base[1], base
    for effect in EFFECTS:
        events, objects, memory, record = solve(name(effect))
        made = {key: after - before for key, (before, after) in difference(objects, base[1]).items() if key != "Abut Effect"}
        print(f"{effect.type:14} {effect.event or '':18} {events.get(effect.event, 0):6} {memory - base[2]:8.0f}  {made}")
        assert {event for event in set(events) ^ set(base[0]) if event.startswith("Abut")} == {effect.event} - {None}, (events, base[0])
        assert (not effect.event or events[effect.event] > 0) and objects["Abut Effect"] == 1
        assert record != base[3], f"{effect.type} acted on nothing"


def test_an_effect_that_amounts_to_nothing_changes_nothing():
    base = solve()
    for effect in EFFECTS:
        if effect.nothing is None:
            continue
        events, _, _, record = solve(name(effect), effect.nothing)
        assert events[effect.event] > 0 and record == base[3], (effect.type, [pair for pair in zip(record, base[3]) if pair[0] != pair[1]])


def test_keys_of_an_effect_that_the_scene_does_not_name_are_errors():
    for effect in EFFECTS:
        line = run_error(None, *BLOCKS.split(), *f"-e_effect_type {effect.type} {effect.keys}".split())
        assert all(word[1:] in line for word in effect.keys.split() if word.startswith("-e_")) and "nothing in this scene reads " in line, line
        assert "e_effect_type" in line, line


def test_two_effects_of_a_type_share_its_event():
    events = solve("-scene_effects a,b -a_effect_type gravity -a_effect_density 1e-3 -b_effect_type gravity -b_effect_density 1e-3")[0]
    assert events["AbutGravity"] == 2 * solve(name(EFFECTS[0]))[0]["AbutGravity"], events
