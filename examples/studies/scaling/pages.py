"""Tables and the picture of the study of scaling"""
import os, sys

HERE = os.path.dirname(os.path.abspath(__file__))
STUDIES = os.path.dirname(HERE)
sys.path[:0] = [HERE, os.path.dirname(STUDIES), STUDIES]
from model import DIVIDED, CAUSES, MESSAGES, PHASES, TERMS, Model  # noqa: E402
from picture import legend_above, plt, save  # noqa: E402

RANKS = (100, 1000, 10000)
SIZES = (1e6, 1e7, 1e8, 1e9)  # unknowns; PETSc's 32-bit indices end at 2.1e9
NAMES = {"multigrid": "messages of multigrid", "others": "other messages", "bytes": "bytes", "steps": "steps", "gathered": "bytes gathered", "work": "work"}
SAME = ("force", "pressure", "energy", "estimate")


def row_of(rows, phase):
    return next(row for row in rows if row["phase"] == phase)


def solved(series, mode, kind=None):
    """Cases and rows of a mode, by size and ranks"""
    found = [(case, rows) for case, rows in series.items() if case.mode == mode and kind in (None, case.series)]
    return {case: rows for case, rows in sorted(found) if rows[0]["verdict"] == "converged"}


def total(rows, name):
    return sum(float(row_of(rows, phase)[name]) for phase in PHASES)


def number(x):
    return f"{x:,.0f}" if x >= 100 else f"{x:.3g}"


def seconds(rows, phase=None):
    """Where there is a core for every rank"""
    if rows[0]["oversubscribed"] == "yes":
        return "oversubscribed"
    if not row_of(rows, phase or PHASES[0])["seconds"]:
        return "not taken"
    return f"{total(rows, 'seconds') if phase is None else float(row_of(rows, phase)['seconds']):.3g}"


def imbalance(row, ranks):
    return ranks * float(row["work_max"]) / float(row["work"])


def differences(series):
    """Between runs of a size: numbers of different meshes, the largest relative difference of an answer, and the number of runs and sizes"""
    groups = {}
    for rows in series.values():
        groups.setdefault((rows[0]["series"], rows[0]["size"]), []).append(rows[0])
    meshes = sum(len({row["mesh"] for row in group}) - 1 for group in groups.values())
    worst = max(max(float(row[key]) for row in group) / min(float(row[key]) for row in group) - 1 for group in groups.values() for key in SAME)
    return meshes, worst, sum(map(len, groups.values())), len(groups)


def runs_table(series):
    """One line a run"""
    yield "| series | unknowns | ranks | meshes | sweeps | iterations | seconds | work s, largest | imbalance | messages | MB | collective |"
    yield "|---" * 12 + "|"
    for case, rows in series.items():
        r, work = rows[0], total(rows, "work")
        sent = [total(rows, name) / case.ranks for name in ("messages", "bytes", "reductions", "gathers")]
        yield (f"| {case.series} | {int(r['unknowns']):,} | {case.ranks} | {r['cycles']} | {r['sweeps']} | {r['its']} | {seconds(rows)} | "
               f"{total(rows, 'work_max'):.2f} | {case.ranks * total(rows, 'work_max') / work:.2f} | {number(sent[0])} | {sent[1] / 1e6:.2f} | "
               f"{number(sent[2] + sent[3])} |")


def phases_table(series):
    """One line a phase of the largest strong series and of the weak one, on the fewest and on the most ranks that have messages"""
    yield "| series | unknowns | ranks | phase | seconds | work s, largest | imbalance | messages | of multigrid | kB | reductions | gathers | kB gathered |"
    yield "|---" * 13 + "|"
    largest = max((case.size for case in series if case.series == "strong"), default=None)
    for kind in "strong", "weak":
        chosen = [case for case in series if case.series == kind and case.ranks > 1 and (kind == "weak" or case.size == largest)]
        for case in chosen[:1] + chosen[-1:]:
            for phase in PHASES:
                row = row_of(series[case], phase)
                each = {name: float(row[name]) / case.ranks for name in "messages multigrid bytes reductions gathers gathered".split()}
                yield (f"| {kind} | {int(row['unknowns']):,} | {case.ranks} | {phase} | {seconds(series[case], phase)} | "
                       f"{float(row['work_max']):.3g} | {imbalance(row, case.ranks):.2f} | {number(each['messages'])} | {number(each['multigrid'])} | "
                       f"{number(each['bytes'] / 1e3)} | {number(each['reductions'])} | {number(each['gathers'])} | {number(each['gathered'] / 1e3)} |")


def formula(model, phase, count):
    found = model.coefficients[phase, count]
    return " + ".join(f"{c:.2g} {name}" if name != "1" else f"{c:.2g}" for name, c in found.items()) or "0"


def unseen(series, count, phase):
    """By how much a model of all but the most ranks misses these"""
    most = max(case.ranks for case in series)
    less, worst = Model(series, most - 1), 0.0
    for case, rows in series.items():
        if case.ranks == most:
            state = less.state(most, int(rows[0]["unknowns"]))._replace(m=int(rows[0]["contact"]))
            had = float(row_of(rows, phase)[f"{count}_max"])
            units = float(rows[0]["its" if phase == "Sweeps" else "cycles"])
            worst = max(worst, abs(less.count(phase, count, state, units) / had - 1)) if had else worst
    return most, worst


def model_table(series, model):
    most = max(case.ranks for case in series)
    yield f"| phase | count | model | largest error | of {most} ranks, from fewer |"
    yield "|---" * 5 + "|"
    for phase in PHASES:
        for count in TERMS:
            unit = "a run" if count == "work" else "an iteration" if phase == "Sweeps" else "a mesh"
            yield (f"| {phase} | {NAMES[count]} {unit} | {formula(model, phase, count)} | {100 * model.error[phase, count]:.0f} % | "
                   f"{100 * unseen(series, count, phase)[1]:.0f} % |")


def cause(key):
    return f"{key[0]}: {CAUSES[key[1]]}" if key else ""


def prediction_table(model, latency, bandwidth):
    yield "| unknowns | ranks | seconds | efficiency | takes most of what is lost | its share of the time |"
    yield "|---" * 6 + "|"
    for n in SIZES:
        for p in RANKS:
            state = model.state(p, n)
            found = model.seconds(state, latency, bandwidth)
            key = max((key for key in found if key[1] not in DIVIDED), key=lambda key: found[key])
            yield (f"| {n:.0e} | {p:,} | {number(sum(found.values()))} | {model.efficiency(state, latency, bandwidth):.2g} | {cause(key)} | "
                   f"{100 * found[key] / sum(found.values()):.0f} % |")


def limits_table(model, latency, bandwidth):
    yield "| unknowns | half is lost on | first by | its share of the time | contact model, GB a rank |"
    yield "|---" * 5 + "|"
    for n in SIZES:
        ranks, key = model.half(n, latency, bandwidth)
        if key is None:
            continue
        state = model.state(ranks, n)
        found = model.seconds(state, latency, bandwidth)
        yield f"| {n:.0e} | {ranks:,} ranks | {cause(key)} | {100 * found[key] / sum(found.values()):.0f} % | {8 * state.m**2 / ranks / 1e9:.2g} |"


def tables(kept, latency, bandwidth):
    """Lines of the page"""
    for mode in sorted({case.mode for case in kept}, reverse=True):
        series = solved(kept, mode)
        failed = [(case, rows[0]["verdict"]) for case, rows in kept.items() if case.mode == mode and case not in series]
        yield from (f"- {case.series}, {case.size:.0f} unknowns, {case.ranks} ranks, {mode}: {said}" for case, said in failed)
        if not series:
            continue
        meshes, worst, runs, sizes = differences(series)
        first = next(iter(series.values()))[0]
        yield (f"Bodies {mode}: {runs} runs of {sizes} sizes, {first['cores']} cores ({first['machine']}, PETSc {first['petsc']}, {first['git']}). "
               f"Of one size {'all runs have the same meshes' if not meshes else f'{meshes} runs have OTHER MESHES'}, and answers that differ by "
               f"at most {worst:.0e}.")
        yield ""
        yield from runs_table(series)
        yield ""
        yield from phases_table(series)
        yield ""
        if len({case.ranks for case in series}) < 4:
            continue
        model = Model(series)
        growth = "; ".join(f"{name} = " + " + ".join(f"{c:.3g} {term}" if term != "1" else f"{c:.3g}" for term, c in found.items())
                           for name, found in (("iterations", model.growth["its"]), ("meshes", model.growth["cycles"])))
        yield f"The model, of the rank with most; n unknowns, p ranks, m = {model.contact:.2f} sqrt(n) contact nodes; log is that to the base 2; {growth}:"
        yield ""
        yield from model_table(series, model)
        yield ""
        yield f"What it predicts for {latency:g} s and {bandwidth:g} B/s:"
        yield ""
        yield from prediction_table(model, latency, bandwidth)
        yield ""
        yield from limits_table(model, latency, bandwidth)


def picture(kept, stem, latency, bandwidth):
    """Counts and their model; what the model makes of them"""
    series = solved(kept, "together")
    if len({case.ranks for case in series}) < 4:
        return
    model = Model(series)
    figure, axes = plt.subplots(2, 2, figsize=(7.2, 5.6))
    line = [2**k for k in range(1, 14)]
    size = max(case.size for case in series if case.series == "strong")
    largest = [(case, rows) for case, rows in series.items() if case.series == "strong" and case.size == size]
    n = int(largest[0][1][0]["unknowns"])
    for index, phase in enumerate(PHASES):
        for axis, counts in (axes[0][0], MESSAGES), (axes[0][1], ("work",)):
            had = [(case.ranks, sum(float(row_of(rows, phase)[f"{count}_max"]) for count in counts)) for case, rows in largest]
            x, y = zip(*[(x, y) for x, y in had if y > 0])
            axis.plot(x, y, ls="", color=f"C{index}", label=phase)
            axis.plot(line, [sum(model.count(phase, count, model.state(p, n)) for count in counts) for p in line], marker="", color=f"C{index}")
    axes[0][0].set(title=f"messages of the rank with most, {n:,} unknowns")
    axes[0][1].set(title="its work, seconds")
    for n in SIZES:
        axes[1][0].plot(line, [model.efficiency(model.state(p, n), latency, bandwidth) for p in line], marker="", label=f"$10^{len(str(int(n))) - 1}$ unknowns")
    axes[1][0].set(title="predicted efficiency", ylim=(1e-3, 1.2))
    axes[1][0].legend()
    states = [model.state(p, 1e8) for p in line]
    for key, name in CAUSES.items():
        parts = [model.seconds(state, latency, bandwidth) for state in states]
        axes[1][1].plot(line, [sum(v for k, v in part.items() if k[1] == key) or float("nan") for part in parts], marker="", label=name)
    axes[1][1].set(title="predicted seconds, $10^8$ unknowns")
    axes[1][1].legend(fontsize="xx-small")
    for axis in axes.flat:
        axis.set(xscale="log", yscale="log", xlabel="ranks")
    low, high = axes[1][1].get_ylim()
    axes[1][1].set_ylim(low, high * (high / low) ** 0.6)  # room for the legend
    legend_above(figure, [axes[0][0]], len(PHASES))
    save(figure, stem, colors=64)
