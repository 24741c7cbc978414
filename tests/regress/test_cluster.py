"""The job script and the recipe of examples/cluster: the script runs, and goes on where it was ended; the recipe installs what the build wants"""
import os, re, shlex, shutil, stat, subprocess, tempfile

from abut import PROGRAM, ROOT, read_record

CLUSTER = os.path.join(ROOT, "examples", "cluster")
COARSE = "-upper_mesh_cells 32,8 -snes_type ddactive -adaptor_threshold 0.25"
KNOWN = "FROM RUN COPY ENV WORKDIR CMD".split()


def script():
    return os.path.join(CLUSTER, "abut.slurm")


def job(folder, *words):
    """The script in a folder like the top one, with an srun that starts two ranks here"""
    srun = os.path.join(folder, "srun")
    with open(srun, "w") as f:
        f.write('#!/bin/sh\nexec mpiexec -n 2 "$@"\n')
    os.chmod(srun, stat.S_IRWXU)
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "ABUT": PROGRAM, "TMPDIR": folder}
    done = subprocess.run(["bash", script(), *words], cwd=folder, capture_output=True, text=True, env=environment)
    assert not done.returncode, done.stdout + done.stderr
    with open(os.path.join(folder, "out", "layers.log")) as f:
        return read_record(os.path.join(folder, "out", "layers.record")), "AbutRestart" in f.read()


def test_the_script_is_one_of_bash():
    done = subprocess.run(["bash", "-n", script()], capture_output=True, text=True)
    assert not done.returncode and not done.stderr, done.stderr
    with open(script()) as f:
        asked = dict(line[len("#SBATCH --") :].strip().split("=", 1) for line in f if line.startswith("#SBATCH"))
    assert {"nodes", "ntasks-per-node", "time", "mem-per-cpu"} <= set(asked), asked


def test_a_job_runs_the_scene_and_another_one_goes_on():
    """On the last mesh, to the same answer, within what CG leaves"""
    with tempfile.TemporaryDirectory() as folder:
        for name in "examples", "petscopts":
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        whole, restarted = job(folder, "examples/layers/layers.yml", *COARSE.split())
        assert whole["verdict"] == "converged" and whole["cycles"] > 2
        left = os.listdir(os.path.join(folder, "out"))
        assert {"layers.record", "layers.xdmf", "layers.h5", "layers.log", "layers.checkpoint"} <= set(left), left
        again, goes_on = job(folder, "examples/layers/layers.yml", *COARSE.split())
    assert goes_on and not restarted
    assert all(again[key] == whole[key] for key in ("verdict", "cycles", "sweeps", "unknowns", "pair.mid.active")), (whole, again)
    assert all(abs(again[key] / whole[key] - 1) < 1e-7 for key in ("pair.mid.force", "pair.mid.pressure_max", "energy.strain", "eta.lower"))


def wanted():
    """Debian's packages of a build, of config/setup.sh"""
    with open(os.path.join(ROOT, "config", "setup.sh")) as f:
        part = f.read().split("find_missing() {")[1].split('[ "$need" = build ]')[0]
    return set(" ".join(re.findall(r'want "[^"]*" "([^"]*)"', part)).split())


def test_the_recipe_installs_what_the_build_wants():
    with open(os.path.join(CLUSTER, "Dockerfile")) as f:
        text = re.sub(r"\\\n", " ", f.read())
    steps = [line.split(None, 1) for line in text.splitlines() if line.strip() and not line.startswith("#")]
    assert steps[0][0] == "FROM" and {step[0] for step in steps} <= set(KNOWN), steps
    commands = [shlex.split(part) for name, rest in steps if name == "RUN" for part in rest.split("&&")]
    (install,) = [words for words in commands if "install" in words and "apt-get" in words]
    packages = {word for word in install[install.index("install") + 1 :] if not word.startswith("-")}
    assert packages == wanted() | {"make", "libopenblas0-serial"} and "gcc" in packages, packages ^ wanted()
    (make,) = [words for words in commands if words[0] == "make"]
    with open(os.path.join(ROOT, "Makefile")) as f:
        goals = re.search(r"^\.PHONY: (.*)", f.read(), re.M)[1].split()
    assert make[-1] in goals and "-C" in make, make
    for name, rest in steps:
        for source in rest.split()[:-1] if name == "COPY" else ():
            assert os.path.exists(os.path.join(ROOT, source)), source
    with open(os.path.join(CLUSTER, "Dockerfile.dockerignore")) as f:
        assert shutil.which("git") is None or ".git" in f.read().split()
