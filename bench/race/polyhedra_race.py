#!/usr/bin/env python3
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Polyhedra of 14 faces: isotet against VTK's contour filter, in one run.

usage: polyhedra_race.py ISOTET [--side 80] [--rounds 5] [--isovalues 0,0.2,-0.3] [--rival-rounds 1]

Needs a Python with VTK. The grid is `isotet make kelvin`, two polyhedra a cube, the field its gyroid. Times are those of
extraction without reading; of isotet that of splitting and packing, of each isovalue afterwards, and of one surface without
packing, medians with the best and the worst round. VTK contours polyhedra cell by cell, on one thread.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

from vtkmodules.vtkFiltersCore import vtkContourFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def run(isotet, path, isovalues, method):
    told = subprocess.run([isotet, "extract", path, "-f", "gyroid", "-i", ",".join(isovalues), "--method", method, "--json",
                           "-", "-q"], check=True, capture_output=True, text=True)
    return json.loads(told.stdout)


def told(seconds):
    ordered = sorted(seconds)
    return f"{statistics.median(ordered):.3f} s ({ordered[0]:.3f} to {ordered[-1]:.3f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("isotet")
    parser.add_argument("--side", type=int, default=80)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--rival-rounds", type=int, default=1)
    parser.add_argument("--isovalues", default="0,0.2,-0.3")
    options = parser.parse_args()
    isovalues = options.isovalues.split(",")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "grid.vtu")
        subprocess.run([options.isotet, "make", "kelvin", "--side", str(options.side), "--fields", "gyroid", "-o", path, "-q"],
                       check=True)
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        reader.Update()
        grid = reader.GetOutput()
        print(f"{grid.GetNumberOfCells()} polyhedra")
        packing, surfaces, once = [], [], []
        for _ in range(options.rounds):
            packed = run(options.isotet, path, isovalues, "clusters")
            packing.append(packed["measured"]["seconds"] - sum(one["seconds"]["extract"] for one in packed["surfaces"]))
            surfaces += [one["seconds"]["extract"] for one in packed["surfaces"]]
            once.append(run(options.isotet, path, isovalues[:1], "direct")["measured"]["seconds"])
        triangles = [one["triangles"] for one in packed["surfaces"]]
        print(f"isotet: split and packed in {told(packing)}, a surface then {told(surfaces)}, one surface from the polyhedra "
              f"{told(once)}; {triangles} triangles", flush=True)
        seconds, counts = [], []
        for _ in range(options.rival_rounds):
            for isovalue in isovalues:
                contour = vtkContourFilter()
                contour.SetInputData(grid)
                contour.SetInputArrayToProcess(0, 0, 0, 0, "gyroid")
                contour.ComputeNormalsOff()
                contour.SetValue(0, float(isovalue))
                start = time.perf_counter()
                contour.Update()
                seconds.append(time.perf_counter() - start)
                counts.append(contour.GetOutput().GetNumberOfCells())
        print(f"VTK: a surface {told(seconds)}; {counts[:len(isovalues)]} triangles")


if __name__ == "__main__":
    sys.exit(main())
