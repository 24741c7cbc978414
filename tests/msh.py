"""Small meshes for tests, and their gmsh files.

    from msh import box, ring, write
    write("part.msh", box((0, 0), (4, 1), 8, 2, corners=3), version=4.1)

A mesh is a dictionary: points [(x, y)], cells [(p, q, r) or (p, q, r, s)] of points, lines {name of a side: [(p, q)]}, name of the surface.
"""
import math, random, struct


def grid(place, nx, ny, sides, corners=4, surface="body"):
    """(nx, ny) quads of the unit square, or twice as many triangles, brought to their place; sides: names of bottom, right, top, left"""
    points = [place(i / nx, j / ny) for j in range(ny + 1) for i in range(nx + 1)]
    at = lambda i, j: j * (nx + 1) + i
    cells = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(ny) for i in range(nx)]
    if corners == 3:
        cells = [c for q in cells for c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    lines = {
        sides[0]: [(at(i, 0), at(i + 1, 0)) for i in range(nx)],
        sides[1]: [(at(nx, j), at(nx, j + 1)) for j in range(ny)],
        sides[2]: [(at(i, ny), at(i + 1, ny)) for i in range(nx)],
        sides[3]: [(at(0, j), at(0, j + 1)) for j in range(ny)],
    }
    return {"points": points, "cells": cells, "lines": lines, "surface": surface}


def box(lower, upper, nx, ny, **options):
    place = lambda s, t: tuple(a + (b - a) * z for a, b, z in zip(lower, upper, (s, t)))
    return grid(place, nx, ny, ("bottom", "right", "top", "left"), **options)


def quarter(inner, outer, nr, nt, **options):
    """A quarter of a ring in the first quadrant"""

    def place(s, t):
        r, angle = inner * (1 - s) + outer * s, t * math.pi / 2
        return r * math.cos(angle), r * math.sin(angle)

    return grid(place, nr, nt, ("bottom", "outer", "left", "inner"), **options)


def ring(inner, outer, nr, nt, corners=4):
    """A whole ring: its sides inner and outer are closed"""
    polar = lambda s, t: ((inner * (1 - s) + outer * s), 2 * math.pi * t)
    mesh = grid(lambda s, t: (polar(s, t)[0] * math.cos(polar(s, t)[1]), polar(s, t)[0] * math.sin(polar(s, t)[1])), nr, nt, "boil", corners)
    same = lambda p: p % (nr + 1) + p // (nr + 1) % nt * (nr + 1)
    join = lambda items: [tuple(map(same, item)) for item in items]
    return {**mesh, "cells": join(mesh["cells"]), "lines": {"inner": join(mesh["lines"]["l"]), "outer": join(mesh["lines"]["o"])}}


def disc(radius, n, corners=4):
    """A disc of five blocks of n by n quads; the side is called rim"""
    points, cells, lines, number = [], [], {"rim": []}, {}

    def point(x, y):
        key = round(x / radius, 9), round(y / radius, 9)
        if key not in number:
            number[key] = len(points)
            points.append((x, y))
        return number[key]

    def block(place):
        p = [[point(*place(i / n, j / n)) for i in range(n + 1)] for j in range(n + 1)]
        for j in range(n):
            for i in range(n):
                q = p[j][i], p[j][i + 1], p[j + 1][i + 1], p[j + 1][i]
                cells.extend([q] if corners == 4 else [q[:3], (q[0], q[2], q[3])])
        return p

    half = 0.45 * radius
    block(lambda s, t: (half * (2 * s - 1), half * (2 * t - 1)))
    for k in range(4):

        def place(s, t):  # from the block in the middle outwards, in a quarter about the axis k
            angle = math.pi / 4 * (2 * s - 1)
            x, y = (1 - t) * half + t * radius * math.cos(angle), (1 - t) * half * (2 * s - 1) + t * radius * math.sin(angle)
            for _ in range(k):
                x, y = -y, x
            return x, y

        rim = block(place)[n]
        lines["rim"] += list(zip(rim, rim[1:]))
    return {"points": points, "cells": cells, "lines": lines, "surface": "body"}


def shake(mesh, part=0.2, seed=1):
    """Moves the vertices inside by at most a part of their shortest line, and turns every cell, so that its first corner is any"""
    chance, points = random.Random(seed), list(mesh["points"])
    outside = {p for lines in mesh["lines"].values() for line in lines for p in line}
    length = {}
    for cell in mesh["cells"]:
        for p, q in zip(cell, cell[1:] + cell[:1]):
            for a in p, q:
                length[a] = min(length.get(a, math.inf), math.dist(points[p], points[q]))
    for p in length:
        if p not in outside:
            points[p] = tuple(x + part * length[p] * chance.uniform(-1, 1) / math.sqrt(2) for x in points[p])
    turn = lambda cell, k: cell[k:] + cell[:k]
    cells = [turn(cell, chance.randrange(len(cell))) for cell in mesh["cells"]]
    cells = [cell[::-1] if chance.random() < 0.5 else cell for cell in cells]
    return {**mesh, "points": points, "cells": cells}


def text(mesh, version=4.1, binary=False):
    """The bytes of the file; several meshes, a list, are several surfaces with points of their own"""
    meshes = mesh if isinstance(mesh, list) else [mesh]
    names = [(1, name) for m in meshes for name in m["lines"]] + [(2, m["surface"]) for m in meshes]
    tags = {pair: i + 1 for i, pair in enumerate(names)}
    points, blocks = [], []  # blocks: dimension, tag, type of elements, nodes of each
    for m in meshes:
        first = len(points) + 1
        points += m["points"]
        shifted = lambda items: [tuple(p + first for p in item) for item in items]
        blocks += [(1, tags[1, name], 1, shifted(lines)) for name, lines in m["lines"].items() if lines]
        for corners in 3, 4:
            cells = [c for c in m["cells"] if len(c) == corners]
            if cells:
                blocks.append((2, tags[2, m["surface"]], corners - 1, shifted(cells)))
    out = bytearray(f"$MeshFormat\n{version} {int(binary)} 8\n".encode())
    out += struct.pack("i", 1) + b"\n" if binary else b""
    out += f"$EndMeshFormat\n$PhysicalNames\n{len(names)}\n".encode()
    out += "".join(f'{d} {tags[d, name]} "{name}"\n' for d, name in names).encode() + b"$EndPhysicalNames\n"

    def put(kinds, *numbers):  # i: int, n: size, d: double
        if binary:
            return struct.pack("=" + kinds.replace("n", "q"), *numbers)
        return (" ".join(repr(x) for x in numbers) + "\n").encode()

    total = sum(len(block[3]) for block in blocks)
    if version == 4.1:
        entities = b"$Entities\n" + put("nnnn", 0, sum(d == 1 for d, _ in names), sum(d == 2 for d, _ in names), 0)
        for d in 1, 2:
            for tag in (tags[pair] for pair in names if pair[0] == d):
                entities += put("iddddddnin", tag, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1, tag, 0)
        nodes = put("nnnn", 1, len(points), 1, len(points)) + put("iiin", 2, names.index(names[-1]) + 1, 0, len(points))
        nodes += b"".join(put("n", i + 1) for i in range(len(points))) + b"".join(put("ddd", *map(float, p), 0.0) for p in points)
        elements, number = put("nnnn", len(blocks), total, 1, total), 0
        for d, tag, kind, items in blocks:
            elements += put("iiin", d, tag, kind, len(items))
            for item in items:
                number += 1
                elements += put("n" * (len(item) + 1), number, *item)
        out += entities + (b"\n" if binary else b"") + b"$EndEntities\n"
    else:
        nodes, elements, number = f"{len(points)}\n".encode(), f"{total}\n".encode(), 0
        nodes += b"".join(put("iddd", i + 1, *map(float, p), 0.0) for i, p in enumerate(points))
        for d, tag, kind, items in blocks:
            elements += put("iii", kind, len(items), 2) if binary else b""
            for item in items:
                number += 1
                head = (number, tag, tag) if binary else (number, kind, 2, tag, tag)
                elements += put("i" * (len(head) + len(item)), *head, *item)
    end = b"\n" if binary else b""
    return bytes(out + b"$Nodes\n" + nodes + end + b"$EndNodes\n$Elements\n" + elements + end + b"$EndElements\n")


def write(path, mesh, **options):
    with open(path, "wb") as f:
        f.write(text(mesh, **options))
    return path
