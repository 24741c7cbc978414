#!/usr/bin/env python3
"""Writes reference.json: what other independent values do not give, from meshes of order 4, graded to the end of the contact.

Of two layers with a penalty the nodal pressures, whose force, largest value, edge and penalty energy, theta/2 times the integral of p^2,
are compared with the independent values of examples/layers/reference.json; of the punch force, energy and pressures, whose error is the
difference from a mesh with cells half as large.

  reference.py [--abut build/bin/abut]
"""
import argparse, collections, json, os, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import scenes  # noqa: E402
from layers import profile, record  # noqa: E402
from study import TOP, pressure_error  # noqa: E402

Case = collections.namedtuple("Case", "scene order c")


def run(abut, case, size):
    """The record, and nodes and pressures where there is contact"""
    scene = scenes.SCENES[case.scene]
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, name) for name in ("record", "profile.csv")]
        text = scene.options(case, folder) + " -snes_rtol 1e-11 " + " ".join(f"-{body}_mesh_size {size}" for body in scene.bodies)
        subprocess.run([abut, *text.split(), "-record", paths[0], "-output_profile", paths[1]], check=True, capture_output=True)
        found, (x, p) = record(paths[0]), profile(paths[1])
    last = next((i for i in range(case.order, len(x), case.order) if not any(p[i:])), len(x) - 1)  # an end of an element
    return found, x[: last + 1], p[: last + 1]


def layers(abut, c):
    one = scenes.layers.reference(c)
    distance = f"sqrt((x-{one['a']['value']!r})^2+(y-1)^2)"
    found, x, p = run(abut, Case("layers", 4, c), f"max(1e-4,0.25*{distance})")
    values = {"P": found["pair.mid.force"], "a": found["pair.mid.contact_edge"], "Jtheta": found["energy.penalty"], "p0": p[0]}
    off = {key: value / one[key]["value"] - 1 for key, value in values.items()}
    return {"x": x, "p": p, "off": {key: float(f"{value:.1e}") for key, value in off.items()}, "unknowns": int(found["unknowns"])}


def punch(abut):
    runs = []
    for h, slope, near in (1e-7, 0.3, 0.125), (1e-8, 0.15, 0.0625):  # cells of 0.125 and 0.0625 below x = 0
        size = f"max({h},min({slope}*(abs(x-1)+abs(y)),{near}+0.5*sqrt(x^2+y^2)))"
        found, x, p = run(abut, Case("punch", 4, 0.0), size)
        values = {"P": found["pair.mid.force"], "p0": p[0]}
        values["energy"] = 0.5 * 1e-3 * values["P"]  # Clapeyron; that of the smallest cells has seven digits only
        runs.append({**values, "x": x, "p": p, "unknowns": int(found["unknowns"])})
    coarse, fine = runs
    off = {key: float(f"{coarse[key] / fine[key] - 1:.1e}") for key in ("P", "energy", "p0")}
    error = pressure_error(coarse["x"], coarse["p"], 4, scenes.piecewise(fine["x"], fine["p"]), 1.0, scenes.Punch.end)
    off["p"] = float(f"{error:.1e}")
    return {**fine, "x": coarse["x"], "p": coarse["p"], "off": off}  # of the pressures the mesh with fewer nodes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--abut", default=os.path.join(TOP, "build", "bin", "abut"))
    parser.add_argument("--out", default=os.path.join(HERE, "reference.json"))
    args = parser.parse_args()
    cases = {f"layers, c = {c:g}": layers(args.abut, c) for c in scenes.PENALTIES if c}
    cases["punch"] = punch(args.abut)
    for name, case in cases.items():
        print(f"{name}: {case['unknowns']} unknowns, {len(case['x'])} nodes, off {case['off']}", flush=True)
    text = {
        "origin": "Written by reference.py, which says how: Abut on meshes of order 4 graded to the end of the contact",
        "keys": "x, p: nodal pressures, polynomials of order 4 between every fourth node; off: relative differences, of layers from the "
        "independent values of examples/layers/reference.json, of the punch from a mesh of half the cell size (p: in L2, x < 0.9)",
        "cases": cases,
    }
    with open(args.out, "w") as f:
        f.write(json.dumps(text, indent=0).replace(",\n", ", ").replace("[\n", "[").replace("\n]", "]") + "\n")


if __name__ == "__main__":
    main()
