# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A session for one grid of VTK's, and its surfaces as vtkContourFilter gives them."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk

from . import _isotet
from ._call import Progress, call_options
from ._surface import Surface
from ._vtk_data import Scalars, cells_of, fill, kept_type, other_cells, points_of, types_of


class Session:
    """A session for one grid of VTK's, which may change at any time.

    Cells are taken for the same while VTK's modified times say so, as VTK's own filters do. Points and values are compared
    with what they were: NumPy code that changes them in place leaves no other trace.
    """

    def __init__(self):
        self.lock = threading.RLock()  # held from setting it to its surface, where threads share it
        self._session: _isotet.Contour | None = None
        self._cells: _isotet.Cells | None = None
        self.times: tuple[int, ...] = ()  # of the cells
        self.others = 0  # cells that isotet does not contour
        self.update = "grid"  # what the last set() found to differ
        self.how: dict[str, Any] = {}  # how the last surface was made
        self._is_new = True

    @staticmethod
    def times_of(grid) -> tuple[int, ...]:
        """Modified times of the cells. VTK never gives the same one twice, so they tell arrays apart, too."""
        cells, types = grid.GetCells(), types_of(grid)
        parts = (cells, cells.GetConnectivityArray(), cells.GetOffsetsArray(), types) if cells else (types,)
        parts += (grid.GetCellGhostArray(),)
        return tuple(part.GetMTime() for part in parts if part is not None)

    def look_at(self, grid, times: tuple[int, ...] | None = None) -> None:
        """Takes its cells, before anything else. `times`: what times_of() gives, if it is known."""
        times = times or self.times_of(grid)
        if self._cells is None or times != self.times:  # equal cells in other arrays: the session finds it out
            self._cells, self.others, self.times = cells_of(grid), len(other_cells(grid)), times

    @property
    def empty_cells(self) -> int:
        """Cells of VTK's type 0, and those that ghost marks hide."""
        types = None if self._cells is None else self._cells.arrays()[2]
        return 0 if types is None else int(np.count_nonzero(types == 0))

    def input(self, grid, scalars: Scalars, numbers: np.ndarray | None = None, points=None) -> tuple[_isotet.Grid, _isotet.PointField]:
        assert self._cells is not None
        field = _isotet.PointField(scalars.name or scalars.array.GetName() or "scalars", scalars.values)
        places = points_of(grid)
        return _isotet.Grid(places if points is None else places.astype(points, copy=False), self._cells, [], [], numbers), field

    def survey(self, grid, scalars: Scalars, fields: list[tuple[str, np.ndarray]], points=None) -> bytes:
        return _isotet.survey(*self.input(grid, scalars, points=points), fields, False, call_options(0, None))

    def inputs(self, grid, scalars: Scalars, *, normals: bool, surfaces: int, fields: list[tuple[str, np.ndarray]],
               cell_fields: list[tuple[str, np.ndarray]], precision: str = "float32", numbers: np.ndarray | None = None,
               frame: _isotet.Frame | None = None, points=None, source_cells: bool = False, refine_for_fields: bool = False,
               tolerances: tuple[float | None, float | None, float, float] = (None, None, 0.0, 0.0)) -> tuple[Any, ...]:  # fmt: skip
        """What contour_all() sets the session to; it is made here if there is none. `refine_for_fields`: `tolerances` hold for
        the carried fields, too."""
        mine, field = self.input(grid, scalars, numbers, points)
        kind = "gradient" if normals else "none"
        options = _isotet.ContourOptions(kind, False, source_cells, "merge", precision, None, surfaces, False, frame, *tolerances,
                                         pack_all=True)  # fmt: skip
        if refine_for_fields:
            options.refine_for(fields)
        self._is_new = self._session is None
        if self._session is None:
            self._session = _isotet.Contour(mine, field, fields, cell_fields, options, call_options(0, None))
        return self._session, mine, field, fields, cell_fields, options

    def took(self, update: str, made: tuple[_isotet.Surface, dict[str, Any]]) -> Surface:
        self.update = "grid" if self._is_new else update
        self.how = made[1]
        return Surface._of(*made)

    def pack(self, grid, scalars: Scalars, **how) -> None:
        session, *inputs = self.inputs(grid, scalars, **how)
        session.set(*inputs, call_options(0, None))
        session.prepare(call_options(0, None))

    @property
    def report(self) -> dict[str, Any]:
        told = {name: self.how[name] for name in ("method", "pack_seconds", "extract_seconds") if name in self.how}
        return {"update": self.update, "packed_bytes": self.packed_bytes, **told}

    def __repr__(self) -> str:
        size = self.packed_bytes
        return f"packed, {size} bytes" if size else "not packed"

    @property
    def packed_bytes(self) -> int:
        """0: it is not packed."""
        return 0 if self._session is None else self._session.packed_bytes()


def says_nothing_to_contour(error: ValueError) -> bool:
    """Whether the library refused a grid for want of cells that it contours: of polyhedra without faces only it knows."""
    return "no cell that can be contoured" in str(error)


def contour_all(blocks: list[tuple[Session, dict[str, Any]]], isovalues: list[float], threads: int = 0,
                progress: Progress | None = None) -> list[Surface | None]:  # fmt: skip
    """Surfaces of sessions, set to what Session.inputs() takes, in one call of the library; None where there is no cell to
    contour."""
    try:
        inputs = [session.inputs(**how) for session, how in blocks]
        made = _isotet.contour_blocks(inputs, isovalues, call_options(threads, progress))
    except ValueError as error:
        if not says_nothing_to_contour(error):
            raise
        if len(blocks) == 1:
            return [None]
        return [surface for block in blocks for surface in contour_all([block], isovalues, threads, progress)]
    return [session.took(*one) for (session, _), one in zip(blocks, made, strict=True)]


def levels(lower: float, upper: float, count: int) -> list[float]:
    """VTK's GenerateValues()."""
    return np.linspace(lower, upper, count).tolist()


def finish(surface: Surface, isovalues: list[float], scalars: Scalars, fields: list[tuple[str, np.ndarray]],
           compute_scalars: bool, cell_isovalues: bool, out, points=None, polygons=None):  # fmt: skip
    """A surface as vtkContourFilter gives it: the contoured scalars are an array of isovalues, integers are integers.
    `cell_isovalues`: the cell array "isovalue" stays."""
    fill(out, surface, copy=False, kinds={name: values.dtype for name, values in fields}, points=points, polygons=polygons)
    if len(isovalues) != 1 and not cell_isovalues:
        out.GetCellData().RemoveArray("isovalue")
    if compute_scalars and scalars.name:
        kind = scalars.values.dtype
        values = np.repeat(np.array(isovalues, np.float64), np.array(surface._how["vertex_counts"], np.intp))
        values = values.astype(kind) if kind.kind == "f" else kept_type(values, kind)
        array = numpy_to_vtk(values)
        array.SetName(scalars.name)
        out.GetPointData().SetScalars(array)
    return out
