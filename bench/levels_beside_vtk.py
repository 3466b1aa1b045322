# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Surfaces across levels of refinement, isotet's beside VTK's: open edges, distance from the exact sphere, pictures.

    python bench/levels_beside_vtk.py OUT_FOLDER [--program build/test/release/apps/cli/isotet]   # needs numpy and vtk
"""

import argparse
import collections
import pathlib
import subprocess

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

RADIUS = 0.6


def vtk_surface(grid_file, field, isovalue, surface_file):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(grid_file))
    contour = vtk.vtkContourFilter()
    contour.SetInputConnection(reader.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, field)
    contour.SetValue(0, isovalue)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(contour.GetOutputPort())
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetInputConnection(triangles.GetOutputPort())
    writer.SetFileName(str(surface_file))
    writer.Write()


def read_surface(file):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    data = reader.GetOutput()
    return vtk_to_numpy(data.GetPoints().GetData()), vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def open_edges(points, triangles):
    """Edges of one triangle, points at one place being one."""
    _, place = np.unique(points, axis=0, return_inverse=True)
    corners = place.reshape(-1)[triangles]
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    return sum(count == 1 for count in collections.Counter(map(tuple, edges)).values())


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("out", type=pathlib.Path)
    arguments.add_argument("--program", default="build/test/release/apps/cli/isotet")
    given = arguments.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)

    def isotet(*words):
        subprocess.run([given.program, *map(str, words), "--quiet"], check=True, stdout=subprocess.DEVNULL)

    def surfaces(shape, side, field, isovalue):
        grid = given.out / "grid.vtu"
        isotet("make", shape, "--side", side, "--fields", field, "-o", grid)
        ours, theirs = given.out / "isotet.vtp", given.out / "vtk.vtp"
        isotet("extract", grid, ours, "-f", field, "-i", isovalue)
        vtk_surface(grid, field, isovalue, theirs)
        return ours, theirs

    print("sphere       isotet: open edges, largest distance     VTK: open edges, largest distance")
    for side in (8, 16, 32):
        row = []
        for file in surfaces("octree-random", side, "sphere", RADIUS):
            points, triangles = read_surface(file)
            radii = np.linalg.norm(points[np.unique(triangles)], axis=1)
            row += [open_edges(points, triangles), np.abs(radii - RADIUS).max()]
        print(f"side {side:<6}  {row[0]:12}  {row[1]:18.2e}   {row[2]:18}  {row[3]:18.2e}")
    ours, theirs = surfaces("octree-random", 8, "torus", 0.31)
    for file, name in ((ours, "isotet"), (theirs, "vtk")):
        points, triangles = read_surface(file)
        print(f"torus in cubes of three sizes, {name}: {open_edges(points, triangles)} open edges")
        isotet("render", file, "--normals", "face", "--edges", "--view", "30,50", "--size", "800x560",
               "-o", given.out / f"{name}.png")  # fmt: skip


if __name__ == "__main__":
    main()
