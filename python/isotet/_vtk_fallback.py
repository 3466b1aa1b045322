# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What isotet does not contour, contoured by VTK."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

from ._vtk_data import Scalars, other_cells, some_cells


class Wishes(NamedTuple):
    """What a surface is asked to have, as the properties of vtkContourFilter."""

    isovalues: list[float]
    compute_normals: int = -1
    compute_scalars: bool = True
    generate_triangles: bool = True
    output_points_precision: int = 2
    array_component: int = 0
    cell_isovalues: bool = False  # of several, as the cell array "isovalue"


def contour_by_vtk(data, scalars: Scalars, of_cells: bool, wishes: Wishes) -> vtkPolyData:
    """The surface, lines or points of any vtkDataSet. Cell arrays are averaged to points by VTK."""
    data, name = _with_array(data, scalars, of_cells)
    if not wishes.cell_isovalues or len(wishes.isovalues) < 2:
        return _contoured(data, name, wishes)
    out = vtkPolyData()
    for isovalue in wishes.isovalues:
        surface = _contoured(data, name, wishes._replace(isovalues=[isovalue]))
        array = numpy_to_vtk(np.full(surface.GetNumberOfCells(), isovalue), deep=True)
        array.SetName("isovalue")
        surface.GetCellData().AddArray(array)
        append(surface, out)
    return out


def _contoured(data, name: str, wishes: Wishes) -> vtkPolyData:
    from vtkmodules.vtkFiltersCore import vtkContourFilter  # these modules take longer to import than all of isotet

    contour = vtkContourFilter()
    contour.SetInputData(data)
    contour.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, name)
    contour.SetNumberOfContours(len(wishes.isovalues))
    for i, isovalue in enumerate(wishes.isovalues):
        contour.SetValue(i, isovalue)
    contour.SetComputeNormals(wishes.compute_normals)
    contour.SetComputeScalars(wishes.compute_scalars)
    contour.SetGenerateTriangles(wishes.generate_triangles)
    contour.SetOutputPointsPrecision(wishes.output_points_precision)
    contour.SetArrayComponent(wishes.array_component)
    contour.Update()
    return contour.GetOutput()


def _with_array(data, scalars: Scalars, of_cells: bool):
    """The data set with what is contoured as a point array, and the name of that."""
    if of_cells:
        from vtkmodules.vtkFiltersCore import vtkCellDataToPointData

        average = vtkCellDataToPointData()
        average.SetInputData(data)
        average.SetPassCellData(True)
        average.Update()
        return average.GetOutput(), scalars.array.GetName()
    own = scalars.array.GetName()
    if own and (scalars.name in ("", own) or data.IsA("vtkImageData")):
        return data, own
    name = scalars.name or "scalars"
    more = data.NewInstance()
    more.ShallowCopy(data)
    array = numpy_to_vtk(scalars.values, deep=True)
    array.SetName(name)
    more.GetPointData().AddArray(array)
    return more, name


def append_other_cells(grid, scalars: Scalars, of_cells: bool, wishes: Wishes, out) -> int:
    """Adds to `out` what VTK makes of the cells of a vtkUnstructuredGrid that isotet does not contour. How many cells these
    are."""
    others = other_cells(grid)
    if len(others):
        append(contour_by_vtk(some_cells(grid, others), scalars, of_cells, wishes), out)
    return len(others)


def append(more, out) -> None:
    """Adds a vtkPolyData to `out`, with the arrays that both have, and normals of 0 where the other has none."""
    if more.GetNumberOfCells() == 0:
        return
    if out.GetNumberOfCells() == 0:
        out.ShallowCopy(more)
        return
    mine, its = out.GetPointData(), more.GetPointData()
    if (normals := mine.GetNormals()) is not None and its.GetNormals() is None:
        none = numpy_to_vtk(np.zeros((more.GetNumberOfPoints(), 3), np.float32), deep=True)
        none.SetName(normals.GetName())
        its.SetNormals(none)
    from vtkmodules.vtkFiltersCore import vtkAppendPolyData

    both = vtkAppendPolyData()
    both.AddInputData(out)
    both.AddInputData(more)
    both.Update()
    out.ShallowCopy(both.GetOutput())


REASON = "isotet contours three-dimensional cells of degree 1 to 10 and polyhedra with faces"
