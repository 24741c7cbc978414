#!/usr/bin/env python3
"""Draws a run: the meshes around the contact, coloured by von Mises stress, and the contact pressure beside a formula

    build/bin/abut SCENE -output out/NAME.xdmf -output_profile out/NAME_profile.csv
    examples/plot.py out/NAME [--window x0,y0,x1,y1] [--along x] [--formula 'p0*sqrt(1-(x/a)**2)'] [--to out/NAME]

The pressure is drawn over a formula in x, y and s, the way along the side, with Python's math; that with which it is compared is one in t, the value of
the first. Where it has no value nothing is drawn. Colours end where one cell of a hundred has more stress, for corners have any."""
import argparse, csv, math, os

import h5py
from matplotlib.collections import PolyCollection

from picture import plt, save


def read_bodies(path):
    """The last meshes: corners and von Mises stress of all cells, body by body"""
    with h5py.File(path) as f:
        for body in (part for part in f[max(f)].values() if "von_mises" in part):  # the others are sides of pairs
            yield body["vertices"][:][body["cells"][:].astype(int)], body["von_mises"][:].ravel()


def read_pressure(path, along):
    """Places and pressures of each pair"""
    pairs = {}
    with open(path) as f:
        for row in csv.DictReader(f):
            if row["side"] == "pressure":
                place = value(along, **{name: float(row[name]) for name in "xys"})
                pairs.setdefault(row["pair"], []).append((place, float(row["pressure"])))
    return {name: sorted(points) for name, points in pairs.items()}


def value(formula, **variables):
    try:
        return eval(formula, vars(math), variables)
    except (ValueError, ZeroDivisionError):
        return math.nan


def draw_meshes(figure, axes, path, window):
    bodies = list(read_bodies(path))
    inside = [s for corners, stress in bodies for cell, s in zip(corners, stress) if window is None or touches(cell, window)]
    for corners, stress in bodies:
        mesh = PolyCollection(corners, array=stress, edgecolors="black", linewidths=0.15)
        mesh.set_clim(0, sorted(inside)[-1 - len(inside) // 100])
        axes.add_collection(mesh)
    axes.autoscale()
    if window:
        axes.set(xlim=window[::2], ylim=window[1::2])
    axes.set(aspect="equal", xlabel="$x$", ylabel="$y$")
    figure.colorbar(mesh, ax=axes, label="von Mises stress", shrink=0.8)


def touches(cell, window):
    middle = cell.mean(axis=0)
    return window[0] <= middle[0] <= window[2] and window[1] <= middle[1] <= window[3]


def draw_pressure(axes, path, along, formula):
    pairs = read_pressure(path, along)
    end = 1.3 * max((place for points in pairs.values() for place, p in points if p > 0), default=1)
    for name, points in pairs.items():
        axes.plot(*zip(*(point for point in points if point[0] <= end)), "o", ms=3, mfc="white", label=f"computed, {name}")
    if formula:
        places = [end * k / 400 for k in range(401)]
        axes.plot(places, [value(formula, t=place) for place in places], "k-", marker="", lw=1, label="formula")
    axes.set(xlim=(0, end), ylim=(0, 1.05 * axes.get_ylim()[1]), xlabel=along, ylabel="contact pressure")
    axes.legend()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", help="out/NAME: reads out/NAME.h5 and out/NAME_profile.csv")
    parser.add_argument("--window", type=lambda text: [float(word) for word in text.split(",")], help="part of the plane to be drawn")
    parser.add_argument("--along", default="x", help="what the pressure is drawn over [x]")
    parser.add_argument("--formula", help="the pressure it is compared with, in t")
    parser.add_argument("--to", help="stem of the pictures [that of the run]")
    args = parser.parse_args()
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    draw_meshes(figure, axes[0], f"{args.run}.h5", args.window)
    draw_pressure(axes[1], f"{args.run}_profile.csv", args.along, args.formula)
    save(figure, args.to or args.run, colors=128)
    print(f"{os.path.getsize((args.to or args.run) + '.png') // 1000} kB")


if __name__ == "__main__":
    main()
