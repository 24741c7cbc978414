"""Runs that are stopped and go on: -checkpoint, -restart. What a run that went on gives is that of the run that was not stopped: to the last digit on the same ranks,
to round-off on others."""

import os, random, re, shutil, signal, subprocess, sys, tempfile, time

from abut import LAYERS, PROGRAM, ROOT, case, read_csv, read_record, run, run_error

sys.path.insert(0, os.path.join(ROOT, "tests", "parallel"))
from same import farthest, read_values  # noqa: E402

EXACT = os.path.join(ROOT, "examples", "studies", "accuracy", "layers_exact.yml")
STACK = os.path.join(ROOT, "examples", "stack", "stack.yml")
FOLLOWED = (EXACT, "-lower_mesh_order 3 -upper_mesh_order 3 -adaptor_target 1e-3 -adaptor_jump 2 -adaptor_settle yes -adaptor_peak 1e-4")
TRIANGLES = (EXACT, "-lower_mesh_order 2 -upper_mesh_order 2 -lower_mesh_shape triangle -upper_mesh_cells 6,2 -adaptor_target 5e-3")
MERGED = (EXACT, "-lower_mesh_shape triangle -lower_mesh_cells 3,1 -upper_mesh_cells 3,1 -adaptor_jump 8 -adaptor_target 5e-3 -adaptor_coarsen 0.2")
GRADED = (EXACT, "-lower_mesh_cells 3,1 -lower_mesh_size 0.2+0.3*abs(x-1) -adaptor_target 5e-3")
INTERLEAVED = (LAYERS, "-adaptor_threshold 0.2 -scene_interleave yes -snes_type ddneumann")
STEPPED = (EXACT, "-adaptor_target 2e-2 -scene_load_steps 0.5,1,0,0.7,-1,1 -lower_ksp_type cg -lower_pc_type jacobi -lower_ksp_rtol 1e-10")
STAYING = (INTERLEAVED[0], INTERLEAVED[1] + " -scene_eps_u 5e-4 -upper_mesh_cells 16,4")  # whose last cycles are on the same meshes
COUNTED = re.compile(r"time\.|memory|imbalance|residual|balance|complementarity|penetration|check|error\.loop|error\.linear|slack")


def stopped(folder, scene, every=1, ranks=1):
    """The record of a run that writes checkpoints, and those of its cycles that it did not overwrite, by the cycle they go on with"""
    last = run(*scene, f"-checkpoint {folder}/last -checkpoint_every {every}", f"-record_csv {folder}/all.csv", ranks=ranks)
    return last, read_csv(f"{folder}/all.csv")


def same(one, other, tolerance):
    """Keys, and values: all of them to the last digit, or without those of round-off to a relative tolerance"""
    assert list(one) == list(other), set(one) ^ set(other)
    for key, value in one.items():
        if key.startswith(("time.", "memory")):
            continue
        if not tolerance or isinstance(value, str):
            assert value == other[key], (key, value, other[key])
        elif not COUNTED.search(key):
            assert abs(value - other[key]) <= tolerance * abs(value), (key, value, other[key])


def test_a_run_that_goes_on_ends_as_if_it_had_not_been_stopped():
    for scene in FOLLOWED, TRIANGLES, MERGED, GRADED, INTERLEAVED, STAYING:
        with tempfile.TemporaryDirectory() as folder:
            whole, cycles = stopped(folder, scene)
            assert len(cycles) > 4, cycles
            on = run(*scene, f"-restart {folder}/last -record_csv {folder}/on.csv")
            same(whole, on, 0)
            rows = read_csv(f"{folder}/on.csv")
            assert len(rows) == len(cycles)
            for row, before in zip(rows, cycles):
                same(before, row, 0)


def test_a_run_of_load_steps_goes_on_within_and_between_them():
    """From every cycle; and with steps to come that are others than the run began with"""
    with tempfile.TemporaryDirectory() as folder:
        whole, cycles = stopped(folder, STEPPED)
        steps = [row["step"] for row in cycles]
        assert len(set(steps)) == 6 and len(steps) > 8, steps
        for every in range(1, len(cycles)):
            stopped(folder, STEPPED, every=every)
            on = run(*STEPPED, f"-restart {folder}/last -record_csv {folder}/on.csv")
            same(whole, on, 0)
            for row, before in zip(read_csv(f"{folder}/on.csv"), cycles):
                same(before, row, 0)
        same(whole, run(*STEPPED, f"-restart {folder}/last", ranks=3), 1e-7)
        line = run_error(STEPPED[0], STEPPED[1].replace("0.5,1,0,0.7,-1,1", "0.5,1"), f"-restart {folder}/last")
        assert "restart: the checkpoint stands in load step 6, and scene_load_steps has 2" in line, line
        assert "scene_load_steps has 0" in run_error(EXACT, "-adaptor_target 2e-2", f"-restart {folder}/last")


def test_steps_without_an_adaptor_go_on():
    with open(LAYERS) as f, tempfile.TemporaryDirectory() as folder:
        fixed = f"{folder}/fixed.yml"
        with open(fixed, "w") as out:
            out.writelines(line for line in f if not line.startswith(("adaptor:", "estimator:", "snes:")))
        scene = (fixed, "-scene_load_steps 0.5,0,1")
        whole, _ = stopped(folder, scene)
        same(whole, run(*scene, f"-restart {folder}/last"), 0)


def test_on_any_number_of_ranks():
    for scene in FOLLOWED, TRIANGLES, MERGED:
        with tempfile.TemporaryDirectory() as folder:
            whole, _ = stopped(folder, scene, ranks=2)
            for ranks in 1, 2, 3, 4:
                same(whole, run(*scene, f"-restart {folder}/last", ranks=ranks), 1e-8)


def test_fields_that_went_on_are_those_of_the_whole_run():
    """To the last bit on one rank, to round-off on three"""
    bits, keys, off = 0, 0, 0
    for scene in FOLLOWED, TRIANGLES:
        with tempfile.TemporaryDirectory() as folder:
            whole = run(*scene, f"-checkpoint {folder}/last -output {folder}/whole.vtu")
            for ranks in 1, 3:
                on = run(*scene, f"-restart {folder}/last -output {folder}/on{ranks}.vtu", ranks=ranks)
                for file in os.listdir(folder):
                    if not file.startswith(f"on{ranks}_"):
                        continue
                    mine, other = f"{folder}/{file}", f"{folder}/whole{file[3:]}"
                    if ranks == 1:
                        bits += open(mine).read() != open(other).read()
                        keys = max(keys, sum(on[key] != whole[key] for key in whole if not key.startswith(("time.", "memory"))))
                    if file.endswith(".vtp"):
                        continue
                    moved, eta = map(farthest, read_values(mine), read_values(other))  # which need the same meshes
                    off = max(off, moved)
                    assert eta < 1e-10, (file, eta)  # of differences of stresses
                for key in "force", "pressure_max":
                    assert abs(on[f"pair.mid.{key}"] / whole[f"pair.mid.{key}"] - 1) < 1e-9, key
    case("H23", "fields and keys of the record that are not the same to the last digit", bits + keys, 0)
    case("H23", "displacements on 3 ranks from those of one, same meshes, over the largest", off, 1e-12)


def test_every_other_cycle():
    """The last checkpoint is that of an even cycle, and a run goes on from it with as many cycles as are left"""
    with tempfile.TemporaryDirectory() as folder:
        whole, cycles = stopped(folder, FOLLOWED, every=2)
        on = run(*FOLLOWED, f"-restart {folder}/last")
        first = next(int(line.split()[0]) for line in on.stdout.splitlines() if re.match(r" +\d+ +\d+ ", line))
        assert first % 2 == 1 and len(cycles) - 2 < first <= len(cycles), (first, len(cycles))
        same(whole, on, 0)


def test_a_run_that_is_killed_loses_no_cycle_that_it_has_finished():
    """At 20 moments of a run that takes some seconds: the checkpoint is there, goes on after the last cycle that was said to be finished or the one before,
    whose checkpoint was just being written, and ends as the run that was not killed"""
    scene = (EXACT, "-lower_mesh_order 2 -upper_mesh_order 2 -adaptor_target 6e-4 -adaptor_bulk 0.3")
    whole = run(*scene)
    command = [PROGRAM, "-options_file", scene[0], *scene[1].split()]
    start = time.time()
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    length, moments = time.time() - start, random.Random(5)
    gone_on = 0
    for k in range(20):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "TMPDIR": folder}
            with open(f"{folder}/said", "w") as said:
                process = subprocess.Popen(["stdbuf", "-oL", *command, "-checkpoint", f"{folder}/last"], stdout=said, env=environment)
                time.sleep(length * (0.2 + 0.8 * moments.random()))
                process.send_signal(signal.SIGKILL)
                process.wait()
            with open(f"{folder}/said") as said:
                finished = [int(line.split()[0]) for line in said if re.match(r" +\d+ +\d+ .*\d\n", line)]
            if not os.path.exists(f"{folder}/last"):
                assert len(finished) <= 1, finished
                continue
            on = run(*scene, f"-restart {folder}/last")
            first = next(int(line.split()[0]) for line in on.stdout.splitlines() if re.match(r" +\d+ +\d+ ", line))
            assert not finished or first >= finished[-1], (first, finished)
            same(whole, on, 0)
            gone_on += 1
    assert gone_on > 5, gone_on


def test_fields_and_rows_go_on_too():
    with tempfile.TemporaryDirectory() as folder:
        for scene, kind in (FOLLOWED, "xdmf"), (FOLLOWED, "vtu"), (STEPPED, "xdmf"), (STEPPED, "vtu"):
            out = f"-output {folder}/run.{kind}"
            run(*scene, out, f"-checkpoint {folder}/last")
            index = f"{folder}/run." + {"xdmf": "xdmf", "vtu": "pvd"}[kind]
            with open(index) as f:
                before = f.read()
            os.remove(index)
            run(*scene, out, f"-restart {folder}/last")
            with open(index) as f:
                assert f.read() == before, kind
            run(*scene, f"-output {folder}/other.{kind}", f"-restart {folder}/last")
            with open(f"{folder}/other." + index.split(".")[-1]) as f:
                cycles = re.findall(r"cycle_(\d+)\"|timestep=\"(\d+)\"", f.read())
            assert len(set(cycles)) == 1, cycles  # only the last one
            run(*scene, f"-restart {folder}/last")


def test_files_that_are_no_checkpoint_of_this_scene_are_refused():
    with tempfile.TemporaryDirectory() as folder:
        run(*FOLLOWED, f"-checkpoint {folder}/good")
        with open(f"{folder}/good", "rb") as f:
            good = f.read()
        size = len(good)
        bad = {
            "is cut off": [good[:20], good[: size // 2], good[:-1]],
            "is not a checkpoint": [b"", b"abc", open(EXACT, "rb").read()],
            "is damaged: its checksum does not fit": [good + b"x", good[: size // 2] + bytes([good[size // 2] ^ 1]) + good[size // 2 + 1 :]],
            "has version 2, and this program reads version 1": [good[:8] + b"\2" + good[9:]],
            "was written on a machine with another order of bytes": [good[:16] + good[16:24][::-1] + good[24:]],
        }
        accepted = 0
        for says, files in bad.items():
            for content in files:
                with open(f"{folder}/bad", "wb") as f:
                    f.write(content)
                line = run_error(*FOLLOWED, f"-restart {folder}/bad")
                print(line)
                accepted += f"restart: {folder}/bad {says}; give one that -checkpoint has written" not in line
        case("H23", "cut off, damaged and other files that were not refused for it", accepted, 0)
        for options, says in (
            ("-lower_mesh_cells 6,2", 'its mesh is "quads of order 3, 8 by 2 from 0,0 to 4,1" there and "quads of order 3, 6 by 2 from 0,0 to 4,1" here'),
            ("-upper_mesh_order 2", 'its mesh is "quads of order 3'),
        ):
            line = run_error(*FOLLOWED, options, f"-restart {folder}/good")
            assert "good is of another scene: " in line and says in line, line
        assert "restart: " in run_error(*FOLLOWED, f"-restart {folder}/nowhere")
        shutil.copy(f"{folder}/good", f"{folder}/again")
        run(*FOLLOWED, f"-restart {folder}/again -checkpoint {folder}/again")  # a run may write to the file it came from


def test_a_cold_run_leaves_no_traces_to_begin_with():
    with tempfile.TemporaryDirectory() as folder:
        cold = run(*TRIANGLES, f"-scene_cold -checkpoint {folder}/last")
        same(cold, run(*TRIANGLES, f"-scene_cold -restart {folder}/last"), 0)
        result = run(*TRIANGLES, f"-restart {folder}/last", expect=1)
        assert result.stderr == "abut: restart: the checkpoint has no traces to begin with; it was written with scene_cold: give that here, too\n", result.stderr


def test_keys_that_cannot_be():
    assert "checkpoint: the scene has no adaptor" in run_error(STACK, "-checkpoint /tmp/abut_checkpoint")
    assert "checkpoint_every: 0 is no number of cycles" in run_error(*FOLLOWED, "-checkpoint /tmp/abut_checkpoint -checkpoint_every 0")
    assert "checkpoint_every: nothing in this scene reads this key" in run_error(*FOLLOWED, "-checkpoint_every 2")
    assert "checkpoint: there is no folder" in run_error(*FOLLOWED, "-checkpoint nowhere/at/all")
