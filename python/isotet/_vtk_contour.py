# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The filter in place of vtkContourFilter, from Python."""

from __future__ import annotations

import ctypes
import functools
import threading
import warnings
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataObjectTree, vtkDataSetAttributes, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkDemandDrivenPipeline

from . import _isotet
from ._polygons import polygons_of
from ._ranks import Ranks
from ._surface import Surface
from ._vtk_data import Scalars, carried_of, keep_active, scalars_of
from ._vtk_fallback import REASON, Wishes, append, append_other_cells, contour_by_vtk
from ._vtk_properties import ContourProperties
from ._vtk_session import Session, contour_all, finish

_UPDATES = ("nothing", "field", "points", "grid")  # ascending in what they cost


def _raised_later(error: BaseException) -> int:
    """A result for VTK, 1, whose end raises an exception of that class in this thread. VTK's wrappers clear what is raised in
    an algorithm; they drop the result when they are done, and the next line of Python raises. It is no failure, which
    observers in Python would be told of: there VTK ends the process."""
    raises = functools.partial(ctypes.pythonapi.PyThreadState_SetAsyncExc, ctypes.c_ulong(threading.get_ident()),
                               ctypes.py_object(type(error)))  # fmt: skip
    return type("RaisedLater", (int,), {"__del__": staticmethod(raises)})(1)


def tell_error(algorithm, name: str, error: Exception) -> None:
    """Tells the observers of an algorithm, or VTK's output window where there are none."""
    if algorithm.HasObserver("ErrorEvent"):
        algorithm.InvokeEvent("ErrorEvent", str(error))
    else:
        vtkOutputWindow.GetInstance().DisplayErrorText(f"ERROR: {name}: {error}\n")


class _Aborted(Exception):
    """VTK was told to stop the execution."""


class Block(NamedTuple):
    """A grid with cells, its scalars, and where its surface goes."""

    number: int
    grid: Any
    scalars: Scalars
    of_cells: bool
    out: Any

    @property
    def numbers(self):
        return self.grid.GetPointData().GetGlobalIds()

    def fields(self, normals: bool) -> list[tuple[str, np.ndarray]]:
        """The carried point arrays, in the same order on all ranks."""
        arrays = carried_of(self.grid.GetPointData(), self.scalars.replaced)
        return sorted((named for named in arrays if not (normals and named[0] == "Normals")), key=lambda named: named[0])

    def times(self, session: Session) -> tuple[int, ...]:
        """Modified times of what a frame follows from."""
        parts = [self.grid.GetPoints().GetData(), self.scalars.array, self.numbers, self.grid.GetPointData()]
        return session.times + tuple(part.GetMTime() for part in parts if part is not None)


def leaves(data, out, kind) -> Iterator[tuple[int, Any, Any]]:
    """Number, data set and output of each block; blocks of the output are made here, of the class `kind`."""
    if not isinstance(data, vtkDataObjectTree):
        yield 0, data, out
        return
    out.CopyStructure(data)
    at = data.NewIterator()
    at.InitTraversal()
    while not at.IsDoneWithTraversal():
        surface = kind()
        out.SetDataSet(at, surface)
        yield at.GetCurrentFlatIndex(), at.GetCurrentDataObject(), surface
        at.GoToNextItem()


class IsotetContour(ContourProperties):
    """A vtkAlgorithm like vtkContourFilter, for vtkUnstructuredGrid: it follows a moving isovalue.

    It has the methods and properties of vtkContourFilter, also as keywords of the constructor. Gradients, scalar trees,
    locators and the fast mode are accepted without effect. What isotet does not contour VTK does, with a warning.

    The grid is packed when many surfaces are expected (`SetExpectedSurfaces`) or were asked for, and not again while its
    cells and points are the same; another array or time step only stores values. Point and cell arrays are carried.

    Composite data are taken whole: the output has the same blocks, whose surfaces fit bit for bit. `SetController` does the
    same for the ranks of a vtkMultiProcessController.

    >>> import pyvista, isotet.vtk
    >>> sphere = pyvista.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    >>> sphere["r"] = ((sphere.points - 4.0) ** 2).sum(axis=1) ** 0.5
    >>> contour = isotet.vtk.IsotetContour()
    >>> contour.SetInputData(sphere)
    >>> contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    >>> contour.SetValue(0, 2.5)
    >>> done = contour.Update()
    >>> pyvista.wrap(contour.GetOutput()).is_manifold
    True
    """

    _output: type = vtkPolyData  # of each data set
    _name = "IsotetContour"

    def __init__(self, **properties: Any) -> None:
        self._expected = 0
        self._threads = 0
        self._precision = "float32"
        self._tolerance = 0.0
        self._controller = None
        self._keeps_active = True  # scalars of the input; else the contoured ones are active
        self._sessions: dict[int, Session] = {}  # of the blocks of the last execution, by their numbers
        self._frame: _isotet.Frame | None = None
        self._framed: list[tuple[int, ...]] | None = None  # modified times that the frame follows from
        self._warned: set[str] = set()
        super().__init__(**properties)

    def _change(self, name: str, value) -> None:
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    def SetExpectedSurfaces(self, count: int) -> None:
        """How many surfaces will be asked for, over all isovalues and time steps; 0: not known."""
        self._expected = int(count)

    def GetExpectedSurfaces(self) -> int:
        return self._expected

    def SetPrecision(self, precision: str) -> None:
        """In "float32", or "float64": pieces of a grid in double precision meet without knowing of each other."""
        self._change("_precision", precision)

    def GetPrecision(self) -> str:
        return self._precision

    def SetTolerance(self, tolerance: float) -> None:
        """Above 0: quadratic cells are refined until the array is within this of their own field, as a share of its range: 0.001
        is 0.1 %. 0, the default: they are split at their nodes, as they are in pieces of a grid."""
        if not 0 <= tolerance <= 1:
            raise ValueError(f"the tolerance is {tolerance}, but must be a share of the range, 0 to 1")
        self._change("_tolerance", float(tolerance))

    def GetTolerance(self) -> float:
        return self._tolerance

    def SetController(self, controller) -> None:
        """Whose ranks have the pieces of the grid; None, the default: this process has all of it. Every rank must execute the
        filter, those without cells, too; an error on one is an error on all."""
        self._change("_controller", controller)

    def GetController(self):
        return self._controller

    def SetNumberOfThreads(self, count: int) -> None:
        """At most so many; 0, the default: all that the process may use."""
        self._threads = int(count)

    def GetNumberOfThreads(self) -> int:
        return self._threads

    def GetLastUpdate(self) -> str:
        """What the last execution found to differ: "nothing", "field", "points" or "grid", the most among the blocks."""
        return max((session.update for session in self._sessions.values()), key=_UPDATES.index, default="nothing")

    def GetPackedBytes(self) -> int:
        """Of all packed grids."""
        return sum(session.packed_bytes for session in self._sessions.values())

    def GetUsedPackedGrids(self) -> bool:
        """Whether the last execution extracted from packed grids."""
        return any(session.how.get("method") == "clusters" for session in self._sessions.values())

    def GetPackSeconds(self) -> float:
        """What packing, or storing other values or points, took in the last execution."""
        return sum(session.how.get("pack_seconds", 0.0) for session in self._sessions.values())

    def GetExtractSeconds(self) -> float:
        return sum(session.how.get("extract_seconds", 0.0) for session in self._sessions.values())

    def FillInputPortInformation(self, port, info) -> int:
        info.Set(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet")
        info.Append(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), "vtkDataObjectTree")
        return 1

    def FillOutputPortInformation(self, port, info) -> int:
        info.Set(vtkDataObject.DATA_TYPE_NAME(), "vtkDataObject")
        return 1

    def RequestDataObject(self, request, inputs, outputs) -> int:
        data, out = vtkDataObject.GetData(inputs[0], 0), vtkDataObject.GetData(outputs, 0)
        wanted = data.NewInstance() if isinstance(data, vtkDataObjectTree) else self._output()
        if out is None or out.GetClassName() != wanted.GetClassName():
            outputs.GetInformationObject(0).Set(vtkDataObject.DATA_OBJECT(), wanted)
        return 1

    def _scalars_of(self, data, number: int) -> tuple[Scalars | None, bool]:
        """What is contoured, and whether it is a cell array; None where there is no such array."""
        info = self.GetInputArrayInformation(0)
        association = info.Get(vtkDataObject.FIELD_ASSOCIATION())
        name, kind = info.Get(vtkDataObject.FIELD_NAME()), info.Get(vtkDataObject.FIELD_ATTRIBUTE_TYPE())
        places = {vtkDataObject.FIELD_ASSOCIATION_CELLS: (True,), vtkDataObject.FIELD_ASSOCIATION_POINTS_THEN_CELLS: (False, True)}
        for of_cells in places.get(association, (False,)):
            attributes = data.GetCellData() if of_cells else data.GetPointData()
            array = attributes.GetArray(name) if name else attributes.GetAttribute(kind or vtkDataSetAttributes.SCALARS)
            if array is not None:
                return scalars_of(data, array, of_cells, self._component()), of_cells
        return None, False

    def _component(self) -> int:
        info, key = self.GetInputArrayInformation(0), getattr(vtkDataObject, "FIELD_ATTRIBUTE_COMPONENT", None)
        return info.Get(key()) if key is not None and info.Has(key()) else self.GetArrayComponent()

    def _wishes(self) -> Wishes:
        return Wishes(self._isovalues(), self.GetComputeNormals(), bool(self.GetComputeScalars()), bool(self.GetGenerateTriangles()),
                      self.GetOutputPointsPrecision(), self.GetArrayComponent())  # fmt: skip

    def _isovalues(self) -> list[float]:
        return self.GetValues()

    def _warn(self, text: str) -> None:
        """Once."""
        if text in self._warned:
            return
        self._warned.add(text)
        if self.HasObserver("WarningEvent"):
            self.InvokeEvent("WarningEvent", text)
        else:
            warnings.warn(f"{self._name}: {text}", stacklevel=2)

    def _report(self, step: str, fraction: float) -> None:
        self.UpdateProgress(max(self.GetProgress(), fraction))  # each step begins at 0
        if self.GetAbortExecute():
            raise _Aborted

    def _missing(self, grid) -> ValueError:
        name = self.GetInputArrayInformation(0).Get(vtkDataObject.FIELD_NAME())
        if not name:
            return ValueError("there are no active point scalars")
        text = f"there is no point array '{name}'"
        if grid.GetCellData().HasArray(name):
            text += ", but a cell array: use vtkCellDataToPointData before, in ParaView Cell Data to Point Data"
        return ValueError(text)

    def _match_sessions(self, blocks: list[Block]) -> None:
        """Each block keeps the session that knows its cells, else that of its number, which compares what the cells hold.
        Sessions of blocks that are gone go, too."""
        before = dict(self._sessions)
        matched: dict[int, Session] = {}
        numbers = {session.times: number for number, session in before.items()}
        times = {block.number: Session.times_of(block.grid) for block in blocks}
        for block in blocks:
            number = numbers.get(times[block.number])
            if number in before:
                matched[block.number] = before.pop(number)
        self._sessions = {block.number: matched.get(block.number) or before.pop(block.number, None) or Session() for block in blocks}
        for block in blocks:
            self._sessions[block.number].look_at(block.grid, times[block.number])

    def _take(self, part):
        """The data set as it is worked on."""
        return part

    def _blocks_of(self, data, out) -> tuple[list[Block], Exception | None]:
        """The data sets that have the array; of composite data others stay empty. And what to say if none has it."""
        blocks, missing = [], None
        for number, part, surface in leaves(data, out, self._output):
            if part is None or not part.IsA("vtkDataSet") or part.GetNumberOfCells() == 0:
                continue
            surface.GetFieldData().PassData(part.GetFieldData())
            part = self._take(part)
            scalars, of_cells = self._scalars_of(part, number)
            if scalars is not None:
                blocks.append(Block(number, part, scalars, of_cells, surface))
            elif surface is out:
                raise self._missing(part)
            else:
                missing = missing or self._missing(part)
        return blocks, missing

    def _deal_out(self, blocks: list[Block]) -> list[Block]:
        """The blocks with cells that isotet contours. VTK contours the others at once."""
        own = []
        for block in blocks:
            if not isinstance(block.grid, vtkUnstructuredGrid):
                self._warn(f"{block.grid.GetClassName()} is contoured by vtkContourFilter: isotet contours vtkUnstructuredGrid")
                append(contour_by_vtk(block.grid, block.scalars, block.of_cells, self._wishes()), block.out)
            else:
                own.append(block)
        return own

    def _surveys_of(self, blocks: list[Block], ranks: Ranks, *, carried: bool) -> list[bytes]:
        """Of all blocks of all ranks, with the carried fields or without."""
        mine, failure = [], None
        try:
            for block in blocks:
                fields = block.fields(self.GetComputeNormals() != 0) if carried else []
                computed, _ = self._points(block.grid)
                mine.append(self._sessions[block.number].survey(block.grid, block.scalars, fields, computed))
        except BaseException as error:  # noqa: BLE001 - the other ranks wait for this one
            failure = error
        ranks.agree(failure)
        return [survey for surveys in ranks.gather_objects(mine) for survey in surveys]

    def _make_frame(self, blocks: list[Block], ranks: Ranks) -> None:
        """One frame for all; None where there is no cell, or points or scalars are not of one type."""
        self._frame = None
        for carried in (True, False):  # carried fields need not be the same in all pieces
            surveys = self._surveys_of(blocks, ranks, carried=carried)
            try:
                self._frame = _isotet.make_frame(surveys) if surveys else None
                return
            except ValueError:  # on all ranks alike
                continue

    def _agree(self, blocks: list[Block], missing: Exception | None,
               failure: BaseException | None, has_array: bool) -> tuple[Ranks, bool]:
        """What all ranks must know before one extracts; and whether all points have global ids. Raises alike on all."""
        ranks = Ranks(self._controller)
        times = [block.times(self._sessions[block.number]) for block in blocks] if failure is None else None
        failed, changed, found, lacks, many, unnumbered = ranks.any(
            [failure is not None, times is None or times != self._framed, has_array, missing is not None, len(blocks) > 1,
             any(block.numbers is None for block in blocks)])  # fmt: skip
        if failed:
            ranks.agree(failure)
        if lacks and not found:
            ranks.agree(missing)
        if ranks.count < 2 and not many:
            self._frame, self._framed = None, None
            return ranks, False
        if changed:
            self._framed = None
            self._make_frame(blocks, ranks)
            self._framed = times
        return ranks, not unnumbered

    def _points(self, grid):
        """The type that points are computed in, and that of the output; None: that of the input."""
        single, double = vtkAlgorithm.SINGLE_PRECISION, vtkAlgorithm.DOUBLE_PRECISION
        wanted = {single: np.float32, double: np.float64}.get(self.GetOutputPointsPrecision())
        return (np.float64 if wanted == np.float64 else None), wanted

    def _has_own_cells(self, block: Block) -> bool:
        return self._sessions[block.number].others < block.grid.GetNumberOfCells()

    def _how(self, block: Block, numbered: bool) -> dict[str, Any]:
        """What the session of a block is set to."""
        computed, _ = self._points(block.grid)
        precision, frame, numbers = "float64" if computed else self._precision, None, None
        framed = self._framed is not None
        if framed:
            frame = self._frame
            precision = precision if frame is not None else "float64"  # fits where types differ, but for one rounding
            numbers = vtk_to_numpy(block.numbers) if numbered else None
        normals = self.GetComputeNormals() != 0
        return {"grid": block.grid, "scalars": block.scalars, "normals": normals, "surfaces": self._expected,
                "fields": block.fields(normals), "cell_fields": carried_of(block.grid.GetCellData()), "precision": precision,
                "numbers": numbers, "frame": frame, "points": computed, "source_cells": not self.GetGenerateTriangles(),
                "tolerances": (None, None if framed else self._tolerance or None, 0.0, 0.0)}  # fmt: skip

    def _look_at_pieces(self, blocks: list[Block], ranks: Ranks, composite: bool) -> None:
        """Raises alike on all ranks where the pieces do not suffice."""

    def _contour(self, blocks: list[Block], numbered: bool) -> None:
        """What isotet contours of the blocks."""
        hows = [self._how(block, numbered) for block in blocks]
        surfaces = contour_all([(self._sessions[block.number], how) for block, how in zip(blocks, hows, strict=True)],
                               self._isovalues(), self._threads, self._report)  # fmt: skip
        for block, how, surface in zip(blocks, hows, surfaces, strict=True):
            if surface is not None:
                self._finish(block, how, surface)

    def _finish(self, block: Block, how: dict[str, Any], surface: Surface) -> None:
        own = any(name == "isovalue" for name, _ in how["cell_fields"])
        polygons = None if self.GetGenerateTriangles() else polygons_of(surface.triangles, surface.source_cells)
        finish(surface, self._isovalues(), block.scalars, how["fields"], bool(self.GetComputeScalars()), own, block.out,
               self._points(block.grid)[1], polygons)  # fmt: skip

    def _add_others(self, block: Block) -> None:
        """What VTK contours of a block."""
        if self._sessions[block.number].others:
            count = append_other_cells(block.grid, block.scalars, block.of_cells, self._wishes(), block.out)
            self._warn(f"{count} of {block.grid.GetNumberOfCells()} cells are contoured by vtkContourFilter: {REASON}")

    def _execute(self, data, out, blocks: list[Block]) -> None:
        """Fills `blocks` first, so that an error finds what is to be emptied."""
        missing, failure, own, framed = None, None, [], []
        try:
            found, missing = self._blocks_of(data, out)
            blocks.extend(found)
            own = self._deal_out(found)
            self._match_sessions(own)
            framed = [block for block in own if self._has_own_cells(block)]
        except BaseException as error:  # noqa: BLE001 - the other ranks wait for this one
            failure = error
        ranks, numbered = self._agree(framed, missing, failure, bool(blocks))
        self._look_at_pieces(framed, ranks, isinstance(data, vtkDataObjectTree))
        try:
            self._contour(framed, numbered)
            for block in own:
                self._add_others(block)
                if self._keeps_active:
                    keep_active(block.grid, block.out)
        except BaseException as error:  # noqa: BLE001
            failure = error
        ranks.agree(failure)

    def RequestData(self, request, inputs, outputs) -> int:
        blocks: list[Block] = []
        try:
            self._execute(vtkDataObject.GetData(inputs[0], 0), vtkDataObject.GetData(outputs, 0), blocks)
        except BaseException as error:  # noqa: BLE001 - VTK would say that a method failed, and not why
            for block in blocks:
                block.out.Initialize()
            if isinstance(error, _Aborted):
                return 1
            cause = error.__cause__ if isinstance(error.__cause__, BaseException) else error
            if not isinstance(cause, Exception):  # as KeyboardInterrupt
                outputs.GetInformationObject(0).Set(vtkDemandDrivenPipeline.DATA_NOT_GENERATED(), 1)
                return _raised_later(cause)
            self._fail(error)
            return 0
        return 1

    def _fail(self, error: Exception) -> None:
        tell_error(self, self._name, error)
