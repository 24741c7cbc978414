#!/usr/bin/env python3
"""libFuzzer on the readers of scenes, formulas, files of points and checkpoints, see readers.c: a bad one has to end in one line, never in a crash.

  readers.py FUZZER PROGRAM [--seconds 60] [READER ...]

Begins with the examples, the bad inputs of tests/errors and a checkpoint of restart.yml. What was found stays beside the fuzzer, and the next run goes on from there.
An input that goes wrong is printed with what repeats it; mended, it belongs in the folder crashes, as a test. Exit status 1 if there was one.
"""
import argparse, glob, os, re, shlex, subprocess, sys, time

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
RUNS = 20000  # of one process, which loses some 30 kB at each bad input
MPI = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_opal_signal": "", "OMP_NUM_THREADS": "1"}
SANITIZERS = {"ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1", "UBSAN_OPTIONS": "print_stacktrace=1"}


def read(*path):
    with open(os.path.join(TOP, *path)) as f:
        return f.read()


def golden():
    """The options of the bad inputs, as pairs of key and value"""
    for line in read("tests", "errors", "golden.txt").splitlines():
        if not line.startswith("#") and " | " in line:
            words = shlex.split(line.split(" | ")[0])
            yield [(key[1:], value) for key, value in zip(words, words[1:] + [""]) if key.startswith("-")]


def seeds(program, folder):
    """Reader: its inputs"""
    scene, bad = read("tests", "fuzz", "restart.yml"), list(golden())
    checkpoint = os.path.join(folder, "checkpoint")
    subprocess.run([program, os.path.join(HERE, "restart.yml"), "-checkpoint", checkpoint], check=True, stdout=subprocess.DEVNULL)
    with open(checkpoint, "rb") as f:
        restart = [f.read()]
    return {
        "scene": [read(path) for path in glob.glob(os.path.join(TOP, "examples", "**", "*.yml"), recursive=True)]
        + [scene + "".join(f'{key}: "{value}"\n' for key, value in case) for case in bad],
        "formula": sorted({value for case in bad for _, value in case}) + ["1e-3*x^2", "max(0.01,0.2*abs(x-1))", "x > 1 ? sin(pi*y) : -2e-3"],
        "points": ["x,y,value\n0,0,1\n0,1,2\n1e3,-2.5,inf\n", "0,0,1\n\n0 , 1 , nan", "\n"],
        "restart": restart,
    }


def prepare(program, folder):
    for reader, texts in seeds(program, folder).items():
        os.makedirs(os.path.join(folder, reader), exist_ok=True)
        for i, text in enumerate(texts):
            with open(os.path.join(folder, reader, f"seed{i}"), "wb") as f:
                f.write(text if isinstance(text, bytes) else text.encode())
    with open(os.path.join(folder, "words"), "w") as f:
        words = {word for case in golden() for pair in case for word in pair if re.fullmatch(r"\w+", word)}
        f.write("".join(f'"{word}"\n' for word in sorted(words)))


def fuzz(fuzzer, reader, seconds, folder):
    """The folder, and what a process that failed said last, or None"""
    environment = {**os.environ, **MPI, **SANITIZERS, "FUZZ_READER": reader, "FUZZ_TOP": TOP}
    runs, end = 0, time.time() + seconds
    while time.time() < end - 1:
        limits = [f"-max_total_time={end - time.time():.0f}", f"-runs={RUNS}", "-timeout=30", "-rss_limit_mb=6000", "-max_len=30000"]
        command = [fuzzer, *limits, "-close_fd_mask=1", "-print_final_stats=1", "-dict=words", f"-artifact_prefix={folder}/{reader}-", reader]
        result = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        said = result.stdout.decode(errors="replace")
        if result.returncode:
            print(f"{said[-6000:]}\nreader {reader} failed; repeat it: FUZZ_READER={reader} FUZZ_TOP={TOP} {fuzzer} FILE")
            return False
        runs += int(re.search(r"executed_units: *(\d+)", said)[1])
    print(f"reader {reader}: {runs} inputs, none wrong; {len(os.listdir(os.path.join(folder, reader)))} of them differ", flush=True)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fuzzer")
    parser.add_argument("program")
    parser.add_argument("reader", nargs="*", default=["scene", "formula", "points", "restart"])
    parser.add_argument("--seconds", type=float, default=60, help="for each reader [60]")
    args = parser.parse_args()
    folder = os.path.join(os.path.dirname(os.path.abspath(args.fuzzer)), "work")
    os.makedirs(folder, exist_ok=True)
    prepare(args.program, folder)
    good = [fuzz(os.path.abspath(args.fuzzer), reader, args.seconds, folder) for reader in args.reader]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
