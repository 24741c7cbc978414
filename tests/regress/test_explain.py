"""abut -list and abut -explain: what there is, what a scene would make, and where its keys are from"""
import os, subprocess, tempfile

from abut import BUILD, LAYERS, PROGRAM, run, run_error


def say(*words, ranks=1, **environment):
    with tempfile.TemporaryDirectory() as folder:
        command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [PROGRAM, *words]
        result = subprocess.run(command, capture_output=True, text=True, cwd=folder, env={**os.environ, **environment})
        assert result.returncode == 0 and not result.stderr, result.stdout + result.stderr
        assert not os.listdir(folder), "nothing is written"
        return result.stdout


def keys(text):
    """value and source of every key"""
    lines = text[text.index("keys that are given or read") :].splitlines()[1:]
    return {line.split()[0]: line.split(None, 2)[1:] for line in lines}


def test_the_list_names_all_types_and_their_files():
    text = say("-list")
    lines = {line.split()[0]: line for line in text.splitlines() if line.startswith("  ")}
    for name in "fembem", "zz", "residual":
        assert lines[name].endswith(f"[{os.path.realpath(BUILD)}/lib/libestimator_{name}.so]") and len(lines[name].split()) > 5, lines[name]
    for name in "gravity", "force", "pressure", "spring", "overlap", "ddactive", "ddneumann", "threshold", "equal", "doerfler":
        assert lines[name].endswith(f"[{os.path.realpath(BUILD)}/lib/libabut.so]"), lines[name]
    assert "libpetsc" in lines["anderson"] and say("-list", ranks=2) == text


def test_an_explained_scene_is_not_solved():
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "record")
        text = say(LAYERS, "-explain", "-record", file, "-upper_mesh_cells", "16,4")
        assert not os.path.exists(file) and "verdict" not in text
        record = run(LAYERS, "-upper_mesh_cells 16,4 -adaptor_max_level 0", expect=None)
        assert f"scene of 2 bodies and 1 pairs, {record['unknowns']:.0f} unknowns" in text
        assert keys(say(LAYERS, "-explain", ranks=2)) == keys(say(LAYERS, "-explain"))


def test_where_keys_are_from():
    with tempfile.TemporaryDirectory() as folder:
        more = os.path.join(folder, "more.opts")
        with open(more, "w") as f:
            f.write("-adaptor_threshold 0.2\n-adaptor_max_level 3\n-lower_ksp_type cg\n")
        said = keys(say(LAYERS, "-options_file", more, "-adaptor_max_level", "4", "-explain"))
        assert said["adaptor_max_level"] == ["4", "command line"]
        assert said["adaptor_threshold"] == ["0.2", more] and said["lower_ksp_type"] == ["cg", more]
        assert said["lower_mesh_cells"] == ["8,2", LAYERS] and said["adaptor_jump"] == ["1", "default"]


def test_what_a_tolerance_puts_aside_is_listed_as_it_was_given():
    text = say(LAYERS, "-explain", "-scene_tol", "0.1")
    assert keys(text)["snes_ddneumann_gamma"][0] == "0.02" and "put aside" in text and "type: equal" in text
    assert any(line.split() == "adaptor_follow from order 2 on default".split() for line in text.splitlines())


def test_keys_from_elsewhere():
    assert keys(say(LAYERS, "-explain", PETSC_OPTIONS="-adaptor_max_level 5"))["adaptor_max_level"] == ["5", "PETSC_OPTIONS or .petscrc"]
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "scene.opts")
        with open(file, "w") as f:
            f.write("-explain\n")
        assert "explain: belongs on the command line" in run_error(LAYERS, "-options_file", file)
    assert "list: says what any scene may choose from" in run_error(LAYERS, "-list")
    assert "warning: pair mid: at first the sides overlap, by 0.0001" in say(LAYERS, "-explain", "-mid_pair_gap", "0-1e-4")


def test_a_key_that_nobody_reads_is_an_error_here_too():
    for words in ((LAYERS, "-explain -adaptor_treshold 0.2"), (None, "-list -adaptor_treshold 0.2")):
        line = run_error(*words)
        assert "adaptor_treshold" in line and "nothing in this scene reads" in line, line
