"""The tables of the study, and the numbers that they and the figures share"""
import math

from infinite import PENALTY, displacement, pressure
from layers import reference

SIX = "paper, first mesh 16,4"  # the run that takes as many iterations as the paper's
REFERENCE = reference(PENALTY)
ENERGY = sum(REFERENCE[key]["value"] for key in ("W1", "W2", "Jtheta"))
ESTIMATORS = {"fembem": "fembem, boundary elements solved", "none": "fembem, data of the finite elements", "zz": "zz"}


def good(rows, run):
    """The last row of a run, or None if it has no answer"""
    row = rows[run][-1] if run in rows else {}
    return row if row.get("unknowns") else None


def energy_error(row):
    """Of the lower body, relative, in the energy norm: the discrete energy is above the exact one by half the square of the error"""
    return math.sqrt(max(0, float(row["energy"]) - ENERGY) / REFERENCE["W2"]["value"])


def local_error(row):
    return float(row["eta_max"])


def deltas(rows):
    runs = ((float(run.split()[1]), good(rows, run)) for run in rows if run.startswith("delta "))
    return sorted(((delta, row) for delta, row in runs if row), key=lambda pair: -pair[0])


def uniforms(rows):
    return sorted((row for row in (good(rows, run) for run in rows if run.startswith("uniform ")) if row), key=lambda r: int(r["unknowns"]))


def uniform_unknowns(rows, error, wanted):
    """Unknowns of a uniform mesh with this error, and whether they are inside the measured ones: a line through the logarithms"""
    points = [(math.log(error(row)), math.log(float(row["unknowns"]))) for row in uniforms(rows)]
    at, k = math.log(wanted), 1
    while k < len(points) - 1 and points[k][0] > at:
        k += 1
    (e0, n0), (e1, n1) = points[k - 1 : k + 1]
    return math.exp(n0 + (at - e0) / (e1 - e0) * (n1 - n0)), at >= points[-1][0]


def with_boundary(unknowns):
    """With those of the boundary elements of a uniform mesh: 50 n - 2 for 8n by 2n cells, as the study finds them for n up to 8"""
    return unknowns + 50 * math.sqrt(unknowns / 32) - 2


def percent(value, exact):
    return f"{100 * (float(value) / exact - 1):+.2f} %"


def times(unknowns, adapted, inside=True):
    return f"{unknowns:,.0f}{'' if inside else ' (extrapolated)'}, {unknowns / adapted:.3g}"


def series(rows, column, form="{}"):
    return ", ".join(form.format(float(row[column])) if row[column] != "" else "-" for row in rows)


def iterations(rows):
    yield "\n**The combined algorithm, one sweep and one adaptation an iteration, δ = 0.1**\n"
    yield "| estimator | iterations | cells of Ω2 | cells split | unknowns of Ω2 | contact force | against c = 0.05 |\n|" + "---|" * 7
    names = {f"paper {key}": text for key, text in ESTIMATORS.items()}
    names.update({run: run.replace("paper", "fembem") for run in rows if run.startswith("paper, ")})
    for run, text in names.items():
        row = good(rows, run)
        if not row:
            yield f"| {text} | *{rows[run][-1]['verdict'] if run in rows else 'not run'}* | | | | | |"
            continue
        few = len(rows[run]) < 20
        yield (f"| {text} | {len(rows[run])} | {series(rows[run], 'cells', '{:.0f}') if few else row['cells']} | "
               f"{series(rows[run], 'marked', '{:.0f}') if few else ''} | {row['unknowns']} | {float(row['force']):.2f} | "
               f"{percent(row['force'], REFERENCE['P']['value'])} |")


def rules(rows):
    yield "\n**The extra rule, δ = 0.1, the loop converged on each mesh**\n"
    yield "| scene | estimator | rule | verdict | meshes | unknowns | cells split | largest η |\n|" + "---|" * 8
    for scene, text in (("", "two layers"), ("given", "Ω2 under the given pressure")):
        for key, estimator in ESTIMATORS.items():
            for rule in ("yes", "no"):
                run = f"{scene}{', ' if scene and rule == 'no' else ''}{'no rule' if rule == 'no' else '' if scene else 'rule'} {key}"
                row = good(rows, run)
                if not row:
                    continue
                yield (f"| {text} | {estimator} | {rule} | {row['verdict'].replace('_', ' ')} | {len(rows[run])} | {row['unknowns']} | "
                       f"{series(rows[run][:-1], 'marked', '{:.0f}')} | {series(rows[run], 'eta_max', '{:.3f}')} |")


def sweep(rows):
    yield "\n**Displacements at (0.5, 0.75), and unknowns of Ω2 (and of its boundary elements), against δ; upper body with an error below 0.001**\n"
    yield ("| δ | meshes | unknowns, BEM | u1 [cm] | error | u2 [cm] | error | uniform, equal smallest cell | uniform, equal energy error | "
           "uniform, equal local error |\n|" + "---|" * 10)
    for delta, row in deltas(rows):
        n, run = float(row["unknowns"]), rows[f"delta {delta:g}"]
        yield (f"| {delta:g} | {len(run)} | {row['unknowns']}, {row['bem']} | "
               + " | ".join(f"{float(row[u]):.6e} | {percent(row[u], REFERENCE['A'][u]['value'])}" for u in ("u1", "u2"))
               + f" | {times(float(row['uniform']), n)} | {energy_error(row):.4f}: {times(*swap(rows, energy_error, row, n))} | "
               f"{local_error(row):.4f}: {times(*swap(rows, local_error, row, n))} |")


def swap(rows, error, row, n):
    unknowns, inside = uniform_unknowns(rows, error, error(row))
    return unknowns, n, inside


def uniform(rows):
    yield "\n**Uniform meshes of Ω2**\n\n| side | unknowns | energy error | largest η | u1 | u2 | contact force |\n|" + "---|" * 7
    for row in uniforms(rows):
        yield (f"| {float(row['hmin']):g} | {row['unknowns']} | {energy_error(row):.4f} | {local_error(row):.4f} | "
               + " | ".join(percent(row[u], REFERENCE["A"][u]["value"]) for u in ("u1", "u2")) + f" | {percent(row['force'], REFERENCE['P']['value'])} |")


def failures(rows):
    lines = [f"| {run} | {row['verdict']} |" for run, (*_, row) in rows.items() if row["verdict"] not in ("converged", "limit_unknowns", "limit_level")]
    if lines:
        yield "\n**Runs without an answer**\n\n| run | why |\n|---|---|"
        yield from lines


def contact(rows, profiles):
    """How far each iteration is from the infinite layers, at the nodes up to x = 1.5"""
    yield f"\n**Contact by iteration ({SIX.removeprefix('paper, ')})**\n"
    yield "| iteration | contact force | largest error of u_n, of its largest value | largest error of the pressure, of that at x = 0 |\n|" + "---|" * 4
    for row in rows.get(SIX, []):
        errors = []
        for what, exact in (("u_n", displacement), ("pressure", pressure)):
            points = [(float(r["x"]), float(r["value"])) for r in profiles if r["run"] == SIX and r["cycle"] == str(row["cycle"]) and r["what"] == what]
            x, value = zip(*[point for point in points if point[0] <= 1.5])
            errors.append(max(abs(value - exact(x))) / abs(exact([0])[0]))
        yield f"| {row['cycle']} | {percent(row['force'], REFERENCE['P']['value'])} | " + " | ".join(f"{100 * e:.1f} %" for e in errors) + " |"


def tables(rows, profiles):
    for part in (iterations, rules, sweep, uniform, failures):
        yield from part(rows)
    yield from contact(rows, profiles)
