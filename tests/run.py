#!/usr/bin/env python3
"""Runs the tests of Abut and closes with one line, `N passed, M failed`.

Three kinds of tests:
  build/tests/ck_X       a unit test, from tests/unit/ck_X.c; on 1, 2 and 3 ranks, or as its source says: /* ranks: 1 */
  tests/*/test_X.py      each function test_... is one test: it fails by raising, is skipped by raising unittest.SkipTest
  tests/*.sh, tests/*/test_X.sh   fails by its exit status, is skipped by 77
Those in tests/long/ are run only if asked for. Each runs in a process of its own, from the top folder, with a time limit; what a failed one said is printed.
"""
import argparse, collections, concurrent.futures, glob, importlib.util, os, re, signal, subprocess, sys, tempfile, time, traceback, unittest

import cases

SELF = os.path.abspath(__file__)
ROOT = os.path.dirname(os.path.dirname(SELF))
SKIPPED = 77

# MPI as root, on fewer cores than ranks, inside one machine, for Open MPI 4 and 5; without a daemon that outlives a run on one rank by a
# second, and without a look for networks, which takes 0.2 s; ranks that wait yield their core, which others may need; what is left of a
# run that failed ends at once; one thread a rank
MPI = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    "OMPI_MCA_pml": "ob1",
    "OMPI_MCA_btl": "self,vader",
    "OMPI_MCA_ess_singleton_isolated": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_odls_base_sigkill_timeout": "0",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
}


def head(path):
    with open(path) as f:
        return "".join(f.readlines()[:10])


def unit_tests(build, quick):
    for source in sorted(glob.glob("tests/unit/ck_*.c")):
        name = os.path.splitext(os.path.basename(source))[0]
        said = re.search(r"ranks:([ 0-9]+)", head(source))
        ranks = [int(n) for n in said.group(1).split()] if said else [1, 2, 3]
        for n in ranks[:1] if quick else ranks:
            program = os.path.join(build, "tests", name)
            yield f"{source} on {n}", (["mpiexec", "-n", str(n)] if n > 1 else []) + [program]


def limit_of(source, limit):
    """For one test: as its file says, limit: 7200 s"""
    said = re.search(r"limit: (\d+) s", head(source)) if os.path.exists(source) else None
    return int(said.group(1)) if said else limit


def measures(source):
    with open(source) as f:
        return bool(re.search(r"\b(case|CkCase)\(", f.read()))


def python_tests(long):
    for source in sorted(glob.glob("tests/*/test_*.py")):
        if source.startswith("tests/long/") and not long:
            continue
        with open(source) as f:
            for name in re.findall(r"^def (test_\w+)\(", f.read(), re.M):
                yield f"{source}:{name}", [sys.executable, SELF, "--function", source, name]


def shell_tests():
    for source in sorted(glob.glob("tests/*.sh") + glob.glob("tests/*/test_*.sh")):
        yield source, ["sh", source]


def call(source, name):
    """One function of one module; the exit status says how it went"""
    sys.path[:0] = [os.path.dirname(os.path.abspath(source)), os.path.join(ROOT, "tests")]
    spec = importlib.util.spec_from_file_location(os.path.basename(source)[:-3], source)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
        getattr(module, name)()
    except unittest.SkipTest as reason:
        print(reason)
        return SKIPPED
    except Exception:
        traceback.print_exc()
        return 1
    return 0


def run(test, limit):
    """With a temporary folder of its own: there MPI keeps its session, which two programs must not share"""
    name, command = test
    start = time.time()
    with tempfile.TemporaryDirectory(prefix="abut_", ignore_cleanup_errors=True) as folder:
        try:
            process = subprocess.Popen(
                command,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                start_new_session=True,
                env={**os.environ, "TMPDIR": folder},
            )
        except OSError as error:
            return name, error.errno, 0.0, str(error)
        try:
            output, status = process.communicate(timeout=limit)[0], process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGTERM)  # mpiexec ends its ranks, which are no children of ours
            time.sleep(2)
            os.killpg(process.pid, signal.SIGKILL)
            output, status = process.communicate()[0] + f"\nstopped after {limit} s\n".encode(), -signal.SIGKILL
    return name, status, time.time() - start, output.decode(errors="replace")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", nargs="*", help="run only tests with one of these in their name")
    parser.add_argument("--build", default="build", help="build folder [build]")
    parser.add_argument("--quick", action="store_true", help="unit tests on one rank, and bad input")
    parser.add_argument("--long", action="store_true", help="also what takes minutes")
    parser.add_argument("--suite", action="store_true", help="the tests that measure cases of tests/cases.py, and their table")
    parser.add_argument("--list", action="store_true", help="only print the names")
    parser.add_argument("-j", type=int, default=1, help="tests at a time [1]; times are then worth little")
    parser.add_argument("--limit", type=float, default=300, help="seconds for one test [300]")
    args = parser.parse_args()

    os.environ.update({key: os.environ.get(key, value) for key, value in MPI.items()}, ABUT_BUILD=os.path.abspath(args.build))
    tests = list(unit_tests(args.build, args.quick)) + list(python_tests(args.long)) + list(shell_tests())
    if args.quick:
        tests = [t for t in tests if t[0].startswith(("tests/unit/", "tests/errors/", "tests/deps"))]
    if args.suite:
        tests = [t for t in tests if measures(t[0].split(":")[0].split(" on ")[0])]
    tests = [t for t in tests if not args.part or any(part in t[0] for part in args.part)]
    if args.list:
        print("\n".join(name for name, _ in tests))
        return 0

    count = {"passed": 0, "FAILED": 0, "skipped": 0}
    measured = collections.defaultdict(list)
    start = time.time()
    with concurrent.futures.ThreadPoolExecutor(args.j) as pool:
        for name, status, seconds, output in pool.map(lambda t: run(t, limit_of(t[0].split(":")[0], args.limit)), tests):
            verdict = {0: "passed", SKIPPED: "skipped"}.get(status, "FAILED")
            count[verdict] += 1
            for case, *row in cases.read(output):
                measured[case].append(tuple(row))
            print(f"{verdict:8}{seconds:7.1f} s  {name}", flush=True)
            if verdict == "FAILED":
                print(f"    exit status {status}\n" + re.sub("^", "    | ", output.rstrip(), flags=re.M), flush=True)
            elif verdict == "skipped":
                print("    " + (output.strip().splitlines() or ["no reason given"])[-1], flush=True)
    good = True
    if args.suite:
        lines, good = cases.table(measured)
        print("\n" + "\n".join(lines) + "\n")
    print(f"{time.time() - start:.0f} s")
    print(f"{count['passed']} passed, {count['FAILED']} failed" + (f", {count['skipped']} skipped" if count["skipped"] else ""))
    return 1 if count["FAILED"] or not tests or (args.suite and not args.part and not good) else 0


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(call(*sys.argv[2:]) if sys.argv[1:2] == ["--function"] else main())
