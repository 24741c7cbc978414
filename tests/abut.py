"""Running the program from a test: run() gives the record of a good run, run_error() the one line of a bad one.

    from abut import run, run_error
    record = run("examples/layers/layers.yml", "-mid_pair_penalty 0.5", ranks=2)
    assert record["verdict"] == "converged" and abs(record["pair.mid.force"] - 123.) < 1.
"""
import os, re, shlex, subprocess, tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.environ.get("ABUT_BUILD", os.path.join(ROOT, "build"))
PROGRAM = os.path.join(BUILD, "bin", "abut")
LEAKS = ["-malloc_dump", "-objects_dump"] if os.environ.get("ABUT_LEAKS") else []  # PETSc prints what was not freed
LAYERS = os.path.join(ROOT, "examples", "layers", "layers.yml")


class Record(dict):
    """The record of a run, `key: number or string`, and what the program said: stdout, stderr, status"""

    stdout = stderr = ""
    status = None


def number(text):
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def read_record(path):
    with open(path) as f:
        pairs = (line.rstrip("\n").split(None, 1) for line in f if line.strip())
        return {pair[0]: number(pair[1] if len(pair) > 1 else "") for pair in pairs}


def read_csv(path):
    """A -record_csv file: one dictionary a cycle"""
    with open(path) as f:
        names, *rows = [line.rstrip("\n").split(",") for line in f]
    return [dict(zip(names, map(number, row))) for row in rows]


def words(options):
    """("-a 1 -b", "-c", "x y") -> -a 1 -b -c "x y": an option may bring its value along in one string"""
    for option in map(str, options):
        yield from shlex.split(option) if option.startswith("-") else [option]


def execute(command, limit):
    """Runs a command in the top folder, with a temporary folder of its own, where MPI keeps its session. One that hangs is ended so that
    mpiexec, too, can end its ranks, and is an error."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        pipe = subprocess.PIPE
        process = subprocess.Popen(command, cwd=ROOT, stdout=pipe, stderr=pipe, stdin=subprocess.DEVNULL, env={**os.environ, "TMPDIR": folder})
        try:
            output = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            process.terminate()
            output = process.communicate()
            limit = None
    stdout, stderr = (text.decode(errors="replace") for text in output)
    assert limit, f"{shlex.join(command)}\ndid not end by itself\n{stdout}{stderr}"
    return subprocess.CompletedProcess(command, process.returncode, stdout, stderr)


def run(scene, *options, ranks=1, expect=0, limit=250):
    """Runs abut on a scene file (or None) with further options; the exit status must be `expect` (None: any)"""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "record")
        command = ["mpiexec", "-n", str(ranks)] if ranks > 1 else []
        command += [PROGRAM] + (["-options_file", str(scene)] if scene else []) + list(words(options)) + ["-record", path] + LEAKS
        result = execute(command, limit)
        record = Record(read_record(path) if os.path.exists(path) else {})
    record.stdout, record.stderr, record.status = result.stdout, result.stderr, result.returncode
    assert expect is None or record.status == expect, (
        f"{shlex.join(command)}\nexit status {record.status}, expected {expect}\n{record.stdout}{record.stderr}"
    )
    leaks = LEAKS and record.status != 1 and re.search(r"^The following objects were never freed|^\[ *\d+\] *\d+ bytes .*", record.stdout, re.M)
    assert not leaks, f"{shlex.join(command)}\nleaves memory behind\n{record.stdout[leaks.start():]}"  # bad input, 1, ends where it is met
    return record


def run_error(scene, *options, ranks=1):
    """Bad input: exit status 1, and one line, which is returned"""
    record = run(scene, *options, ranks=ranks, expect=1)
    lines = [line for line in record.stderr.splitlines() if line.strip()]
    assert len(lines) == 1, f"one line expected on stderr, not {len(lines)}:\n{record.stderr}"
    assert not record, f"a record was written although the input was bad: {dict(record)}"
    return lines[0]


def case(name, criterion, measured, most, least=None):
    """A line of the table of `make suite`: of a case of tests/cases.py, what was measured and what it may be; anything else is an error"""
    good = measured <= most and (least is None or measured >= least)
    bound = f"at most {most:g}" if least is None else f"{least:g} to {most:g}"
    print(f"case {name} | {criterion} | {measured:.3g} | {bound} | {'pass' if good else 'FAIL'}", flush=True)
    assert good, (name, criterion, measured, most, least)
