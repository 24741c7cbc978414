#!/usr/bin/env python3
"""Only what a scene calls for: whatever a scene can switch on is a row, set alone on top of a base scene that does without it, and
measured by what it leaves in PETSc's log, in the linker's list of opened libraries, in PETSc's memory and on the disk.

    matrix.py --build build       all rows, as a table; `make matrix`

A new effect, estimator, adaptor or output adds a row to ROWS. `events` are those that it brings: no other one of Abut, SNES or
EPS may appear, and none may go; `libraries` and `files` are what is opened and written beyond the base's, where rows that write
`parallel` also open parts of MPI. What `leaves` the "answer", the "record" to the last bit, or "all", the counts of the solvers'
events too, says so; anything else must change the record. `nothing` are keys with which a row amounts to nothing: the record then
is the base's. `without` are keys of the base that its own take the place of.
"""
import argparse, collections, concurrent.futures, os, re, shutil, subprocess, sys, tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests"))

INPUTS = {"gap.csv": b"0,1,1e-5\n4,1,0\n", "none.csv": b"0,1,0\n4,1,0\n", "bent.csv": b"0,2,-1e-3\n2,2,-1.2e-3\n4,2,-1e-3\n"}


def gmsh(nx, ny):
    """The box [0,4]x[0,1] in squares, as gmsh would write it, version 2.2"""
    at = lambda i, j: 1 + i + (nx + 1) * j
    nodes = [f"{at(i, j)} {4 * i / nx} {j / ny} 0" for j in range(ny + 1) for i in range(nx + 1)]
    lines = [(1, at(i, 0), at(i + 1, 0)) for i in range(nx)] + [(2, at(nx, j), at(nx, j + 1)) for j in range(ny)]
    lines += [(3, at(i + 1, ny), at(i, ny)) for i in range(nx)] + [(4, at(0, j + 1), at(0, j)) for j in range(ny)]
    cells = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(ny) for i in range(nx)]
    elements = [f"1 2 {side} {side} {a} {b}" for side, a, b in lines] + ["3 2 5 5 " + " ".join(map(str, cell)) for cell in cells]
    names = [f'1 {k + 1} "{name}"' for k, name in enumerate(("bottom", "right", "top", "left"))] + ['2 5 "body"']
    numbered = [f"{k + 1} {text}" for k, text in enumerate(elements)]
    parts = ("PhysicalNames", names), ("Nodes", nodes), ("Elements", numbered)
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + "".join("\n".join([f"${k}", str(len(v)), *v, f"$End{k}", ""]) for k, v in parts)


INPUTS["part.msh"] = gmsh(8, 2).encode()

BODY = "-{0}_material_young 2e5 -{0}_material_poisson 0.3 -{0}_bc_left_u1 0"
BOX = "-lower_mesh_box 0,0,4,1 -lower_mesh_cells 8,2"
LOWER = f"{BODY.format('lower')} -lower_bc_bottom_u2 0 -record record"
UPPER = f"{BODY.format('upper')} -upper_mesh_box 0,1,4,2 -upper_mesh_cells 6,2"
PAIR = "-scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top"
WALL = "-scene_pairs mid -mid_pair_bodies lower -mid_pair_sides right"
PUSH = "-upper_bc_top_u2 -1e-3"
ONE = f"-scene_bodies lower {BOX} {LOWER} -lower_bc_top_u2 -1e-3"  # one linear body
TWO = f"-scene_bodies lower,upper {LOWER} {UPPER}"
APART = f"{TWO} {BOX} {PUSH}"
BLOCKS = f"{APART} {PAIR}"  # contact, with numbers only
BENT = BLOCKS.replace(PUSH, "-upper_bc_top_u2 bent.csv")  # with something to estimate
ADAPTED = f"{BENT} -adaptor_type doerfler -adaptor_target 0.02 -estimator_type zz"
PAPER = "-snes_type ddneumann -mid_pair_penalty 0.5"
FILED = f"{TWO} {PUSH} {PAIR} -lower_mesh_file part.msh"
PARTS = ("lower", "vtu"), ("upper", "vtu"), ("mid", "vtp")
VTU = [f"f_{name}_{cycle:04d}.{kind}" for name, kind in PARTS for cycle in (0, 1)] + ["f.pvd"]
MUPARSER, ESTIMATES = ["libmuparser.so.2"], {"AbutEstimate"}
ADAPTS = ESTIMATES | {"AbutMark", "AbutMeshAdapt"}
LOOP = {"AbutSweep", "SNESSolve", "SNESSetUp"}

FIELDS = "name on keys events libraries files leaves nothing without parallel"
Row = collections.namedtuple("Row", FIELDS, defaults=((), (), None, None, "", False))


def effect(kind, keys, events, nothing=None, libraries=()):
    keys = f"-scene_effects e -e_effect_type {kind} {keys}"
    return Row(f"effect {kind}", BLOCKS, keys, set(events.split()), libraries, nothing=nothing)


def estimator(kind, keys=""):
    libraries = [f"libestimator_{name}.so" for name in kind.split(",")]
    return Row(f"estimator {kind}", BENT, f"-estimator_type {kind} {keys}", ESTIMATES, libraries)


def adaptor(kind, keys):
    return Row(f"adaptor {kind}", BENT, f"-adaptor_type {kind} -estimator_type zz {keys}", ADAPTS, ["libestimator_zz.so"])


def output(name, keys, event, files, on=ADAPTED):
    return Row(name, on, keys, {event}, (), files, "all")


ROWS = [
    effect("gravity", "-e_effect_density 2e-3", "AbutGravity", "-e_effect_acceleration 0,0"),
    effect("force", "-e_effect_f1 1e-3*y", "AbutForce AbutFormula", "-e_effect_f1 0*y", MUPARSER),
    effect("pressure", "-e_effect_bodies lower -e_effect_side right -e_effect_pressure 3", "AbutPressure", "-e_effect_pressure 0*x"),
    effect("spring", "-e_effect_bodies lower -e_effect_side right -e_effect_normal 1e3", "AbutSpring"),
    effect("overlap", "-e_effect_bodies upper -e_effect_side bottom -e_effect_depth 1e-4", "AbutOverlap", "-e_effect_depth 0"),
    effect("thermal", "-e_effect_temperature 3+y -e_effect_expansion 1e-5", "AbutThermal AbutFormula", "-e_effect_temperature 0", MUPARSER),
    effect("plane_stress", "-e_effect_bodies lower", "AbutPlane_stress"),
    effect("axisymmetric", "", "AbutAxisymmetric"),
    effect("point", "-plugin {point} -e_effect_bodies lower -e_effect_f -3", "AbutPoint", "-e_effect_f 0", ["libeffect_point.so"]),
    Row("contact of two bodies", APART, PAIR, LOOP | {"AbutPairSetUp"}),
    Row("contact with a wall", ONE, f"{WALL} -mid_pair_gap 0", LOOP | {"AbutObstacle"}),
    Row("rigid obstacle", ONE, f"{WALL} -mid_pair_obstacle 4-x", LOOP | {"AbutObstacle", "AbutFormula"}, MUPARSER),
    Row("gap by a formula", BLOCKS, "-mid_pair_gap 1e-5*x^2", {"AbutFormula"}, MUPARSER, nothing="-mid_pair_gap 0*x"),
    Row("gap by points", BLOCKS, "-mid_pair_gap gap.csv", set(), nothing="-mid_pair_gap none.csv"),
    Row("exact contact", BLOCKS, "-mid_pair_penalty 0", set()),
    Row("the paper's loop", BLOCKS, PAPER, {"SNESFunctionEval"}),
    Row("spectrum for gamma", f"{BLOCKS} {PAPER}", "-snes_ddneumann_gamma_spectrum", {"EPSSetUp", "EPSSolve"}),
    Row("interleaved loop", f"{ADAPTED} {PAPER}", "-scene_interleave", set()),
    Row("load steps", BLOCKS, "-scene_load_steps 0.5,1", {"AbutLoadStep"}),
    Row("body that floats", BLOCKS, "-upper_bc_top_t2 -10", {"AbutFreeModes"}, without=PUSH),
    Row("mean dilatation", BLOCKS, "-lower_material_poisson 0.4999", {"AbutDilatation"}),
    Row("body from gmsh", BLOCKS, "-lower_mesh_file part.msh", {"AbutReadGmsh"}, leaves="answer", without=BOX),
    Row("curved side", FILED, "-lower_mesh_curve_top y-1", {"AbutCurve", "AbutFormula"}, MUPARSER, leaves="record"),
    Row("first mesh by size", BLOCKS, "-lower_mesh_size 0.3", {"AbutMeshSize", "AbutMeshAdapt"}),
    estimator("zz"),
    estimator("residual"),
    estimator("fembem"),
    estimator("zz,residual"),
    estimator("template", "-plugin {template}"),
    adaptor("threshold", "-adaptor_threshold 0.055"),
    adaptor("equal", "-adaptor_target 0.02"),
    adaptor("doerfler", "-adaptor_target 0.02"),
    Row("meshes follow edges", ADAPTED, "-adaptor_follow yes", {"AbutFollow"}),
    Row("peak of the pressure", ADAPTED, "-adaptor_peak 1e-2", {"AbutPeak"}),
    output("record", "-record record", "AbutWriteRecord", ["record"], ADAPTED.replace("-record record", "")),
    output("record_csv", "-record_csv cycles.csv", "AbutWriteCSV", ["cycles.csv"]),
    output("fields, xdmf", "-output f.xdmf", "AbutWriteFields", ["f.h5", "f.xdmf"])._replace(parallel=True),
    output("fields, vtu", "-output f.vtu", "AbutWriteFields", VTU),
    output("profile", "-output_profile p.csv", "AbutWriteProfile", ["p.csv"]),
    output("checkpoint", "-checkpoint c", "AbutCheckpoint", ["c"]),
    Row("restart", ADAPTED, "-restart before", {"AbutRestart"}, leaves="record"),
    Row("bodies on ranks of their own", BLOCKS, "-scene_split", (), leaves="all"),  # on one rank nothing
    Row("time ratio", BLOCKS, "-record_time_ratio", {"AbutTimeRatio"}, leaves="record"),
]
TIMES = re.compile("^(time|memory)[.]")
OF_MPI = re.compile("^(lib)?mca_")  # what Open MPI opens when a file is written by all ranks
OF_SCENES = re.compile("^(Abut|SNES|EPS)")
OF_SOLVERS = re.compile("^(Abut|SNES|EPS|KSP|PC|MatSolve|MatChol|MatLU)")
Measured = collections.namedtuple("Measured", "events objects bytes record libraries files calls")


def words(options):
    return " ".join(options).split()


def environment(debug):
    """One rank without a daemon beside it; the dynamic linker writes down what it does"""
    from run import MPI  # as tests/run.py sets it

    return {**MPI, **os.environ, **({"LD_DEBUG": debug, "LD_DEBUG_OUTPUT": "linker"} if debug else {})}


def read(name):
    """A file the run may not have written"""
    if not os.path.exists(name):
        return ""
    with open(name, errors="replace") as f:
        return f.read()


def total(counts):
    """Of all stages of a log together"""
    every = collections.Counter()
    for name, count in counts:
        every[name.strip()] += int(count)
    return dict(every)


class Matrix:
    """The program of a build folder, what it is given, and what its runs left behind, each run once"""

    def __init__(self, build):
        self.program = os.path.join(build, "bin", "abut")
        self.inputs = dict(INPUTS)
        self.paths = {}
        self.done = {}

    def execute(self, folder, *options, debug="files", expect=0):
        for name, content in self.inputs.items():
            with open(os.path.join(folder, name), "wb") as f:
                f.write(content)
        given = [word.format(**self.paths) for word in words(options)]
        around = {**environment(debug), "TMPDIR": folder}
        done = subprocess.run([self.program, *given], cwd=folder, capture_output=True, text=True, env=around)
        assert done.returncode == expect, f"{' '.join(given)}\n{done.stdout}{done.stderr}"
        return done

    def measure(self, *options, debug="files"):
        key = tuple(words(options)), debug
        if key not in self.done:
            self.done[key] = self.look(*options, debug=debug)
        return self.done[key]

    def look(self, *options, debug="files"):
        """Counts of events and objects, most bytes at a time, the record without times, libraries and files"""
        with tempfile.TemporaryDirectory() as folder:
            done = self.execute(folder, *options, "-log_view :log -malloc_view", debug=debug)
            written = {name: read(os.path.join(folder, name)) for name in os.listdir(folder) if name not in self.inputs}
        linker = "".join(written.pop(name) for name in sorted(written) if name.startswith("linker"))
        log, record = written.pop("log"), [line for line in written.get("record", "").splitlines() if not TIMES.match(line)]
        events = total(re.findall(r"^(\w+) +(\d+) 1\.0 ", log, re.M))
        objects = total(re.findall(r"^ +(\w[\w ]*?) +(\d+) +\d+ *$", log, re.M))
        (memory,) = re.findall(r"Maximum memory PetscMalloc\(\)ed (\d+)", done.stdout)
        libraries = {os.path.basename(path) for path in re.findall(r"calling init: (\S+)", linker)}
        calls = re.findall(r"binding file (\S+) \[0\] to (\S+) \[0\]: normal symbol `(\w+)'", linker)
        calls = {tuple(map(os.path.basename, three)) for three in calls}
        return Measured(events, objects, int(memory), record, libraries, set(written), calls)


def difference(one, other):
    """What is in one and not in the other, or counts otherwise there: how many more"""
    return {key: one.get(key, 0) - other.get(key, 0) for key in {**one, **other} if one.get(key, 0) != other.get(key, 0)}


def answer(record):
    """The numbers of a record as far as they do not hang on the last bits"""
    pairs = (line.split(None, 1) for line in record)
    return {key: float(f"{float(value):.6g}") for key, value in pairs if re.fullmatch(r"pair\.\w+\.(force|active)", key)}


def complaints(row, base, with_it):
    """What is not as the row says"""
    events, before = ({k: n for k, n in m.events.items() if OF_SCENES.match(k)} for m in (with_it, base))
    appeared, went = set(events) - set(before), set(before) - set(events)
    if appeared != set(row.events) or went:
        yield f"events {sorted(appeared)} came, {sorted(went)} went, and {sorted(row.events)} should come"
    opened = {name for name in with_it.libraries - base.libraries if not (row.parallel and OF_MPI.match(name))}
    if opened != set(row.libraries):
        yield f"libraries {sorted(opened)} were opened, not {list(row.libraries)}"
    if with_it.files - base.files != set(row.files):
        yield f"files {sorted(with_it.files - base.files)} were written, not {list(row.files)}"
    same = with_it.record == base.record
    if row.leaves in ("all", "record") and not same and base.record:
        yield f"the record changed: {[pair for pair in zip(base.record, with_it.record) if pair[0] != pair[1]][:3]}"
    if row.leaves == "answer" and answer(with_it.record) != answer(base.record):
        yield f"the answer changed: {answer(base.record)} {answer(with_it.record)}"
    if row.leaves is None and same:
        yield "it did nothing to the record"
    if row.leaves == "all":
        more = {k: n for k, n in difference(with_it.events, base.events).items() if OF_SOLVERS.match(k) and k not in row.events}
        if more:
            yield f"other events changed: {more}"


def keys_of(row):
    return [word for word in row.keys.split() if re.match("-[a-z]", word)]


def misspelt(matrix, on, rows):
    """The keys of all rows on a base, each with a letter too many: all must be refused, by name, before any work"""
    wrong = " ".join(word + "x" if re.match("-[a-z]", word) else word for row in rows for word in row.keys.split())
    with tempfile.TemporaryDirectory() as folder:
        said = matrix.execute(folder, on, wrong, debug=None, expect=1).stderr
    named = set(re.findall(r"\w+", said))
    for row in rows:
        left = [key for key in keys_of(row) if key[1:] + "x" not in named]
        if left or len(said.strip().splitlines()) != 1 or "nothing in this scene reads" not in said:
            yield f"{row.name}: misspelt {left}: {said}"


def judge(matrix, row):
    """A line of the table, and what is wrong"""
    on = row.on.replace(row.without, "") if row.without else row.on
    base, with_it = matrix.measure(row.on), matrix.measure(on, row.keys)
    wrong = [*complaints(row, base, with_it)]
    if row.nothing and matrix.measure(on, row.keys, row.nothing).record != base.record:
        wrong.append(f"with {row.nothing} it is not nothing")
    events = ", ".join(f"{name.replace('Abut', '')} {with_it.events.get(name, 0)}" for name in sorted(row.events))
    more = difference(with_it.objects, base.objects)
    objects = ", ".join(f"{TOLD[name]} {more[name]:+}" for name in TOLD if name in more)
    libraries = ", ".join(name[3:].split(".so")[0] for name in row.libraries)
    line = row.name, events, objects, libraries, f"{with_it.bytes - base.bytes:+}", "FAILS" if wrong else "passes"
    return line, [f"{row.name}: {text}" for text in wrong]


# The classes that the table shows; those of meshes and index sets follow from the meshes
TOLD = {f"Abut {name}": name for name in ("Effect", "Pair", "Estimator", "Adaptor")}
TOLD.update({"SNES": "SNES", "EPS Solver": "EPS", "Krylov Solver": "KSP", "Matrix": "Mat", "Matrix Null Space": "NullSpace"})
TOLD["Viewer"] = "Viewer"
HEAD = "switched on", "its events, how often", "more objects", "libraries", "more bytes", "verdict"


def compile_point(folder):
    """The effect of test_plugin.py"""
    import test_plugin

    return os.path.join(folder, os.path.basename(test_plugin.build(folder)))


def compile_template(folder):
    place = os.path.join(folder, "template")
    shutil.copytree(os.path.join(ROOT, "plugins", "template"), place)
    done = subprocess.run(["make", "-s", "-C", place, f"ABUT_DIR={ROOT}", "CFLAGS=-O2"], capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return os.path.join(place, "libestimator_template.so")


def prepare(matrix, folder):
    """Plugins from out of the tree, and a checkpoint to go on from"""
    matrix.paths = {"point": compile_point(folder), "template": compile_template(folder)}
    place = os.path.join(folder, "run")
    os.mkdir(place)
    matrix.execute(place, ADAPTED, "-checkpoint before", debug=None)
    with open(os.path.join(place, "before"), "rb") as f:
        matrix.inputs["before"] = f.read()


def table(lines):
    width = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    return "\n".join("  ".join(text.ljust(n) for text, n in zip(line, width)).rstrip() for line in lines)


def config(build, key):
    """A line of config.mk, which says what Abut was built with"""
    with open(os.path.join(build, "config.mk")) as f:
        return [line.split("=", 1)[1].split() for line in f if line.startswith(key + " ")][0]


def run_all(build):
    """The table, and what is wrong"""
    chosen = [row for row in ROWS if "spectrum" not in row.name or config(build, "SLEPC_LIBS")]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        matrix = Matrix(build)
        prepare(matrix, folder)
        rows = list(pool.map(lambda row: judge(matrix, row), chosen))
        wrong = [text for _, texts in rows for text in texts]
        for on in {row.on for row in chosen}:
            wrong += misspelt(matrix, on, [row for row in chosen if row.on == on])
    return table([HEAD] + [line for line, _ in rows]), wrong


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="build folder [build]")
    args = parser.parse_args()
    os.environ["ABUT_BUILD"] = os.path.abspath(args.build)
    text, wrong = run_all(os.environ["ABUT_BUILD"])
    print(text, *wrong, sep="\n")
    sys.exit(bool(wrong))
