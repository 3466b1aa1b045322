# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Solids against VTK's two clips and their surface, at a moving range of values, in one run.

    python bench/solid_race.py kuhn 94      # shape and side of isotet.make; needs isotet, numpy and vtk
"""

import statistics
import sys
import time

import isotet
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

ROUNDS = 5


def vtk_grid(grid, field):
    cells = np.asarray(grid.cells)
    corners = cells.shape[1]
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.asarray(grid.points), deep=True))
    array = vtk.vtkCellArray()
    array.SetData(numpy_to_vtk(np.arange(0, cells.size + 1, corners, dtype=np.int64), deep=True),
                  numpy_to_vtk(cells.astype(np.int64).ravel(), deep=True))  # fmt: skip
    out = vtk.vtkUnstructuredGrid()
    out.SetPoints(points)
    out.SetCells({4: vtk.VTK_TETRA, 8: vtk.VTK_HEXAHEDRON}[corners], array)
    values = numpy_to_vtk(np.asarray(grid.fields[field]), deep=True)
    values.SetName(field)
    out.GetPointData().SetScalars(values)
    return out


def clipped(data, field, lower, upper):
    above, below, surface = vtk.vtkTableBasedClipDataSet(), vtk.vtkTableBasedClipDataSet(), vtk.vtkDataSetSurfaceFilter()
    above.SetInputData(data)
    below.SetInputConnection(above.GetOutputPort())
    surface.SetInputConnection(below.GetOutputPort())
    for clip, value, inside in ((above, lower, 0), (below, upper, 1)):
        clip.SetValue(value)
        clip.SetInsideOut(inside)
        clip.SetInputArrayToProcess(0, 0, 0, 0, field)
    surface.Update()
    return surface.GetOutput()


def seconds_of(work):
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def main():
    shape, side, field = sys.argv[1], int(sys.argv[2]), "gyroid"
    grid = isotet.make(shape, side, [field])
    data = vtk_grid(grid, field)
    setup, solids = seconds_of(lambda: isotet.Solids(grid, field, fields=[], method="clusters"))
    solids.solid(above=0.05)  # packs
    mine, theirs = [], []
    for k in range(ROUNDS):
        lower, upper = 0.1 + 0.01 * k, 0.6
        seconds, solid = seconds_of(lambda: solids.solid(above=lower, below=upper))
        mine.append(seconds)
        theirs.append(seconds_of(lambda: clipped(data, field, lower, upper))[0])
        assert solid.solid["open_edges"] == 0
    for name, times in (("isotet", mine), ("VTK " + vtk.VTK_VERSION, theirs)):
        print(f"{name}: {1e3 * statistics.median(times):.1f} ms ({1e3 * min(times):.1f} to {1e3 * max(times):.1f})")
    print(f"{len(grid)} cells; boundary and session {setup:.2f} s; {statistics.median(theirs) / statistics.median(mine):.1f} times")


if __name__ == "__main__":
    main()
