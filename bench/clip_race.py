# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Cells between isovalues against vtkTableBasedClipDataSet, at a moving isovalue, in one run.

    python bench/clip_race.py kuhn 94      # shape and side of isotet.make; needs isotet, numpy and vtk
"""

import statistics
import sys

import isotet
import vtk
from solid_race import ROUNDS, seconds_of, vtk_grid


def clipped(data, field, value):
    clip = vtk.vtkTableBasedClipDataSet()
    clip.SetInputData(data)
    clip.SetValue(value)
    clip.SetInputArrayToProcess(0, 0, 0, 0, field)
    clip.Update()
    return clip.GetOutput()


def main():
    shape, side, field = sys.argv[1], int(sys.argv[2]), "gyroid"
    grid = isotet.make(shape, side, [field])
    data = vtk_grid(grid, field)
    setup, clipper = seconds_of(lambda: isotet.Clipper(grid, field, method="clusters"))
    once, _ = seconds_of(lambda: isotet.Clipper(grid, field).clip(above=0.05))
    clipper.clip(above=0.05)  # packs
    mine, theirs = [], []
    for k in range(ROUNDS):
        value = 0.1 + 0.01 * k
        seconds, part = seconds_of(lambda: clipper.clip(above=value))
        mine.append(seconds)
        theirs.append(seconds_of(lambda: clipped(data, field, value))[0])
    for name, times in (("isotet", mine), ("VTK " + vtk.VTK_VERSION, theirs)):
        print(f"{name}: {1e3 * statistics.median(times):.1f} ms ({1e3 * min(times):.1f} to {1e3 * max(times):.1f})")
    print(f"{len(grid)} cells, {len(part.types)} of the last clip, {part.info['polyhedra']} of them polyhedra; session "
          f"{setup:.2f} s, the first clip with it {once:.2f} s; "
          f"{statistics.median(theirs) / statistics.median(mine):.1f} times")  # fmt: skip


main()
