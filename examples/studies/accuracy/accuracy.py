#!/usr/bin/env python3
"""What an answer costs: errors of contact force and peak pressure on two layers in exact contact, for every order, estimator, marking, with
and without following of the contact edge.

  accuracy.py [--abut build/bin/abut] [--out out] [--processes 2] [--quick] [--order 2] [--tables]

Leaves accuracy.csv, one line a mesh, accuracy.md, the tables, and accuracy.png and .svg. Every line is a run of its own that ends with this
mesh: its CPU seconds are those of the whole process, start-up included. Cases that accuracy.csv already has are not repeated: delete it
after a change of the program. --tables runs nothing and makes tables of what is there.
"""

import argparse, collections, csv, json, os, sys, tempfile, threading

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
SCENE = os.path.join(HERE, "layers_exact.yml")
EXAMPLES = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [os.path.join(EXAMPLES, "layers"), EXAMPLES, os.path.dirname(HERE)]
from layers import number, profile, record  # noqa: E402
from study import append, chebyshev, cpu_of, ends, first_that, load, points, pressure_error, side_by_side  # noqa: E402

ORDERS = (1, 2, 3, 4)
ESTIMATORS = ("zz", "residual", "fembem")
MARKINGS = {
    "bulk .5": "-adaptor_bulk 0.5",
    "bulk .7": "-adaptor_bulk 0.7",
    "bulk .7, jump 2": "-adaptor_bulk 0.7 -adaptor_jump 2",
    "bulk .6, jump 3": "-adaptor_bulk 0.6 -adaptor_jump 3",
    "bulk .7, jump 3": "-adaptor_bulk 0.7 -adaptor_jump 3",
}
PEAKS = {  # with the peak pressure asked for, and meshes solved twice
    f"{name}, peak {peak}{settle}": f"{marking} -adaptor_peak {peak}" + (" -adaptor_settle yes" if settle else "")
    for name, marking in {**MARKINGS, "bulk .4, jump 3": "-adaptor_bulk 0.4 -adaptor_jump 3"}.items()
    if name not in ("bulk .7", "bulk .7, jump 3")
    for peak, settle in (("1e-4", ", settled"), ("5e-6", ", settled"), ("5e-6", ""))
}
LINEAR = {  # of order 1: steps small enough not to jump over an error, and pressures on the stiffer of two bodies
    "bulk .3": "-adaptor_bulk 0.3",
    "bulk .35": "-adaptor_bulk 0.35",
    "bulk .4": "-adaptor_bulk 0.4",
    "bulk .5, pressures on upper": "-adaptor_bulk 0.5 -mid_pair_pressure_side first",
}
FOLLOWING = ("yes", "no")
OPTIONS = {**MARKINGS, **PEAKS, **LINEAR}
MOST = {1: 14000, 2: 4500, 3: 3500, 4: 6000}  # unknowns of one body, by order: beyond the limits, to see whether a target stays met
LAYERS = {"equal": "", "steel on aluminium": "-lower_material_young 7e4 -lower_material_poisson 0.33"}
STARTS = {"8,2 on 8,2": "", "8,2 on 6,2": "-lower_mesh_cells 6,2"}
SCENE_CLOSURE, SCENE_START = 1.366, "8,2 on 8,2"
SCENE_KEY = ("equal", SCENE_CLOSURE, SCENE_START)
OTHERS = [("equal", closure, SCENE_START) for closure in (1.0, 1.2, 1.6, 2.2)]
OTHERS += [("steel on aluminium", SCENE_CLOSURE, SCENE_START), ("equal", SCENE_CLOSURE, "8,2 on 6,2")]
TARGETS = ((1e-3, 2e-3), (1e-4, 1e-3), (1e-5, 1e-4), (1e-7, 1e-5), (1e-8, 5e-6))  # of P and p0
LIMITS = {(1, 1): 9500, (2, 1): 900, (2, 2): 2100, (3, 2): 1700, (4, 3): 3800, (4, 4): 6200}  # unknowns by order and target
OTHERS_BY = [(order, estimator, "bulk .5", "yes" if order > 1 else "no") for order in ORDERS for estimator in ESTIMATORS]
OTHERS_BY += [(2, estimator, "bulk .7", "yes") for estimator in ESTIMATORS]
OTHERS_BY += [(1, estimator, marking, follow) for estimator in ("zz", "residual") for marking in LINEAR for follow in FOLLOWING]
OTHERS_BY += [(1, "fembem", "bulk .35", "no")]
PEAKS_BY = [
    (order, estimator, marking, "yes") for order in ORDERS[1:] for estimator in ("zz", "residual") for marking in PEAKS if ("1e-4" in marking) == (order < 4)
]
ALLOWED = {"closure": 1.15, "other": 1.5}  # times these where the closure, or materials and first meshes are others
PEERS = {"ngsolve": ("ZZ",), "dealii": ("Kelly",), "getfem": ("ALM", "pen"), "kratos": ("ALM",)}
BEST = ("residual", "bulk .5")  # what the plot shows, and --quick runs
HEAD = """In every field: unknowns of both bodies, meshes, sweeps, CPU seconds of the whole process, relative error of the edge and of the
nodal pressures in L2, all of the first mesh from which on every mesh meets the target for the relative errors of (P, p0).
The fixed reference load took {:.3f} s of CPU."""
with open(os.path.join(HERE, "reference.json")) as _file:
    REFERENCE = json.load(_file)
Case = collections.namedtuple("Case", "layers closure start order estimator marking follow")
COLUMNS = [*Case._fields, *"cycle verdict unknowns cells sweeps P p0 p0_nodal edge pressure_error estimate cpu".split()]


def options(case):
    text = f"-lower_mesh_order {case.order} -upper_mesh_order {case.order} -upper_bc_top_u2 {-1e-3 * case.closure!r}"
    text += f" -estimator_type {case.estimator} {OPTIONS[case.marking]} -adaptor_max_unknowns {MOST[case.order]}"
    text += f" -adaptor_follow {case.follow}"
    return [*text.split(), *LAYERS[case.layers].split(), *STARTS[case.start].split()]


def reference(case):
    for one in REFERENCE["cases"]:
        if (one["materials"], one["closure"]) == (case.layers, case.closure):
            return one
    raise SystemExit(f"reference.json has no {case.layers} with closure {case.closure}")


class Study:
    def __init__(self, args):
        self.args, self.lock, self.cases = args, threading.Lock(), {}
        self.path = os.path.join(args.out, "accuracy.csv")
        if os.path.exists(self.path):
            with open(self.path) as f:
                for row in csv.DictReader(f):
                    row = {
                        key: number(value) if key not in Case._fields or key in ("closure", "order") else value
                        for key, value in row.items()
                    }
                    row["order"] = int(row["order"])
                    self.cases.setdefault(Case(*(row[key] for key in Case._fields)), []).append(row)

    def meshes(self, case):
        """One line a mesh; of a case that failed one line of mesh 0, which says why"""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "run.csv")
            command = [self.args.abut, SCENE, *options(case)]
            status, said, cpu = cpu_of([*command, "-record_csv", path])[:3]
            if status not in (0, 3) or not os.path.exists(path):  # 3: a limit was reached, which the verdict names
                yield dict(case._asdict(), cycle=0, verdict=said, cpu=cpu)
                return
            with open(path) as f:
                series = [{key: number(value) for key, value in row.items()} for row in csv.DictReader(f)]
            if "settled" in case.marking:  # the second solve of each mesh; the first only moves it
                series = [row for row, after in zip(series, series[1:] + [{}]) if row["unknowns"] != after.get("unknowns")]
            for row, target in ends(series):
                yield self.mesh(case, command, row, target, folder)

    def mesh(self, case, command, row, target, folder):
        """A run that ends with the mesh of this line"""
        paths = [os.path.join(folder, name) for name in ("record", "profile.csv")]
        status, said, cpu = cpu_of([*command, "-adaptor_target", repr(target), "-record", paths[0], "-output_profile", paths[1]])[:3]
        line = dict(case._asdict(), cycle=int(row["cycles"]), cpu=f"{cpu:.3f}", unknowns=int(row["unknowns"]))
        run = record(paths[0]) if status in (0, 3) else {}
        if run.get("unknowns") != row["unknowns"]:
            return dict(line, verdict=said if not run else f"ends with {run['unknowns']:.0f} unknowns")
        nodes, pressures = profile(paths[1])
        line.update(verdict=run["verdict"], cells=int(run["body.lower.cells"] + run["body.upper.cells"]), sweeps=int(run["sweeps"]))
        line.update(P=run["pair.mid.force"], p0=run["pair.mid.pressure_max"], p0_nodal=pressures[0], edge=run["pair.mid.contact_edge"])
        one = reference(case)
        off = pressure_error(nodes, pressures, case.order, chebyshev(one), one["a"])
        line.update(pressure_error=f"{off:.3e}", estimate=run["error.discretisation"])
        return line

    def keep(self, case, rows, done, total):
        with self.lock:
            append(self.path, COLUMNS, rows)
            self.cases[case] = rows
            print(f"{done:4}/{total}  {named(case):82}{len(rows):3} meshes  {rows[-1]['verdict'][:60]}", flush=True)

    def all(self, cases):
        todo = [case for case in cases if case not in self.cases]
        print(f"{len(cases)} cases, {len(cases) - len(todo)} of them in {self.path}", flush=True)
        side_by_side(self.args.processes, lambda case: list(self.meshes(case)), todo, self.keep)


def named(case):
    what = f"order {case.order}, {case.estimator}, {case.marking}, following {case.follow}"
    return what if case[:3] == SCENE_KEY else f"{case.layers}, {case.closure}, {case.start}, {what}"


def errors(case, row, p0="p0"):
    """Relative errors of P, p0, and the edge"""
    one = reference(case)
    return [abs(row[key] / one[name] - 1) for key, name in (("P", "P"), (p0, "p0"), ("edge", "a"))]


def solved(rows):
    return [row for row in rows if row.get("P", "") != ""]


def met(case, rows, target, p0="p0"):
    """The first mesh that meets a target which all later ones meet, too, and at least one later one does"""
    return first_that(solved(rows), lambda row: all(error <= most for error, most in zip(errors(case, row, p0), target)))


def pair(target):
    return f"({target[0]:.0e}, {target[1]:.0e})".replace("e-0", "e-")


def table(cases, study):
    """Of each case one line, of each target what it took"""
    yield "\n| order | estimator | marking | following | " + " | ".join(map(pair, TARGETS)) + " |\n" + "|---" * (4 + len(TARGETS)) + "|"
    for case in cases:
        rows, cells = study.cases.get(case, []), []
        for target in TARGETS:
            row = met(case, rows, target)
            if row:
                what = f"{row['unknowns']:.0f}, {row['cycle']:.0f}, {row['sweeps']:.0f}, {float(row['cpu']):.2f}"
                cells.append(f"{what}, {errors(case, row)[2]:.0e}, {float(row['pressure_error']):.0e}")
            else:
                cells.append("-")
        if rows and not solved(rows):
            cells = [f"*{rows[-1]['verdict']}*"] + [""] * (len(TARGETS) - 1)
        yield f"| {case.order} | {case.estimator} | {case.marking} | {case.follow} | " + " | ".join(cells) + " |"


def limits(study, cases):
    """Of every limit the case with the fewest unknowns, on the scene and on the others, with the peak pressure of the record and with the
    nodal one"""
    yield "\n| where | order | target | limit | unknowns | by | unknowns with nodal p0 | by | |\n|---|---|---|---|---|---|---|---|---|"
    for (order, index), limit in LIMITS.items():
        for key in [SCENE_KEY, *OTHERS]:
            same, closure = key == SCENE_KEY, key[1] != SCENE_CLOSURE
            most = limit * (1 if same else ALLOWED["closure" if closure else "other"])
            mine, cells, least = [case for case in cases if case[:4] == (*key, order)], [], []
            if not mine:
                continue
            for p0 in ("p0", "p0_nodal"):
                found = [
                    (row["unknowns"], case) for case in mine for row in [met(case, study.cases.get(case, []), TARGETS[index], p0)] if row
                ]
                least += [unknowns for unknowns, _ in found]
                cells += [f"{unknowns:.0f} | {short(case)}" for unknowns, case in [min(found)]] if found else ["- | "]
            where = "the scene" if same else f"closure {key[1]}" if closure else key[2] if key[0] == "equal" else key[0]
            verdict = "met" if least and min(least) <= most else "**missed**"
            yield f"| {where} | {order} | {pair(TARGETS[index])} | {most:.0f} | {cells[0]} | {cells[1]} | {verdict} |"


def short(case):
    return f"{case.estimator}, {case.marking}" + ("" if case.follow == "yes" else ", no following")


def least(study, cases):
    """Of every target and order the case with the least CPU, and what the peers took"""
    yield "\n| target | order | CPU [s] | meshes | sweeps | unknowns | by | NGSolve: CPU [s] |\n|---|---|---|---|---|---|---|---|"
    for target in TARGETS:
        ngsolve = [row["cpu_s"] for row in peers("ngsolve", "ZZ") if row["err_P"] <= target[0] and row["err_p0"] <= target[1]]
        for order in ORDERS:
            mine = [case for case in cases if case[:4] == (*SCENE_KEY, order)]
            found = [(float(row["cpu"]), row, case) for case in mine for row in [met(case, study.cases.get(case, []), target)] if row]
            if found:
                cpu, row, case = min(found, key=lambda one: one[0])
                counts = " | ".join(f"{row[key]:.0f}" for key in ("cycle", "sweeps", "unknowns"))
                peer = f"{min(ngsolve):.2f}" if ngsolve else "never"
                yield f"| {pair(target)} | {order} | {cpu:.2f} | {counts} | {short(case)} | {peer} |"


def peers(program, *variants):
    rows = points(os.path.join(HERE, "peers.csv"))
    return [row for row in rows if row["program"] == program and row["err_P"] and any(variant in row["variant"] for variant in variants)]


def draw(study, folder):
    from picture import plt, save

    figure, axes = plt.subplots(2, 2, figsize=(11, 7.5))
    for (program, variants), marker in zip(PEERS.items(), "x+1234"):
        mine = peers(program, *variants)
        for axis, column in zip(axes.T, ("unknowns", "cpu_s")):
            for one, error in zip(axis, ("err_P", "err_p0")):
                one.loglog([row[column] for row in mine], [row[error] for row in mine], marker, color="0.5", ms=5, label=program)
    for order, color, marker in zip(ORDERS, ("C0", "C1", "C2", "C3"), "os^D"):
        for follow, style in (("yes", "-"), ("no", ":")):
            case = Case(*SCENE_KEY, order, BEST[0], BEST[1], follow)
            rows = solved(study.cases.get(case, []))
            if not rows:
                continue
            label = f"order {order}" + (", following" if follow == "yes" else "")
            for axis, column in zip(axes.T, ("unknowns", "cpu")):
                for k, one in enumerate(axis):
                    x, y = [float(row[column]) for row in rows], [errors(case, row)[k] for row in rows]
                    one.loglog(x, y, marker + style, color=color, label=label)
    for axis, name in zip(axes, ("error of P", "error of $p_0$")):
        axis[0].set(xlabel="unknowns of both bodies", ylabel=name)
        axis[1].set(xlabel="CPU seconds, all meshes (Abut: with start-up)")
    axes[0, 1].legend(loc="upper left", bbox_to_anchor=(1, 1))
    save(figure, os.path.join(folder, "accuracy"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--processes", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--quick", action="store_true", help="one estimator and marking, with following, and the scene only")
    parser.add_argument("--order", type=int, choices=ORDERS, help="only this")
    parser.add_argument("--tables", action="store_true", help="run nothing")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    study = Study(args)
    main_cases = [
        Case(*SCENE_KEY, *rest) for rest in ((o, e, m, f) for o in ORDERS for e in ESTIMATORS for m in MARKINGS for f in FOLLOWING)
    ]
    main_cases += [Case(*SCENE_KEY, *rest) for rest in PEAKS_BY]
    others = [Case(*key, *rest) for rest in OTHERS_BY + PEAKS_BY for key in OTHERS]
    if args.quick:
        main_cases, others = [case for case in main_cases if (case.estimator, case.marking) == BEST and case.follow == "yes"], []
    main_cases, others = ([case for case in cases if args.order in (None, case.order)] for cases in (main_cases, others))
    cases, seconds = main_cases + others, load()
    if not args.tables:
        study.all(cases)
    path = os.path.join(args.out, "accuracy.md")
    with open(path, "w") as f:
        print(HEAD.format(seconds), file=f)
        print("\n".join(table(main_cases, study)), file=f)
        for key in OTHERS if others else []:
            print(f"\n{key[0]}, closure {key[1]}, first meshes {key[2]}", file=f)
            print("\n".join(table([case for case in others if case[:3] == key], study)), file=f)
        print("\n".join([*limits(study, cases), *least(study, cases)]), file=f)
    draw(study, args.out)
    print(path)
    with open(path) as f:
        print(f.read())


if __name__ == "__main__":
    main()
