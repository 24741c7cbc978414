"""What the pictures of the examples and studies share: one style, lines of known slope, and files that are whole or not there"""
import math, os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

plt.style.use(os.path.join(os.path.dirname(os.path.abspath(__file__)), "abut.mplstyle"))


def slope(axes, power, x, y, text=None):
    """A thin line y ~ x^power through the middle of (x[0], x[1]) at y, with its power beside it"""
    middle = math.sqrt(x[0] * x[1])
    axes.plot(x, [y * (end / middle) ** power for end in x], color="0.6", lw=0.7, ls="-", marker="", zorder=0)
    axes.annotate(text or f"{power:g}", (x[1], y * (x[1] / middle) ** power), color="0.4", fontsize="small", va="center")


def save(figure, stem):
    """stem.png and stem.svg; the same bytes for the same figure"""
    for kind in ("png", "svg"):
        aside = f"{stem}.part.{kind}"
        figure.savefig(aside, metadata={"Date": None} if kind == "svg" else None)
        os.replace(aside, f"{stem}.{kind}")
    plt.close(figure)
    print(f"{stem}.png")
