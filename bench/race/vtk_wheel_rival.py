# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The newest VTK wheel as a contestant of the race, with the commands of vtk_rival.cpp.

The wheel has no TBB: its threads are those of vtkSMPTools' own pool. Its vtkContour3DLinearGrid always merges points.
"""

import ctypes
import json
import sys
import time
from pathlib import Path

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints, vtkSMPTools, vtkTypeInt32Array, vtkTypeInt64Array, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkSpanSpace
from vtkmodules.vtkFiltersCore import vtkContour3DLinearGrid

CORNERS = {10: 4, 11: 8, 12: 8, 13: 6, 14: 5}  # of VTK's types of cells


def read_reals(folder: Path, name: str) -> numpy.ndarray:
    doubles = folder / f"{name}.f64"
    if doubles.exists():
        return numpy.fromfile(doubles, numpy.float64)
    return numpy.fromfile(folder / f"{name}.f32", numpy.float32)


def integers(values: numpy.ndarray):
    """A VTK array that borrows `values`; the caller keeps them."""
    array = vtkTypeInt32Array() if values.dtype == numpy.int32 else vtkTypeInt64Array()
    array.SetVoidArray(values, values.size, 1)
    return array


class Rival:
    def __init__(self):
        self.kept = []
        self.filters = {}

    def answer(self, words: list[str]) -> dict:
        command, *rest = words
        if command == "open":
            return self.open(Path(rest[0]), int(rest[1]), rest[2])
        if command == "tree":
            self.filters["span_space"] = self.new_filter(with_tree=True)
            return self.run("span_space", float(rest[0]))
        if command == "contour":
            return self.run(rest[0], float(rest[1]))
        raise ValueError(f"no such command: '{command}'")

    def open(self, folder: Path, threads: int, ids: str) -> dict:
        vtkSMPTools.SetBackend("STDThread")
        vtkSMPTools.Initialize(threads)
        integer = numpy.int32 if ids == "int32" else numpy.int64
        points, field = read_reals(folder, "points"), read_reals(folder, "field")
        corners = numpy.fromfile(folder / "corners.i32", numpy.int32).astype(integer, copy=False)
        types = numpy.fromfile(folder / "types.u8", numpy.uint8)
        if (folder / "offsets.i64").exists():
            offsets = numpy.fromfile(folder / "offsets.i64", numpy.int64).astype(integer, copy=False)
        else:
            size = CORNERS[types[0]]
            offsets = numpy.arange(corners.size // size + 1, dtype=integer) * integer(size)

        cells = vtkCellArray()
        cells.SetData(integers(offsets), integers(corners))
        grid_points = vtkPoints()
        grid_points.SetData(numpy_to_vtk(points.reshape(-1, 3)))
        scalars = numpy_to_vtk(field)
        scalars.SetName("field")
        self.grid = vtkUnstructuredGrid()
        self.grid.SetPoints(grid_points)
        self.grid.SetCells(int(types[0]) if types.size == 1 else numpy_to_vtk(types), cells)
        self.grid.GetPointData().SetScalars(scalars)
        self.kept = [points, field, corners, offsets, types]
        self.filters = {"merged": self.new_filter(with_tree=False)}
        self.must_read = corners.nbytes + types.nbytes + field.nbytes
        return {"version": vtkVersion.GetVTKVersion(), "backend": vtkSMPTools.GetBackend(),
                "threads": vtkSMPTools.GetEstimatedNumberOfThreads(), "cells": offsets.size - 1}

    def new_filter(self, with_tree: bool) -> vtkContour3DLinearGrid:
        made = vtkContour3DLinearGrid()
        made.SetInputData(self.grid)
        if hasattr(made, "MergePointsOn"):
            made.MergePointsOn()
        made.InterpolateAttributesOff()
        made.ComputeNormalsOff()
        if with_tree:
            made.UseScalarTreeOn()
            made.SetScalarTree(vtkSpanSpace())
        return made

    def run(self, method: str, isovalue: float) -> dict:
        contour = self.filters[method]
        last = contour.GetOutputDataObject(0)
        if last is not None:
            last.Initialize()
        contour.SetValue(0, isovalue)
        contour.Modified()
        start = time.perf_counter()
        contour.Update()
        seconds = time.perf_counter() - start
        surface = contour.GetOutputDataObject(0)
        reply = {"seconds": seconds, "vertices": surface.GetNumberOfPoints(), "triangles": surface.GetNumberOfPolys(),
                 "must_move": self.must_read + 1024 * surface.GetActualMemorySize()}
        surface.Initialize()
        return reply


def status_bytes(name: str) -> int:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(name):
            return 1024 * int(line.split()[1])
    raise RuntimeError(f"/proc/self/status has no line {name}")


def answer_with_peak(rival: Rival, words: list[str]) -> dict:
    ctypes.CDLL(None).malloc_trim(0)  # what the allocator keeps for later is counted when it is used again
    Path("/proc/self/clear_refs").write_text("5\n")  # proc(5): resets the peak resident set size
    before = status_bytes("VmRSS:")
    reply = rival.answer(words)
    return reply | {"peak_bytes": max(0, status_bytes("VmHWM:") - before)}


def main() -> None:
    rival = Rival()
    for line in sys.stdin:
        words = line.rstrip("\n").split("\t")
        try:
            reply = answer_with_peak(rival, words[1:]) if words[0] == "peak" else rival.answer(words)
        except Exception as error:  # the other side is told, whatever it was
            reply = {"error": str(error)}
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    main()
