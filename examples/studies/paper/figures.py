"""The figures of the study, from its CSV files"""
import os, sys

import numpy as np
from matplotlib.collections import PolyCollection
from infinite import displacement, pressure
from tables import REFERENCE, SIX, deltas, energy_error, local_error, uniform_unknowns, with_boundary

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
from picture import plt, save  # noqa: E402


def mesh_of(meshes, run, cycle=None):
    """Corners and von Mises stresses of a stored mesh, of the last cycle unless given"""
    cycle = cycle or max(int(r["cycle"]) for r in meshes if r["run"] == run)
    rows = [r for r in meshes if r["run"] == run and int(r["cycle"]) == cycle]
    box = np.array([[float(r[k]) for k in ("x0", "y0", "x1", "y1")] for r in rows])
    return box[:, [[0, 1], [2, 1], [2, 3], [0, 3]]], np.array([float(r["von_mises"]) for r in rows]), cycle


def draw_mesh(axes, corners, stress=None, xlim=(0, 4), ylim=(0, 1), lines=0.3):
    cells = PolyCollection(corners, array=stress, facecolors=None if stress is not None else "none", edgecolors="black", linewidths=lines)
    axes.add_collection(cells)
    axes.set(xlim=xlim, ylim=ylim, aspect="equal", xlabel="$x_1$ [cm]", ylabel="$x_2$ [cm]")
    return cells


def figure_4(rows, meshes, profiles):
    figure, axes = plt.subplots(figsize=(7, 2.3))
    corners, stress, cycle = mesh_of(meshes, "rule fembem")
    figure.colorbar(draw_mesh(axes, corners, stress, lines=0.15), ax=axes, label="von Mises stress [MPa]", pad=0.01)
    axes.set_title(f"$\\delta$ = 0.1, loop converged, {len(corners)} cells")
    return figure


def figure_5_6(rows, meshes, profiles):
    figure, axes = plt.subplot_mosaic([["mesh", "mesh"], ["eta", "split"]], figsize=(7, 5), height_ratios=(1, 1.2))
    corners, _, cycle = mesh_of(meshes, "no rule fembem")
    draw_mesh(axes["mesh"], corners, lines=0.25)
    axes["mesh"].set_title(f"without the extra rule, mesh {cycle}, {len(corners)} cells")
    for run, text in (("given, no rule none", "without, given pressure"), ("given none", "with, given pressure"),
                      ("no rule fembem", "without, two layers"), ("rule fembem", "with, two layers")):
        n = range(1, len(rows[run]) + 1)
        axes["eta"].plot(n, [float(r["eta_max"]) for r in rows[run]], label=text)
        axes["split"].semilogy(n, [float(r["unknowns"]) for r in rows[run]], label=text)
    axes["eta"].axhline(0.1, color="0.5", lw=0.7, ls="-", marker="")
    axes["eta"].set(xlabel="mesh", ylabel=r"largest $\eta$", ylim=(0, None))
    axes["split"].set(xlabel="mesh", ylabel="unknowns of the lower body")
    axes["split"].legend()
    return figure


def figure_7(rows, meshes, profiles):
    figure, axes = plt.subplots(3, 1, figsize=(6, 5.2), sharex=True)
    for axis, cycle, text in zip(axes, (1, 3, None), ("first", "third", "last")):
        corners, _, number = mesh_of(meshes, SIX, cycle)
        draw_mesh(axis, corners, lines=0.25)
        axis.set_title(f"{text} mesh (iteration {number}), {len(corners)} cells")
    for axis in axes[:2]:
        axis.set_xlabel("")
    return figure


def figure_8(rows, meshes, profiles):
    figure, axes = plt.subplots(1, 2, figsize=(7, 2.8))
    runs = deltas(rows)
    for axis, u in zip(axes, ("u1", "u2")):
        axis.axhline(1e4 * REFERENCE["A"][u]["value"], color="0.4", lw=0.8, ls="--", marker="", label="reference")
        axis.plot([d for d, _ in runs], [1e4 * float(r[u]) for _, r in runs], "o-", label="computed")
        axis.set(xlabel=r"$\delta$", ylabel=f"$u_{u[1]}(0.5, 0.75)$ [$10^{{-4}}$ cm]", xlim=(0, None))
        axis.legend()
    return figure


def figure_9(rows, meshes, profiles):
    figure, axes = plt.subplots(1, 2, figsize=(7, 3.2))
    last = max(int(r["cycle"]) for r in profiles)
    for cycle in range(1, last + 1):
        for axis, what, scale in zip(axes, ("u_n", "pressure"), (1e4, 1)):
            points = [(float(r["x"]), scale * float(r["value"])) for r in profiles if int(r["cycle"]) == cycle and r["what"] == what]
            axis.plot(*zip(*[p for p in points if p[0] <= 1.5]), label=f"iteration {cycle}", ms=2.5)
    x = np.linspace(0, 1.5, 151)
    axes[0].plot(x, 1e4 * displacement(x), color="0.5", ls="-", marker="", lw=2, zorder=0, label="infinite layers")
    axes[1].plot(x, pressure(x), color="0.5", ls="-", marker="", lw=2, zorder=0, label="infinite layers")
    axes[0].set(xlabel="$x_1$ [cm]", ylabel=r"$u_n$ of the lower body [$10^{-4}$ cm]")
    axes[1].set(xlabel="$x_1$ [cm]", ylabel="contact pressure [MPa]", xlim=(0, 1.5), ylim=(0, None))
    axes[1].legend()
    return figure


def figure_10(rows, meshes, profiles):
    figure, axis = plt.subplots(figsize=(5, 3.6))
    runs = deltas(rows)
    inverse = [1 / d for d, _ in runs]
    axis.semilogy(inverse, [float(r["unknowns"]) + float(r["bem"]) for _, r in runs], label="adapted")
    axis.semilogy(inverse, [with_boundary(float(r["uniform"])) for _, r in runs], label="uniform, equal smallest cell (the paper's)")
    for error, text in ((local_error, "local error"), (energy_error, "energy error")):
        axis.semilogy(inverse, [with_boundary(uniform_unknowns(rows, error, error(r))[0]) for _, r in runs], label=f"uniform, equal {text}")
    axis.set(xlabel=r"$1/\delta$", ylabel="unknowns of the lower body, BEM included")
    axis.legend()
    return figure


FIGURES = {"4": figure_4, "5-6": figure_5_6, "7": figure_7, "8": figure_8, "9": figure_9, "10": figure_10}


def draw(rows, meshes, profiles, folder):
    for name, figure in FIGURES.items():
        save(figure(rows, meshes, profiles), os.path.join(folder, f"figure_{name}"))
