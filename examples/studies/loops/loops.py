#!/usr/bin/env python3
"""Sweeps of the contact loops on the layers, for penalties c from 0.5 to 0, three uniform meshes and a graded one, four pairs of layers.

  loops.py [--abut build/bin/abut] [--out out] [--cap 300] [--processes 2] [--quick] [--layers equal]

Leaves loops.csv, one line a run, loops.md, the tables, and loops.png and .svg. Runs that loops.csv already has are not repeated: delete it
after a change of the program.
The exit status is 1 if the default loop fails anywhere, or takes more sweeps than the page of this folder says.
"""
import argparse, collections, csv, os, statistics, subprocess, sys, tempfile, threading, time

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.dirname(os.path.dirname(HERE))
LOOPS = os.path.join(os.path.dirname(EXAMPLES), "petscopts", "loop")
sys.path[:0] = [os.path.join(EXAMPLES, "layers"), EXAMPLES, os.path.dirname(HERE)]
from layers import record  # noqa: E402
from study import append, side_by_side  # noqa: E402

RTOL = 1e-8
PENALTIES = (0.5, 0.05, 0.005, 5e-4, 5e-5, 0)
MESHES = ("1/16", "1/32", "1/64", "graded")
LAYERS = {  # (E, nu, height) of the upper and of the lower layer; gap and closure are those of examples/layers
    "equal": ((2.1e5, 0.3, 1), (2.1e5, 0.3, 1)),
    "steel on aluminium": ((2.1e5, 0.3, 1), (7e4, 0.33, 1)),
    "E 10000:1": ((2.1e9, 0.3, 1), (2.1e5, 0.3, 1)),
    "heights 2:1": ((2.1e5, 0.3, 2), (2.1e5, 0.3, 1)),
}
INNER = 1e-9  # of CG in the softer body; a stiffer one also has its prescribed displacement in the right-hand side, times its modulus
TYPES = {
    "paper": "-snes_type ddneumann -snes_ddneumann_gamma 0.02",
    "automatic": "-snes_type ddneumann",
    "anderson": f"-options_file {LOOPS}/anderson.opts",
    "ngmres": f"-options_file {LOOPS}/ngmres.opts",
    "qn": f"-options_file {LOOPS}/qn.opts",
    "ddactive": "-snes_type ddactive",
    "ddactive hypre": "-snes_type ddactive",
}
DEFAULT, INEXACT = "ddactive", "ddactive hypre"
MOST = {"max": 20, "uniform max": 15, "median": 12, "hypre": 2, "spread": 1e-5}
COLUMNS = "layers mesh c loop cap status verdict sweeps error_loop force edge unknowns hmin seconds".split()
Case = collections.namedtuple("Case", "layers mesh c loop cap")


def scene(case, edge=None):
    """Options of a run; a graded mesh has its smallest cells at the end of the contact, `edge`"""
    upper, lower = LAYERS[case.layers]
    n = 13 if case.mesh == "graded" else int(case.mesh[2:])  # 1/13 halved seven times is 6.0e-4
    text = "-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 1e-3*x^2"
    text += f" -mid_pair_theta {case.c / min(upper[0], lower[0])!r} -snes_rtol {RTOL} -snes_max_it {case.cap}"
    for name, (young, poisson, height), y in (("lower", lower, (0, 1)), ("upper", upper, (1, 1 + upper[2]))):
        text += f" -{name}_mesh_box 0,{y[0]},4,{y[1]} -{name}_mesh_cells {4 * n},{height * n}"
        text += f" -{name}_material_young {young} -{name}_material_poisson {poisson} -{name}_bc_left_u1 0"
        if case.loop == INEXACT:
            text += f" -{name}_ksp_type cg -{name}_pc_type hypre -{name}_ksp_rtol {INNER * min(upper[0], lower[0]) / young!r}"
        if case.mesh == "graded":
            text += f" -{name}_mesh_size max(6.1e-4,0.1*sqrt((x-{edge!r})^2+(y-1)^2))"
    return f"{text} -lower_bc_bottom_u2 0 -upper_bc_top_u2 -1.366e-3 {TYPES[case.loop]}".split()


class Study:
    def __init__(self, args):
        self.args, self.lock = args, threading.Lock()
        self.path = os.path.join(args.out, "loops.csv")
        self.rows, self.edges = {}, {}
        if os.path.exists(self.path):
            with open(self.path) as f:
                for row in csv.DictReader(f):
                    row["c"], row["cap"] = float(row["c"]), int(row["cap"])
                    self.rows[Case(*(row[key] for key in Case._fields))] = row

    def run(self, case):
        edge = self.edge(case) if case.mesh == "graded" else None
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:  # also where MPI keeps its session
            path = os.path.join(folder, "record")
            command, start = [self.args.abut, *scene(case, edge), "-record", path], time.time()
            result = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "TMPDIR": folder, "OMP_NUM_THREADS": "1"})
            run = record(path) if os.path.exists(path) else {}
        row = dict(case._asdict(), status=result.returncode, seconds=f"{time.time() - start:.2f}")
        if result.returncode == 1 and "needs a penalty" in result.stderr:
            row["verdict"] = "refused"
        elif not run:
            raise SystemExit(f"{' '.join(command)}\n{result.stderr}")
        else:
            row.update(verdict=run["verdict"], sweeps=int(run["sweeps"]), error_loop=run["error.loop"], force=run["pair.mid.force"])
            row.update(edge=run["pair.mid.contact_edge"], unknowns=int(run["unknowns"]), hmin=run["body.upper.hmin"])
        return row

    def edge(self, case):
        """Where the contact ends, from the default loop on 1/16"""
        key = case.layers, case.c
        if key not in self.edges:
            self.edges[key] = self.run(case._replace(mesh="1/16", loop=DEFAULT))["edge"]
        return self.edges[key]

    def keep(self, case, row, done, total):
        with self.lock:
            append(self.path, COLUMNS, [row])
            self.rows[case] = row
            what = f"{case.layers}, {case.mesh}, c = {case.c:g}, {case.loop}"
            print(f"{done:4}/{total}  {row['seconds']:>7} s  {what:55}{row['verdict']:15}{row.get('sweeps', '')}", flush=True)

    def all(self, cases):
        todo = [case for case in cases if case not in self.rows]
        print(f"{len(cases)} runs, {len(cases) - len(todo)} of them in {self.path}", flush=True)
        side_by_side(self.args.processes, self.run, todo, self.keep)


def text(row):
    """A cell of the table: the sweeps of a run that converged, or why it did not"""
    if row["verdict"] == "converged":
        return str(row["sweeps"])
    return "refused" if row["verdict"] == "refused" else f"*{row['verdict'].replace('_', ' ')}, {row['sweeps']}*"


def tables(rows, cases, cap):
    loops = [loop for loop in TYPES if any(case.loop == loop for case in cases)]
    yield f"Sweeps to a residual of {RTOL:g}; in italics why a loop failed, and after how many sweeps. At most {cap} iterations.\n"
    for layers, mesh in dict.fromkeys((case.layers, case.mesh) for case in cases):
        yield f"\n**{layers}, {mesh}**\n\n| c | " + " | ".join(loops) + " |\n" + "|---" * (len(loops) + 1) + "|"
        for c in dict.fromkeys(case.c for case in cases):
            yield f"| {c:g} | " + " | ".join(text(rows[Case(layers, mesh, c, loop, cap)]) for loop in loops) + " |"


def summary(rows, cases):
    """Lines that say how the default loop did, and what of it is not as promised"""
    mine = {case: rows[case] for case in cases if case.loop == DEFAULT}
    failed = [case for case in cases if case.loop in (DEFAULT, INEXACT) and rows[case]["verdict"] != "converged"]
    sweeps = [int(row["sweeps"]) for row in mine.values()]
    uniform = [int(row["sweeps"]) for case, row in mine.items() if case.mesh != "graded"]
    change = [abs(int(rows[case._replace(loop=INEXACT)]["sweeps"]) - int(row["sweeps"])) for case, row in mine.items()]
    spread = {key: [] for key in ((case.layers, case.mesh, case.c) for case in cases)}
    for case in cases:
        if rows[case]["verdict"] == "converged":
            spread[case[:3]].append(float(rows[case]["force"]))
    spread = max(max(forces) / min(forces) - 1 for forces in spread.values() if forces)
    found = {"max": max(sweeps), "uniform max": max(uniform), "median": statistics.median(sweeps), "hypre": max(change), "spread": spread}
    lines = [
        f"{DEFAULT}: {len(mine)} runs, {sum(case.loop == DEFAULT for case in failed)} failed; sweeps {found['max']} at most, "
        f"median {found['median']:g}, {found['uniform max']} at most on uniform meshes",
        f"{INEXACT}: {found['hypre']} sweeps more or less than with the direct solver, at most",
        f"forces of loops that converged differ by at most {spread:.1e}",
    ]
    for loop in (loop for loop in TYPES if loop not in (DEFAULT, INEXACT)):
        verdicts = collections.Counter(rows[case]["verdict"] for case in cases if case.loop == loop)
        lines.append(f"{loop}: " + ", ".join(f"{n} {verdict.replace('_', ' ')}" for verdict, n in verdicts.most_common()))
    wrong = [f"{case.layers}, {case.mesh}, c = {case.c:g}, {case.loop}: {rows[case]['verdict']}" for case in failed]
    wrong += [f"{key}: {found[key]:g}, {most:g} promised" for key, most in MOST.items() if found[key] > most]
    return lines, wrong


def draw(rows, cases, folder):
    """Sweeps against c, a panel a mesh and pair of layers; c = 0 at the left. A loop that failed is a cross at what it swept in vain"""
    from picture import legend_above, plt, save

    names, meshes = (list(dict.fromkeys(getattr(case, key) for case in cases)) for key in ("layers", "mesh"))
    size = 2.6 * len(meshes), 2.2 * len(names) + 0.4
    figure, axes = plt.subplots(len(names), len(meshes), figsize=size, sharex=True, sharey=True, squeeze=False)
    penalties = sorted({case.c for case in cases})
    place = {c: c or penalties[1] / 10 for c in penalties}
    for name, row in zip(names, axes):
        for mesh, axis in zip(meshes, row):
            for loop, color, marker in zip(TYPES, ("0.5", *(f"C{i}" for i in range(6))), "xsD^vo+"):
                mine = [(place[case.c], rows[case]) for case in cases if (case.layers, case.mesh, case.loop) == (name, mesh, loop)]
                good = sorted((c, int(row["sweeps"])) for c, row in mine if row["verdict"] == "converged")
                bad = [(c, int(row["sweeps"])) for c, row in mine if row["verdict"] not in ("converged", "refused")]
                line = "-" if loop == DEFAULT else "--"
                axis.loglog(*(zip(*good) if good else ([], [])), color=color, marker=marker, ls=line, label=loop)
                axis.loglog(*(zip(*bad) if bad else ([], [])), color=color, marker="x", ls="", ms=5)
            axis.set_title(f"{name}, {mesh}")
    for axis in axes[-1]:
        axis.set(xlabel="c", xticks=list(place.values()), xticklabels=["0" if not c else f"{c:g}" for c in penalties])
        axis.minorticks_off()
        axis.tick_params(axis="x", labelrotation=45)
    for axis in axes[:, 0]:
        axis.set_ylabel("sweeps")
    legend_above(figure, axes[0], 4)
    save(figure, os.path.join(folder, "loops"), 64)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(os.path.dirname(EXAMPLES), "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--cap", type=int, default=300, help="iterations after which a loop is stopped [300]")
    parser.add_argument("--processes", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--quick", action="store_true", help="two meshes, three penalties, two pairs of layers: less than a minute")
    parser.add_argument("--layers", choices=LAYERS, help="only these")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    layers, meshes, penalties = (LAYERS, MESHES, PENALTIES) if not args.quick else (list(LAYERS)[:2], MESHES[:2], (0.05, 5e-4, 0))
    layers = [args.layers] if args.layers else layers
    cases = [Case(a, mesh, c, loop, args.cap) for a in layers for mesh in meshes for c in penalties for loop in TYPES]
    study = Study(args)
    study.all(cases)
    lines, wrong = summary(study.rows, cases)
    path = os.path.join(args.out, "loops.md")
    with open(path, "w") as f:
        print("\n".join(tables(study.rows, cases, args.cap)) + "\n\n" + "\n\n".join(lines), file=f)
    draw(study.rows, cases, args.out)
    print("\n".join([path, *lines, *(f"NOT AS PROMISED: {line}" for line in wrong)]))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
