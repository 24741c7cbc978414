"""Only the effects that a scene calls for: the rows of matrix.py, the exact logs of one body and of the layers, and builds
from which something was taken"""
import glob, os, re, shlex, subprocess, tempfile, unittest

from abut import BUILD, LAYERS, ROOT
from matrix import APART, BENT, BLOCKS, BODY, ONE, PAPER, ROWS, Matrix, config, difference, run_all

EFFECTS = [row for row in ROWS if row.name.startswith("effect ")]
SOLVES = re.compile("^(Abut|SNES|EPS|KSP|PCSetUp|MatCholFctrNum)")


def log_of(measured, pattern=SOLVES):
    return {name: count for name, count in measured.events.items() if pattern.match(name)}


def test_every_row_brings_what_it_says_and_nothing_else():
    table, wrong = run_all(BUILD)
    print(table)
    assert not wrong, "\n".join(wrong)


def test_all_types_have_a_row():
    """What `abut -list` knows, and the plugins of the tree"""
    said = subprocess.run([os.path.join(BUILD, "bin", "abut"), "-list"], capture_output=True, text=True).stdout
    kinds = re.split(r"^(\w+), -.*\n", said, flags=re.M)[1:]
    types = {kind: set(re.findall(r"^  (\w+) ", text, re.M)) for kind, text in zip(kinds[::2], kinds[1::2])}
    for kind in "estimators", "effects", "adaptors":
        assert types[kind] and types[kind] <= {row.name.split()[1] for row in ROWS if row.name.startswith(kind[:-1])}, (kind, types)


def test_one_linear_body_is_one_solve():
    one = Matrix(BUILD).measure(ONE)
    solve = dict.fromkeys(("AbutBodyAssemble", "AbutBodySolve", "KSPSetUp", "KSPSolve", "PCSetUp", "MatCholFctrNum", "AbutWriteRecord"), 1)
    assert log_of(one) == solve, log_of(one)
    objects = {name: count for name, count in one.objects.items() if re.match("Abut|SNES|DMSNES|EPS|Krylov|Precond|Matrix Null", name)}
    mine = "Abut Scene", "Abut Body", "Abut Mesh", "Abut Interface", "Abut Recorder", "Krylov Solver", "Preconditioner", "Matrix Null Space"
    assert objects == dict.fromkeys(mine, 1), objects


def test_every_further_body_makes_the_same_objects():
    """What three bodies have more than two is what two have more than one: nothing is made for pairs of bodies that do not touch"""
    third = f"{BODY.format('c')} -c_mesh_box 9,0,13,1 -c_mesh_cells 8,2 -c_bc_bottom_u2 0 -c_bc_top_u2 -1e-3"
    second = third.replace("c_", "d_").replace("9,0,13,1", "20,0,24,1").replace("-d_bd_", "-d_bc_")
    scenes = ONE, f"{ONE} {third} -scene_bodies lower,c", f"{ONE} {third} {second} -scene_bodies lower,c,d"
    one, two, three = (Matrix(BUILD).measure(scene) for scene in scenes)
    assert difference(two.objects, one.objects) == difference(three.objects, two.objects) != {}
    assert difference(log_of(two), log_of(one)) == difference(log_of(three), log_of(two))


def test_effects_along_sides_are_logged_once_for_all_points():
    """Whatever the number of elements: a pressure when the load is made, and when estimators get the boundary; what stands out when the pair is set up"""
    for kind, event in (("pressure", "AbutPressure"), ("overlap", "AbutOverlap")):
        keys = next(row.keys for row in EFFECTS if row.name == f"effect {kind}")
        counts = [Matrix(BUILD).measure(BLOCKS, f"{keys} -lower_mesh_cells {cells} -upper_mesh_cells {cells}").events[event] for cells in ("8,2", "32,8")]
        assert counts == [1, 1], (kind, counts)


def test_the_layers_have_exactly_the_events_and_objects_of_their_loop():
    """c meshes of the lower body, one of the upper; s sweeps, eqs. (20) and (21), each one solve of both bodies; one estimate a mesh"""
    matrix = Matrix(BUILD)
    layers = matrix.measure(LAYERS, "-upper_mesh_cells 32,8 -adaptor_threshold 0.3 -snes_ddneumann_gamma 0.05 -record record")
    record = dict(line.split(None, 1) for line in layers.record)
    c, s = int(record["cycles"]), int(record["sweeps"])
    assert c > 2 and s > 100 and record["verdict"] == "converged"
    assert log_of(layers) == {
        **dict.fromkeys(("AbutBodyAssemble", "KSPSetUp", "PCSetUp", "MatCholFctrNum"), c + 1),
        **dict.fromkeys(("AbutBodySolve", "KSPSolve"), 2 * s),
        **dict.fromkeys(("AbutSweep", "SNESFunctionEval"), s),
        **dict.fromkeys(("AbutPairSetUp", "SNESSolve", "SNESSetUp", "AbutEstimate", "AbutMark"), c),
        **{"AbutMeshAdapt": c - 1, "AbutFormula": 1, "AbutWriteRecord": 1},
    }, (c, s, log_of(layers))
    of_meshes = "Container", "Distributed Mesh", "DM Label", "Quadrature", "Mesh Transform", "Index Set", "IS L to G Mapping", "Section"
    others = *of_meshes, "Star Forest Graph", "Discrete System", "Weak Form", "GraphPartitioner", "Vector", "Viewer"
    quads = matrix.measure(ONE).objects["Matrix"]
    triangles = matrix.measure(ONE, "-lower_mesh_shape triangle").objects["Matrix"]
    assert {name: count for name, count in layers.objects.items() if name not in others} == {
        **dict.fromkeys(("Abut Scene", "Abut Pair", "Abut Interface", "Abut Estimator", "Abut Adaptor", "Abut Recorder"), 1),
        **dict.fromkeys(("Abut Body", "Abut Mesh"), 2),
        **dict.fromkeys(("Krylov Solver", "Preconditioner"), 2 + c),  # one a body, and one that every SNES brings along
        **{"SNES": c, "DMSNES": c, "Matrix Null Space": c + 1, "Matrix": quads * c + triangles},
    }, (c, layers.objects)
    opened = {name for name in layers.libraries - matrix.measure(ONE).libraries}
    assert opened == {"libestimator_fembem.so", "libmuparser.so.2"}, opened


def copy(folder, name, plugins, library=None):
    """The program and its library under another path of equal length, as long paths take more bytes; with those plugins"""
    place = os.path.join(folder, name)
    for part in "bin", "lib":
        os.makedirs(os.path.join(place, part))
    subprocess.run(["cp", os.path.join(BUILD, "bin", "abut"), os.path.join(place, "bin")], check=True)
    subprocess.run(["cp", library or os.path.join(BUILD, "lib", "libabut.so"), os.path.join(place, "lib", "libabut.so")], check=True)
    for plugin in plugins:
        os.symlink(os.path.join(BUILD, "lib", f"libestimator_{plugin}.so"), os.path.join(place, "lib", f"libestimator_{plugin}.so"))
    return Matrix(place)


def without_effects(folder):
    """libabut.so of the same objects, but for those of the types of effects, whose functions are nowhere then"""
    types = {os.path.join(ROOT, "src", "effect", row.name.split()[1] + ".c") for row in EFFECTS}
    sources = set(glob.glob(f"{ROOT}/src/*/*.c")) - set(glob.glob(f"{ROOT}/src/app/*.c"))
    objects = [os.path.join(BUILD, "obj", os.path.relpath(source, ROOT)[:-1] + "o") for source in sources - types]
    assert len(sources - types) == len(sources) - 8
    with open(f"{ROOT}/src/effect/type.c") as f:
        creators = set(re.findall(r"AbutEffectCreate_\w+", f.read()))
    library = os.path.join(folder, "libabut.so")
    nowhere = [f"-Wl,--defsym={name}=0" for name in creators]
    flags = shlex.split(os.environ.get("CFLAGS", "")) + ["-Wl,--as-needed", "-shared", "-Wl,-soname,libabut.so", *nowhere]
    libraries = *config(BUILD, "SLEPC_LIBS"), *config(BUILD, "DEPS_LIBS"), "-lm", "-ldl"
    command = [*config(BUILD, "CC"), *flags, *objects, "-o", library, *libraries]
    done = subprocess.run(command, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return library


def content(path):
    with open(path, "rb") as f:
        return f.read()


def test_what_is_built_but_not_called_for_costs_no_byte():
    """A library without any type of effect, and no plugin: the same events, objects, bytes, files and digits"""
    with tempfile.TemporaryDirectory() as folder:
        full, bare = copy(folder, "full", ("zz", "residual", "fembem")), copy(folder, "bare", (), without_effects(folder))
        for scene in ONE, APART, BLOCKS, f"{BLOCKS} {PAPER}":
            with_all, without = full.measure(scene), bare.measure(scene)
            assert with_all == without, [pair for pair in zip(with_all, without) if pair[0] != pair[1]]
        keys = [b"-effect_density" in content(os.path.join(folder, name, "lib", "libabut.so")) for name in ("full", "bare")]
        assert keys == [True, False], "the types are not gone"


def test_a_plugin_that_is_taken_away_is_missed_by_its_own_scene_only():
    plugins = "zz", "residual", "fembem"
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as place:
        full = copy(folder, "all", plugins)
        scenes = {plugin: f"{BENT} -estimator_type {plugin}" for plugin in plugins}
        for gone in plugins:
            fewer = copy(folder, gone[:3].ljust(3, "_"), set(plugins) - {gone})
            for scene in [BLOCKS] + [scenes[plugin] for plugin in plugins if plugin != gone]:
                assert fewer.measure(scene) == full.measure(scene), (gone, scene)
            said = fewer.execute(place, scenes[gone], debug=None, expect=1).stderr
            assert said.startswith(f'abut: estimator_type: no estimator named "{gone}"; there are: '), said
            assert gone not in said.split("there are: ")[1].split(" (")[0], said
            path = os.path.join(folder, f"libestimator_{gone}.so")
            said = fewer.execute(place, scenes[gone], "-plugin", path, debug=None, expect=1).stderr
            assert said == f'abut: plugin: no file "{path}"\n', said


def called(measured, library, caller):
    """Functions of a library that were bound when another one first called them; what only its address is taken of is bound at the start"""
    return {name for one, other, name in measured.calls if one.startswith(caller) and other.startswith(library)}


def test_slepc_and_hdf5_are_mapped_but_not_called_unless_asked_for():
    """libabut.so is linked with SLEPc, and PETSc with HDF5, so that both are mapped always"""
    library = os.path.join(BUILD, "lib", "libabut.so")
    linked = subprocess.run(["ldd", library], capture_output=True, text=True, check=True).stdout
    for path in library, re.search(r"libpetsc\S* => (\S+)", linked).group(1):
        said = subprocess.run(["readelf", "-d", path], capture_output=True, text=True, check=True).stdout
        if "NOW" in said or os.environ.get("LD_BIND_NOW"):
            raise unittest.SkipTest(f"{path} binds all functions at the start")
    if not config(BUILD, "SLEPC_LIBS"):
        raise unittest.SkipTest("built without SLEPc")
    matrix = Matrix(BUILD)
    base, spectrum = (matrix.measure(f"{BLOCKS} {PAPER}", key, debug="bindings") for key in ("", "-snes_ddneumann_gamma_spectrum"))
    fields = matrix.measure(BLOCKS, "-output f.xdmf", debug="bindings")
    assert called(base, "libslepc", "libabut") <= {"SlepcFinalize"}, called(base, "libslepc", "libabut")
    assert {"SlepcInitialize", "EPSSolve"} <= called(spectrum, "libslepc", "libabut")
    assert not {"H5open", "H5Fcreate", "H5Fopen"} & called(base, "libhdf5", "libpetsc"), called(base, "libhdf5", "libpetsc")
    assert {"H5Fcreate"} <= called(fields, "libhdf5", "libpetsc")


def test_keys_of_an_effect_that_the_scene_does_not_name_are_errors():
    matrix = Matrix(BUILD)
    for row in EFFECTS:
        keys = row.keys.replace("-scene_effects e ", "").replace("-plugin {point} ", "")
        with tempfile.TemporaryDirectory() as folder:
            said = matrix.execute(folder, row.on, keys, debug=None, expect=1).stderr
        assert "nothing in this scene reads " in said and all(word[1:] in said for word in keys.split() if word.startswith("-e_")), said


def test_two_effects_of_a_type_share_its_event():
    matrix = Matrix(BUILD)
    two = "-scene_effects a,b -a_effect_type gravity -a_effect_density 1e-3 -b_effect_type gravity -b_effect_density 1e-3"
    assert matrix.measure(BLOCKS, two).events["AbutGravity"] == 2 * matrix.measure(BLOCKS, EFFECTS[0].keys).events["AbutGravity"]
