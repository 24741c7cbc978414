"""Tables and pictures of the study of cost"""
import os, sys

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
sys.path[:0] = [os.path.dirname(STUDIES), STUDIES]
from picture import legend_above, plt, save, slope  # noqa: E402
from study import first_that  # noqa: E402

TARGETS = (1e-2, 1e-3, 1e-4, 1e-5)
QUANTITIES = {"err_energy": "energy norm", "err_p_L2": "pressure, L2", "err_P": "force", "err_p0": "p0"}
AXES = {"unknowns": "unknowns of both bodies", "work": "sweeps × unknowns", "cpu_s": "CPU seconds"}
BASE = ("uniform", "random")
SHOWN = {"layers": "err_energy", "hertz": "err_p_L2", "punch": "err_energy"}  # the energy of hertz has an error of its boundary data, too
LAW = {"layers": {"uniform": 0.75, "residual": 1}, "punch": {"uniform": 0.25, "residual": 1}}  # powers of 1/unknowns, energy norm, order 2
STYLE = {  # colour, marker, line of an estimator: apart in grey too
    "uniform": ("0.55", "x", ":"),
    "random": ("0.55", "+", "--"),
    "fembem": ("C0", "o", "-"),
    "fembem none": ("C5", "v", "-."),
    "zz": ("C1", "s", "--"),
    "residual": ("C2", "^", "-"),
    "fembem+residual": ("C3", "D", ":"),
}


def solved(rows):
    return [row for row in rows if row.get("P")]


def column(rows, key):
    return [float(row[key]) for row in rows]


def met(rows, quantity, target):
    return first_that(solved(rows), lambda row: float(row[quantity]) <= target)


def cheapest(series, quantity, target):
    """Of all series the case and the row that meet a target with the least CPU"""
    found = [(float(row["cpu_s"]), case, row) for case, rows in series.items() for row in [met(rows, quantity, target)] if row]
    return min(found, key=lambda one: one[0])[1:] if found else None


def exact(series, scene, *estimators, but=()):
    """The series of exact contact, the default loop"""
    found = {case: rows for case, rows in series.items() if case.scene == scene and not case.c and case.loop == "ddactive"}
    return {case: rows for case, rows in found.items() if case.estimator in (estimators or STYLE) and case.estimator not in but}


def took(found):
    """Four cells of a table: CPU seconds with their spread, unknowns, work, and memory"""
    if not found:
        return "- | - | - | -"
    case, row = found
    return f"{seconds(row)} | {int(row['unknowns']):,} | {float(row['work']):,.0f} | {float(row['rss_MB']):.0f}"


def seconds(row):
    return f"{float(row['cpu_s']):.2f} ({float(row['cpu_min']):.2f}–{float(row['cpu_max']):.2f})"


def power(target):
    return f"{target:.0e}".replace("e-0", "e-")


def tables(series, load):
    rows = [row for rows in series.values() for row in solved(rows)]
    places = sorted({(row["machine"], row["petsc"], row["git"]) for row in rows})
    yield f"{len(series)} series, {len(rows)} meshes, {sum(not row['P'] for rows in series.values() for row in rows)} rows of failed runs. "
    for machine, petsc, git in places:
        yield f"{machine}, PETSc {petsc}, commit {git}, one thread. "
    many = ", ".join(sorted({row["repetitions"] for row in rows}))
    yield f"CPU seconds are medians (least–largest) of {many} whole processes, start-up included; the reference load took {load:.3f} s."
    yield from smallest(series)
    yield from by_series(series)
    yield from split(series)
    yield from failures(series)


def smallest(series):
    yield "\n**The smallest cost to a target**, of all orders and estimators, that every later mesh meets, too; exact contact\n"
    yield "| scene | error of | target | CPU s | unknowns | sweeps × unknowns | MB | by | uniform: CPU s | unknowns | random: unknowns |"
    yield "|---" * 11 + "|"
    for scene in dict.fromkeys(case.scene for case in series):
        for quantity, name in QUANTITIES.items():
            for target in TARGETS:
                found = cheapest(exact(series, scene, but=BASE), quantity, target)
                if not found:
                    continue
                uniform, random = (cheapest(exact(series, scene, kind), quantity, target) for kind in BASE)
                cells = f"order {found[0].order}, {found[0].estimator}"
                cells += f" | {seconds(uniform[1])} | {int(uniform[1]['unknowns']):,}" if uniform else " | - | -"
                cells += f" | {int(random[1]['unknowns']):,}" if random else " | -"
                yield f"| {scene} | {name} | {power(target)} | {took(found)} | {cells} |"


def by_series(series):
    for scene in dict.fromkeys(case.scene for case in series):
        mine = exact(series, scene)
        for quantity in ("err_energy", "err_p_L2", "err_P") if mine else ():
            yield f"\n**{scene}, {QUANTITIES[quantity]}**: CPU seconds; unknowns; sweeps × unknowns to a target; the last mesh\n"
            yield "| order | estimator | " + " | ".join(map(power, TARGETS)) + " | last error | unknowns | share of the estimates | estimate / error |"
            yield "|---" * 10 + "|"
            for case, rows in sorted(mine.items(), key=lambda one: one[0].order):
                cells, last = [], solved(rows)[-1] if solved(rows) else None
                for target in TARGETS:
                    row = met(rows, quantity, target)
                    cells.append(f"{float(row['cpu_s']):.2f}; {int(row['unknowns']):,}; {float(row['work']):,.0f}" if row else "-")
                if last:
                    error = float(last["err_energy"])
                    ratio = f"{float(last['est_mesh']) / error:.2f}" if last["est_mesh"] and error else ""
                    share = f"{100 * float(last['share_estimate'] or 0):.0f} %"
                    cells += [f"{float(last[quantity]):.1e}", f"{int(last['unknowns']):,}", share, ratio]
                else:
                    cells = [f"*{rows[-1]['verdict']}*"] + [""] * 7
                yield f"| {case.order} | {case.estimator} | " + " | ".join(cells) + " |"


def split(series):
    """Of the scene with penalties: what mesh, penalty and loop leave, on the last mesh and on the way to it"""
    mine = {case: rows for case, rows in series.items() if case.scene == "layers" and case.estimator == "residual"}
    yield "\n**layers, residual: mesh, penalty and loop**, last mesh of each series; of the force: against the same c, the difference of the"
    yield "two references, and against exact contact; energy norm: measured, and the record's error.discretisation, .penalty (a bound), .loop\n"
    yield "| c | loop | order | unknowns | sweeps | CPU s | force: mesh and loop | penalty | both | energy: mesh | estimated | penalty | loop |"
    yield "|---" * 13 + "|"
    for case, rows in sorted(mine.items(), key=lambda one: (-one[0].c, one[0].loop, one[0].order)):
        last = solved(rows)[-1] if solved(rows) else None
        if last:
            keys = ("err_P", "penalty_P", "total_P", "err_energy", "est_mesh", "est_penalty", "est_loop")
            cells = [f"{int(last['unknowns']):,}", last["sweeps"], seconds(last), *(f"{float(last[key] or 0):.1e}" for key in keys)]
        else:
            cells = [f"*{rows[-1]['verdict']}*"] + [""] * 9
        yield f"| {case.c:g} | {case.loop} | {case.order} | " + " | ".join(cells) + " |"


def failures(series):
    lines = [(case, row) for case, rows in series.items() for row in rows if not row["P"]]
    if lines:
        yield "\n**Runs that failed**\n"
    for case, row in lines:
        yield f"- {case.scene}, order {case.order}, {case.estimator}, c = {case.c:g}, {case.loop}: {row['verdict']}"


def line(axis, rows, x, y, style, label):
    rows = [row for row in solved(rows) if float(row[y]) > 0]
    if rows:
        color, marker, dashes = style
        axis.loglog(column(rows, x), column(rows, y), color=color, marker=marker, ls=dashes, label=label)


def draw(series, peers, folder):
    if exact(series, "layers"):
        draw_orders(series, peers, folder)
    draw_estimators(series, folder)
    if any(case.c for case in series):
        draw_split(series, folder)


def draw_orders(series, peers, folder):
    """Errors of the layers against everything that costs; orders, adapted by residual, and uniform"""
    figure, axes = plt.subplots(2, 3, figsize=(10, 6), sharey="row", sharex="col")
    for row, quantity in zip(axes, ("err_energy", "err_P")):
        for axis, x in zip(row, AXES):
            for programme, marker in zip(dict.fromkeys(one["program"] for one in peers), "x+1234*.|_"):
                mine = [one for one in peers if (one["program"], one["scene"]) == (programme, "layers") and one.get(quantity) and one.get(x)]
                if mine:
                    axis.loglog([one[x] for one in mine], [one[quantity] for one in mine], marker, color="0.6", label=programme)
            for case, rows in exact(series, "layers", "uniform", "residual", "random").items():
                if case.estimator == "random" and case.order != 2:
                    continue
                color, marker = ("C0", "C1", "C2")[case.order - 1], "os^"[case.order - 1]
                dashes = {"residual": "-", "uniform": ":", "random": "--"}[case.estimator]
                name = {"residual": "adapted (residual)", "uniform": "uniform", "random": "random"}[case.estimator]
                line(axis, rows, x, quantity, (color, "+" if case.estimator == "random" else marker, dashes), f"order {case.order}, {name}")
    for order in (1, 2, 3):
        one = next((rows for case, rows in exact(series, "layers", "residual").items() if case.order == order), None)
        if one and solved(one):
            last = solved(one)[-1]
            x, y = float(last["unknowns"]), 0.55 * float(last["err_energy"])
            slope(axes[0, 0], -order / 2, (x / 6, x), y * 6 ** (order / 4), f"−{order / 2:g}")
    for axis, name in zip(axes[1], AXES.values()):
        axis.set_xlabel(name)
    axes[0, 0].set_ylabel("relative error, energy norm")
    axes[1, 0].set_ylabel("relative error of the force P")
    legend_above(figure, axes[1, 2:], 4)
    save(figure, os.path.join(folder, "cost"), 64)


def draw_estimators(series, folder):
    """All estimators at one order, on all scenes"""
    names = [scene for scene in SHOWN if exact(series, scene)]
    if not names:
        return
    figure, axes = plt.subplots(2, len(names), figsize=(3.6 * len(names), 6), squeeze=False)
    for scene, pair in zip(names, axes.T):
        for case, rows in exact(series, scene).items():
            if case.order == 2:
                for axis, x in zip(pair, ("unknowns", "cpu_s")):
                    line(axis, rows, x, SHOWN[scene], STYLE[case.estimator], case.estimator)
        pair[0].set(title=f"{scene}, order 2", xlabel=AXES["unknowns"])
        pair[1].set_xlabel(AXES["cpu_s"])
        pair[1].set_xticks([0.1, 0.2, 0.5, 1, 2], ["0.1", "0.2", "0.5", "1", "2"])
        pair[1].tick_params(axis="x", which="minor", labelbottom=False)
        for axis in pair:
            axis.set_ylabel("relative error, " + QUANTITIES[SHOWN[scene]])
        for estimator, rate in LAW.get(scene, {}).items():
            rows = next((rows for case, rows in exact(series, scene, estimator).items() if case.order == 2 and solved(rows)), None)
            if rows:
                x, y = (float(solved(rows)[-1][key]) for key in ("unknowns", "err_energy"))
                slope(pair[0], -rate, (x / 5, x), (0.6 if rate == 1 else 1.5) * y * 5 ** (rate / 2), f"−{rate:g}")
    legend_above(figure, axes[0], 7)
    save(figure, os.path.join(folder, "cost_estimators"), 64)


def draw_split(series, folder):
    """What the penalty leaves, what the record says of it, and what loops cost"""
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.4))
    styles = [("C0", "o", "-"), ("C1", "s", "--"), ("C2", "^", "-."), ("C3", "D", ":")]
    residual = {case: rows for case, rows in series.items() if case.scene == "layers" and case.estimator == "residual" and solved(rows)}
    of_order = {case: rows for case, rows in residual.items() if case.order == 2 and case.loop == "ddactive"}
    for (case, rows), style in zip(sorted(of_order.items(), key=lambda one: -one[0].c), styles):
        line(axes[0], rows, "unknowns", "total_P", style, f"c = {case.c:g}")
        if case.c:
            axes[0].axhline(float(solved(rows)[0]["penalty_P"]), color="0.6", lw=0.7, zorder=0)
        if case.c == 0.05:
            for key, name, style in (
                ("err_energy", "mesh, measured", styles[0]),
                ("est_mesh", "mesh, estimated", styles[1]),
                ("est_penalty", "penalty, bound", styles[2]),
                ("est_loop", "loop, estimated", styles[3]),
            ):
                line(axes[1], rows, "unknowns", key, style, name)
    axes[0].set(xlabel=AXES["unknowns"], ylabel="error of P against exact contact", title="order 2; grey: the penalty's own")
    axes[1].set(xlabel=AXES["unknowns"], ylabel="relative error, energy norm", title="order 2, c = 0.05: the parts")
    color = {0.5: "C0", 0.05: "C1", 0.005: "C2"}
    look = {"ddactive": ("o", "-"), "ddneumann": ("s", ":"), "anderson": ("^", "--")}
    for case, rows in sorted(residual.items(), key=lambda one: (-one[0].c, one[0].loop)):
        if case.order == 1 and case.c in color:
            line(axes[2], rows, "work", "err_energy", (color[case.c], *look[case.loop]), f"c = {case.c:g}, {case.loop}")
    axes[2].set(xlabel=AXES["work"], ylabel="relative error, energy norm", title="order 1: loops")
    for axis in axes[:2]:
        if axis.lines:
            axis.legend()
    axes[2].set_xlim(left=20)
    axes[2].legend(fontsize=6, loc="lower left")
    save(figure, os.path.join(folder, "cost_split"), 64)
