# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Solids, clipped cells and planes against VTK's filters, each at a place that moves, alternately in one run.

    python bench/solids_race.py             # 5 million tetrahedra, then 3.4 million hexahedra; needs isotet, numpy and vtk
    python bench/solids_race.py hex 40 --rounds 3
"""

import argparse
import os
import statistics
import time

import isotet
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

FIELD = "gyroid"


def vtk_grid(grid):
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
    values = numpy_to_vtk(np.asarray(grid.fields[FIELD]), deep=True)
    values.SetName(FIELD)
    out.GetPointData().SetScalars(values)
    return out


def clip_of(value, inside_out):
    clip = vtk.vtkTableBasedClipDataSet()
    clip.SetValue(value)
    clip.SetInsideOut(inside_out)
    clip.SetInputArrayToProcess(0, 0, 0, 0, FIELD)
    return clip


def vtk_solid(data, lower, upper):
    above, below, surface = clip_of(lower, 0), clip_of(upper, 1), vtk.vtkDataSetSurfaceFilter()
    above.SetInputData(data)
    below.SetInputConnection(above.GetOutputPort())
    surface.SetInputConnection(below.GetOutputPort())
    surface.Update()
    return surface.GetOutput()


def vtk_clip(data, value):
    clip = clip_of(value, 0)
    clip.SetInputData(data)
    clip.Update()
    return clip.GetOutput()


def vtk_plane(data, offset):
    plane, cutter = vtk.vtkPlane(), vtk.vtk3DLinearGridPlaneCutter()
    plane.SetNormal(0.3, 0.2, 1)
    plane.SetOrigin(0, 0, offset)
    cutter.SetInputData(data)
    cutter.SetPlane(plane)
    cutter.SetInterpolateAttributes(False)
    cutter.SetComputeNormals(False)
    cutter.Update()
    return cutter.GetOutput()


def seconds_of(work):
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def race(name, rounds, ours, theirs):
    """One contestant after the other at each place; the first place warms both up."""
    times = []
    for k in range(rounds + 1):
        mine, result = seconds_of(lambda: ours(k))
        times.append((mine, seconds_of(lambda: theirs(k))[0]))
    mine, other = zip(*times[1:])
    text = [f"{1e3 * statistics.median(all):,.1f} ms ({1e3 * min(all):,.1f} to {1e3 * max(all):,.1f})" for all in (mine, other)]
    print(f"| {name} | {text[0]} | {text[1]} | {statistics.median(other) / statistics.median(mine):.1f} |", flush=True)
    return result


def race_grid(shape, side, rounds):
    grid = isotet.make(shape, side, [FIELD])
    data = vtk_grid(grid)
    kind = {"kuhn": "tetrahedra", "hex": "hexahedra"}.get(shape, "cells")
    name = f"{len(grid):,} {kind}"
    solids = isotet.Solids(grid, FIELD, fields=[], method="clusters")
    solid = race(f"{name}: solid between two isovalues", rounds, lambda k: solids.solid(above=0.1 + 0.01 * k, below=0.6),
                 lambda k: vtk_solid(data, 0.1 + 0.01 * k, 0.6))  # fmt: skip
    assert solid.solid["open_edges"] == 0
    del solids
    clipper = isotet.Clipper(grid, FIELD, method="clusters")
    race(f"{name}: cells above an isovalue", rounds, lambda k: clipper.clip(above=0.1 + 0.02 * k),
         lambda k: vtk_clip(data, 0.1 + 0.02 * k))  # fmt: skip
    del clipper
    normal = np.array((0.3, 0.2, 1))
    packed = isotet.pack(grid.points, grid.cells, np.asarray(grid.points, np.float64) @ normal)
    race(f"{name}: a plane, packed before", rounds, lambda k: packed.contour(0.03 * k), lambda k: vtk_plane(data, 0.03 * k))
    del packed
    race(f"{name}: a plane, from arrays", rounds, lambda k: grid.slice(normal, offsets=0.03 * k, fields=[], cell_fields=[]),
         lambda k: vtk_plane(data, 0.03 * k))  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shape", nargs="?", help="kuhn or hex, as isotet.make takes it")
    parser.add_argument("side", nargs="?", type=int)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    vtk.vtkSMPTools.Initialize(os.cpu_count())
    print(f"isotet {isotet.__version__}, VTK {vtk.VTK_VERSION}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} before; "
          f"medians of {options.rounds} (least to most)\n")  # fmt: skip
    print("| | isotet | VTK | times |\n|---|---:|---:|---:|")
    for shape, side in [(options.shape, options.side)] if options.shape else [("kuhn", 94), ("hex", 150)]:
        race_grid(shape, side, options.rounds)
    print(f"\nload {os.getloadavg()[0]:.1f} after")


if __name__ == "__main__":
    main()
