# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Solids, and the cells of solids, in VTK's pipelines from Python."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkStreamingDemandDrivenPipeline

from . import _isotet
from ._call import call_options
from ._grid import Grid
from ._ranks import Ranks
from ._surface import Surface
from ._vtk_contour import Block, IsotetContour
from ._vtk_data import carried_of, cells_shown, fill, fill_unstructured, points_of, unstructured_of
from ._vtk_fallback import append
from ._vtk_session import says_nothing_to_contour

_SIDES = ("above", "below", "between")
_NEED = ("ghost cells, of which solids of pieces need one layer: vtkGhostCellsGenerator makes them, in ParaView Ghost Cells")


class _Sided(IsotetContour):
    """Works on what lies on one side of isovalues, or between two."""

    _kind = ""

    def __init__(self, **properties: Any) -> None:
        self._side = "above"
        super().__init__(**properties)

    def SetSide(self, side: str | int) -> None:
        """"above": where the array is at least the isovalue; "below": where it is less; "between": from the smallest to the
        largest isovalue. Or 1, 2, 3."""
        word = _SIDES[side - 1] if side in (1, 2, 3) else side
        if word not in _SIDES:
            raise ValueError(f"the side is {side!r}, but must be one of {', '.join(_SIDES)}")
        self._change("_side", word)

    def GetSide(self) -> str:
        return self._side

    side = property(GetSide, SetSide, doc="GetSide(), SetSide().")

    def _ranges(self) -> list[tuple[float, float]]:
        values = self.GetValues()
        if self._side == "between":
            if len(set(values)) < 2:
                raise ValueError(f"a {self._kind} between values takes two of them")
            return [(min(values), max(values))]
        return [(value, math.inf) if self._side == "above" else (-math.inf, value) for value in values]

    def _fields(self, block: Block) -> list[tuple[str, np.ndarray]]:
        """With the array that decides."""
        fields = block.fields(False)
        if self.GetComputeScalars() and block.scalars.replaced:
            fields.append((block.scalars.name, block.scalars.values))
        return fields

    def _options(self, how: dict[str, Any], precision: str, frame=None):
        return _isotet.ContourOptions("none", False, False, "merge", precision, "direct", 0, False, frame, *how["tolerances"])

    def _contour(self, blocks: list[Block], numbered: bool) -> None:
        call = call_options(self._threads, self._report)
        ranges = self._ranges()
        for block in blocks:
            try:
                self._make(block, self._how(block, numbered), ranges, call)
            except ValueError as error:
                if not says_nothing_to_contour(error):
                    raise


class IsotetSolid(_Sided):
    """A vtkAlgorithm whose output are closed solids: isosurfaces, and the part of the boundary on one side of them.

    The cell array "boundary" is 1 on the boundary; points have the array that decides as it is there, and no normals. Each block
    is a solid of its own. With SetController() pieces give the solid of the whole; they need a layer of ghost cells, which is
    asked for. Data that VTK would contour are an error.

    >>> import pyvista, isotet.vtk
    >>> grid = pyvista.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    >>> grid["x"] = grid.points[:, 0]
    >>> solid = isotet.vtk.IsotetSolid(side="below", input_data=grid, input_array="x", values=[2.5])
    >>> done = solid.Update()
    >>> round(pyvista.wrap(solid.GetOutput()).volume, 6)
    160.0
    """

    _name, _kind = "IsotetSolid", "Solid"

    def RequestUpdateExtent(self, request, inputs, outputs) -> int:
        pipeline = vtkStreamingDemandDrivenPipeline
        out, into = outputs.GetInformationObject(0), inputs[0].GetInformationObject(0)
        if into is not None and (out.Get(pipeline.UPDATE_NUMBER_OF_PIECES()) or 1) > 1:
            levels = out.Get(pipeline.UPDATE_NUMBER_OF_GHOST_LEVELS()) or 0
            into.Set(pipeline.UPDATE_NUMBER_OF_GHOST_LEVELS(), max(levels, 1))
        return 1

    def _deal_out(self, blocks: list[Block]) -> list[Block]:
        for block in blocks:
            if not isinstance(block.grid, vtkUnstructuredGrid):
                raise ValueError(f"a Solid was asked for, but {block.grid.GetClassName()} is contoured by vtkContourFilter: isotet "
                                 "contours vtkUnstructuredGrid")  # fmt: skip
        return blocks

    def _look_at_pieces(self, blocks: list[Block], ranks: Ranks, composite: bool) -> None:
        has_ghosts = any(cells_shown(block.grid)[1].any() for block in blocks)
        told = np.frombuffer(b"".join(ranks.gather(bytes([bool(blocks), has_ghosts]))), np.uint8).reshape(-1, 2).sum(axis=0)
        if told[0] < 2 or told[1]:
            return
        if not composite:
            raise ValueError(f"the grid lies in pieces on several ranks, without {_NEED}")
        self._warn(f"blocks on several ranks have no {_NEED}")

    def _solids_of(self, block: Block, how: dict[str, Any], call) -> _isotet.Solids:
        """Of a piece where there is a frame: then ghost cells are the other pieces'."""
        fields, cell_fields = self._fields(block), carried_of(block.grid.GetCellData(), "vtkGhostType")
        options = self._options(how, how["precision"], how["frame"])
        whole, field = self._sessions[block.number].input(block.grid, block.scalars, how["numbers"], how["points"])
        if how["frame"] is None:
            return _isotet.Solids(whole, field, fields, cell_fields, options, None, call)
        cells, ghosts = cells_shown(block.grid)
        piece = _isotet.Grid(whole.points, cells, [], [], how["numbers"])
        return _isotet.Solids(piece, field, fields, cell_fields, options, ghosts, call)

    def _make(self, block: Block, how: dict[str, Any], ranges: list[tuple[float, float]], call) -> None:
        solids = self._solids_of(block, how, call)
        kinds = {name: values.dtype for name, values in self._fields(block)}
        for lower, upper in ranges:
            surface = Surface._of(*solids.extract(lower, upper, call))
            self._warn_of(surface.solid)
            append(fill(vtkPolyData(), surface, copy=False, kinds=kinds, points=self._points(block.grid)[1]), block.out)
        if self.GetComputeScalars() and block.scalars.replaced:
            block.out.GetPointData().SetActiveScalars(block.scalars.name)

    def _warn_of(self, told: dict[str, Any]) -> None:
        if told["open_edges"]:
            self._warn(f"the solid has {told['open_edges']} open edges: the grid has repeated cells")
        if told["seam_edges"]:
            self._warn(f"the isosurface of the solid has {told['seam_edges']} open edges inside the grid, where points are doubled: "
                       "vtkStaticCleanUnstructuredGrid joins them")  # fmt: skip
        if told["unfit_edges"]:
            self._warn(f"the isosurface of the solid has {told['unfit_edges']} open edges inside the grid, where cells of different "
                       "sizes do not fit together")  # fmt: skip

    def _add_others(self, block: Block) -> None:
        if self._sessions[block.number].others:
            self._warn("cells that isotet does not contour are no part of the solid")


class IsotetClip(_Sided):
    """A vtkAlgorithm whose output are the cells on one side of an isosurface, or between two: a vtkUnstructuredGrid.

    Cells that the isosurface crosses are cut. All point and cell arrays are carried. Other data sets are converted before; 2D
    cells, lines and ghost cells are left out. Pieces on several ranks fit.

    >>> import pyvista, isotet.vtk
    >>> grid = pyvista.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    >>> grid["x"] = grid.points[:, 0]
    >>> clip = isotet.vtk.IsotetClip(side="below", input_data=grid, input_array="x", values=[2.5])
    >>> done = clip.Update()
    >>> round(pyvista.wrap(clip.GetOutput()).volume, 6)
    160.0
    """

    _output = vtkUnstructuredGrid
    _name, _kind = "IsotetClip", "clip"

    def __init__(self, **properties: Any) -> None:
        self._polyhedra = True
        super().__init__(**properties)

    def SetPolyhedra(self, on: bool) -> None:
        """Whether cut cells that are no tetrahedra, pyramids, wedges or hexahedra are polyhedra. Off: they are split."""
        self._change("_polyhedra", bool(on))

    def GetPolyhedra(self) -> bool:
        return self._polyhedra

    polyhedra = property(GetPolyhedra, SetPolyhedra, doc="GetPolyhedra(), SetPolyhedra().")

    def _take(self, part):
        return unstructured_of(part)

    def _deal_out(self, blocks: list[Block]) -> list[Block]:
        return blocks

    def _make_frame(self, blocks: list[Block], ranks: Ranks) -> None:
        """None: cut points are computed in double where single precision would depend on the piece."""
        self._frame = None

    def _ranges(self) -> list[tuple[float, float]]:
        ranges = super()._ranges()
        if len(set(ranges)) != 1:
            raise ValueError(f"a clip above or below takes one value, but there are {len(set(ranges))}")
        return ranges

    def _make(self, block: Block, how: dict[str, Any], ranges: list[tuple[float, float]], call) -> None:
        mine, field = self._sessions[block.number].input(block.grid, block.scalars, None, how["points"])
        single = how["points"] is None and points_of(block.grid).dtype == block.scalars.values.dtype == np.float32
        options = self._options(how, self._precision if single else "float64")
        clipper = _isotet.Clipper(mine, field, self._fields(block), carried_of(block.grid.GetCellData(), "vtkGhostType"), options, call)
        grid, told, _ = clipper.clip(*ranges[0], self._polyhedra, False, call)
        if told["folded_pieces"]:
            self._warn(f"pieces with cells inside out, as no point sees all of them: {told['folded_pieces']}; Polyhedra avoids them")
        kinds = {name: values.dtype for name, values in self._fields(block)}
        fill_unstructured(block.out, Grid._of(grid), kinds=kinds, points=self._points(block.grid)[1])

    def _add_others(self, block: Block) -> None:
        if count := self._sessions[block.number].others:
            self._warn(f"{count} of {block.grid.GetNumberOfCells()} cells are left out: isotet clips three-dimensional cells of degree 1 "
                       "to 10 and polyhedra with faces")  # fmt: skip
