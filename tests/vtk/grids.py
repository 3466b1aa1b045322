# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Grids of VTK for tests, and what surfaces have in common."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkTypeInt32Array
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

TETS = np.array([[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]])
HEXAHEDRON = np.array([[0, 1, 3, 2, 4, 5, 7, 6]])


def lattice(n, cells=TETS, dtype=np.float32, origin=0.0):
    """Points and cells of n^3 cubes, moved a little; a field that is no distance of any point from the middle."""
    axis = np.arange(n + 1)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1) / n
    points += 0.2 / n * np.sin(37.0 * points[:, [1, 2, 0]] + np.arange(3))
    corner = (np.arange(n)[:, None, None] * (n + 1) ** 2 + np.arange(n)[None, :, None] * (n + 1) + np.arange(n)).ravel()
    steps = np.array([(i & 1) + (i >> 1 & 1) * (n + 1) + (i >> 2) * (n + 1) ** 2 for i in range(8)])
    field = np.sqrt(((points - 0.47) ** 2).sum(axis=1)) + 0.03 * np.sin(9 * points[:, 0])
    return (points + origin).astype(dtype), (corner[:, None, None] + steps[cells][None]).reshape(-1, cells.shape[1]), field.astype(dtype)


def grid_of(points, cells, fields, kind=None, bits=64, ids=None, ghosts=None):
    """A vtkUnstructuredGrid; `bits` of its cell array, 32 or 64."""
    kind = {4: 10, 8: 12}[cells.shape[1]] if kind is None else kind
    grid, where, array = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    where.SetData(numpy_to_vtk(points, deep=True))
    offsets = np.arange(len(cells) + 1) * cells.shape[1]
    if bits == 64:
        array.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    else:
        parts = [vtkTypeInt32Array(), vtkTypeInt32Array()]
        for part, values in zip(parts, (offsets, cells.ravel())):
            part.SetNumberOfValues(len(values))
            vtk_to_numpy(part)[:] = values
        array.SetData(*parts)
    grid.SetPoints(where)
    grid.SetCells(numpy_to_vtk(np.full(len(cells), kind, np.uint8), deep=True), array)
    for name, values in fields.items():
        add(grid.GetPointData(), name, values)
    if ids is not None:
        array = numpy_to_vtkIdTypeArray(np.ascontiguousarray(ids, np.int64), deep=True)
        array.SetName("ids")
        grid.GetPointData().SetGlobalIds(array)
    if ghosts is not None:
        add(grid.GetCellData(), "vtkGhostType", ghosts.astype(np.uint8))
    return grid


def add(attributes, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)
    return array


def sphere(n=8, **options):
    points, cells, field = lattice(n, dtype=options.pop("dtype", np.float32))
    return grid_of(points, cells, {"r": field}, **options)


def points_of(surface):
    if surface.GetNumberOfPoints() == 0:
        return np.empty((0, 3), np.float32)
    return vtk_to_numpy(surface.GetPoints().GetData())


def triangles_of(surface):
    if surface.GetNumberOfPolys() == 0:
        return np.empty((0, 3), np.int64)
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(np.int64)


def corners_of(surface):
    """Coordinates of the corners of each triangle, smallest corner first: a set that no numbering changes."""
    corners = points_of(surface)[triangles_of(surface)]
    out = set()
    for triangle in corners:
        rows = [tuple(corner) for corner in triangle]
        first = rows.index(min(rows))
        out.add(tuple(rows[first:] + rows[:first]))
    return out


def area_of(surface):
    a, b, c = points_of(surface)[triangles_of(surface)].astype(float).transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def names(attributes):
    return sorted(attributes.GetArrayName(i) for i in range(attributes.GetNumberOfArrays()))


def open_edges(surface):
    """Edges with one triangle, vertices taken for one where their bits are."""
    _, number = np.unique(points_of(surface), axis=0, return_inverse=True)
    triangles = number.reshape(-1)[triangles_of(surface)]
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    return int((count == 1).sum())
