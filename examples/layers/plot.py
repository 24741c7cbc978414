#!/usr/bin/env python3
"""Draws a run of layers.yml, folder/layers.png and .svg: plot.py [folder, out unless given]
Above the adapted mesh of the lower body with its von Mises stress, below its part at the end of the contact, and the contact pressure
beside the reference curves. Stress and pressure differ in lightness and marker too, so that print in grey can be read."""
import os, sys

import h5py
from matplotlib.collections import PolyCollection

from layers import penalty, profile, record, reference

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from picture import plt, save  # noqa: E402


def read_mesh(path, body):
    """The last cycle of one body: corners of each cell, von Mises stress of each cell"""
    with h5py.File(path) as f:
        last = f[max(f)][body]
        return last["vertices"][:][last["cells"][:].astype(int)], last["von_mises"][:].ravel()


def draw_mesh(axes, corners, stress, xlim, ylim, lines):
    mesh = PolyCollection(corners, array=stress, edgecolors="black", linewidths=lines)
    axes.add_collection(mesh)
    axes.set(xlim=xlim, ylim=ylim, aspect="equal", xlabel="$x_1$ [cm]", ylabel="$x_2$ [cm]")
    return mesh


def draw_pressure(axes, path, c):
    x, p = profile(path)
    for case, style in ((c, "k-"), (0, "k--")):
        curve = reference(case)["pressure"]
        axes.plot(curve["x"], curve["p"], style, marker="", label=f"reference, c = {case:g}" if case else "reference, exact contact")
    shown = [(u, v) for u, v in zip(x, p) if u <= 1.25]
    axes.plot(*zip(*shown), "o", ms=3, mfc="white", color="tab:red", label="computed, nodal values")
    axes.set(xlim=(0, 1.25), ylim=(0, None), xlabel="$x_1$ [cm]", ylabel="contact pressure [MPa]")
    axes.legend()


def main(folder="out"):
    figure, axes = plt.subplot_mosaic([["body", "body"], ["edge", "pressure"]], figsize=(9, 5.4), height_ratios=(1, 1.25))
    corners, stress = read_mesh(f"{folder}/layers.h5", "lower")
    mesh = draw_mesh(axes["body"], corners, stress, (0, 4), (0, 1), 0.2)
    figure.colorbar(mesh, ax=axes["body"], label="von Mises stress [MPa]", pad=0.01)
    axes["body"].set_title(f"lower body, {len(corners)} cells")
    draw_mesh(axes["edge"], corners, stress, (0.75, 1.25), (0.7, 1), 0.3)
    axes["edge"].set_title("the end of the contact")
    draw_pressure(axes["pressure"], f"{folder}/layers_profile.csv", penalty(record(f"{folder}/layers.record")))
    save(figure, f"{folder}/layers")


if __name__ == "__main__":
    main(*sys.argv[1:])
