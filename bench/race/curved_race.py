#!/usr/bin/env python3
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Quadratic tetrahedra at the same tolerance: isotet against VTK's tessellator and contour filter, in one run.

usage: curved_race.py ISOTET [--side 55] [--cells-a-wave 8] [--isovalue 0.2] [--tolerances 1,0.1] [--no-rival] [--rival-limit 600]

Needs a Python with VTK and NumPy. The grid is `isotet make tet10`, the field a gyroid at its nodes. Times are those of extraction
without reading; of VTK the tessellator (field criterion on, geometry off: edges are straight) and the contour filter. One run
each, since VTK's takes minutes: the spread is not told.
"""
import argparse
import json
import math
import multiprocessing
import os
import subprocess
import sys
import tempfile
import time

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkContourFilter
from vtkmodules.vtkFiltersGeneral import vtkTessellatorFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter


def grid_with_gyroid(isotet, side, cells_a_wave, path):
    subprocess.run([isotet, "make", "tet10", "--side", str(side), "--fields", "sphere", "-o", path, "-q"], check=True)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    at = vtk_to_numpy(grid.GetPoints().GetData()).astype(float) * side / 2 * 2 * math.pi / cells_a_wave
    x, y, z = at[:, 0], at[:, 1], at[:, 2]
    values = numpy.sin(x) * numpy.cos(y) + numpy.sin(y) * numpy.cos(z) + numpy.sin(z) * numpy.cos(x)
    field = numpy_to_vtk(values.astype(numpy.float32), deep=True)
    field.SetName("wave")
    grid.GetPointData().RemoveArray("sphere")
    grid.GetPointData().AddArray(field)
    grid.GetPointData().SetActiveScalars("wave")
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.Write()
    return grid, float(values.max() - values.min())


def ours(isotet, path, isovalue, percent):
    told = subprocess.run([isotet, "extract", path, "-f", "wave", "-i", str(isovalue), "--tolerance", f"{percent}%",
                           "--json", "-", "-q"], check=True, capture_output=True, text=True)
    report = json.loads(told.stdout)
    return {"seconds": report["measured"]["seconds"], "bytes": report["measured"]["bytes"],
            "triangles": report["surfaces"][0]["triangles"], "tets": report["curved"]["tets"],
            "bound": report["curved"]["field_bound"]}


def rival(grid, isovalue, error):
    tessellator = vtkTessellatorFilter()
    tessellator.SetInputData(grid)
    tessellator.SetMaximumNumberOfSubdivisions(8)
    tessellator.SetChordError(1e30)
    tessellator.ResetFieldCriteria()
    names = [grid.GetPointData().GetArrayName(i) for i in range(grid.GetPointData().GetNumberOfArrays())]
    for index, name in enumerate(names):
        tessellator.SetFieldCriterion(index, error if name == "wave" else -1.0)
    start = time.perf_counter()
    tessellator.Update()
    tets = tessellator.GetOutput().GetNumberOfCells()
    contour = vtkContourFilter()
    contour.SetInputConnection(tessellator.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, "wave")
    contour.ComputeNormalsOff()
    contour.SetValue(0, isovalue)
    contour.Update()
    return {"seconds": time.perf_counter() - start, "triangles": contour.GetOutput().GetNumberOfCells(), "tets": tets}


def rival_within(seconds, *arguments):
    """What rival() returns, or None after so many seconds: it runs in a process of its own."""
    fork = multiprocessing.get_context("fork")
    receiver, sender = fork.Pipe(duplex=False)
    process = fork.Process(target=lambda: sender.send(rival(*arguments)))
    process.start()
    sender.close()
    try:
        if receiver.poll(seconds):
            return receiver.recv()
        return None
    finally:
        process.kill()
        process.join()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("isotet")
    parser.add_argument("--side", type=int, default=55)
    parser.add_argument("--cells-a-wave", type=float, default=8)
    parser.add_argument("--isovalue", type=float, default=0.2)
    parser.add_argument("--tolerances", default="1,0.1", help="in %% of the range")
    parser.add_argument("--no-rival", action="store_true")
    parser.add_argument("--rival-limit", type=float, default=600, help="seconds after which VTK is stopped")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "grid.vtu")
        grid, width = grid_with_gyroid(options.isotet, options.side, options.cells_a_wave, path)
        print(f"{grid.GetNumberOfCells()} quadratic tetrahedra")
        for percent in (float(text) for text in options.tolerances.split(",")):
            mine = ours(options.isotet, path, options.isovalue, percent)
            print(f"{percent} %: isotet {mine}")
            if options.no_rival:
                continue
            other = rival_within(options.rival_limit, grid, options.isovalue, percent / 100 * width)
            if other is None:
                times = options.rival_limit / mine["seconds"]
                print(f"{percent} %: VTK not done in {options.rival_limit:g} s, over {times:.1f} times the time", flush=True)
            else:
                print(f"{percent} %: VTK {other}, {other['seconds'] / mine['seconds']:.1f} times the time", flush=True)


if __name__ == "__main__":
    sys.exit(main())
