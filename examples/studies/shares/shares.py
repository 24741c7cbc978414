#!/usr/bin/env python3
"""Where the time of an adaptive run goes, and what contact and adaptivity cost, for 1e3 to 1e6 unknowns of two layers in exact contact.

  shares.py [--abut build/bin/abut] [--out out] [--most 1e6] [--estimator zz] [--solver direct hypre] [--order 1]

Every row is one run with -scene_tol, whose tolerance is chosen so that the last mesh has about as many unknowns as the row says.
Leaves shares.csv, one line a run, and shares.md, the table. Runs that shares.csv already has are not repeated: delete it after a change of
the program. Seconds are those of this machine, alone; compare rows of one study only.
"""
import argparse, csv, math, os, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
EXAMPLES = os.path.dirname(STUDIES)
sys.path[:0] = [os.path.join(EXAMPLES, "layers"), STUDIES]
from layers import record  # noqa: E402
from study import append  # noqa: E402

SCENE = os.path.join(STUDIES, "shares", "layers_tol.yml")
SIZES = (1e3, 1e4, 1e5, 1e6, 1e7)
CONSTANT = {1: 1.05, 2: 0.55}  # of the relative energy error: CONSTANT[p] * unknowns^(-p/2), roughly
SOLVERS = {"direct": "", "hypre": " ".join(f"-{body}_ksp_type cg -{body}_pc_type hypre" for body in ("lower", "upper"))}
PARTS = ("mesh and assembly", "factor", "loop", "estimate", "adapt", "output")
COLUMNS = "size solver estimator order status verdict unknowns cycles sweeps seconds ratio memory".split() + list(PARTS)


def run(args, size, solver):
    tolerance = CONSTANT[args.order] * size ** (-args.order / 2) / 0.75  # three quarters of it are the mesh's
    options = f"-scene_tol {tolerance:.3g} -estimator_type {args.estimator} -adaptor_max_level 28 -adaptor_max_unknowns 100000000"
    options += f" -lower_mesh_order {args.order} -upper_mesh_order {args.order} -record_time_ratio {SOLVERS[solver]}"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        path = os.path.join(folder, "record")
        command = [args.abut, "-options_file", SCENE, *options.split(), "-record", path]
        result = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "TMPDIR": folder, "OMP_NUM_THREADS": "1"})
        if not os.path.exists(path):
            raise SystemExit(f"{' '.join(command)}\n{result.stderr}")
        r = record(path)
    row = {"size": f"{size:g}", "solver": solver, "estimator": args.estimator, "order": args.order, "status": result.returncode}
    row.update(verdict=r["verdict"], unknowns=int(r["unknowns"]), cycles=int(r["cycles"]), sweeps=int(r["sweeps"]))
    row.update(seconds=r["time.total"], ratio=r["time.ratio"], memory=r["memory.peak"])
    row.update(zip(PARTS, (r["time.setup"] - r["time.factor"], *(r[f"time.{part}"] for part in "factor solve estimate adapt output".split()))))
    return row


def table(rows):
    yield "| solver | unknowns | meshes | sweeps | seconds | " + " | ".join(f"{part} %" for part in PARTS)
    yield "|---" * (len(PARTS) + 7) + "|"
    previous = None
    for row in rows:
        seconds = float(row["seconds"])
        growth = "" if not previous or previous["solver"] != row["solver"] else "{:.2f}".format(
            math.log(seconds / float(previous["seconds"])) / math.log(float(row["unknowns"]) / float(previous["unknowns"])))
        shares = " | ".join(f"{100 * float(row[part]) / seconds:.0f}" for part in PARTS)
        yield (f"| {row['solver']} | {int(row['unknowns']):,} | {row['cycles']} | {row['sweeps']} | {seconds:.3g} | {shares} | "
               f"{growth} | {float(row['ratio']):.1f} | {float(row['memory']) / float(row['unknowns']) / 1e3:.2f} |")
        previous = row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(os.path.dirname(EXAMPLES), "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--most", type=float, default=1e5, help="unknowns of the largest run; 1e6 takes minutes, 1e7 most of an hour")
    parser.add_argument("--estimator", default="zz")
    parser.add_argument("--solver", nargs="+", default=list(SOLVERS), choices=list(SOLVERS))
    parser.add_argument("--order", type=int, default=1, choices=list(CONSTANT))
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    path, done = os.path.join(args.out, "shares.csv"), {}
    if os.path.exists(path):
        with open(path) as f:
            done = {(r["size"], r["solver"], r["estimator"], int(r["order"])): r for r in csv.DictReader(f)}
    rows = []
    for solver in args.solver:
        for size in (size for size in SIZES if size <= args.most):
            key = f"{size:g}", solver, args.estimator, args.order
            if key not in done:
                done[key] = run(args, size, solver)
                append(path, COLUMNS, [done[key]])
                print(f"{solver:8}{size:8g} unknowns wanted, {done[key]['unknowns']} had, {float(done[key]['seconds']):.1f} s", flush=True)
            rows.append(done[key])
    lines = list(table(rows))
    lines[0] += " | grows as N^ | in linear problems | kB an unknown |"
    with open(os.path.join(args.out, "shares.md"), "w") as f:
        f.write("\n".join(lines) + "\n")
    print("\n".join(lines))
    return any(int(row["status"]) for row in rows)


if __name__ == "__main__":
    sys.exit(main())
