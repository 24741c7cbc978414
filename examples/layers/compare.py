#!/usr/bin/env python3
"""Prints what a run of layers.yml found beside the reference values: compare.py [folder, out unless given]"""
import sys

from layers import penalty, profile, record, reference


def table(folder):
    run = record(f"{folder}/layers.record")
    c = penalty(run)
    x, p = profile(f"{folder}/layers_profile.csv")
    this, exact = reference(c), reference(0)
    rows = [
        ("a, end of contact [cm]", run["pair.mid.contact_edge"], this["a"], exact["a"]),
        ("p0, pressure at x = 0 [MPa]", p[0], this["p0"], exact["p0"]),
        ("P, its integral [MPa cm]", run["pair.mid.force"], this["P"], exact["P"]),
        ("u1 at (0.5, 0.75) [cm]", run["probe.A.u1"], this["A"]["u1"], exact["A"]["u1"]),
        ("u2 at (0.5, 0.75) [cm]", run["probe.A.u2"], this["A"]["u2"], exact["A"]["u2"]),
        ("von Mises there [MPa]", run["probe.A.vm"], this["A"]["vm"], exact["A"]["vm"]),
    ]
    line = "{:29}{:>14}{:>18}{:>13}{:>18}{:>13}"
    yield line.format("", "computed", f"ref. c = {c:g}", "difference", "ref. theta = 0", "difference")
    for name, value, *refs in rows:
        cells = [text for ref in refs for text in (f"{ref['value']:.6g}", f"{100 * (value / ref['value'] - 1):+.2f} %")]
        yield line.format(name, f"{value:.6g}", *cells)
    adapted, uniform = run["body.lower.unknowns"], run["body.lower.unknowns_uniform"]
    yield f"unknowns, lower body: {adapted:.0f} after {run['cycles']:.0f} cycles; {uniform:.0f}, {uniform / adapted:.0f} times as many, in a uniform mesh of its smallest cells"
    yield f"unknowns, both bodies: {run['unknowns']:.0f}; verdict: {run['verdict']}"


if __name__ == "__main__":
    print("\n".join(table(*(sys.argv[1:] or ["out"]))))
