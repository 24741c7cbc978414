#!/usr/bin/env python3
"""Writes the scene of N layers one on the other: stack.py N [--cells 16] [--penalty 0] > stack.yml, then build/bin/abut stack.yml"""
import argparse

CLOSURE = 1.366e-3  # of each interface


def body(k, n, cells):
    """Layer k of n, counted from below; those between the lowest and the highest are free to move up and down"""
    held = {1: "  bc_bottom: {u2: 0}\n", n: f"  bc_top:    {{u2: {-(n - 1) * CLOSURE:.10g}}}\n"}
    return (
        f'layer{k}:\n  mesh:     {{box: "0,{k - 1},4,{k}", cells: "{4 * cells},{cells}"}}\n  material: {{young: 2.1e5, poisson: 0.3}}\n'
        f"  bc_left:   {{u1: 0}}\n{held.get(k, '')}"
    )


def pair(k, penalty):
    """Between layers k and k + 1; the gap is given, for layers are drawn as boxes"""
    return (
        f'between{k}:\n  pair: {{bodies: "layer{k + 1},layer{k}", sides: "bottom,top", gap: "1e-3*x^2", penalty: {penalty:g}}}\n'
    )


def scene(n, cells=16, penalty=0):
    bodies, pairs = ",".join(f"layer{k}" for k in range(1, n + 1)), ",".join(f"between{k}" for k in range(1, n))
    return (
        f"scene:\n  bodies: {bodies}\n  pairs: {pairs}\n"
        + "".join(body(k, n, cells) for k in range(1, n + 1))
        + "".join(pair(k, penalty) for k in range(1, n))
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("layers", type=int, help="how many, 2 or more")
    parser.add_argument("--cells", type=int, default=16, help="per unit of length [16]")
    parser.add_argument("--penalty", type=float, default=0, help="c, theta = cH/E [0: exact contact]")
    args = parser.parse_args()
    if args.layers < 2 or args.cells < 1 or args.penalty < 0:
        parser.error("give 2 or more layers, 1 or more cells, and a penalty of 0 or more")
    print(scene(args.layers, args.cells, args.penalty), end="")


if __name__ == "__main__":
    main()
