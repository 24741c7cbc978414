"""What VTK reads of a series of fields: `python3 vtk_series.py FILE.pvd|FILE.xdmf [READER]`, for a Python that has VTK, prints it as JSON, for each time

    [time, {grid: {"points": [...], "cells": [[...], ...], "type": [...], "point": {name: rows}, "cell": {name: rows}, "field": {name: rows}}}]

READER is vtkXdmfReader or vtkXdmf3Reader, ParaView's readers of XDMF 2 and 3: the first is in VTK from PyPI, both in Debian's python3-paraview, none in python3-vtk9.
Exit status 77: this Python has no such reader.
"""
import json, os, sys, xml.etree.ElementTree as xml


def rows(array):
    return [list(array.GetTuple(i)) for i in range(array.GetNumberOfTuples())]


def arrays(data):
    return {data.GetArrayName(i): rows(data.GetArray(i)) for i in range(data.GetNumberOfArrays()) if data.GetArray(i)}


def corners(cell):
    return [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]


def grid(g):
    return {
        "points": [list(g.GetPoint(i)) for i in range(g.GetNumberOfPoints())],
        "cells": [corners(g.GetCell(i)) for i in range(g.GetNumberOfCells())],
        "type": [g.GetCellType(i) for i in range(g.GetNumberOfCells())],
        "point": arrays(g.GetPointData()),
        "cell": arrays(g.GetCellData()),
        "field": arrays(g.GetFieldData()),
    }


def read_pvd(path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    times = {}
    for entry in xml.parse(path).getroot().findall("Collection/DataSet"):
        reader = (vtkXMLPolyDataReader if entry.get("file").endswith(".vtp") else vtkXMLUnstructuredGridReader)()
        reader.SetFileName(os.path.join(os.path.dirname(path), entry.get("file")))
        reader.Update()
        assert reader.GetErrorCode() == 0, entry.get("file")
        times.setdefault(float(entry.get("timestep")), {})[entry.get("name")] = grid(reader.GetOutput())
    return list(times.items())


def read_xdmf(path, kind):
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline

    module = __import__("vtkmodules." + {"vtkXdmfReader": "vtkIOXdmf2", "vtkXdmf3Reader": "vtkIOXdmf3"}[kind], fromlist=[kind])
    reader = getattr(module, kind)()
    reader.SetFileName(path)
    reader.UpdateInformation()
    info, key, series = reader.GetOutputInformation(0), pipeline.TIME_STEPS(), []
    for time in [info.Get(key, i) for i in range(info.Length(key))]:
        reader.UpdateTimeStep(time)
        blocks, grids = reader.GetOutputDataObject(0), {}
        for i in range(blocks.GetNumberOfBlocks()):
            name = blocks.GetMetaData(i).Get(blocks.NAME())
            grids[name.split("[")[0]] = grid(blocks.GetBlock(i))  # a name that comes again gets a number
        series.append((time, grids))
    return series


if __name__ == "__main__":
    try:
        found = read_pvd(sys.argv[1]) if sys.argv[1].endswith(".pvd") else read_xdmf(sys.argv[1], sys.argv[2])
    except ImportError as missing:
        print(missing)
        sys.exit(77)
    print(json.dumps(found))
