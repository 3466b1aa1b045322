# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""VTK's side of the race from file to surface: converts a grid, or reads one and contours it, and prints seconds."""
import argparse
import array
import time
import warnings

import vtk

import hdf5

KINDS = {vtk.VTK_FLOAT: "float32", vtk.VTK_DOUBLE: "float64", vtk.VTK_UNSIGNED_CHAR: "uint8", vtk.VTK_LONG_LONG: "int64",
         vtk.VTK_LONG: "int64", vtk.VTK_ID_TYPE: "int64"}


def reader_of(path):
    if path.endswith(".vtk"):
        reader = vtk.vtkUnstructuredGridReader()
    elif path.endswith(".hdf"):
        reader = vtk.vtkHDFReader()
    else:
        reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    return reader


def write_vtkhdf(grid, path):
    cells = grid.GetCells()
    cells.ConvertTo64BitStorage()
    connectivity = cells.GetConnectivityArray()
    with hdf5.File(path) as file:
        def put(name, values):
            components = values.GetNumberOfComponents()
            shape = (values.GetNumberOfTuples(),) + ((components,) if components > 1 else ())
            file.data(name, KINDS[values.GetDataType()], shape, values)

        for name in ("/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"):
            file.group(name)
        file.attribute("/VTKHDF", "Version", [1, 0])
        file.attribute("/VTKHDF", "Type", "UnstructuredGrid")
        for name, count in (("Points", grid.GetNumberOfPoints()), ("Cells", grid.GetNumberOfCells()),
                            ("ConnectivityIds", connectivity.GetNumberOfTuples())):
            file.data(f"/VTKHDF/NumberOf{name}", "int64", (1,), array.array("q", [count]))
        put("/VTKHDF/Points", grid.GetPoints().GetData())
        put("/VTKHDF/Connectivity", connectivity)
        put("/VTKHDF/Offsets", cells.GetOffsetsArray())
        put("/VTKHDF/Types", grid.GetCellTypesArray())
        arrays = grid.GetPointData()
        for i in range(arrays.GetNumberOfArrays()):
            put(f"/VTKHDF/PointData/{arrays.GetArrayName(i)}", arrays.GetArray(i))


def convert(grid, path, kind):
    if kind == "vtkhdf":
        return write_vtkhdf(grid, path)
    if kind == "legacy":
        writer = vtk.vtkUnstructuredGridWriter()
        writer.SetFileTypeToBinary()
    else:
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetDataModeToAppended()
        writer.SetEncodeAppendedData(kind == "base64 zlib")
        {"raw": writer.SetCompressorTypeToNone, "lz4": writer.SetCompressorTypeToLZ4}.get(
            kind, writer.SetCompressorTypeToZLib)()
    writer.SetInputData(grid)
    writer.SetFileName(path)
    writer.Write()


def contour_all(grid, options, with_tree):
    """Seconds for one surface after another, and all their triangles."""
    contour = vtk.vtkContour3DLinearGrid()
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, options.field)
    with warnings.catch_warnings():  # newer ones always merge, and say so
        warnings.simplefilter("ignore", DeprecationWarning)
        contour.SetMergePoints(True)
    contour.SetInterpolateAttributes(False)
    if with_tree:
        contour.SetUseScalarTree(True)
        contour.SetScalarTree(vtk.vtkSpanSpace())
    triangles = 0
    begin = time.perf_counter()
    for isovalue in options.isovalues:
        contour.SetValue(0, isovalue)
        contour.Update()
        triangles += contour.GetOutput().GetNumberOfCells()
    return time.perf_counter() - begin, triangles


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--convert", nargs=2, action="append", metavar=("KIND", "PATH"), default=[])
    parser.add_argument("--field")
    parser.add_argument("--isovalues", type=lambda text: [float(part) for part in text.split(",")])
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    vtk.vtkSMPTools.Initialize(options.threads)
    reader = reader_of(options.file)
    begin = time.perf_counter()
    reader.Update()
    read = time.perf_counter() - begin
    for kind, path in options.convert:
        convert(reader.GetOutput(), path, kind)
    if options.field:
        ways = [contour_all(reader.GetOutput(), options, with_tree=False)]
        if len(options.isovalues) > 1:  # a span space may be worth its price: the faster way counts
            ways.append(contour_all(reader.GetOutput(), options, with_tree=True))
        print(read, *min(ways))


main()
