# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Grids of other packages, in and out."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _isotet
from ._arrays import VTK_TYPES, cells_in, fields_in, numbers_in, points_in

if TYPE_CHECKING:
    from ._grid import Grid

_MESHIO_NAMES = {number: name for name, number in VTK_TYPES.items()}
_VOXEL, _HEXAHEDRON, _POLYHEDRON = 11, 12, 42
_ORDER_OF_VOXEL = [0, 1, 3, 2, 4, 5, 7, 6]  # as a hexahedron


def grid_of_mesh(mesh, fields, cell_fields, point_numbers) -> _isotet.Grid:
    """Of a mesh of VTK, PyVista or meshio: with its fields, where none are given."""
    if hasattr(mesh, "IsA"):
        from ._vtk_data import grid_in

        found = grid_in(mesh)
    elif hasattr(mesh, "points") and hasattr(mesh, "cells") and hasattr(mesh, "point_data"):
        found = _of_meshio(mesh)
    else:
        raise TypeError(f"the mesh is a {type(mesh).__name__}, but must be one of VTK, PyVista or meshio; points need cells beside them")
    numbers = found.point_numbers if point_numbers is None else numbers_in("point_numbers", point_numbers)
    own = [list(found.fields.items()), list(found.cell_fields.items())]
    return _isotet.Grid(found.points, found.cells, own[0] if fields is None else fields_in("fields", fields),
                        own[1] if cell_fields is None else fields_in("cell_fields", cell_fields), numbers)  # fmt: skip


def _of_meshio(mesh) -> _isotet.Grid:
    points = {name: _flat(values) for name, values in mesh.point_data.items()}
    joined = {name: _joined(name, [_flat(part) for part in parts]) for name, parts in mesh.cell_data.items() if parts}
    cells = cells_in(mesh.cells if len(mesh.cells) else {})
    return _isotet.Grid(points_in(mesh.points), cells, fields_in("point_data", points), fields_in("cell_data", joined))


def _flat(values) -> np.ndarray:
    """Tensors, of shape (N, 3, 3), as rows of their components."""
    values = np.asanyarray(values)
    return values.reshape(len(values), math.prod(values.shape[1:])) if values.ndim > 2 else values


def _joined(name: str, parts: list[np.ndarray]) -> np.ndarray:
    """The cell data of all blocks."""
    shapes = {part.shape[1:] for part in parts}
    if len(shapes) > 1:
        raise ValueError(f"cell_data[{name!r}] has blocks of shape {' and '.join(str(part.shape) for part in parts)}, "
                         "but a cell must have as many components in all")  # fmt: skip
    return np.concatenate(parts)


def expanded(grid: _isotet.Grid) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners of all cells one after another, where those of each begin, and types."""
    connectivity, offsets, types, uniform, *_ = grid.cells.arrays()
    if offsets is not None:  # without cells there are no types
        return connectivity, offsets, np.empty(0, np.uint8) if types is None else types
    sizes = {10: 4, _VOXEL: 8, _HEXAHEDRON: 8, 13: 6, 14: 5}
    count = len(grid.cells)
    return connectivity, np.arange(count + 1) * sizes[uniform], np.full(count, uniform, np.uint8)


def faces_of(grid: Grid) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of polyhedra: the points of all faces one after another, how many each face has, and how many faces each cell has."""
    stream, starts = np.asarray(grid.faces, np.int64), np.asarray(grid.face_offsets, np.int64)
    counts = np.zeros(len(starts) - 1, np.int64)
    has = np.diff(starts) > 0
    counts[has] = stream[starts[:-1][has]]
    first = np.cumsum(counts) - counts
    sizes, places = np.empty(counts.sum(), np.int64), np.empty(counts.sum(), np.int64)
    cell, at = np.flatnonzero(has), starts[:-1][has] + 1
    for face in range(int(counts.max(initial=0))):
        sizes[first[cell] + face], places[first[cell] + face] = stream[at], at + 1
        goes_on = counts[cell] > face + 1
        cell, at = cell[goes_on], (at + 1 + stream[at])[goes_on]
    within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    return stream[np.repeat(places, sizes) + within], sizes, counts


def to_meshio(grid: Grid) -> Any:
    """A meshio.Mesh: cells of one type that follow each other are a block."""
    import meshio

    connectivity, offsets, types = expanded(grid._grid)
    unknown = sorted(set(np.unique(types).tolist()) - {_VOXEL, *_MESHIO_NAMES})
    if unknown:
        raise ValueError(f"the grid has cells of VTK's type {unknown[0]}, for which meshio has no name")
    sizes = np.diff(offsets)
    ends = np.append(np.flatnonzero((np.diff(types) != 0) | (np.diff(sizes) != 0)) + 1, len(types)) if len(types) else np.empty(0, np.intp)
    starts = np.concatenate([[0], ends[:-1]]).astype(np.intp) if len(ends) else ends
    blocks = []
    for start, end in zip(starts, ends, strict=True):
        corners = np.array(connectivity[offsets[start] : offsets[end]]).reshape(end - start, -1)
        is_voxel = types[start] == _VOXEL
        blocks.append(("hexahedron", corners[:, _ORDER_OF_VOXEL]) if is_voxel else (_MESHIO_NAMES[int(types[start])], corners))
    cell_data = {name: [np.array(values[start:end]) for start, end in zip(starts, ends, strict=True)]
                 for name, values in grid.cell_fields.items()}  # fmt: skip
    return meshio.Mesh(np.array(grid.points), blocks, point_data={name: np.array(values) for name, values in grid.fields.items()},
                       cell_data=cell_data)  # fmt: skip
