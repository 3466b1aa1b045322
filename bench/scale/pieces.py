# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A grid of `isotet make` as a PVTU of N x N x N boxes of cells, as parallel solvers write it, with global point numbers
unless told otherwise.

    python bench/scale/pieces.py GRID.vtu OUT.pvtu N FIELD [no-ids]
"""
import pathlib
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def write_piece(grid, path):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.Write()


def part_of(grid, cells, field, ids):
    """The cells of a grid of one kind, with the points that they use, in their order."""
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)[cells]
    used, local = np.unique(corners, return_inverse=True)
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(grid.GetPoints().GetData())[used], deep=True))
    connectivity = vtk.vtkCellArray()
    connectivity.SetData(numpy_to_vtk(np.arange(0, local.size + 1, corners.shape[1], dtype=np.int64), deep=True),
                         numpy_to_vtk(local.ravel().astype(np.int64), deep=True))  # fmt: skip
    part = vtk.vtkUnstructuredGrid()
    part.SetPoints(points)
    part.SetCells(grid.GetCellType(0), connectivity)
    arrays = [(field, vtk_to_numpy(grid.GetPointData().GetArray(field))[used])] + [("GlobalNodeId", used)] * ids
    for name, values in arrays:
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        part.GetPointData().AddArray(array)
    if ids:
        part.GetPointData().SetActiveGlobalIds("GlobalNodeId")
    return part


def index_of(names, grid, field, ids=True):
    """What a PVTU says of its pieces."""
    kinds = {vtk.VTK_FLOAT: "Float32", vtk.VTK_DOUBLE: "Float64"}
    point = kinds[grid.GetPoints().GetDataType()]
    values = kinds[grid.GetPointData().GetArray(field).GetDataType()]
    sources = "\n".join(f'<Piece Source="{name}"/>' for name in names)
    announced = '<PDataArray type="Int64" Name="GlobalNodeId"/>' if ids else ""
    return f"""<?xml version="1.0"?>
<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PUnstructuredGrid GhostLevel="0">
<PPointData><PDataArray type="{values}" Name="{field}"/>{announced}</PPointData>
<PPoints><PDataArray type="{point}" Name="Points" NumberOfComponents="3"/></PPoints>
{sources}
</PUnstructuredGrid>
</VTKFile>
"""


def cut(path, out, boxes, field, ids=True):
    """Writes OUT and a piece for each of `boxes`^3 boxes, beside it."""
    grid = read(path)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)
    middles = points[corners].mean(axis=1)
    place = np.clip(((middles + 1) / 2 * boxes).astype(int), 0, boxes - 1)
    box = (place[:, 0] * boxes + place[:, 1]) * boxes + place[:, 2]
    order = np.argsort(box, kind="stable")
    ends = np.searchsorted(box[order], np.arange(boxes**3 + 1))
    out = pathlib.Path(out)
    names = [f"{out.stem}_{number}.vtu" for number in range(boxes**3)]
    for number, name in enumerate(names):
        write_piece(part_of(grid, order[ends[number] : ends[number + 1]], field, ids), out.parent / name)
    out.write_text(index_of(names, grid, field, ids))


if __name__ == "__main__":
    cut(sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4], sys.argv[5:] != ["no-ids"])
