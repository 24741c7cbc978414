#!/usr/bin/env python3
"""Writes layer_pressure.csv, pressures against which the layers are tested: two elastic layers without end on smooth supports, pressed together.

With the penalty law theta p + K p = Delta - r0 x^2 on [-a, a] and p(a) = 0. A layer of height H answers cos(xi x) by C(xi) cos(xi x) with
C = 2(1-nu^2)/(E xi) (cosh 2z - 1)/(sinh 2z + 2z), z = xi H. K is split in C0 tanh(xi)/xi, whose kernel is -C0/pi ln tanh(pi|x|/4), and a rest
that decays like exp(-2 xi). Collocation with polynomials of degree 13 on panels that shrink towards a; needs NumPy and SciPy, takes half a minute.
It shares nothing with Abut; a, p(0) and the force agree with examples/layers/reference.json, bodies of length 4, to 1.5e-7.
"""
import numpy as np
from numpy.polynomial.legendre import leggauss, legvander
from scipy.optimize import brentq

E, NU, R0, DELTA = 2.1e5, 0.3, 1e-3, 1.366e-3  # MPa, cm; H = 1
C0 = 4 * (1 - NU**2) / E  # of both layers
PANELS, DEGREE, RATIO = 12, 14, 0.2
CASES = (0.5, 0.05, 0.005, 0.0005)


def composite(edges, n):
    x, w = leggauss(n)
    h, c = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
    return (c[:, None] + h[:, None] * x).ravel(), (h[:, None] * w).ravel()


def rest(xi):
    e = np.exp(-2 * xi)
    return C0 / xi * ((1 - e) ** 2 / (1 - e * e + 4 * xi * e) - (1 - e) / (1 + e))


def singular(distance):
    return -C0 / np.pi * np.log(np.tanh(np.pi * np.abs(distance) / 4))


XI, WEIGHT = composite(np.linspace(0, 40, 81), 16)
GAUSS, GAUSS_WEIGHT = leggauss(40)
COEFFICIENTS = np.linalg.inv(legvander(leggauss(DEGREE)[0], DEGREE - 1))  # values at the collocation points -> Legendre coefficients


class Pressure:
    """p on [0, a], by its values at the collocation points"""

    def __init__(self, a, theta):
        self.edges = a * np.r_[0, 1 - RATIO ** np.arange(1, PANELS), 1]
        x = composite(self.edges, DEGREE)[0]
        points = np.r_[x, a]
        t, w = composite(self.edges, 40)
        to_t = np.array([self.row(s) for s in t])
        K = np.array([self.singular_row(s) for s in points])
        K += np.cos(np.outer(points, XI)) * (rest(XI) * WEIGHT / np.pi) @ (2 * np.cos(np.outer(XI, t)) * w @ to_t)
        self.p = np.linalg.solve(K[:-1] + theta * np.eye(len(x)), DELTA - R0 * x**2)
        self.end = DELTA - R0 * a**2 - K[-1] @ self.p  # theta p(a)
        self.force = w @ to_t @ self.p

    def basis(self, panel, t):
        low, high = self.edges[panel : panel + 2]
        return legvander((2 * t - low - high) / (high - low), DEGREE - 1) @ COEFFICIENTS

    def row(self, t):
        panel = min(np.searchsorted(self.edges, t, "right") - 1, PANELS - 1)
        row = np.zeros((PANELS, DEGREE))
        row[panel] = self.basis(panel, np.array([t]))[0]
        return row.ravel()

    def singular_row(self, x):
        """Integrals of the singular kernel, cut at x, with the points crowded there"""
        row = np.zeros((PANELS, DEGREE))
        z, w = ((GAUSS + 1) / 2) ** 4, 2 * GAUSS_WEIGHT * ((GAUSS + 1) / 2) ** 3
        for panel, (low, high) in enumerate(zip(self.edges, self.edges[1:])):
            for at in (x, -x):  # the panel and its mirror image
                cuts = [low, at, high] if low < at < high else [low, high]
                for near, far in zip(cuts, cuts[1:]):
                    if abs(near - at) > abs(far - at):
                        near, far = far, near
                    step = (far - near) * z
                    row[panel] += singular(near - at + step) * w * abs(far - near) @ self.basis(panel, near + step)
        return row.ravel()

    def __call__(self, x):
        return np.array([self.row(s) @ self.p for s in x])


def main():
    s = np.linspace(1, 0, 201)
    columns, comments = [s], []
    for c in CASES:
        a = brentq(lambda a: Pressure(a, c / E).end, 0.985, 1.2, xtol=1e-12)
        p = Pressure(a, c / E)
        columns.append(np.r_[p(a * (1 - s[:-1] ** 2)), 0])
        comments.append(f"# c = {c}: a = {a:.9g}, force of the half {p.force:.9g}")
    print("# Pressures [MPa] of the layers at x = a (1 - s^2) [cm] for theta = c H/E, written by layer_pressure.py, which says how")
    print("\n".join(comments))
    print("s," + ",".join(map(str, CASES)))
    for row in zip(*columns):
        print(f"{row[0]:.4g}," + ",".join(f"{value:.8g}" for value in row[1:]))


if __name__ == "__main__":
    main()
