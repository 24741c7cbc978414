"""Gmsh files with one fault each"""
import os, sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from msh import box, quarter, text

PLATE = box((0, 0), (2, 1), 4, 2)


def change(mesh, **parts):
    """Parts of a mesh changed by functions"""
    return {**mesh, **{key: function(mesh[key]) for key, function in parts.items()}}


def join(first, second):
    """Two meshes as one surface; points at one place are one point"""
    points = list(first["points"])
    place = {p: i for i, p in enumerate(points)}
    for p in second["points"]:
        if place.setdefault(p, len(points)) == len(points):
            points.append(p)
    renamed = lambda items: [tuple(place[second["points"][i]] for i in item) for item in items]
    lines = {name: first["lines"][name] + renamed(second["lines"][name]) for name in first["lines"]}
    return {**first, "points": points, "cells": first["cells"] + renamed(second["cells"]), "lines": lines}


def bad_meshes():
    """Name of the file and its bytes"""
    plate = text(PLATE)
    old = text(PLATE, version=2.2).decode()
    cell = lambda kind, nodes: old.replace("\n1 1 2 1 1 1 2\n", f"\n1 {kind} 2 1 1 {' '.join(map(str, nodes))}\n").encode()
    yield "plate.msh", plate
    yield "quarter.msh", text(quarter(1, 2, 4, 6))
    yield "coarse.msh", text(quarter(1, 1.05, 1, 2))
    yield "triangles.msh", text(quarter(1, 2, 4, 6, corners=3))
    yield "empty.msh", b""
    yield "cut.msh", plate[: len(plate) // 2]
    yield "cutbinary.msh", text(PLATE, binary=True)[:-40]
    yield "version.msh", plate.replace(b"4.1 0 8", b"4 0 8")
    yield "solid.msh", cell(4, (1, 2, 3, 4))
    yield "second.msh", cell(8, (1, 2, 3))
    yield "lost.msh", old.replace("\n13 3 2 5 5 1 2 7 6\n", "\n13 3 2 5 5 1 2 99 6\n").encode()
    yield "same.msh", old.replace("\n2 0.5 0.0", "\n1 0.5 0.0").encode()
    yield "high.msh", old.replace("\n2 0.5 0.0 0.0\n", "\n2 0.5 0.0 0.1\n").encode()
    yield "tiny.msh", text(box((0, 0), (2e-9, 1e-9), 4, 2), version=2.2).replace(b"\n2 5e-10 0.0 0.0\n", b"\n2 5e-10 0.0 1e-10\n")
    yield "nan.msh", old.replace("\n2 0.5 0.0 0.0\n", "\n2 0.5 nan 0.0\n").encode()
    yield "many.msh", old.replace("$Nodes\n15\n", "$Nodes\n1500000000000\n").encode()
    yield "mixed.msh", text(change(PLATE, cells=lambda c: c[1:] + [c[0][:3], (c[0][0], c[0][2], c[0][3])]))
    yield "unnamed.msh", text(change(PLATE, lines=lambda lines: {**lines, "top": lines["top"][:-1]}))
    yield "flat.msh", text(change(PLATE, points=lambda p: [(0.0, 0.0) if q == (0.5, 0.5) else q for q in p]))
    yield "twice.msh", plate.replace(b'"right"', b'"LEFT"')
    four = old.replace("$PhysicalNames\n5\n", "$PhysicalNames\n4\n").replace('1 4 "left"\n', "").replace('"right"', '"4"')
    yield "number.msh", four.encode()
    yield "numbered.msh", old.replace("\n13 3 2 5 5 ", "\n13 3 2 6 6 ").replace('"body"', '"6"').encode()
    yield "long.msh", plate.replace(b'"right"', b'"' + 70 * b"r" + b'"')
    yield "vertex.msh", text(join(box((0, 0), (1, 1), 2, 2), box((1, 1), (2, 2), 2, 2)))
    yield "pieces.msh", text(join(box((0, 0), (1, 1), 2, 2), box((2, 0), (3, 1), 2, 2)))
    yield "over.msh", text(change(PLATE, cells=lambda c: c + c[:1]))
    yield "tag.msh", old.replace("\n1 1 2 1 1 1 2\n", "\n1 1 2 4294967295 1 1 2\n").encode()
    yield "groups.msh", old.replace("\n1 1 2 1 1 1 2\n", "\n1 1 2 1 1 1 2\n99 1 2 2 1 1 2\n").replace("$Elements\n20\n", "$Elements\n21\n").encode()
    move = lambda lines: {**lines, "top": lines["top"][:1] + lines["top"][2:], "right": lines["right"] + lines["top"][1:2]}
    yield "split.msh", text(change(PLATE, lines=move))
