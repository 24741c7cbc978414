"""What the pictures of the examples and studies share: one style, lines of known slope, and files that are whole or not there"""
import math, os

import matplotlib
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

plt.style.use(os.path.join(os.path.dirname(os.path.abspath(__file__)), "abut.mplstyle"))


def slope(axes, power, x, y, text=None):
    """A thin line y ~ x^power through the middle of (x[0], x[1]) at y, with its power beside it"""
    middle = math.sqrt(x[0] * x[1])
    axes.plot(x, [y * (end / middle) ** power for end in x], color="0.6", lw=0.7, ls="-", marker="", zorder=0)
    axes.annotate(text or f"{power:g}", (x[1], y * (x[1] / middle) ** power), color="0.4", fontsize="small", va="center")


def legend_above(figure, axes, columns):
    """One legend, of what is drawn in some axes, above all of a figure"""
    handles = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels())}
    lines = -(-len(handles) // columns)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - (0.18 * lines + 0.08) / figure.get_figheight()))
    figure.legend(handles.values(), handles, loc="upper center", ncol=columns)


def save(figure, stem, colors=None):
    """stem.png and stem.svg; the same bytes for the same figure. With a number of colours, for lines, the PNG is a third as large"""
    for kind in ("png", "svg"):
        aside = f"{stem}.part.{kind}"
        figure.savefig(aside, metadata={"Date": None} if kind == "svg" else None)
        if colors and kind == "png":
            Image.open(aside).convert("RGB").quantize(colors).save(aside, optimize=True)
        os.replace(aside, f"{stem}.{kind}")
    plt.close(figure)
    print(f"{stem}.png")
