#!/usr/bin/env python3
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Races grid.isotet.contour against PyVista's contour on one grid, in rounds that alternate: medians and best times.

Usage: pyvista_race.py [SIDE [ROUNDS]]   (94 and 7: 4,983,504 tetrahedra). Needs what tests/python needs.
"""

import statistics
import sys
import time

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkSMPTools, vtkVersion

import isotet
from isotet.vtk import IsotetContour

side, rounds = (int(sys.argv[1]) if len(sys.argv) > 1 else 94), (int(sys.argv[2]) if len(sys.argv) > 2 else 7)
made = isotet.make("kuhn", side, ["gyroid"])
points, cells, values = np.array(made.points), np.array(made.cells, np.int64), np.array(made.fields["gyroid"])
grid = pv.UnstructuredGrid({pv.CellType.TETRA: cells}, points)
grid["gyroid"] = values
packed_grid = grid.copy()
start = time.perf_counter()
packed_grid.isotet.pack("gyroid")
packing = time.perf_counter() - start
packed = isotet.pack(points, cells, values)
contour = IsotetContour(compute_normals=False)
contour.SetInputDataObject(grid)
contour.SetInputArrayToProcess(0, 0, 0, 0, "gyroid")
contour.SetExpectedSurfaces(1000)
contour.Update()
default = vtkSMPTools.GetBackend(), vtkSMPTools.GetEstimatedNumberOfThreads()


def vtk_with(threads: int, isovalue: float):
    vtkSMPTools.SetBackend("Sequential" if threads == 1 else "STDThread")
    vtkSMPTools.Initialize(threads)
    return grid.contour([isovalue], "gyroid")


def from_grid(isovalue: float):
    grid.isotet.clear()
    return grid.isotet.contour([isovalue], "gyroid")


def pipeline(isovalue: float):
    contour.SetValue(0, isovalue)
    contour.Update()
    return pv.wrap(contour.GetOutputDataObject(0))


WAYS = {
    "PyVista's contour, VTK with 1 thread": lambda v: vtk_with(1, v),
    "PyVista's contour, VTK with 2 threads": lambda v: vtk_with(2, v),
    "grid.isotet.contour, first call": from_grid,
    "isotet.contour from NumPy arrays": lambda v: isotet.contour(points, cells, values, v),
    "grid.isotet.contour, packed": lambda v: packed_grid.isotet.contour([v], "gyroid"),
    "IsotetContour in a pipeline, moving": pipeline,
    "packed.contour, NumPy": packed.contour,
}
taken: dict[str, list[float]] = {name: [] for name in WAYS}
for turn in range(rounds + 1):
    isovalue = 0.1 + 0.01 * turn
    for name, way in WAYS.items():
        start = time.perf_counter()
        surface = way(isovalue)
        if turn:  # the first warms up
            taken[name].append(1e3 * (time.perf_counter() - start))

count = len(surface.triangles)
print(f"{len(cells):,} tetrahedra, about {count:,} triangles, packing {packing:.2f} s; {rounds} rounds; Python "
      f"{sys.version.split()[0]}, PyVista {pv.__version__}, VTK {vtkVersion.GetVTKVersion()} (as it comes: {default[0]}, {default[1]})")
threaded = [statistics.median(taken["PyVista's contour, VTK with 2 threads"]), min(taken["PyVista's contour, VTK with 2 threads"])]
for name, times in taken.items():
    middle, best = statistics.median(times), min(times)
    print(f"{name:42} median {middle:8.1f} ms ({threaded[0] / middle:5.1f}x)   best {best:8.1f} ms ({threaded[1] / best:5.1f}x)")
