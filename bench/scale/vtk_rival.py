# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Reads a grid with VTK, contours it the fastest way for its cells and writes a VTP. Prints wall and processor seconds of that, and
the peak of memory in bytes, all without what importing VTK takes but the memory.

    python bench/scale/vtk_rival.py GRID FIELD ISOVALUES THREADS
"""
import pathlib
import resource
import sys
import tempfile
import time

import vtk

LINEAR = {vtk.VTK_TETRA, vtk.VTK_VOXEL, vtk.VTK_HEXAHEDRON, vtk.VTK_WEDGE, vtk.VTK_PYRAMID}


def reader_of(path, field):
    if path.endswith(".foam"):
        parts = any(pathlib.Path(path).parent.glob("processor*"))
        reader = vtk.vtkPOpenFOAMReader() if parts else vtk.vtkOpenFOAMReader()
        if parts:
            reader.SetCaseType(reader.DECOMPOSED_CASE)
        reader.SetFileName(path)
        reader.SkipZeroTimeOff()
        reader.UpdateInformation()
        reader.DisableAllCellArrays()
        reader.SetCellArrayStatus(field, 1)
        reader.CreateCellToPointOn()
        return reader
    kinds = {".pvtu": vtk.vtkXMLPUnstructuredGridReader, ".vtu": vtk.vtkXMLUnstructuredGridReader,
             ".vtk": vtk.vtkUnstructuredGridReader, ".vtkhdf": vtk.vtkHDFReader}  # fmt: skip
    reader = kinds[pathlib.Path(path).suffix]()
    reader.SetFileName(path)
    if path.endswith(".vtk"):
        reader.SetScalarsName(field)
        return reader
    reader.UpdateInformation()
    reader.GetPointDataArraySelection().DisableAllArrays()
    reader.GetPointDataArraySelection().EnableArray(field)
    return reader


def grid_of(data):
    """The unstructured grid of a reader's output; where that is a tree, of its leaves together."""
    if data.IsA("vtkUnstructuredGrid"):
        return data
    leaves = []
    walk = data.NewIterator()
    while not walk.IsDoneWithTraversal():
        if walk.GetCurrentDataObject().IsA("vtkUnstructuredGrid"):
            leaves.append(walk.GetCurrentDataObject())
        walk.GoToNextItem()
    if len(leaves) == 1:
        return leaves[0]
    append = vtk.vtkAppendFilter()
    for leaf in leaves:
        append.AddInputData(leaf)
    append.Update()
    return append.GetOutput()


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


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def main(path, field, isovalues, threads):
    vtk.vtkSMPTools.Initialize(int(threads))
    begin, cpu = time.perf_counter(), cpu_seconds()
    reader = reader_of(path, field)
    reader.Update()
    contour = contour_of(grid_of(reader.GetOutputDataObject(0)), field, [float(value) for value in isovalues.split(",")])
    contour.Update()
    with tempfile.NamedTemporaryFile(suffix=".vtp") as out:
        write(contour.GetOutput(), out.name)
        if contour.GetOutput().GetNumberOfCells() == 0:
            sys.exit("VTK found no triangle")
    print(time.perf_counter() - begin, cpu_seconds() - cpu, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)


if __name__ == "__main__":
    main(*sys.argv[1:])
