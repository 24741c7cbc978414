#!/usr/bin/env python3
"""How good estimators are, and what they take: every registered one, and those of plugins named with --plugin.

  estimators.py [--abut build/bin/abut] [--out out] [--plugin path/to/libestimator_mine.so ...] [--only NAME ...] [--scene NAME ...]

Each estimator refines the scenes of examples/studies/cost (order 1, exact contact). On every mesh the error of the stress in every cell is
measured from outside, from the displacements that -output writes: against the exact stress (hertz), or that in the middle of the much
smaller cells of a mesh of order 2 (layers, punch), extrapolated from cells twice as large. Leaves estimators.csv, one line a
mesh and body, estimators_meshes.csv, the cells of one mesh of each, estimators.md, the tables, and estimators.png, estimators_meshes.png
and .svg. What estimators.csv already has is not repeated: delete it after a change of the program.
"""
import argparse, collections, os, subprocess, sys, tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
sys.path[:0] = [os.path.join(STUDIES, "cost"), os.path.dirname(STUDIES), STUDIES]
import scenes  # noqa: E402
from layers import number, record  # noqa: E402
from study import TOP, Kept, append, cpu_of, read, where  # noqa: E402

ADAPTOR = "-adaptor_type doerfler -adaptor_bulk 0.5 -adaptor_target 1e-9 -adaptor_max_level 28 -adaptor_max_unknowns 1500"
ADAPTOR += " -scene_loop_share 0"  # the loop runs to its end on every mesh
SETTINGS = {"fembem": {"fembem": "", "fembem none": "-estimator_fembem_solve none"}}  # of types that are more than one
SHOWN = 600  # unknowns of the meshes that are drawn, at least
LEAST = 250  # unknowns of the meshes that count in the tables
GRADED = {  # cells of the reference by the distance from where the stress is singular, times 1, and times 2
    "layers": "{}*min(0.0157,max(1e-4,0.05*sqrt((x-0.99264)^2+(y-1)^2)))",
    "punch": "{}*max(1e-6,min(0.05*sqrt((x-1)^2+y^2),0.0314))",
}
MATERIAL = {"layers": (2.1e5, 2.1e5), "hertz": (2.1e5, 2.1e5), "punch": (2.1e2, 2.1e6)}  # Young's moduli of its bodies
Case = collections.namedtuple("Case", "scene estimator")
Run = collections.namedtuple("Run", "scene order c")
COLUMNS = [*Case._fields, *"verdict cycle body unknowns cells estimate error effectivity effectivity_fine spearman".split()]
COLUMNS += "share_estimate share_body cpu_s git petsc machine".split()
MESHES = [*Case._fields, *"body unknowns x0 y0 x1 y1".split()]


def case_of(row):
    return Case(row["scene"], row["estimator"])


def registered(abut, plugins):
    """Names and options of all estimators: those that the program names, and those of the plugins"""
    text = scenes.SCENES["layers"].options(Run("layers", 1, 0.0), "")
    command = [abut, *text.split(), "-estimator_type", "which_are_there", "-adaptor_type", "doerfler"]
    said = subprocess.run(command, capture_output=True, text=True).stderr
    if "there are: " not in said:
        raise SystemExit(f"{abut} does not name its estimators:\n{said}")
    found = {}
    for name in said.split("there are: ")[1].split(" (")[0].split(", "):
        for setting, text in SETTINGS.get(name, {name: ""}).items():
            found[setting] = f"-estimator_type {name} {text}"
    for path in plugins:
        name = os.path.basename(path)
        if not (name.startswith("libestimator_") and name.endswith(".so") and os.path.exists(path)):
            raise SystemExit(f'--plugin: "{path}" is no file libestimator_NAME.so; plugins/template shows how to make one')
        name = name[len("libestimator_") : -len(".so")]
        found[name] = f"-plugin {os.path.abspath(path)} -estimator_type {name}"
    return found


def fields(path, body, cycle):
    """Of a body in a cycle: corners of its cells [n, 4, 2], displacements there, stresses in the middle [n, 3], and eta"""
    import h5py

    with h5py.File(path) as f:
        group = f[f"cycle_{cycle:04}/{body}"]
        cells, x, u = (group[name][()] for name in ("cells", "vertices", "displacement"))
        s = np.stack([group[name][()].ravel() for name in ("s11", "s22", "s12")], axis=1)
        eta = group["eta"][()].ravel() if "eta" in group else None
    return x[cells.astype(int)], u[cells.astype(int), :2], s, eta


class Reference:
    """Points, weights and stresses of a body, as fine as they are there"""

    def __init__(self, abut, scene, times):
        self.points = {}
        with tempfile.TemporaryDirectory() as folder:
            size, kind = GRADED[scene].format(times), scenes.SCENES[scene]
            text = kind.options(Run(scene, 2, 0.0), folder) + "".join(f" -{body}_mesh_size {size}" for body in kind.bodies)
            path = os.path.join(folder, "fine")
            subprocess.run([abut, *text.split(), "-output", path + ".xdmf"], check=True, capture_output=True)
            for body in kind.bodies:
                x, _, s, _ = fields(path + ".h5", body, 0)
                size = x.max(axis=1) - x.min(axis=1)
                self.points[body] = x.mean(axis=1), size.prod(axis=1), s

    def at(self, body, corners):
        """Of each cell the points in it, their weights, and stresses"""
        at, weights, s = self.points[body]
        order = np.argsort(at[:, 0])
        at, weights, s = at[order], weights[order], s[order]
        for low, high in zip(corners.min(axis=1), corners.max(axis=1)):
            part = slice(*np.searchsorted(at[:, 0], (low[0], high[0])))
            inside = (at[part, 1] > low[1]) & (at[part, 1] < high[1])
            yield at[part][inside], weights[part][inside], s[part][inside]


class Exact:
    """Of hertz: 5 by 5 Gauss points in each cell"""

    def at(self, body, corners):
        points, weights = np.polynomial.legendre.leggauss(5)
        xi, eta = (grid.ravel() for grid in np.meshgrid((points + 1) / 2, (points + 1) / 2))
        w = np.outer(weights, weights).ravel() / 4
        for low, high in zip(corners.min(axis=1), corners.max(axis=1)):
            at = low + np.stack([xi, eta], axis=1) * (high - low)
            sign = 1 if body == "upper" else -1  # of the mirror image the shear stress is the negative one
            s = np.array([scenes.hertz(x, sign * -y)[1] for x, y in at]) * (1, 1, -sign)
            yield at, w * np.prod(high - low), s


def bilinear_stress(corners, u, at, young):
    """Of quads of order 1 along the axes: the stresses at points of one cell"""
    low, size = corners.min(axis=0), corners.max(axis=0) - corners.min(axis=0)
    xi = (at - low) / size
    sign = (corners - low) / size * 2 - 1  # of each corner, -1 or 1
    weight = 1 + sign[:, None, :] * (2 * xi - 1)  # [corner, point, direction]
    dx, dy = sign[:, None, 0] * weight[..., 1] / (2 * size[0]), sign[:, None, 1] * weight[..., 0] / (2 * size[1])
    e11, e22, e12 = u[:, 0] @ dx, u[:, 1] @ dy, u[:, 0] @ dy + u[:, 1] @ dx
    nu = scenes.POISSON
    lame, shear = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
    return np.stack([lame * (e11 + e22) + 2 * shear * e11, lame * (e11 + e22) + 2 * shear * e22, shear * e12], axis=1)


def square(s):
    return s[:, 0] ** 2 + s[:, 1] ** 2 + 2 * s[:, 2] ** 2


def true_errors(truth, body, corners, u, young):
    """Squares of the error of the stress in all cells, and of the stress of the body"""
    errors, norm = np.zeros(len(corners)), 0.0
    for c, (at, weights, s) in enumerate(truth.at(body, corners)):
        errors[c] = weights @ square(s - bilinear_stress(corners[c], u[c], at, young)) if len(at) else 0
        norm += weights @ square(s)
    return errors, norm


def ranks(values):
    _, place, count = np.unique(np.round(values / values.max(), 9), return_inverse=True, return_counts=True)
    return (np.cumsum(count) - (count - 1) / 2)[place]  # equal ones share the mean


def spearman(a, b):
    return float(np.corrcoef(ranks(a), ranks(b))[0, 1]) if len(a) > 2 and np.ptp(a) and np.ptp(b) else float("nan")


class Runs:
    def __init__(self, args, options):
        self.args, self.options, self.truths, self.place = args, options, {}, where()

    def truth(self, scene):
        """The reference, and the coarser one from which is extrapolated"""
        if scene not in self.truths:
            self.truths[scene] = [Exact()] * 2 if scene == "hertz" else [Reference(self.args.abut, scene, times) for times in (1, 2)]
        return self.truths[scene]

    def run(self, case):
        with tempfile.TemporaryDirectory() as folder:
            path, kind = os.path.join(folder, "run"), scenes.SCENES[case.scene]
            text = f"{kind.options(Run(case.scene, 1, 0.0), folder)} {ADAPTOR} {self.options[case.estimator]}"
            files = [f"{path}{end}" for end in (".xdmf", ".csv", ".record")]
            took = cpu_of([self.args.abut, *text.split(), "-output", files[0], "-record_csv", files[1], "-record", files[2]])
            if took.status not in (0, 3):
                return [dict(case._asdict(), verdict=took.said.removeprefix("verdict: "), **self.place)]
            series = [{key: number(value) for key, value in row.items()} for row in read(files[1])]
            run, rows, drawn = record(files[2]), [], False
            share = {"share_estimate": f"{run['time.estimate'] / run['time.total']:.3f}", "cpu_s": f"{took.cpu:.3f}"}
            for cycle, row in enumerate(series):
                bodies = [self.body(case, path + ".h5", cycle, body, young) for body, young in zip(kind.bodies, MATERIAL[case.scene])]
                if not drawn and (row["unknowns"] >= SHOWN or cycle + 1 == len(series)):
                    drawn = True
                    for body in kind.bodies:
                        self.keep_mesh(case, body, int(row["unknowns"]), fields(path + ".h5", body, cycle)[0])
                mesh = {**case._asdict(), "verdict": row["verdict"], "cycle": cycle + 1, "unknowns": int(row["unknowns"])}
                rows += [{**mesh, **one, **share, **self.place} for one in bodies]
            return rows

    def body(self, case, path, cycle, body, young):
        corners, u, _, eta = fields(path, body, cycle)
        area = (corners.max(axis=1) - corners.min(axis=1)).prod(axis=1)
        estimate = float((eta**2 @ area / area.sum()) ** 0.5)
        (errors, norm), (rough, _) = (true_errors(truth, body, corners, u, young) for truth in self.truth(case.scene))
        exact = float(((errors.sum() + (errors.sum() - rough.sum()) / 3) / norm) ** 0.5)  # the midpoint rule is of order 2
        values = {"estimate": estimate, "error": exact, "effectivity": estimate / exact}
        values["effectivity_fine"] = estimate / float((errors.sum() / norm) ** 0.5)
        values["spearman"] = spearman(eta, np.sqrt(errors / area))
        return {"body": body, "cells": len(corners), **{key: f"{value:.6g}" for key, value in values.items()}, "share_body": f"{norm:.6g}"}

    def keep_mesh(self, case, body, unknowns, corners):
        boxes = [[f"{value:.8g}" for value in (*c.min(axis=0), *c.max(axis=0))] for c in corners]
        rows = [dict(zip(MESHES, (*case, body, unknowns, *box))) for box in boxes]
        append(os.path.join(self.args.out, "estimators_meshes.csv"), MESHES, rows)


def counted(rows, body):
    found = [row for row in rows if row["body"] == body and row["effectivity"]]
    return [row for row in found if int(row["unknowns"]) >= LEAST] or found[-1:]


def table(kept):
    yield "Effectivity: estimated over true error of the stress; least to largest and, in brackets, on the last mesh, of all meshes of at"
    yield f"least {LEAST} unknowns, and by how much the extrapolation changed it at most; Spearman's rank correlation of the cells'"
    yield "indicators with their true errors, least and median; the part of the time of the run that the estimates took.\n"
    yield "| scene | body | estimator | meshes | unknowns | effectivity | extrapolated by | ranking | time |\n|---|---|---|---|---|---|---|---|---|"
    for case, rows in kept.items():
        if not any(row["effectivity"] for row in rows):
            yield f"| {case.scene} | | {case.estimator} | *{rows[-1]['verdict']}* | | | | | |"
            continue
        for body in dict.fromkeys(row["body"] for row in rows):
            mine = counted(rows, body)
            value, rough, rank = ([float(row[key]) for row in mine] for key in ("effectivity", "effectivity_fine", "spearman"))
            off = max(abs(a / b - 1) for a, b in zip(rough, value))
            rank = [one for one in rank if one == one]
            ranking = f"{min(rank):.2f}, {float(np.median(rank)):.2f}" if rank else "-"
            line = f"| {case.scene} | {body} | {case.estimator} | {len(mine)} | {mine[-1]['unknowns']}"
            yield f"{line} | {min(value):.2f}–{max(value):.2f} ({value[-1]:.2f}) | {100 * off:.1f} % | {ranking} | {100 * float(mine[-1]['share_estimate']):.0f} % |"


def draw(kept, folder):
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle
    from picture import legend_above, plt, save

    good = {case: rows for case, rows in kept.items() if any(row["effectivity"] for row in rows)}
    names, estimators = (list(dict.fromkeys(getattr(case, key) for case in good)) for key in ("scene", "estimator"))
    if not good:
        return
    figure, axes = plt.subplots(2, len(names), figsize=(3.4 * len(names), 5), squeeze=False, sharex=True, sharey="row")
    for scene, pair in zip(names, axes.T):
        body = scenes.SCENES[scene].bodies[0]
        for estimator in estimators:
            mine = [row for row in good.get(Case(scene, estimator), []) if row["body"] == body]
            for axis, key in zip(pair, ("effectivity", "spearman")):
                axis.semilogx([float(row["unknowns"]) for row in mine], [float(row[key]) for row in mine], label=estimator)
        pair[0].axhline(1, color="0.6", lw=0.7, ls="-", marker="", zorder=0)
        pair[0].set_title(f"{scene}, {body} body" if body != "base" else f"{scene}, base")
        pair[1].set_xlabel("unknowns of both bodies")
    axes[0, 0].set_ylabel("estimate / true error")
    axes[1, 0].set_ylabel("rank correlation")
    legend_above(figure, axes[0], 6)
    save(figure, os.path.join(folder, "estimators"), 64)
    meshes = read(os.path.join(folder, "estimators_meshes.csv"))
    figure, axes = plt.subplots(len(names), len(estimators), figsize=(2.1 * len(estimators), 2.3 * len(names)), squeeze=False)
    for scene, row in zip(names, axes):
        for estimator, axis in zip(estimators, row):
            mine = [one for one in meshes if (one["scene"], one["estimator"]) == (scene, estimator)]
            boxes = [[float(one[key]) for key in ("x0", "y0", "x1", "y1")] for one in mine]
            patches = [Rectangle((x0, y0), x1 - x0, y1 - y0) for x0, y0, x1, y1 in boxes]
            axis.add_collection(PatchCollection(patches, facecolor="none", edgecolor="k", lw=0.3))
            middle = {"layers": 1.0, "hertz": 0.0, "punch": -0.5}[scene]
            axis.set(xlim=(0, 2), ylim=(middle - 1, middle + 1), aspect="equal", xticks=[], yticks=[])
            axis.set_title(f"{estimator}\n{mine[0]['unknowns']} unknowns" if mine else estimator, fontsize=7)
        row[0].set_ylabel(scene)
    save(figure, os.path.join(folder, "estimators_meshes"), 64)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--out", default="out")
    parser.add_argument("--plugin", action="append", default=[], help="path/to/libestimator_NAME.so, may be given several times")
    parser.add_argument("--only", action="append", help="only these estimators")
    parser.add_argument("--scene", action="append", choices=list(scenes.SCENES), help="only these scenes")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    options = registered(args.abut, args.plugin)
    cases = [Case(scene, name) for scene in scenes.SCENES for name in options]
    cases = [case for case in cases if case.estimator in (args.only or options) and case.scene in (args.scene or scenes.SCENES)]
    kept = Kept(os.path.join(args.out, "estimators.csv"), COLUMNS, case_of)
    kept.all(1, Runs(args, options).run, cases, lambda case: f"{case.scene}, {case.estimator}")
    path = os.path.join(args.out, "estimators.md")
    with open(path, "w") as f:
        print("\n".join(table({case: kept.rows[case] for case in cases})), file=f)
    draw({case: kept.rows[case] for case in cases}, args.out)
    print(path)


if __name__ == "__main__":
    main()
