"""The model of the study of scaling: what the counts of a run grow with, and the seconds that follow on a machine of given latency and
bandwidth.

A count of the rank that has most of it is a sum of terms, each above zero; which ones is decided by the Bayesian information criterion,
among those that the algorithm can have. Seconds are

  work + latency (messages of multigrid and others + steps) + (bytes sent + bytes gathered)/bandwidth

of that rank: nothing overlaps, nothing waits beyond that, and no message slows another one down. What one rank does while all others wait,
too little to be seen at the sizes measured, was measured alone, and is added.
"""
import collections, itertools, math

import numpy as np

PHASES = ("Set-up", "Sweeps", "Estimate", "Adapt", "Output")
State = collections.namedtuple("State", "p n m")  # ranks, unknowns of all bodies, contact nodes
Term = collections.namedtuple("Term", "cause value")
CAUSES = {  # of seconds, as the page names them
    "share": "cells of its own",
    "columns": "a part of the contact model",
    "replicated": "contact model on every rank",
    "boundary": "traces and boundaries on every rank",
    "modes": "modes of a side on one rank",
    "fixed": "work whatever the size",
    "messages": "messages",
    "steps": "reductions and gathers",
    "bytes": "bytes",
}


def log2(x):
    return math.log2(x) if x > 1 else 0.0


TERMS = {
    "multigrid": {  # messages: on every level a rank has neighbours, on the coarse ones many
        "near": lambda s: min(s.p - 1.0, 8.0),
        "log p": lambda s: log2(s.p),
        "log p log n": lambda s: log2(s.p) * log2(s.n),
    },
    "others": {  # the cells' neighbours; what owns a part of the boundary sends it to all; factors of the contact model
        "near": lambda s: min(s.p - 1.0, 8.0),
        "log p": lambda s: log2(s.p),
        "p": lambda s: s.p - 1.0,
        "m log p": lambda s: s.m * log2(s.p),
    },
    "bytes": {  # sides of the parts; coarse levels; the boundary, sent to all; modes of the contact model, which go round, and its factors
        "sqrt(n/p)": lambda s: (s.n / s.p) ** 0.5 * (s.p > 1),
        "sqrt(n)": lambda s: s.n**0.5 * (s.p > 1),
        "sqrt(np)": lambda s: (s.n * s.p) ** 0.5 * (s.p > 1),
        "log p": lambda s: log2(s.p),
        "m^2": lambda s: s.m**2 * (s.p > 1.0),
        "m^2/sqrt(p)": lambda s: s.m**2 / s.p**0.5 * (s.p > 1.0),
    },
    "steps": {"log p": lambda s: log2(s.p), "log p log n": lambda s: log2(s.p) * log2(s.n)},
    "gathered": {"1": lambda s: 1.0 * (s.p > 1), "p": lambda s: s.p * (s.p > 1.0), "m": lambda s: s.m * (s.p > 1.0), "m^2/p": lambda s: s.m**2 / s.p * (s.p > 1.0)},
    "work": {
        "n/p": lambda s: s.n / s.p,
        "1": lambda s: 1.0,
        "m": lambda s: float(s.m),
        "m^2": lambda s: float(s.m) ** 2,
        "m^3": lambda s: float(s.m) ** 3,
        "m^2/p": lambda s: float(s.m) ** 2 / s.p,
        "m^3/p": lambda s: float(s.m) ** 3 / s.p,
    },  # none that grows with p: more ranks than cores share caches, which looks like that
}
MESSAGES = ("multigrid", "others")
MODES = 8.5e-8 * 2  # seconds/m^2 of all meshes, each with half the unknowns of the next: LAPACK's stegr, m = 2,000 to 16,000
CAUSE = {"n/p": "share", "1": "fixed", "m": "boundary", "m^2": "replicated", "m^3": "replicated", "m^2/p": "columns", "m^3/p": "columns"}  # of work
DIVIDED = ("share", "columns")  # causes of seconds that more ranks make less
GROWTH = {"1": lambda s: 1.0, "log n": lambda s: log2(s.n), "log p": lambda s: log2(s.p)}  # of iterations and meshes


def fit(terms, states, values):
    """Coefficients above zero with the least relative errors, and the largest of these; no term is there that explains next to nothing"""
    values, best = np.array(values, float), None
    used = values > 0
    if not used.any():
        return {}, 0.0
    columns = {name: np.array([term(s) for s in states]) for name, term in terms.items()}
    terms = [name for name in terms if columns[name][used].any()]
    for size in range(1, len(terms) + 1):
        for names in itertools.combinations(terms, size):
            a = np.stack([columns[name][used] / values[used] for name in names], 1)
            solution, *_ = np.linalg.lstsq(a / np.linalg.norm(a, axis=0), np.ones(used.sum()), rcond=None)
            solution = solution / np.linalg.norm(a, axis=0)
            if (solution <= 0).any():
                continue
            error = a @ solution - 1
            score = used.sum() * math.log(max(error @ error, 1e-20) / used.sum()) + size * math.log(used.sum())
            if best is None or score < best[0] - 1e-6:  # terms that are the same on few ranks: the first, whatever the round-off
                best = score, dict(zip(names, map(float, solution))), float(abs(error).max())
    return best[1:] if best else ({}, 0.0)


def value(terms, coefficients, state):
    return sum(c * terms[name](state) for name, c in coefficients.items())


class Model:
    """Fitted to rows of one mode, {case: rows of its phases}; most: the largest number of ranks that is looked at"""

    def __init__(self, series, most=math.inf):
        runs = [rows for case, rows in series.items() if rows[0]["verdict"] == "converged" and case.ranks <= most]
        self.states = [State(int(rows[0]["ranks"]), int(rows[0]["unknowns"]), int(rows[0]["contact"])) for rows in runs]
        first = [rows[0] for rows in runs]
        self.growth = {name: fit(GROWTH, self.states, [float(row[name]) for row in first])[0] for name in ("its", "cycles")}
        self.contact = float(np.mean([s.m / s.n**0.5 for s in self.states]))
        self.coefficients, self.error = {}, {}
        for phase in PHASES:
            rows = [next(row for row in one if row["phase"] == phase) for one in runs]
            for count, terms in TERMS.items():
                units = [1.0 if count == "work" else float(row["its" if phase == "Sweeps" else "cycles"]) for row in rows]
                values = [float(row[f"{count}_max"]) / unit for row, unit in zip(rows, units)]
                self.coefficients[phase, count], self.error[phase, count] = fit(terms, self.states, values)

    def state(self, ranks, unknowns):
        return State(ranks, unknowns, self.contact * unknowns**0.5)

    def count(self, phase, count, state, units=None):
        """Of the rank with most; units: iterations or meshes, where they are known"""
        if units is None:
            units = value(GROWTH, self.growth["its" if phase == "Sweeps" else "cycles"], state)
        return value(TERMS[count], self.coefficients[phase, count], state) * (1 if count == "work" else units)

    def seconds(self, state, latency, bandwidth):
        """By phase and cause"""
        found = collections.Counter()
        for phase in PHASES:
            for name, c in self.coefficients[phase, "work"].items():
                found[phase, CAUSE[name]] += c * TERMS["work"][name](state)
            found[phase, "messages"] += latency * sum(self.count(phase, count, state) for count in MESSAGES)
            found[phase, "steps"] += latency * self.count(phase, "steps", state)
            found[phase, "bytes"] += (self.count(phase, "bytes", state) + self.count(phase, "gathered", state)) / bandwidth
        found["Sweeps", "modes"] = MODES * state.m**2
        return found

    def efficiency(self, state, latency, bandwidth):
        """Seconds on one rank over those on all of them, times their number"""
        found = (self.seconds(s, latency, bandwidth) for s in (state._replace(p=1), state))
        one, all_ = (sum(part.values()) for part in found)
        return one / (state.p * all_)

    def half(self, unknowns, latency, bandwidth):
        """The first power of two of ranks on which more than half of the time is lost, and the phase and cause that take most of it"""
        for k in range(1, 31):
            state = self.state(2**k, unknowns)
            if self.efficiency(state, latency, bandwidth) < 0.5:
                own = self.seconds(state, latency, bandwidth)
                return state.p, max((key for key in own if key[1] not in DIVIDED), key=lambda key: own[key])
        return math.inf, None
