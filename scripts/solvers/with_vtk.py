# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What VTK's readers have of a file: one unstructured grid a time step."""
import pathlib
import xml.etree.ElementTree

import vtk
from vtk.util.numpy_support import vtk_to_numpy

READERS = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".pvtu": vtk.vtkXMLPUnstructuredGridReader,
           ".vts": vtk.vtkXMLStructuredGridReader, ".vti": vtk.vtkXMLImageDataReader,
           ".vtm": vtk.vtkXMLMultiBlockDataReader, ".vtk": vtk.vtkDataSetReader, ".hdf": vtk.vtkHDFReader,
           ".vtkhdf": vtk.vtkHDFReader, ".cgns": vtk.vtkCGNSReader, ".case": vtk.vtkGenericEnSightReader,
           ".e": vtk.vtkExodusIIReader, ".exo": vtk.vtkExodusIIReader, ".avs": vtk.vtkAVSucdReader,
           ".inp": vtk.vtkAVSucdReader, ".foam": vtk.vtkOpenFOAMReader}


def can_read(path):
    if path.suffix == ".foam" and list(path.parent.glob("processor*")):
        return False  # as many cases as processors to it, with open seams
    return path.suffix in READERS or path.suffix in (".pvd", ".series")


class Steps:
    """The times of a file, none where it has none, and its grid at each."""

    def __init__(self, path):
        self.path = path
        if path.suffix in (".pvd", ".series"):
            self.files = files_of_times(path)
            self.times = list(self.files)
            return
        self.files = None
        self.reader = READERS[path.suffix]()
        name = "SetCaseFileName" if path.suffix == ".case" else "SetFileName"
        getattr(self.reader, name)(str(path))
        read_everything(self.reader)
        self.reader.UpdateInformation()
        steps = self.reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        self.times = list(steps or [])

    def grid(self, step):
        if self.files:
            grids = [Steps(path).grid(0) for path in self.files[self.times[step]]]
            return grids[0] if len(grids) == 1 else appended(grids)
        if self.times:
            self.reader.UpdateTimeStep(self.times[step])
        self.reader.Update()
        return one_grid(self.reader.GetOutputDataObject(0))


def files_of_times(path):
    if path.suffix == ".series":
        import json
        return {entry["time"]: [path.parent / entry["name"]] for entry in json.loads(path.read_text())["files"]}
    times = {}
    for entry in xml.etree.ElementTree.parse(path).iter("DataSet"):
        times.setdefault(float(entry.get("timestep", 0)), []).append(path.parent / entry.get("file"))
    return times


def read_everything(reader):
    for call in ("ReadAllScalarsOn", "ReadAllVectorsOn", "ReadAllTensorsOn", "ReadAllFieldsOn", "ReadAllNormalsOn",
                 "EnableAllBases", "EnableAllPointArrays", "EnableAllCellArrays"):
        if hasattr(reader, call):
            getattr(reader, call)()
    if isinstance(reader, vtk.vtkOpenFOAMReader):
        reader.SetSkipZeroTime(False)
    if isinstance(reader, vtk.vtkExodusIIReader):
        reader.UpdateInformation()
        for kind in (vtk.vtkExodusIIReader.NODAL, vtk.vtkExodusIIReader.ELEM_BLOCK):
            reader.SetAllArrayStatus(kind, 1)


def leaves(data):
    if data is None:
        return []
    if isinstance(data, vtk.vtkDataSet):
        return [data]
    if isinstance(data, vtk.vtkPartitionedDataSet):
        return [leaf for i in range(data.GetNumberOfPartitions()) for leaf in leaves(data.GetPartitionAsDataObject(i))]
    if isinstance(data, vtk.vtkPartitionedDataSetCollection):
        return [leaf for i in range(data.GetNumberOfPartitionedDataSets())
                for leaf in leaves(data.GetPartitionedDataSet(i))]
    return [leaf for i in range(data.GetNumberOfBlocks()) for leaf in leaves(data.GetBlock(i))]


def appended(grids):
    append = vtk.vtkAppendFilter()
    for grid in grids:
        append.AddInputData(grid)
    append.Update()
    return append.GetOutput()


def one_grid(data):
    grids = [grid for grid in leaves(data) if grid.GetNumberOfCells() and not isinstance(grid, vtk.vtkPolyData)]
    return solid_cells(grids[0] if len(grids) == 1 else appended(grids))


def solid_cells(grid):
    """Without surfaces and lines, and without ghosts."""
    ghosts = grid.GetCellData().GetArray("vtkGhostType")
    kept = vtk.vtkIdList()
    for cell in range(grid.GetNumberOfCells()):
        is_ghost = ghosts is not None and int(ghosts.GetTuple1(cell)) & (1 | 32)
        if dimension(grid.GetCellType(cell)) == 3 and not is_ghost:
            kept.InsertNextId(cell)
    if kept.GetNumberOfIds() == grid.GetNumberOfCells() and isinstance(grid, vtk.vtkUnstructuredGrid):
        return grid
    extract = vtk.vtkExtractCells()
    extract.SetInputData(grid)
    extract.SetCellList(kept)
    extract.Update()
    return extract.GetOutput()


def dimension(cell_type, known={}):
    if cell_type not in known:
        cell = vtk.vtkGenericCell.InstantiateCell(cell_type)
        known[cell_type] = cell.GetCellDimension() if cell else 0
    return known[cell_type]


LINEAR = {(71, 4): 10, (72, 8): 12, (73, 6): 13, (74, 5): 14}


def counts_by_type(grid):
    """Lagrange cells of the corners alone are linear cells."""
    types = [(grid.GetCellType(cell), grid.GetCellSize(cell)) for cell in range(grid.GetNumberOfCells())]
    types = [LINEAR.get(of_cell, of_cell[0]) for of_cell in types]
    return {cell_type: types.count(cell_type) for cell_type in set(types)}


def fields(grid):
    """{(association, name): [range of each component]}"""
    found = {}
    for association, data in (("point", grid.GetPointData()), ("cell", grid.GetCellData())):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            if array is None or array.GetName() in (None, "vtkGhostType", "vtkOriginalPointIds", "vtkOriginalCellIds"):
                continue
            ranges = [array.GetFiniteRange(c) for c in range(array.GetNumberOfComponents())]
            found[association, array.GetName().strip()] = ranges
    return found


def area_of_isosurface(grid, field, isovalue):
    """Curved cells are split by VTK at their nodes only."""
    contour = vtk.vtkContourFilter()
    if field in "xyz":
        array = vtk.vtkDoubleArray()
        array.SetName("isotet:" + field)
        for point in range(grid.GetNumberOfPoints()):
            array.InsertNextValue(grid.GetPoint(point)["xyz".index(field)])
        grid.GetPointData().AddArray(array)
        field = array.GetName()
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, field)
    contour.SetValue(0, isovalue)
    contour.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(contour.GetOutputPort())
    triangles.Update()
    if triangles.GetOutput().GetNumberOfPolys() == 0:
        return 0.0
    mass = vtk.vtkMassProperties()
    mass.SetInputConnection(triangles.GetOutputPort())
    return mass.GetSurfaceArea()
