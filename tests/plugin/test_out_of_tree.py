"""The template of an estimator, built outside the source tree: from the tree, from an installation, and what is said when something is wrong"""
import os, re, shutil, subprocess, tempfile

from abut import BUILD, LAYERS, PROGRAM, ROOT, run, run_error

SHORT = ("-upper_mesh_cells 32,8", "-adaptor_threshold 0.3", "-snes_ddneumann_gamma 0.05")
COMPILE = "mpicc -std=gnu99 -Wall -Wextra -Werror -fPIC -shared"


def call(*command, **more):
    result = subprocess.run(command, capture_output=True, text=True, **more)
    assert result.returncode == 0, f"{' '.join(command)}\n{result.stdout}{result.stderr}"
    return result.stdout


def build(folder, *options, **environment):
    """The template, copied into a folder and made there; gives the library"""
    place = os.path.join(folder, "mine")
    shutil.copytree(os.path.join(ROOT, "plugins", "template"), place)
    call("make", "-C", place, "CFLAGS=-O2 -Wall -Wextra -Werror", *options, env={**os.environ, **environment})
    return os.path.join(place, "libestimator_template.so")


def compile_plugin(folder, name, source):
    path = os.path.join(folder, f"lib{name}.so")
    with open(os.path.join(folder, f"{name}.c"), "w") as f:
        f.write(source)
    call(*COMPILE.split(), os.path.join(folder, f"{name}.c"), "-o", path)
    return path


def check(record):
    """It adapted by what the template said: its estimate is there, and of the size of the error of the last mesh"""
    assert record["verdict"] == "converged" and record["cycles"] > 1
    assert 0.03 < record["eta.lower"] < 0.15 and record["eta_max.lower"] <= 0.3


def test_built_against_the_source_tree():
    with tempfile.TemporaryDirectory() as folder:
        library = build(folder, f"ABUT_DIR={ROOT}")
        one = run(LAYERS, *SHORT, "-plugin", library, "-estimator_type template")
        two = run(LAYERS, *SHORT, "-plugin", library, "-estimator_type template", ranks=2)
        check(one)
        (line,) = [line for line in call(PROGRAM, "-list", "-plugin", library).splitlines() if line.startswith("  template")]
        assert line.endswith(f"[{os.path.realpath(library)}]") and "to copy" in line, line
        assert one["body.lower.cells"] == two["body.lower.cells"]
        assert abs(one["eta.lower"] / two["eta.lower"] - 1) < 1e-5


def test_built_against_an_installation():
    with tempfile.TemporaryDirectory() as folder:
        prefix = os.path.join(folder, "prefix")
        call("make", "-s", "install", f"B={BUILD}", f"PREFIX={prefix}", cwd=ROOT)
        paths = os.path.join(prefix, "lib", "pkgconfig") + ":" + os.environ.get("PKG_CONFIG_PATH", "")
        library = build(folder, PKG_CONFIG_PATH=paths)
        program = [os.path.join(prefix, "bin", "abut"), LAYERS, "-record", os.path.join(folder, "record")]
        program += [word for option in SHORT for word in option.split()]
        said = call(*program, "-plugin", library, "-estimator_type", "template", cwd=folder)
        assert "converged" in said
        call(*program, "-estimator_type", "zz", cwd=folder)  # the installed plugins are found as well


def test_found_by_name_in_the_folder_of_plugin_path():
    with tempfile.TemporaryDirectory() as folder:
        library = build(folder, f"ABUT_DIR={ROOT}")
        check(run(LAYERS, *SHORT, "-plugin_path", os.path.dirname(library), "-estimator_type template"))
        line = run_error(LAYERS, "-plugin_path", os.path.dirname(library), "-estimator_type zzz")
        assert line.startswith('abut: estimator_type: no estimator named "zzz"; there are: template (a plugin from elsewhere'), line


def said_once(record):
    """The line of a bad input on several ranks, without what mpiexec adds"""
    lines = [line for line in record.stderr.splitlines() if line.startswith("abut: ")]
    assert len(lines) == 1, record.stderr
    return lines[0]


def test_there_are_the_shipped_ones():
    line = said_once(run(LAYERS, "-estimator_type zzz", ranks=2, expect=1))
    assert line.startswith('abut: estimator_type: no estimator named "zzz"; there are: fembem, '), line
    files = r"\(a plugin from elsewhere is loaded with -plugin path/to/libestimator_NAME\.so; there is no (.*)/libestimator_zzz\.so, (.*)/abut/libestimator_zzz\.so\)"
    found = re.search(files, line)
    assert found and found[1] == found[2] and os.path.samefile(found[1], os.path.join(BUILD, "lib")), line


def test_wrong_plugins_are_named():
    with tempfile.TemporaryDirectory() as folder:
        line = run_error(LAYERS, "-plugin", os.path.join(folder, "libnone.so"))
        assert line == f'abut: plugin: no file "{folder}/libnone.so"', line

        dumb = compile_plugin(folder, "dumb", "int abut_dumb(void);\nint abut_dumb(void) { return 0; }\n")
        line = said_once(run(LAYERS, "-plugin", dumb, ranks=2, expect=1))
        assert line == f'abut: plugin: "{dumb}" is not a plugin of Abut: it has no function PetscDLLibraryRegister_dumb()', line

        hollow = "int abut_not_there(void);\nint PetscDLLibraryRegister_hollow(void);\n"
        hollow += "int PetscDLLibraryRegister_hollow(void) { return abut_not_there(); }\n"
        line = run_error(LAYERS, "-plugin", compile_plugin(folder, "hollow", hollow))
        assert line.startswith(f'abut: plugin: cannot open "{folder}/libhollow.so": ') and "abut_not_there" in line, line

        mute = "int PetscDLLibraryRegister_estimator_mute(void);\nint PetscDLLibraryRegister_estimator_mute(void) { return 0; }\n"
        compile_plugin(folder, "estimator_mute", mute)
        line = run_error(LAYERS, "-plugin_path", folder, "-estimator_type mute")
        assert line.startswith('abut: estimator_type: libestimator_mute.so was opened but registers no estimator "mute"'), line
