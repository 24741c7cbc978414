#!/usr/bin/env python3
"""What the paper's Figs 4-10 show, computed again: von Mises stress, refinement without the extra rule and with it, meshes, displacements
against delta, contact displacement and pressure by iteration, unknowns against 1/delta. docs/paper.md is the page to it.

  paper.py [--abut build/bin/abut] [--out out/paper] [--processes 2] [--only NAME ...] [--tables]

Leaves cycles.csv (a line for each mesh of each run), meshes.csv, profiles.csv, paper.md (the tables), and the figures as PNG and SVG. Runs
that cycles.csv already has are not repeated: delete the folder after a change of the program. --tables runs nothing.
"""
import argparse, csv, glob, os, subprocess, sys, tempfile, threading, time

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
EXAMPLES = os.path.dirname(STUDIES)
sys.path[:0] = [os.path.join(EXAMPLES, "layers"), STUDIES, HERE]
from layers import profile_rows  # noqa: E402
from figures import draw  # noqa: E402
from study import append, side_by_side  # noqa: E402
from tables import SIX, tables  # noqa: E402

LAYERS, GIVEN = os.path.join(EXAMPLES, "layers", "layers.yml"), os.path.join(HERE, "given.yml")
# Pressures on the adapted side: cells smaller than those of the pressure side would be split without end, the dual functions jump there
CONTACT = f"{LAYERS} -mid_pair_pressure_side second -adaptor_max_level 14"
FAST = "-snes_type ddactive"  # the answer of the paper's loop on every mesh, in 4 sweeps instead of some 500
# An upper body whose own error is below a thousandth, so that what is left of the energy's is the lower body's
EXACT = "-upper_mesh_shape quad -upper_mesh_order 3 -upper_mesh_cells 32,8 -upper_mesh_size max(2e-3,0.2*sqrt((x-1.009)^2+(y-1)^2))"
UNIFORM = "-adaptor_threshold 1e9"
ESTIMATORS = {
    "fembem": "-estimator_type fembem -estimator_fembem_solve galerkin",
    "none": "-estimator_type fembem -estimator_fembem_solve none",
    "zz": "-estimator_type zz",
}
DELTAS = (0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.035)
CELLS = (1, 2, 4, 8, 16, 32, 64)  # times 8 by 2
FIRST = ("4,1", "16,4", "32,8")  # first meshes beside 8,2: that of the paper is not known
CAP = 20000  # unknowns at which refinement without end is ended
SECONDS = 250

COLUMNS = "run cycle verdict unknowns cells marked level hmin bem uniform eta eta_max force u1 u2 vm energy seconds".split()
KEYS = {  # of the record
    "unknowns": "body.lower.unknowns", "cells": "body.lower.cells", "level": "body.lower.level_max", "hmin": "body.lower.hmin",
    "bem": "unknowns_estimator", "uniform": "body.lower.unknowns_uniform", "eta": "eta.lower", "eta_max": "eta_max.lower",
    "force": "pair.mid.force", "u1": "probe.A.u1", "u2": "probe.A.u2", "vm": "probe.A.vm", "verdict": "verdict", "seconds": "time.total",
}
RUNS = {}
for name, options in ESTIMATORS.items():
    RUNS[f"paper {name}"] = f"{CONTACT} -scene_interleave {options}"  # Fig. 2: a sweep and an adaptation an iteration
    RUNS[f"rule {name}"] = f"{CONTACT} {FAST} {options}"
    RUNS[f"no rule {name}"] = f"{CONTACT} {FAST} {options} -lower_mesh_balance no -adaptor_max_unknowns {CAP}"
    RUNS[f"given {name}"] = f"{GIVEN} {options}"
    RUNS[f"given, no rule {name}"] = f"{GIVEN} {options} -lower_mesh_balance no -adaptor_max_unknowns {CAP}"
RUNS.update({f"paper, first mesh {cells}": f"{CONTACT} -scene_interleave -lower_mesh_cells {cells}" for cells in FIRST})
RUNS["paper, stop 0.0001"] = f"{CONTACT} -scene_interleave -scene_eps_u 1e-4"
RUNS.update({f"delta {d:g}": f"{CONTACT} {FAST} {EXACT} -adaptor_threshold {d:g}" for d in DELTAS})
RUNS.update({f"uniform {n}": f"{CONTACT} {FAST} {EXACT} {UNIFORM} -lower_mesh_cells {8 * n},{2 * n}" for n in CELLS})
FIELDS = {SIX: (0, 2, -1), "no rule fembem": (6,), "rule fembem": (-1,)}  # meshes to be drawn, of these cycles
PROFILES = (SIX,)


def read_cycles(text, path):
    """Rows of one run: its CSV, and the marked cells from what it printed"""
    table = (line.split() for line in text.splitlines())
    marked = {int(words[0]): int(words[3]) for words in table if len(words) == 8 and words[0].isdigit()}
    with open(path) as f:
        for cycle, r in enumerate(csv.DictReader(f), 1):
            row = {column: r.get(key, "") for column, key in KEYS.items()}
            if "pair.mid.force" in r:
                row["energy"] = repr(float(r["energy.strain"]) + float(r["energy.penalty"]))
            yield dict(row, cycle=cycle, marked=marked.get(cycle, ""))


def read_meshes(path, cycles):
    """Cells of the lower body as rectangles, with their von Mises stress"""
    import h5py

    with h5py.File(path) as f:
        names = sorted(f)
        for cycle in sorted({range(len(names))[c] for c in cycles if c < len(names)}):
            body = f[names[cycle]]["lower"]
            corners = body["vertices"][:][body["cells"][:].astype(int)]
            for cell, stress in zip(corners, body["von_mises"][:].ravel()):
                (x0, y0), (x1, y1) = cell.min(0), cell.max(0)
                yield dict(cycle=cycle + 1, x0=f"{x0:.9g}", y0=f"{y0:.9g}", x1=f"{x1:.9g}", y1=f"{y1:.9g}", von_mises=f"{stress:.6g}")


def read_profiles(stem):
    for cycle, path in enumerate(sorted(glob.glob(f"{stem}_????.csv")), 1):
        for r in profile_rows(path):
            if r["side"] in ("2", "pressure") and float(r["x"]) <= 2:
                yield dict(cycle=cycle, what="pressure" if r["pressure"] else "u_n", x=r["x"], value=r["pressure"] or r["u_n"])


class Study:
    def __init__(self, args):
        self.args, self.lock = args, threading.Lock()
        self.rows = {}
        for row in self.read("cycles"):
            self.rows.setdefault(row["run"], []).append(row)

    def path(self, name):
        return os.path.join(self.args.out, f"{name}.csv")

    def read(self, name):
        if not os.path.exists(self.path(name)):
            return []
        with open(self.path(name)) as f:
            return list(csv.DictReader(f))

    def run(self, name):
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # also where MPI keeps its session
            stem, start = os.path.join(folder, "run"), time.time()
            command = [self.args.abut, "-options_file", *RUNS[name].split(), "-record_csv", f"{stem}.csv"]
            if name in PROFILES:
                command += ["-output_profile", f"{stem}_profile.csv", "-output_profile_cycles"]
            if name in FIELDS:
                command += ["-output", f"{stem}.xdmf"]
            try:
                result = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS,
                                        env={**os.environ, "TMPDIR": folder, "OMP_NUM_THREADS": "1"})
            except subprocess.TimeoutExpired:
                return [dict(verdict=f"stopped after {SECONDS} s")], [], []
            if not os.path.exists(f"{stem}.csv"):
                return [dict(verdict=(result.stderr.strip() or f"exit status {result.returncode}").splitlines()[-1], seconds=time.time() - start)], [], []
            meshes = list(read_meshes(f"{stem}.h5", FIELDS[name])) if name in FIELDS else []
            return list(read_cycles(result.stdout, f"{stem}.csv")), meshes, list(read_profiles(f"{stem}_profile"))

    def keep(self, name, result, done, total):
        with self.lock:
            cycles, meshes, profiles = ([dict(row, run=name) for row in rows] for rows in result)
            for what, columns, rows in (("meshes", ("run", "cycle", "x0", "y0", "x1", "y1", "von_mises"), meshes),
                                        ("profiles", ("run", "cycle", "what", "x", "value"), profiles), ("cycles", COLUMNS, cycles)):
                if rows:  # the cycles last: a run that is in their file is complete
                    append(self.path(what), columns, rows)
            self.rows[name] = cycles
            last = cycles[-1]
            print(f"{done:3}/{total}  {name:24}{len(cycles):4} meshes {last.get('unknowns', ''):>8} unknowns  {last['verdict']}", flush=True)

    def all(self, names):
        todo = [name for name in names if name not in self.rows]
        print(f"{len(names)} runs, {len(names) - len(todo)} of them in {self.path('cycles')}", flush=True)
        side_by_side(self.args.processes, self.run, todo, self.keep)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(os.path.dirname(EXAMPLES), "build", "bin", "abut"))
    parser.add_argument("--out", default=os.path.join("out", "paper"))
    parser.add_argument("--processes", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--only", nargs="+", choices=RUNS, help="only these runs, and no figures")
    parser.add_argument("--tables", action="store_true", help="run nothing: tables and figures of what is there")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    study = Study(args)
    if not args.tables:
        study.all(args.only or list(RUNS))
    if args.only:
        return
    rows, profiles = {name: study.rows[name] for name in RUNS if name in study.rows}, study.read("profiles")
    lines = list(tables(rows, profiles))
    with open(os.path.join(args.out, "paper.md"), "w") as f:
        print("\n".join(lines), file=f)
    print("\n".join(lines))
    draw(rows, study.read("meshes"), profiles, args.out)


if __name__ == "__main__":
    main()
