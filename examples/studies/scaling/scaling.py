#!/usr/bin/env python3
"""How a run scales with ranks: what each phase sends, does and takes, and what would stop it on 10^2 to 10^4 ranks.

  scaling.py [--abut build/bin/abut] [--out out] [--ranks 1 2 4 8 16] [--sizes 3e4 1e5 3e5 1e6] [--each 3e4] [--modes together split]
             [--repetitions 3] [--latency 2e-6] [--bandwidth 1e10] [--launcher "mpiexec -n {ranks}"] [--tables] [--keep]

Two layers in exact contact are solved with -scene_tol, CG and BoomerAMG: strong series with about as many unknowns as a size says on all
numbers of ranks, and a weak one with about --each unknowns a rank. Leaves scaling.csv, one line a run and phase, scaling.md, the tables,
and scaling.png and .svg. Messages and bytes are counted by count.c in front of MPI, whoever sends them; seconds are the median of runs
without it, and none are taken of more ranks than cores. What scaling.csv already has is not repeated: delete it after a change of the
program. The mode "split" is left out of a program without -scene_split. --latency, in seconds, and --bandwidth, in bytes a second and rank,
are those of the machine that the model is asked about. --tables runs nothing, and takes the scaling.csv of this folder if --out has none;
--keep puts what was found into this folder: the CSV file, the pictures and the tables of the page.
"""
import argparse, collections, hashlib, os, re, shlex, shutil, statistics, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
TOP = os.path.dirname(os.path.dirname(STUDIES))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(STUDIES), "layers"), STUDIES, os.path.join(TOP, "tests")]
from layers import record  # noqa: E402
from run import MPI  # noqa: E402
from study import Kept, read, where  # noqa: E402

SCENE = os.path.join(STUDIES, "shares", "layers_tol.yml")
MODES = {"together": "", "split": "-scene_split"}  # all ranks on every body, or each body on ranks of its own
# linear problems so exact that no mesh hangs on the number of ranks; the contact model as in large problems
OPTIONS = "-estimator_type zz -adaptor_max_level 28 -adaptor_max_unknowns 1000000000 -snes_ddactive_share 0 "
OPTIONS += " ".join(f"-{body}_ksp_type cg -{body}_pc_type hypre -{body}_ksp_rtol 1e-11" for body in ("lower", "upper"))
CONSTANT = 1.4  # -scene_tol of a mesh, times the root of its unknowns
TIMES = {"Set-up": "setup", "Sweeps": "solve", "Estimate": "estimate", "Adapt": "adapt", "Output": "output"}  # of a phase in the record
SUMS = "messages bytes multigrid others reductions reduced gathers gathered steps work".split()
MOST = "messages bytes multigrid others gathered steps work".split()  # of which the largest of all ranks is kept, too
Case = collections.namedtuple("Case", "series size ranks mode")
RUN = "cores oversubscribed verdict unknowns contact cycles sweeps its mesh force pressure energy estimate imbalance memory_MB".split()
COLUMNS = [*Case._fields, *RUN, "phase", "seconds", "seconds_min", "seconds_max", *SUMS, *(f"{name}_max" for name in MOST)]
COLUMNS += "git petsc machine".split()


def case_of(row):
    return Case(row["series"], float(row["size"]), int(row["ranks"]), row["mode"])


def named(case):
    return f"{case.series}, {case.size:.0f} unknowns, {case.ranks} ranks, {case.mode}"


def scene(case, each):
    """A weak series begins with meshes that grow like the last ones, so that all of its runs refine as often"""
    fine = round(2 * case.ranks**0.5) if case.series == "weak" else 2
    tolerance = CONSTANT * (each**-0.5 * 2 / fine if case.series == "weak" else case.size**-0.5)
    cells = " ".join(f"-{body}_mesh_cells {4 * fine},{fine}" for body in ("lower", "upper"))
    return f"-scene_tol {tolerance:.4g} {cells} {OPTIONS} {MODES[case.mode]}"


def checksum(path):
    """Of all meshes of a series of fields: middle and level of every cell, wherever it stands in the file; and the contact nodes of the last"""
    import h5py
    import numpy as np

    digest, contact = hashlib.sha256(), 0
    with h5py.File(path) as f:
        for cycle in sorted(f):
            for name, part in sorted(f[cycle].items()):
                if "level" not in part:
                    contact = len(part["vertices"])
                    continue
                middle = part["vertices"][()][part["cells"][()].astype(int)].mean(axis=1)
                cells = np.column_stack([part["level"][()], np.rint(middle * 2.0**28)]).astype(np.int64)
                digest.update(cells[np.lexsort(cells.T)].tobytes())
    return digest.hexdigest()[:16], contact


def counts(path):
    """Of count.c's file, by phase: sums over all ranks, and the largest of one"""
    found = {}
    for row in read(path):
        one = found.setdefault(row["phase"], collections.Counter())
        row["others"] = float(row["messages"]) - float(row["multigrid"])
        for name in SUMS:
            one[name] += float(row[name])
            one[f"{name}_max"] = max(one[f"{name}_max"], float(row[name]))
    return {phase: {name: f"{one[name]:.9g}" for name in [*SUMS, *(f"{name}_max" for name in MOST)]} for phase, one in found.items()}


class Runs:
    def __init__(self, args):
        self.args, self.place, self.counter, self.session = args, where(), "", ""  # session: where MPI keeps what it needs, on each machine
        self.cores = len(os.sched_getaffinity(0))

    def build(self, folder):
        """Where every machine of a cluster finds it"""
        self.counter = os.path.join(os.path.abspath(folder), "libcount.so")
        command = [os.environ.get("MPICC", "mpicc"), *"-std=gnu99 -O2 -fPIC -shared".split(), os.path.join(HERE, "count.c"), "-o", self.counter]
        made = subprocess.run([*command, "-ldl"], capture_output=True, text=True)
        if made.returncode:
            raise SystemExit(f"examples/studies/scaling/count.c was not built:\n{made.stdout}{made.stderr}")

    def once(self, case, folder, *before):
        """One run: why it failed or nothing, and its record"""
        path = os.path.join(folder, "record")
        command = shlex.split(self.args.launcher.format(ranks=case.ranks)) + list(before)
        command += [os.path.abspath(self.args.abut), "-options_file", SCENE, *scene(case, self.args.each).split(), "-record", path]
        command += ["-output", os.path.join(folder, "fields.xdmf")]
        done = subprocess.run(command, capture_output=True, text=True, env={**MPI, **os.environ, "TMPDIR": self.session})
        if os.path.exists(path):
            return record(path)
        said = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
        return {"verdict": said[0] if said else f"exit status {done.returncode}"}

    def rows(self, case):
        """One of each phase; of a run that failed one that says why"""
        over = case.ranks > self.cores
        start = dict(case._asdict(), cores=self.cores, oversubscribed="yes" if over else "no", **self.place)
        with tempfile.TemporaryDirectory(dir=os.path.abspath(self.args.out), ignore_cleanup_errors=True) as folder:
            path = os.path.join(folder, "counts")
            r = self.once(case, folder, "env", f"LD_PRELOAD={self.counter}", f"ABUT_COUNTS={path}")
            start["verdict"] = r["verdict"]
            if "unknowns" not in r:
                return [start]
            found, (mesh, contact) = counts(path), checksum(os.path.join(folder, "fields.h5"))
            timed = [self.once(case, folder) for _ in range(0 if over else self.args.repetitions)]
        bodies = [key[5:-9] for key in r if re.fullmatch(r"body\.\w+\.unknowns", key)]
        shares = [r[f"body.{body}.imbalance"] for body in bodies if f"body.{body}.imbalance" in r]
        start.update(unknowns=int(r["unknowns"]), contact=contact, cycles=int(r["cycles"]), sweeps=int(r["sweeps"]), mesh=mesh)
        start.update(its=int(sum(r[f"body.{body}.ksp_its"] for body in bodies)), imbalance=max(shares, default=""))
        start.update(force=r["pair.mid.force"], pressure=r["pair.mid.pressure_max"], energy=r["energy.strain"], estimate=r["error.discretisation"])
        start["memory_MB"] = f"{r['memory.peak'] / 1e6:.0f}"
        rows = []
        for phase in ["Main", *TIMES]:
            seconds = [one[f"time.{TIMES[phase]}"] for one in timed if phase in TIMES]
            times = zip(("seconds", "seconds_min", "seconds_max"), (f"{of(seconds):.4g}" for of in (statistics.median, min, max)) if seconds else ())
            rows.append({**start, "phase": phase, **found[phase], **dict(times)})
        return rows


def modes_of(args):
    """Those of the program"""
    said = subprocess.run([args.abut, "-options_file", SCENE, "-help"], capture_output=True, text=True, env={**MPI, **os.environ}).stdout
    return [mode for mode in args.modes if all(word in said for word in MODES[mode].split())]


def cases(args):
    modes = args.modes if args.tables else modes_of(args)
    found = [Case("strong", size, ranks, mode) for mode in modes for size in sorted(args.sizes) for ranks in sorted(args.ranks)]
    found += [Case("weak", args.each * ranks, ranks, mode) for mode in modes for ranks in sorted(args.ranks) if args.each]
    return [case for case in found if case.mode == "together" or case.ranks > 1]


def keep(args, lines):
    """The CSV file, the pictures, and the tables between the marks of the page"""
    page = os.path.join(HERE, "README.md")
    with open(page) as f:
        before, _, after = re.split(r"(?s)(?<=<!-- tables -->\n)(.*)(?=<!-- end of tables -->)", f.read())
    with open(page, "w") as f:
        f.write(before + "\n".join(lines) + "\n" + after)
    for name in "scaling.csv", "scaling.png":
        if os.path.exists(os.path.join(args.out, name)):
            shutil.copy(os.path.join(args.out, name), HERE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--ranks", nargs="+", type=int, default=[1, 2, 4, 8, 16])
    parser.add_argument("--sizes", nargs="*", type=float, default=[3e4, 1e5, 3e5, 1e6], help="unknowns of the strong series")
    parser.add_argument("--each", type=float, default=3e4, help="unknowns a rank of the weak series, 0: none")
    parser.add_argument("--modes", nargs="+", default=list(MODES), choices=list(MODES))
    parser.add_argument("--repetitions", type=int, default=3, help="runs for the seconds")
    parser.add_argument("--latency", type=float, default=2e-6, help="of a message of the model's machine, seconds")
    parser.add_argument("--bandwidth", type=float, default=1e10, help="of one of its ranks, bytes a second")
    parser.add_argument("--launcher", default="mpiexec -n {ranks}")
    parser.add_argument("--tables", action="store_true")
    parser.add_argument("--keep", action="store_true")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    path = os.path.join(args.out, "scaling.csv")
    if args.tables and not os.path.exists(path):
        path = os.path.join(HERE, "scaling.csv")
    kept = Kept(path, COLUMNS, case_of)
    if not args.tables:
        runs = Runs(args)
        with tempfile.TemporaryDirectory(dir=args.out) as folder, tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as runs.session:
            runs.build(folder)
            kept.all(1, runs.rows, cases(args), named)
    from pages import picture, tables

    lines = list(tables(kept.rows, args.latency, args.bandwidth))
    with open(os.path.join(args.out, "scaling.md"), "w") as f:
        f.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    picture(kept.rows, os.path.join(args.out, "scaling"), args.latency, args.bandwidth)
    if args.keep:
        keep(args, lines)


if __name__ == "__main__":
    main()
