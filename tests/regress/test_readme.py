"""Every command of the README and of the examples' pages that runs the program is run, as it stands there, and so are those that draw what it wrote"""
import functools, glob, os, re, shlex, shutil, subprocess, sys, tempfile, unittest

from abut import PROGRAM, ROOT

RUNS, GMSH, DRAWS = "build/bin/abut", "gmsh", "/usr/bin/python3"


@functools.lru_cache(None)
def commands(page):
    """Those of fenced and of indented blocks"""
    with open(os.path.join(ROOT, page)) as f:
        text = f.read()
    blocks = re.findall(r"^```\n(.*?)^```", text, re.M | re.S) + re.findall(r"^((?:    \S.*\n)+)", text, re.M)
    lines = [shlex.split(line, comments=True) for block in blocks for line in block.splitlines() if re.match(r"\s*(build/bin/abut|gmsh|/usr/bin/python3|make -C) ", line)]
    return [words for words in lines if "&&" not in words]


def call(words, folder):
    program = {RUNS: PROGRAM, DRAWS: sys.executable}.get(words[0], words[0])
    done = subprocess.run([program] + words[1:], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"{shlex.join(words)}\n{done.stdout}{done.stderr}"


def follow(page):
    """In a folder like that of the sources; without gmsh its files are those that are shipped, without h5py nothing is drawn"""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(os.path.join(ROOT, "examples"), os.path.join(folder, "examples"), ignore=shutil.ignore_patterns("*.png"))
        for name in "petscopts", "include":
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        os.mkdir(os.path.join(folder, "out"))
        draws = subprocess.run([sys.executable, "-c", "import h5py, matplotlib"], capture_output=True).returncode == 0
        for words in commands(page):
            if words[0] == GMSH and not shutil.which(GMSH):
                shutil.copy(os.path.join(folder, words[2].replace(".geo", ".msh")), os.path.join(folder, "mesh"))
                os.replace(os.path.join(folder, "mesh"), os.path.join(folder, words[words.index("-o") + 1]))
            elif words[0] != DRAWS or draws:
                call(words, folder)
        missing = [words for words in commands(page) if words[0] == DRAWS and draws and not os.path.exists(os.path.join(folder, words[2] + ".png"))]
        assert not missing, missing


def test_every_command_ends_well():
    assert len(commands("README.md")) >= 2, "the README shows no command"
    follow("README.md")


def test_every_example_does_what_its_page_says():
    pages = [os.path.relpath(path, ROOT) for path in sorted(glob.glob(os.path.join(ROOT, "examples", "*", "README.md")))]
    shown = [page for page in pages if any(words[0] == RUNS for words in commands(page))]
    assert len(shown) >= 8, shown
    for page in shown:
        follow(page)


def test_files_of_meshes_are_those_that_gmsh_makes():
    """As many bodies, sides and vertices, within what versions of gmsh differ by"""
    if not shutil.which(GMSH):
        raise unittest.SkipTest("gmsh is not here")
    for geo in sorted(glob.glob(os.path.join(ROOT, "examples", "*", "*.geo"))):
        with tempfile.TemporaryDirectory() as folder:
            call([GMSH, "-2", "-v", "1", geo, "-o", os.path.join(folder, "new.msh")], folder)
            both = [open(path).read() for path in (os.path.join(folder, "new.msh"), geo[:-4] + ".msh")]
        names, nodes = zip(*((re.search(r"\$PhysicalNames\n(.*?)\$End", text, re.S)[1], int(re.search(r"\$Nodes\n\d+ (\d+)", text)[1])) for text in both))
        assert names[0] == names[1] and abs(nodes[0] / nodes[1] - 1) < 0.2, (geo, nodes)
