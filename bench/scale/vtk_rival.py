# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Reads a VTU or PVTU with VTK, contours it the fastest way for its cells and writes a VTP; prints seconds and triangles."""
import sys
import tempfile
import time

import vtk

LINEAR = {vtk.VTK_TETRA, vtk.VTK_VOXEL, vtk.VTK_HEXAHEDRON, vtk.VTK_WEDGE, vtk.VTK_PYRAMID}


def reader_of(path, field):
    reader = vtk.vtkXMLPUnstructuredGridReader() if path.endswith(".pvtu") else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.GetPointDataArraySelection().DisableAllArrays()
    reader.GetPointDataArraySelection().EnableArray(field)
    return reader


def contour_of(grid, field, isovalues):
    types = vtk.vtkCellTypes()
    grid.GetCellTypes(types)
    linear = all(types.GetCellType(i) in LINEAR for i in range(types.GetNumberOfTypes()))
    contour = vtk.vtkContour3DLinearGrid() if linear else vtk.vtkContourFilter()
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, field)
    for i, isovalue in enumerate(isovalues):
        contour.SetValue(i, isovalue)
    return contour


def write(surface, path):
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(surface)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.Write()


def main(path, field, isovalues, threads):
    vtk.vtkSMPTools.Initialize(int(threads))
    begin = time.perf_counter()
    reader = reader_of(path, field)
    reader.Update()
    read = time.perf_counter()
    contour = contour_of(reader.GetOutput(), field, [float(value) for value in isovalues.split(",")])
    contour.Update()
    contoured = time.perf_counter()
    with tempfile.NamedTemporaryFile(suffix=".vtp") as out:
        write(contour.GetOutput(), out.name)
        print(read - begin, contoured - read, time.perf_counter() - contoured, contour.GetOutput().GetNumberOfCells())


main(*sys.argv[1:])
