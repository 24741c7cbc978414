"""abut -list and abut -explain: what there is, what a scene would make, and where its keys are from"""
import os, subprocess, tempfile

from abut import BUILD, LAYERS, PROGRAM, run, run_error


def say(*words, ranks=1):
    with tempfile.TemporaryDirectory() as folder:
        command = (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [PROGRAM, *words]
        result = subprocess.run(command, capture_output=True, text=True, cwd=folder)
        assert result.returncode == 0 and not result.stderr, result.stdout + result.stderr
        assert not os.listdir(folder), "nothing is written"
        return result.stdout


def keys(text):
    """value and source of every key"""
    lines = text[text.index("keys in force") :].splitlines()[1:]
    return {line.split()[0]: line.split(None, 2)[1:] for line in lines}


def test_the_list_names_all_types_and_their_files():
    text = say("-list")
    lines = {line.split()[0]: line for line in text.splitlines() if line.startswith("  ")}
    for name in "fembem", "zz", "residual":
        assert lines[name].endswith(f"[{os.path.realpath(BUILD)}/lib/libestimator_{name}.so]") and len(lines[name].split()) > 5, lines[name]
    for name in "ddactive", "ddneumann", "threshold", "equal", "doerfler":
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


def test_a_key_that_nobody_reads_is_an_error_here_too():
    for words in ((LAYERS, "-explain -adaptor_treshold 0.2"), (None, "-list -adaptor_treshold 0.2")):
        line = run_error(*words)
        assert "adaptor_treshold" in line and "nothing in this scene reads" in line, line
