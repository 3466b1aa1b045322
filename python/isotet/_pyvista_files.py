# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Readers and writers for pyvista.read() and save(), found by entry points: of formats that only isotet reads or writes."""

from __future__ import annotations

import pyvista

from . import _isotet
from ._grid import Grid, read
from ._surface import read_surface
from ._vtk_data import surface_of


def read_grid_file(path: str, **options) -> pyvista.UnstructuredGrid:
    """`options` are those of `isotet.read`."""
    return read(path, **options).to_pyvista()


def read_surface_file(path: str, **options) -> pyvista.PolyData:
    """`options` are those of `isotet.read_surface`."""
    return read_surface(path, **options).to_pyvista()


def write_surface_file(mesh: pyvista.DataObject, path: str, **options) -> None:
    """`options` are those of `isotet.Surface.write`. Faces are cut into triangles."""
    if not isinstance(mesh, pyvista.PolyData):
        raise TypeError(f"the mesh is a {type(mesh).__name__}, but this format takes surfaces: pyvista.PolyData")
    surface_of(mesh).write(path, **options)


def write_packed_file(mesh: pyvista.DataObject, path: str, *, scalars: str | None = None) -> None:
    """A packed grid (.isotet) with all point arrays of one component: `scalars`, else the active ones, first."""
    grid = Grid(mesh)
    fields = {name: values for name, values in grid.fields.items() if values.ndim == 1}
    first = scalars or (mesh.active_scalars_name if mesh.active_scalars_name in fields else next(iter(fields), None))
    if first not in fields:
        there = ", ".join(fields) or "none"
        raise ValueError(f"a packed grid has point arrays of one component, but there is no '{first}': there are {there}")
    packed = grid.pack(first, gradients=True, source_cells=not _isotet.has_cells_to_linearize(grid._grid.cells))
    packed.save(path, fields={name: values for name, values in fields.items() if name != first})
