"""The files of -output: what ParaView is told of them agrees with what is in them, on any number of ranks.

The scene is two boxes with non-matching sides pressed evenly: the displacement is linear, sigma_22 = -p is the only stress in the plane.
What the HDF5 file holds is read back in tests/unit/ck_fields.c; here it is only asked to be there, for the standard library cannot read it.
"""
import os, re, tempfile, xml.etree.ElementTree as xml

from abut import LAYERS, read_csv, run, run_error

DELTA, NU, THETA = 0.01, 0.3, 0.05
SCENE = """-scene_bodies lower,upper -scene_pairs mid
-lower_mesh_box 0,0,2,1 -lower_mesh_cells 4,2 -lower_material_young 1 -lower_material_poisson 0.3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0
-upper_mesh_box 0,1,2,2 -upper_mesh_cells 3,2 -upper_material_young 1 -upper_material_poisson 0.3 -upper_bc_left_u1 0 -upper_bc_top_u2 -0.01
-upper_mesh_shape triangle -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 0 -mid_pair_theta 0.05
"""
PRESSURE = DELTA / (THETA + 2 * (1 - NU**2))
STRESS = [0.0, -PRESSURE, -NU * PRESSURE, 0.0]
VON_MISES = PRESSURE * (1 - NU + NU**2) ** 0.5


def near(value, exact, scale):
    return abs(value - exact) < 1e-6 * scale


def numbers(array):
    """A <DataArray> as a list of rows"""
    values, width = [float(v) for v in array.text.split()], int(array.get("NumberOfComponents", 1))
    return [values[i : i + width] for i in range(0, len(values), width)]


def read_vtu(path):
    piece = xml.parse(path).getroot().find("UnstructuredGrid/Piece")
    data = {array.get("Name"): numbers(array) for array in piece.iter("DataArray")}
    corners = [int(v) for v, in data["connectivity"]]
    ends = [int(v) for v, in data["offsets"]]
    data["cells"] = [corners[i:j] for i, j in zip([0] + ends, ends)]
    assert len(data["vertices"]) == len(data["displacement"]) == int(piece.get("NumberOfPoints"))
    cells = int(piece.get("NumberOfCells"))
    assert all(len(data[name]) == cells for name in ("cells", "types", "stress", "von_mises", "level"))
    assert ends[-1] == len(corners)
    return data


def area(cell, vertices):
    x = [vertices[i] for i in cell]
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(x, x[1:] + x[:1])) / 2


def check_body(data, bottom, corners):
    """`bottom`: the part of the lower edge of the box, y0, in u_2 = -(1-nu^2) p (y-y0) + u_2(y0)"""
    vertices, y0, u0 = data["vertices"], *bottom
    for (x, y, z), (u1, u2, u3) in zip(vertices, data["displacement"]):
        assert z == u3 == 0
        assert near(u1, NU * (1 + NU) * PRESSURE * x, DELTA)
        assert near(u2, u0 - (1 - NU**2) * PRESSURE * (y - y0), DELTA)
    assert {len(cell) for cell in data["cells"]} == {corners}
    assert {kind for kind, in data["types"]} == {9 if corners == 4 else 5}
    areas = [area(cell, vertices) for cell in data["cells"]]
    assert min(areas) > 0 and abs(sum(areas) - 2) < 1e-12
    for stress in data["stress"]:
        assert all(near(s, exact, PRESSURE) for s, exact in zip(stress, STRESS))
    assert all(near(v, VON_MISES, PRESSURE) for v, in data["von_mises"])


def check_vtu(ranks):
    with tempfile.TemporaryDirectory() as folder:
        run(None, SCENE, f"-output {folder}/fields.vtu", ranks=ranks)
        assert sorted(os.listdir(folder)) == ["fields.pvd", "fields_lower_0000.vtu", "fields_mid_0000.vtp", "fields_upper_0000.vtu"]
        listed = xml.parse(f"{folder}/fields.pvd").getroot().findall("Collection/DataSet")
        assert [d.get("file") for d in listed] == ["fields_lower_0000.vtu", "fields_upper_0000.vtu", "fields_mid_0000.vtp"]
        body = {d.get("name"): read_vtu(f"{folder}/{d.get('file')}") for d in listed[:2]}
    check_body(body["lower"], (0, 0), 4)
    check_body(body["upper"], (2, -DELTA), 3)
    return body


def test_vtu_files_hold_the_solution():
    check_vtu(1)


def test_vtu_files_hold_the_solution_on_three_ranks():
    check_vtu(3)


def test_the_xdmf_file_describes_the_same_bodies_as_the_vtu_files():
    body = check_vtu(2)
    with tempfile.TemporaryDirectory() as folder:
        run(None, SCENE, f"-output {folder}/fields.xdmf", ranks=2)
        assert sorted(os.listdir(folder)) == ["fields.h5", "fields.xdmf"]
        with open(f"{folder}/fields.h5", "rb") as f:
            assert f.read(8) == b"\x89HDF\r\n\x1a\n"
        cycles = xml.parse(f"{folder}/fields.xdmf").getroot().findall("Domain/Grid/Grid")
    assert [cycle.find("Time").get("Value") for cycle in cycles] == ["0"]
    grids = cycles[0].findall("Grid")
    assert [grid.get("Name") for grid in grids] == ["lower", "upper", "mid"]
    for grid in grids[:2]:
        name = grid.get("Name")
        size = {"vertices": len(body[name]["vertices"]), "cells": len(body[name]["cells"])}
        width = {"vertices": 2, "displacement": 3, "cells": len(body[name]["cells"][0])}
        items = [item for item in grid.iter("DataItem") if item.get("Format") == "HDF"]
        assert {a.get("Name") for a in grid.iter("Attribute")} >= {"displacement", "s11", "s22", "s33", "s12", "von_mises", "level"}
        for item in items:
            field = re.fullmatch(rf"fields\.h5:/cycle_0000/{name}/(\w+)", item.text).group(1)
            rows = size["vertices" if field in ("vertices", "displacement") else "cells"]
            shape = f"{rows} {width[field]}" if field in width else str(rows)
            assert item.get("Dimensions") == shape, (name, field, item.get("Dimensions"), shape)


def test_every_cycle_of_an_adaptive_run_is_in_the_fields_and_in_the_csv():
    with tempfile.TemporaryDirectory() as folder:
        files = f"-output {folder}/fields.xdmf -record_csv {folder}/cycles.csv"
        record = run(LAYERS, "-upper_mesh_cells 16,4 -estimator_type zz -adaptor_max_level 2", files, expect=3)
        assert sorted(os.listdir(folder)) == ["cycles.csv", "fields.h5", "fields.xdmf"]
        rows = read_csv(f"{folder}/cycles.csv")
        cycles = xml.parse(f"{folder}/fields.xdmf").getroot().findall("Domain/Grid/Grid")
    assert len(rows) == len(cycles) == record["cycles"] == 3
    cells = [int(cycle.find("Grid[@Name='lower']/Topology").get("NumberOfElements")) for cycle in cycles]
    assert cells == [row["body.lower.cells"] for row in rows] and cells[0] < cells[1] < cells[2]
    assert rows[-1]["body.lower.level_max"] == record["body.lower.level_max"] == 2


def test_a_file_that_cannot_be_written_is_refused_in_one_line():
    assert "FILE.xdmf or FILE.vtu" in run_error(None, SCENE, "-output fields.vtk")
    assert "there is no folder" in run_error(None, SCENE, "-output nowhere/fields.vtu")
    assert "FILE.csv" in run_error(None, SCENE, "-output_profile profile.txt")
