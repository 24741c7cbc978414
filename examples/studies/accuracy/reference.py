#!/usr/bin/env python3
"""Writes reference.json, what the runs of this folder are measured against: two layers of length 4 and height 1 pressed together, exact
contact.

A layer without end on a smooth support answers a pressure cos(xi x) by the normal displacement C(xi) cos(xi x), C = 2(1-nu^2)/(E xi)
(cosh 2z - 1)/(sinh 2z + 2z), z = xi H. With the sum of both layers and C0 = sum 2(1-nu^2)/E, C = C0 tanh(xi)/xi + R(xi), where R decays
like exp(-2 xi); the kernel of the first part is -C0/pi ln tanh(pi|x|/4), its singular part -C0/pi ln|x|. With p = sqrt(1-t^2) sum c_k
U_2k(t), t = x/a, the singular part of the derivative of the displacement is sum c_k T_2k+1(t) (Chebyshev), and all others are integrals
of smooth functions against sqrt(1-t^2): Gauss's formula of that weight. So the equation of the first kind, displacement = Delta - r0 x^2
on [-a, a], is solved by collocation of its derivative; at x = 0 it gives Delta for a given a.

That the layers end at x = 4 changes the force by 1.5e-7 at Delta/r0 = 1.366 and by 1.1e-6 at 2.2. The change of the displacement under
each c_k is that of spectral elements (order 6) of length 4 less those of length 8, on the same mesh: it is smooth, and what the mesh does
not resolve at the end of the contact is in both. It enters the equation like R.

Needs NumPy, takes two minutes, shares nothing with Abut. At 1.366 it agrees with examples/layers/reference.json, finite elements of order
9 in both bodies, to 3e-10 in P, 6e-10 in p0 and 2e-10 in a, less than the error bounds there.
"""

import argparse, json, os

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
R0, LENGTH = 1e-3, 4.0
MATERIALS = {"equal": ((2.1e5, 0.3), (2.1e5, 0.3)), "steel on aluminium": ((2.1e5, 0.3), (7e4, 0.33))}
CASES = [("equal", closure) for closure in (1.366, 1.0, 1.2, 1.6, 2.2)] + [("steel on aluminium", 1.366)]
POINTS = 400  # of the formulae of Gauss


def rest(xi):
    """R(xi)/C0"""
    e = np.exp(-2 * xi)
    return ((1 - e) ** 2 / (1 - e * e + 4 * xi * e) - (1 - e) / (1 + e)) / xi


class SpectralLayer:
    """Normal displacement of the upper side of [0, length] x [0, 1], u1 = 0 at x = 0, u2 = 0 at y = 0, under nodal forces there"""

    def __init__(self, length, young, poisson, order=6, size=0.5):
        self.order, self.size = order, size
        self.nodes, self.weights = lobatto(order)
        nx, ny = round(length / size), round(1 / size)
        n, m = nx * order + 1, ny * order + 1
        element = self.stiffness(young, poisson)
        K = np.zeros((2 * n * m, 2 * n * m))
        for i in range(nx):
            for j in range(ny):
                points = (i * order + np.arange(order + 1))[:, None] * m + j * order + np.arange(order + 1)
                unknowns = (2 * points.ravel()[:, None] + (0, 1)).ravel()
                K[np.ix_(unknowns, unknowns)] += element
        index = np.arange(n * m).reshape(n, m)
        free = np.setdiff1d(np.arange(2 * n * m), np.r_[2 * index[0], 2 * index[:, 0] + 1])
        self.top = np.searchsorted(free, 2 * index[:, -1] + 1)[: round(LENGTH / size) * order + 1]
        rhs = np.zeros((len(free), len(self.top)))
        rhs[self.top, np.arange(len(self.top))] = 1
        self.flexibility = np.linalg.solve(K[np.ix_(free, free)], rhs)[self.top]

    def stiffness(self, young, poisson):
        D = differentiation(self.nodes)
        g, w = np.polynomial.legendre.leggauss(self.order + 1)
        B = interpolation(self.nodes, g)
        N = [np.kron(B @ D, B).reshape(len(g), len(g), -1) * 2 / self.size, np.kron(B, B @ D).reshape(len(g), len(g), -1) * 2 / self.size]
        W = np.outer(w, w) * (self.size / 2) ** 2
        lame, shear = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
        d = [[np.einsum("ij,ijk,ijl->kl", W, N[a], N[b]) for b in (0, 1)] for a in (0, 1)]
        K = np.zeros((d[0][0].shape[0], 2, d[0][0].shape[0], 2))
        for a in (0, 1):
            for b in (0, 1):
                K[:, a, :, b] = lame * d[a][b] + shear * (d[b][a] + (a == b) * (d[0][0] + d[1][1]))
        return K.reshape(2 * K.shape[0], -1)

    def trace(self, x, derivative=False):
        """Rows that give the value, or the derivative, at points of the upper side from those at its nodes"""
        last = (len(self.top) - 1) // self.order - 1
        rows = np.zeros((len(x), len(self.top)))
        for row, at in zip(rows, x):
            i = min(int(at / self.size), last)
            B = interpolation(self.nodes, np.array([2 * (at / self.size - i) - 1]))[0]
            row[i * self.order : (i + 1) * self.order + 1] = B @ differentiation(self.nodes) * 2 / self.size if derivative else B
        return rows


def lobatto(order):
    inner = np.polynomial.legendre.Legendre.basis(order).deriv().roots()
    x = np.r_[-1, np.sort(inner.real), 1]
    return x, 2 / (order * (order + 1) * np.polynomial.legendre.Legendre.basis(order)(x) ** 2)


def interpolation(nodes, x):
    rows = np.ones((len(x), len(nodes)))
    for k, node in enumerate(nodes):
        for other in np.delete(nodes, k):
            rows[:, k] *= (x - other) / (node - other)
    return rows


def differentiation(nodes):
    difference = nodes[:, None] - nodes + np.eye(len(nodes))
    product = difference.prod(axis=1)
    D = product[:, None] / product / difference
    np.fill_diagonal(D, 0)
    return D - np.diag(D.sum(axis=1))


class Contact:
    """a, p0, force of the half and the c_k for a closure Delta; end: the correction for layers of length 4"""

    def __init__(self, materials, closure, terms=16, end=True):
        self.C0, self.terms, self.end = sum(2 * (1 - nu**2) / E for E, nu in materials), terms, None
        if end:
            self.layers = [[SpectralLayer(length, *material) for length in (LENGTH, 2 * LENGTH)] for material in materials]
            self.end = sum(short.flexibility - long.flexibility for short, long in self.layers)
        self.a = self.half_width(closure)
        c = self.solve(self.a)[1]
        self.force, self.p0, self.c = self.a * np.pi / 4 * c[0], (-1.0) ** np.arange(terms) @ c, c

    def half_width(self, closure):
        a, b, low = 0.9, 1.0, self.solve(0.9)[0]
        for _ in range(20):  # secants
            high = self.solve(b)[0]
            if abs(b - a) < 1e-14 or high == low:
                return b
            a, b, low = b, b + (closure * R0 - high) * (b - a) / (high - low), high
        raise SystemExit(f"no half-width for Delta/r0 = {closure}")

    def solve(self, a):
        n, k = self.terms, np.arange(self.terms)
        theta = np.arange(1, POINTS + 1) * np.pi / (POINTS + 1)
        s = np.cos(theta)
        density = np.pi / (POINTS + 1) * np.sin(theta)[:, None] * np.sin(np.outer(theta, 2 * k + 1))  # weight times sqrt(1-s^2) U_2k(s)
        t = np.cos((2 * k + 1) * np.pi / (4 * n + 2))
        xi, w = gauss(40, 60)
        moment = a * np.cos(np.outer(xi, a * s)) @ density  # Fourier transforms
        x = a * (t[:, None] - s)
        smooth = np.where(abs(x) < 1e-4, -np.pi**2 / 24 * x, np.pi / 2 / np.sinh(np.pi / 2 * np.where(x, x, 1)) - 1 / np.where(x, x, 1))
        slope = -np.cos(np.outer(np.arccos(t), 2 * k + 1)) - a / np.pi * smooth @ density
        slope += np.sin(np.outer(a * t, xi)) * (-xi * w * rest(xi)) @ moment / np.pi
        value = -a / np.pi * (np.log(np.tanh(np.pi / 4 * a * abs(s)) / abs(s)) @ density + logarithm(k)) + (w * rest(xi)) @ moment / np.pi
        slope, value = self.C0 * slope, self.C0 * value
        if self.end is not None:
            layer = self.layers[0][0]
            right = s > 0
            u = self.end @ layer.trace(a * s[right]).T @ (a * density[right])
            slope, value = slope + layer.trace(a * t, True) @ u, value + u[0]
        c = np.linalg.solve(slope, -2 * R0 * a * t)
        return value @ c, c


def logarithm(k):
    """Integrals of ln|s| sqrt(1-s^2) U_2k(s), where sqrt(1-s^2) U_m = (T_m - T_m+2)/(2 sqrt(1-s^2)); those of ln|s| T_m/sqrt(1-s^2) are
    -pi T_m(0)/m, and -pi ln 2 for m = 0"""
    m = 2 * np.arange(len(k) + 1)
    T = np.r_[-np.pi * np.log(2), -np.pi / m[1:] * (-1.0) ** (m[1:] // 2)]
    return (T[:-1] - T[1:]) / 2


def gauss(end, panels):
    x, w = np.polynomial.legendre.leggauss(16)
    h = end / panels / 2
    return (h * (2 * np.arange(panels)[:, None] + 1 + x)).ravel(), np.tile(h * w, panels)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default=os.path.join(HERE, "reference.json"))
    args = parser.parse_args()
    cases = []
    for name, closure in CASES:
        endless, found = Contact(MATERIALS[name], closure, end=False), Contact(MATERIALS[name], closure)
        values = {"a": found.a, "p0": found.p0, "P": found.force}
        case = {"materials": name, "closure": closure, **{key: float(f"{value:.12g}") for key, value in values.items()}}
        case["without_end"] = {key: float(f"{v:.12g}") for key, v in zip(values, (endless.a, endless.p0, endless.force))}
        case["chebyshev"] = [float(f"{value:.12g}") for value in found.c]
        cases.append(case)
        print(name, closure, values, case["without_end"], f"last coefficients {found.c[-2:]}", flush=True)
    text = {
        "origin": "Written by reference.py, which says how, independently of Abut: two layers of length 4 in exact contact, half model",
        "keys": "closure: Delta/r0; a: end of the contact [cm], p0 [MPa], P: force of the half [MPa cm]; "
        "p(x) = sqrt(1-t^2) sum chebyshev_k U_2k(t), t = x/a; without_end: the same for layers without end",
        "cases": cases,
    }
    with open(args.out, "w") as f:
        json.dump(text, f, indent=1)
        f.write("\n")


if __name__ == "__main__":
    main()
