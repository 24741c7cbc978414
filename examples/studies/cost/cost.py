#!/usr/bin/env python3
"""What accuracy costs: errors against unknowns, sweeps times unknowns, CPU seconds and memory, all of the whole adaptive run.

  cost.py [--abut build/bin/abut] [--out out] [--full] [--only TEXT ...] [--compare FILE ...] [--repetitions 3] [--processes 2] [--tables]

Leaves cost.csv, one line a mesh, cost.md, the tables, and pictures (.png and .svg): cost, cost_estimators, cost_split. Every line is a run
of its own that ends with this mesh, start-up included, of which CPU and wall seconds are the median of all repetitions, with the least and
the largest. Cases that cost.csv already has are not repeated: delete it after a change of the program. --only takes the cases whose
names, as they are printed, have all the words of one TEXT; --compare puts the points of other programs on the pictures, in the format of
examples/studies/compare; --tables runs nothing, and
takes the cost.csv of this folder if --out has none.
"""
import argparse, collections, os, shutil, statistics, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import scenes  # noqa: E402
from layers import number, profile, record  # noqa: E402
from study import TOP, Kept, cpu_of, ends, load, points, read, where  # noqa: E402

ESTIMATORS = {  # what refines: the series
    "uniform": "",
    "random": "-estimator_type random",
    "fembem": "-estimator_type fembem -estimator_fembem_solve galerkin",
    "fembem none": "-estimator_type fembem -estimator_fembem_solve none",
    "zz": "-estimator_type zz",
    "residual": "-estimator_type residual",
    "fembem+residual": "-estimator_type fembem,residual",
}
OPTS = os.path.join(TOP, "petscopts", "loop")
LOOPS = {
    "ddactive": "-snes_type ddactive",
    "ddneumann": f"-options_file {OPTS}/automatic.opts -snes_max_it 300",
    "anderson": f"-options_file {OPTS}/anderson.opts -snes_max_it 300",
}
ORDERS = (1, 2, 3)
FACTORS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)  # of the first mesh, uniform series
ADAPTOR = "-adaptor_type doerfler -adaptor_bulk 0.5 -adaptor_target 1e-9 -adaptor_max_level 28"
MOST = {"quick": {1: 8000, 2: 3000, 3: 3000}, "full": {1: 60000, 2: 60000, 3: 60000}}  # unknowns of one body, by order
CAPS = {"ddneumann": 1500, "anderson": 1500, "uniform": 30000}  # in the quick preset: these sweep much, and uniform meshes need more
Case = collections.namedtuple("Case", "scene order estimator c loop most")
ERRORS = "err_energy err_p_L2 err_P err_p0 err_a total_P total_p0 penalty_P penalty_p0".split()
COUNTS = "unknowns ndof1 ndof2 cells sweeps work ksp_its".split()
ESTIMATES = "est_mesh est_penalty est_loop est_linear share_estimate".split()
COLUMNS = [*Case._fields, "cycle", "verdict", *COUNTS, *ERRORS, "P", "p0", "a", "energy", *ESTIMATES, "rss_MB"]
COLUMNS += "repetitions cpu_s cpu_min cpu_max wall_s wall_min wall_max np git petsc machine".split()


def case_of(row):
    return Case(row["scene"], int(row["order"]), row["estimator"], float(row["c"]), row["loop"], int(row["most"]))


def named(case):
    return f"{case.scene}, order {case.order}, {case.estimator}, c = {case.c:g}, {case.loop}"


def presets(full):
    most = MOST["full" if full else "quick"]
    if full:
        what = [(scene, order, estimator, 0.0, "ddactive") for scene in scenes.SCENES for order in ORDERS for estimator in ESTIMATORS]
        what += [("layers", o, e, c, "ddactive") for c in scenes.PENALTIES if c for o in ORDERS for e in ESTIMATORS]
        what += [("layers", o, "residual", c, loop) for loop in LOOPS if loop != "ddactive" for c in scenes.PENALTIES if c for o in ORDERS]
        return [Case(*one, most[one[1]]) for one in what]
    what = [(scene, order, estimator, 0.0, "ddactive") for scene in scenes.SCENES for order in ORDERS[:2] for estimator in ESTIMATORS]
    what += [(scene, 3, estimator, 0.0, "ddactive") for scene in scenes.SCENES for estimator in ("uniform", "zz", "residual")]
    what += [("layers", order, "residual", c, "ddactive") for c in scenes.PENALTIES if c for order in ORDERS]
    what += [("layers", 1, "residual", c, loop) for loop in LOOPS if loop != "ddactive" for c in scenes.PENALTIES if c]
    return [Case(*one, CAPS.get(one[2], CAPS.get(one[4], most[one[1]]))) for one in what]


def reason(said):
    """Of a last line, why a run failed"""
    return said.removeprefix("verdict: ")


def build_random(folder):
    """The estimator of this folder, made as one of a user's would be; gives the library"""
    place = os.path.join(os.path.abspath(folder), "random")
    os.makedirs(place, exist_ok=True)
    shutil.copy(os.path.join(HERE, "random.c"), place)
    shutil.copy(os.path.join(TOP, "plugins", "template", "Makefile"), place)
    made = subprocess.run(["make", "-s", "-C", place, "NAME=random", f"ABUT_DIR={TOP}"], capture_output=True, text=True)
    if made.returncode:
        raise SystemExit(f"the estimator of examples/studies/cost/random.c was not built:\n{made.stdout}{made.stderr}")
    return os.path.join(place, "libestimator_random.so")


class Runs:
    def __init__(self, args):
        self.args, self.place, self.plugin = args, where(), ""

    def command(self, case, folder, factor=1):
        text = f"{scenes.SCENES[case.scene].options(case, folder, factor)} {LOOPS[case.loop]}"
        if case.estimator != "uniform":
            text += f" {ADAPTOR} -adaptor_max_unknowns {case.most} {ESTIMATORS[case.estimator]}"
        if case.estimator == "random":
            text += f" -plugin {self.plugin}"
        return [self.args.abut, *text.split()]

    def series(self, case):
        """One row a mesh; where the series fails a row of mesh 0, or of the mesh, that says why, and it ends"""
        with tempfile.TemporaryDirectory() as folder:
            rows = []
            for cycle, command in self.meshes(case, folder):
                rows.append(self.mesh(case, cycle, command, folder) if command else dict(self.start(case, 0), verdict=reason(cycle)))
                if "P" not in rows[-1]:
                    break
            return rows

    def start(self, case, cycle):
        return dict(case._asdict(), cycle=cycle, np=1, **self.place)

    def meshes(self, case, folder):
        """Number of a mesh and a command that ends with it; or what was said, and none"""
        if case.estimator == "uniform":
            for cycle, factor in enumerate(FACTORS, 1):
                command = self.command(case, folder, factor)
                cells = [text for word, text in zip(command, command[1:]) if word.endswith("_mesh_cells")]
                sizes = [[case.order * int(n) + 1 for n in text.split(",")] for text in cells]
                if max(2 * nx * ny for nx, ny in sizes) > case.most:
                    return
                yield cycle, command
            return
        path, command = os.path.join(folder, "run.csv"), self.command(case, folder)
        took = cpu_of([*command, "-record_csv", path])
        series = [{key: number(value) for key, value in row.items()} for row in read(path)]
        series = [row for row in series if row["verdict"] in ("converged", "limit_level", "limit_unknowns")]
        for cycle, (_, target) in enumerate(ends(series), 1):
            yield cycle, [*command, "-adaptor_target", repr(target)]
        if took.status not in (0, 3):  # 3: a limit was reached, as it has to be here
            yield took.said, None

    def mesh(self, case, cycle, command, folder):
        paths, took, first = [os.path.join(folder, name) for name in ("record", "profile.csv")], [], None
        for _ in range(self.args.repetitions):
            took.append(cpu_of([*command, "-record", paths[0], "-output_profile", paths[1]]))
            row = self.start(case, cycle)
            if took[-1].status not in (0, 3) or not os.path.exists(paths[0]):
                return dict(row, verdict=reason(took[-1].said))
            row.update(self.read(case, record(paths[0]), *profile(paths[1])))
            first = first or row
            if any(row[key] != first[key] for key in (*COUNTS, *ERRORS)):
                return {**self.start(case, cycle), "verdict": "repetitions differ"}
        for name, values in (("cpu", [one.cpu for one in took]), ("wall", [one.wall for one in took])):
            middle = (statistics.median(values), min(values), max(values))
            row.update(zip((f"{name}_s", f"{name}_min", f"{name}_max"), (f"{value:.3f}" for value in middle)))
        return dict(row, rss_MB=f"{max(one.rss for one in took) / 1e6:.1f}", repetitions=len(took))

    def read(self, case, run, nodes, pressures):
        values, off = scenes.errors(case, run, nodes, pressures)
        body = [[run[f"body.{name}.{key}"] for name in scenes.SCENES[case.scene].bodies] for key in ("unknowns", "cells", "ksp_its")]
        row = {"verdict": run["verdict"], "unknowns": int(run["unknowns"]), "ndof1": int(body[0][0]), "ndof2": int(body[0][1])}
        row.update(cells=int(sum(body[1])), sweeps=int(run["sweeps"]), work=f"{run['sweeps_work'] * run['unknowns']:.0f}")
        row.update(ksp_its=int(sum(body[2])), **{key: f"{value:.10g}" for key, value in {**values, **off}.items()})
        for key, name in zip(ESTIMATES, ("discretisation", "penalty", "loop", "linear")):
            row[key] = f"{run[f'error.{name}']:.3g}" if f"error.{name}" in run else ""
        row["share_estimate"] = f"{run['time.estimate'] / run['time.total']:.3f}" if "time.estimate" in run else ""
        return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--full", action="store_true", help="all scenes, orders, estimators, penalties and loops, larger meshes: hours")
    parser.add_argument("--only", action="append", default=[], metavar="TEXT", help="cases whose names have all the words of this")
    parser.add_argument("--compare", action="append", default=[], metavar="FILE", help="points of other programs")
    parser.add_argument("--repetitions", type=int, default=3, help="runs of each mesh, for the seconds [3]")
    parser.add_argument("--processes", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--tables", action="store_true", help="run nothing")
    args = parser.parse_args()
    import pages  # what needs Matplotlib

    os.makedirs(args.out, exist_ok=True)
    cases, runs, peers = presets(args.full), Runs(args), [one for path in args.compare for one in points(path)]
    if args.only:
        wanted = [set(text.split()) for text in args.only]
        cases = [case for case in cases if any(words <= set(named(case).replace(",", "").split()) for words in wanted)]
    path = os.path.join(args.out, "cost.csv")
    kept, seconds = Kept(path if os.path.exists(path) or not args.tables else os.path.join(HERE, "cost.csv"), COLUMNS, case_of), load()
    if not args.tables:
        if any(case.estimator == "random" for case in cases if case not in kept.rows):
            runs.plugin = build_random(args.out)
        kept.all(args.processes, runs.series, cases, named)
    series = {case: kept.rows[case] for case in cases if case in kept.rows}
    path = os.path.join(args.out, "cost.md")
    with open(path, "w") as f:
        print("\n".join(pages.tables(series, seconds)), file=f)
    pages.draw(series, peers, args.out)
    print(path)


if __name__ == "__main__":
    main()
