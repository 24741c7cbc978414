"""Bad input ends in one line on standard error and exit status 1, before any mesh is made, and no file is touched. golden.txt has the lines."""
import concurrent.futures, os, random, re, shlex, tempfile, time, unittest

from abut import BUILD, LAYERS, PROGRAM, case, execute
from meshes import PLATE, bad_meshes
from msh import text

HERE = os.path.dirname(os.path.abspath(__file__))
LINE = "abut: "
OLD = "of an earlier run\n"


def write(folder, name, text):
    with open(os.path.join(folder, name), "wb") as f:
        f.write(text if isinstance(text, bytes) else text.encode())


def fixed_scene():
    """The scene without adaptor, estimator and loop"""
    with open(LAYERS) as f:
        return "".join(line for line in f if not line.startswith(("adaptor:", "estimator:", "snes:")))


def prepare(folder):
    for name in ("run.record", "run.csv"):
        write(folder, name, OLD)
    for name in ("garbage.yml", "garbage.opts"):
        write(folder, name, random.Random(1).randbytes(3000))
    write(folder, "empty.yml", "")
    write(folder, "empty.csv", "x,y,value\n")
    write(folder, "bad.csv", "x,y,value\n0,0,1\n0,1,one\n")
    write(folder, "fixed.yml", fixed_scene())
    for name, content in bad_meshes():
        write(folder, name, content)
    return sorted(os.listdir(folder))


def read_golden():
    with open(os.path.join(HERE, "golden.txt")) as f:
        for text in f:
            if text.strip() and not text.startswith("#"):
                yield text.rstrip("\n").split(" | ", 1)


def abut(words, folder, ranks=1, limit=60):
    """The words of a golden line, or more of them, as a run that would write to the folder"""
    names = {"LAYERS": "examples/layers/layers.yml", "FIXED": f"{folder}/fixed.yml", "LIBRARY": f"{BUILD}/lib/libabut.so"}
    words = [names.get(word, word).replace("FOLDER", folder) for word in shlex.split(words)]
    scene = words[:1] if words[:1] and not words[0].startswith("-") else []
    files = {"-record": "run.record", "-record_csv": "run.csv", "-output": "run.xdmf", "-output_profile": "profile.csv"}
    files = [word for key, name in files.items() for word in (key, f"{folder}/{name}")]
    mpi = ["mpiexec", "-n", str(ranks)] if ranks > 1 else []
    return execute(mpi + [PROGRAM] + scene + files + words[len(scene) :], limit)


def complain(words, expected, ranks=1):
    """What is wrong with how a golden line ends, None if nothing is"""
    with tempfile.TemporaryDirectory() as folder:
        files = prepare(folder)
        result = abut(words, folder, ranks)
        lines = [line for line in result.stderr.splitlines() if ranks == 1 or line.startswith(LINE) or "PETSC ERROR" in line]
        wanted = re.escape(LINE + expected)
        for short, long in (("...", ".*"), ("FOLDER", re.escape(folder)), ("LIBRARY", re.escape(f"{BUILD}/lib/libabut.so"))):
            wanted = wanted.replace(re.escape(short), long)
        said = f"{words}\nexpected {LINE}{expected}\nfound    " + "\n         ".join(lines or ["nothing"])
        if len(lines) != 1 or not re.fullmatch(wanted, lines[0]):
            return said
        if result.returncode != 1 or result.stdout:
            return f"{said}\nexit status {result.returncode}\n{result.stdout}"
        if sorted(os.listdir(folder)) != files or any(open(os.path.join(folder, name)).read() != OLD for name in ("run.record", "run.csv")):
            return f"{said}\nfiles were written: {sorted(os.listdir(folder))}"


def check(cases, ranks=1):
    """The seconds of the slowest"""

    def timed(words, expected):
        start = time.time()
        return complain(words, expected, ranks), time.time() - start

    with concurrent.futures.ThreadPoolExecutor(2 if ranks == 1 else 1) as pool:
        complaints, seconds = zip(*pool.map(lambda one: timed(*one), cases))
    complaints = [text for text in complaints if text]
    print(*complaints[:5], sep="\n")
    if ranks == 1:
        case("H26", f"of {len(cases)} bad inputs those without status 1 and their one line", len(complaints), 0)
    assert not complaints, f"{len(complaints)} of {len(cases)}:\n" + "\n".join(complaints[:5])
    return max(seconds)


def test_every_bad_input_ends_in_its_line():
    cases = list(read_golden())
    assert len(cases) > 100
    case("H26", "seconds to the end of the slowest of them", check(cases), 5)


def test_long_messages_are_said_to_their_end():
    """A value of 900 letters in a key that PETSc's objects read, which passes our own error handler; a list of names that has no room"""
    long = 900 * "7" + "x"
    assert not complain(
        f"LAYERS -snes_ddneumann_gamma {long}", f'snes_ddneumann_gamma: "{long}" is not a number (Relaxation of a sweep, whatever accelerates it)'
    )
    with tempfile.TemporaryDirectory() as folder:
        prepare(folder)
        result = abut("FIXED " + " ".join(f"-nobody_knows_what_this_key_is_for_{i} 1" for i in range(50)), folder)
    end = "nothing in this scene reads these keys; check the spelling (-help lists the keys), and that the scene names the body, pair or effect it belongs to"
    assert re.fullmatch(rf"{LINE}(nobody_knows_what_this_key_is_for_\d+, ){{20,}}\.\.\.: {re.escape(end)}", result.stderr.strip()), result.stderr


def test_constants_that_no_material_has():
    """Exit status 1 and one line that begins with the key, which has the name of the body; PETSc's log knows neither mesh nor matrix"""
    complaints, made = [], 0
    for body in "lower", "upper":
        for key, values in ("poisson", (0.5, 0.51, 7, -1, -1.01)), ("young", (0, -0.0, -2.1e5)):
            for value in values:
                with tempfile.TemporaryDirectory() as folder:
                    prepare(folder)
                    result = abut(f"LAYERS -{body}_material_{key} {value} -log_view :FOLDER/log.txt", folder)
                    with open(f"{folder}/log.txt") as f:
                        made += len(re.findall("^ *(AbutBodyAssemble|Distributed Mesh|Matrix )", f.read(), re.M))
                lines = result.stderr.splitlines()
                if result.returncode != 1 or result.stdout or len(lines) != 1 or not lines[0].startswith(f"{LINE}{body}_material_{key}: "):
                    complaints.append((body, key, value, result.returncode, result.stderr))
    print(complaints)
    case("H02", "bad constants without exit status 1 and a line with body and key", len(complaints), 0)
    case("H02", "meshes and matrices made before the line", made, 0)


def test_on_two_ranks_it_is_still_one_line():
    """One of every kind; mpiexec adds its own"""
    kinds = "yuong|nowhere.yml|garbage.yml|box 0,0,0,1|poisson 0.5|gap 1/0|_t1 1/.x|left,top|type guess|mine.so|_u2 0|record nowhere|pc_type best"
    cases = [case for case in read_golden() if re.search(kinds, case[0])]
    assert len(cases) >= 14
    check(cases, ranks=2)


def test_nothing_is_made_before_the_input_is_known_to_be_good():
    """PETSc's log of a bad run knows neither mesh nor matrix; that of a good run does"""
    bad = "FIXED -lower_bc_right_t1 1/(x-4)", "FIXED -mid_pair_gap 1/0", "FIXED -upper_bc_right_t2 sqrt(y-2)", "LAYERS -adaptor_treshold 0.2"
    for words, made in [(words, False) for words in bad] + [("FIXED -upper_mesh_cells 8,2 -snes_max_it 1", True)]:
        with tempfile.TemporaryDirectory() as folder:
            prepare(folder)
            status = abut(f"{words} -log_view :FOLDER/log.txt", folder).returncode
            with open(f"{folder}/log.txt") as f:
                log = f.read()
            assert status == (2 if made else 1), (words, status)
            for name in ("AbutBodyAssemble", "Distributed Mesh", "Matrix "):
                assert (re.search(f"^ *{name}", log, re.M) is not None) == made, (words, name, log)


def ends_well(result):
    """In one line and status 1, or as a run with a verdict"""
    lines = result.stderr.splitlines()
    if result.returncode == 1:
        return len(lines) == 1 and lines[0].startswith(LINE) and not result.stdout
    return result.returncode in (0, 2, 3) and not lines and result.stdout.splitlines()[-1].startswith("verdict: ")


def check_scenes(texts, kind):
    """Damaged scenes: none may crash, hang, or say more than one line"""

    def one(text):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, f"scene.{kind}", text)
            result = execute([PROGRAM, f"{folder}/scene.{kind}", "-snes_max_it", "2"], 60)
        return None if ends_well(result) else f"{text[-60:]!r}: exit status {result.returncode}\n{result.stdout}{result.stderr}"

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        complaints = [text for text in pool.map(one, texts) if text]
    assert not complaints, f"{len(complaints)} of {len(texts)}:\n" + "\n".join(complaints[:5])


def small_scene():
    with open(LAYERS) as f:
        text = re.sub(" +#.*", "", f.read()).replace('"128,32"', '"8,2"')
    assert '"8,2"' in text and "#" not in text
    return text


def test_a_scene_that_is_cut_off():
    text = small_scene()
    parts = ('"0,0', '"upper', "young:", "{u1", "pairs:", 'gap: "', "0.05}", "ddneumann,")
    cuts = sorted(set(range(0, len(text), 40)) | {text.index(part) + 3 for part in parts})
    check_scenes([text[:cut] for cut in cuts], "yml")


def test_a_scene_that_lacks_a_line():
    lines = small_scene().splitlines(keepends=True)
    check_scenes(["".join(lines[:i] + lines[i + 1 :]) for i in range(len(lines))], "yml")


def test_meshes_that_are_cut_off():
    with tempfile.TemporaryDirectory() as folder:
        for version in 2.2, 4.1:
            for binary in False, True:
                whole = text(PLATE, version=version, binary=binary)
                last = len(whole.rstrip())
                for end in [*range(0, last, last // 7), last - 1]:
                    write(folder, "cut.msh", whole[:end])
                    result = execute([PROGRAM, "-scene_bodies", "p", "-p_mesh_file", f"{folder}/cut.msh", "-explain"], 5)
                    lines = result.stderr.splitlines()
                    assert result.returncode == 1 and len(lines) == 1, (version, binary, end, result)
                    assert lines[0].startswith(f"{LINE}p_mesh_file: {folder}/cut.msh: "), lines


def test_plain_options_that_are_cut_off():
    text = "-scene_bodies one\n-one_mesh_box 0,0,1,1\n-one_mesh_cells 2,2\n-one_material_young 1\n-one_material_poisson 0\n"
    text += "-one_bc_left_u1 0\n-one_bc_bottom_u2 0 # done\n"
    check_scenes([text[:cut] for cut in range(5, len(text), 8)], "opts")


def test_garbage_after_a_good_scene():
    text = small_scene().encode()
    longer = [text + more for more in (b"\x00\xff\xfe", b"}", b"\tlower: {")]
    check_scenes(longer + [text.replace(b"young", b"yo\xffng"), b"\xef\xbb\xbf" + text, text.replace(b"\n", b"\r\n")], "yml")


def test_a_scene_that_is_there_but_cannot_be_read():
    if os.geteuid() == 0:
        raise unittest.SkipTest("root reads everything")
    with tempfile.TemporaryDirectory() as folder:
        write(folder, "scene.yml", small_scene())
        os.chmod(f"{folder}/scene.yml", 0)
        assert ends_well(execute([PROGRAM, f"{folder}/scene.yml"], 60))
