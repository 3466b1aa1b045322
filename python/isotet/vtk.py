# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet in VTK's pipelines, from Python. Needs the package vtk.

`IsotetContour` is a filter with the methods of vtkContourFilter; `grid_of` and `to_polydata` convert data sets.
"""

from __future__ import annotations

import ctypes
import functools
import threading
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject, vtkDataObjectTree, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkDemandDrivenPipeline

from . import _isotet
from ._arrays import points_in, scalars_in, values_in
from ._call import call_options
from ._grid import Grid
from ._ranks import Ranks
from ._surface import Surface

__all__ = ["IsotetContour", "grid_of", "to_polydata"]

_TETRAHEDRON, _POLYHEDRON = 10, 42
_GHOSTS = 57  # marks of cells that are another piece's, refined, outside or hidden


def _types_of(grid):
    """The array of cell types: its method has another name since VTK 9.6."""
    types = grid.GetCellTypes() if hasattr(grid, "GetDistinctCellTypes") else grid.GetCellTypesArray()
    return types if hasattr(types, "GetMTime") else grid.GetCellTypesArray()


def _cells_of(grid) -> _isotet.Cells:
    """The cells of a vtkUnstructuredGrid, shared."""
    types = _types_of(grid)
    if grid.GetNumberOfCells() == 0 or types is None:
        return _isotet.Cells(np.empty(0, np.int64), None, None, _TETRAHEDRON)
    types = vtk_to_numpy(types)
    if (ghosts := grid.GetCellGhostArray()) is not None:
        types = np.where(vtk_to_numpy(ghosts) & _GHOSTS, 0, types).astype(np.uint8)
    cells = grid.GetCells()
    connectivity = np.ascontiguousarray(vtk_to_numpy(cells.GetConnectivityArray()))
    if types[0] == _TETRAHEDRON and (types == _TETRAHEDRON).all():
        return _isotet.Cells(connectivity, None, None, _TETRAHEDRON)
    offsets = np.ascontiguousarray(vtk_to_numpy(cells.GetOffsetsArray()))
    return _isotet.Cells(connectivity, offsets, types, _TETRAHEDRON, *_faces_of(grid, types))


def _parts_of(cells) -> tuple[np.ndarray, np.ndarray]:
    """Corners and offsets of a vtkCellArray."""
    return tuple(vtk_to_numpy(array) for array in (cells.GetConnectivityArray(), cells.GetOffsetsArray()))


def _faces_of(grid, types: np.ndarray) -> tuple[np.ndarray, ...]:
    """Faces of polyhedra and where those of each cell begin; nothing where there are none."""
    if not (types == _POLYHEDRON).any():
        return ()
    if not hasattr(grid, "GetPolyhedronFaces"):  # before VTK 9.4
        faces, starts = grid.GetFaces(), grid.GetFaceLocations()
        if faces is None or starts is None:
            return ()
        stream, starts = vtk_to_numpy(faces), vtk_to_numpy(starts)
        ends = np.append(starts, len(stream))
        for cell in range(len(starts) - 1, -1, -1):
            if ends[cell] < 0:  # no polyhedron
                ends[cell] = ends[cell + 1]
        return np.ascontiguousarray(stream), ends
    faces, of_cells = grid.GetPolyhedronFaces(), grid.GetPolyhedronFaceLocations()
    if faces is None or of_cells is None:
        return ()
    points, first_point = (array.astype(np.int64) for array in _parts_of(faces))
    order, first_face = (array.astype(np.int64) for array in _parts_of(of_cells))
    sizes = np.diff(first_point)[order]
    counts = np.diff(first_face)  # of faces, a cell
    is_polyhedron = counts > 0
    # Each polyhedron has an entry for its count of faces, each face one for its count of points.
    before_face = np.cumsum(np.append(0, sizes + 1))
    cell_of_face = np.repeat(np.arange(len(counts)), counts)
    counts_before = np.cumsum(is_polyhedron)
    offsets = before_face[first_face] + np.append(0, counts_before)
    stream = np.empty(offsets[-1], np.int64)
    stream[offsets[:-1][is_polyhedron]] = counts[is_polyhedron]
    at_face = before_face[:-1] + counts_before[cell_of_face]
    stream[at_face] = sizes
    within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    stream[np.repeat(at_face + 1, sizes) + within] = points[np.repeat(first_point[order], sizes) + within]
    return stream, offsets


def _points_of(grid) -> np.ndarray:
    points = grid.GetPoints()
    return np.empty((0, 3), np.float32) if points is None else points_in(vtk_to_numpy(points.GetData()))


def _arrays_of(attributes, leave_out: str | None = None) -> list[tuple[str, np.ndarray]]:
    """The named arrays of numbers of point or cell data, shared."""
    out = []
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(i)  # None for strings
        if array is not None and array.GetName() and array.GetName() != leave_out:
            out.append((array.GetName(), values_in(array.GetName(), vtk_to_numpy(array))))
    return out


def grid_of(grid) -> Grid:
    """A vtkUnstructuredGrid, or pyvista.UnstructuredGrid, as `isotet.Grid`: arrays are shared, and must not change meanwhile."""
    fields, cell_fields = _arrays_of(grid.GetPointData()), _arrays_of(grid.GetCellData())
    return Grid._of(_isotet.Grid(_points_of(grid), _cells_of(grid), fields, cell_fields))


def _add_arrays(attributes, arrays: dict[str, np.ndarray], copy: bool) -> None:
    for name, values in arrays.items():
        array = numpy_to_vtk(values, deep=copy)
        array.SetName(name)
        attributes.AddArray(array)


def to_polydata(surface: Surface):
    """A surface as vtkPolyData, with its normals ("Normals") and fields. The arrays are copies."""
    return _fill(vtkPolyData(), surface, copy=True)


def _fill(out, surface: Surface, *, copy: bool):
    """Without `copy` the surface must be left alone afterwards: VTK may write to its points and fields.

    Triangles are always copied: vtkCellArray.SetData() makes arrays of its own on the memory of those given, and lets go
    of the Python object that keeps that memory.
    """
    points = vtkPoints()
    points.SetData(numpy_to_vtk(surface.points, deep=copy))
    triangles = surface.triangles.reshape(-1)
    fits = triangles.dtype == np.uint32 and len(surface.points) < 2**31
    triangles = triangles.view(np.int32) if fits else triangles.astype(np.int64)
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(triangles, deep=True))
    out.SetPoints(points)
    out.SetPolys(cells)
    _add_arrays(out.GetPointData(), surface.fields, copy)
    _add_arrays(out.GetCellData(), surface.cell_fields, copy)
    normals = surface.normals
    if normals is not None:
        array = numpy_to_vtk(normals, deep=copy)
        array.SetName("Normals")
        (out.GetPointData() if surface._has_vertex_normals else out.GetCellData()).SetNormals(array)
    return out


class _Session:
    """A session for one grid of VTK's, which may change at any time.

    Cells are taken for the same while VTK's modified times say so, as VTK's own filters do. Points and values are compared
    with what they were: NumPy code that changes them in place leaves no other trace.
    """

    def __init__(self):
        self._session: _isotet.Contour | None = None
        self._cells: _isotet.Cells | None = None
        self._times: tuple[int, ...] = ()
        self.update = "grid"  # what the last set() found to differ

    @staticmethod
    def times_of(grid) -> tuple[int, ...]:
        """Modified times of the cells. VTK never gives the same one twice, so they tell arrays apart, too."""
        cells, types = grid.GetCells(), _types_of(grid)
        parts = (cells, cells.GetConnectivityArray(), cells.GetOffsetsArray(), types) if cells else (types,)
        parts += (grid.GetCellGhostArray(),)
        return tuple(part.GetMTime() for part in parts if part is not None)

    def contour(self, grid, scalars, isovalues: list[float], **how) -> Surface:
        self.set(grid, scalars, **how)
        assert self._session is not None
        return Surface._of(*self._session.extract(isovalues, call_options(0, None)))

    def _input(self, grid, scalars, numbers: np.ndarray | None = None) -> tuple[_isotet.Grid, _isotet.PointField]:
        times = self.times_of(grid)
        if self._cells is None or times != self._times:  # equal cells in other arrays: the session finds it out
            self._cells, self._times = _cells_of(grid), times
        name = scalars.GetName() or "scalars"
        field = _isotet.PointField(name, scalars_in(name, vtk_to_numpy(scalars)))
        return _isotet.Grid(_points_of(grid), self._cells, [], [], numbers), field

    def survey(self, grid, scalars, fields: list[tuple[str, np.ndarray]]) -> bytes:
        return _isotet.survey(*self._input(grid, scalars), fields, False, call_options(0, None))

    def set(self, grid, scalars, *, normals: bool, surfaces: int, fields: list[tuple[str, np.ndarray]],
            cell_fields: list[tuple[str, np.ndarray]], precision: str = "float32", numbers: np.ndarray | None = None,
            frame: _isotet.Frame | None = None,
            tolerances: tuple[float | None, float | None, float, float] = (None, None, 0.0, 0.0)) -> None:  # fmt: skip
        mine, field = self._input(grid, scalars, numbers)
        kind = "gradient" if normals else "none"
        options = _isotet.ContourOptions(kind, False, False, "merge", precision, None, surfaces, False, frame, *tolerances)
        call = call_options(0, None)
        if self._session is None:
            self._session, self.update = _isotet.Contour(mine, field, fields, cell_fields, options, call), "grid"
        else:
            self.update = self._session.set(mine, field, fields, cell_fields, options, call)

    def prepare(self) -> None:
        assert self._session is not None
        self._session.prepare(call_options(0, None))


def _says_nothing_to_contour(error: ValueError) -> bool:
    """Whether the library refused a grid for want of cells that it contours; which they are only it knows."""
    return "no cell that can be contoured" in str(error)


def _levels(lower: float, upper: float, count: int) -> list[float]:
    """VTK's GenerateValues()."""
    return np.linspace(lower, upper, count).tolist()


def _finish(surface: Surface, isovalues: list[float], scalars, compute_scalars: bool, own_cell_fields: bool, out):
    """A surface as vtkContourFilter gives it: the contoured scalars are an array of isovalues."""
    _fill(out, surface, copy=False)
    if len(isovalues) != 1 and not own_cell_fields:
        out.GetCellData().RemoveArray("isovalue")
    if compute_scalars:
        kind = vtk_to_numpy(scalars).dtype
        values = np.repeat(np.array(isovalues, kind if kind.kind == "f" else np.float64), np.array(surface._how["vertex_counts"], np.intp))
        array = numpy_to_vtk(values)
        array.SetName(scalars.GetName())
        out.GetPointData().SetScalars(array)
    return out


def _raised_later(error: BaseException) -> int:
    """A result for VTK, 1, whose end raises an exception of that class in this thread. VTK's wrappers clear what is raised in
    an algorithm; they drop the result when they are done, and the next line of Python raises. It is no failure, which
    observers in Python would be told of: there VTK ends the process."""
    raises = functools.partial(ctypes.pythonapi.PyThreadState_SetAsyncExc, ctypes.c_ulong(threading.get_ident()),
                               ctypes.py_object(type(error)))  # fmt: skip
    return type("RaisedLater", (int,), {"__del__": staticmethod(raises)})(1)


class _Block(NamedTuple):
    """A grid with cells, its scalars, and where its surface goes."""

    number: int
    grid: Any
    scalars: Any
    out: Any

    @property
    def numbers(self):
        return self.grid.GetPointData().GetGlobalIds()

    def fields(self) -> list[tuple[str, np.ndarray]]:
        """The carried point arrays, in the same order on all ranks."""
        return sorted(_arrays_of(self.grid.GetPointData(), self.scalars.GetName()), key=lambda named: named[0])

    def times(self) -> tuple[int, ...]:
        """Modified times of what a frame follows from."""
        parts = [self.grid.GetPoints().GetData(), self.scalars, self.numbers, self.grid.GetPointData()]
        return _Session.times_of(self.grid) + tuple(part.GetMTime() for part in parts if part is not None)


def _leaves(data, out) -> Iterator[tuple[int, Any, Any]]:
    """Number, data set and output of each block; blocks of the output are made here."""
    if not isinstance(data, vtkDataObjectTree):
        yield 0, data, out
        return
    out.CopyStructure(data)
    at = data.NewIterator()
    at.InitTraversal()
    while not at.IsDoneWithTraversal():
        surface = vtkPolyData()
        out.SetDataSet(at, surface)
        yield at.GetCurrentFlatIndex(), at.GetCurrentDataObject(), surface
        at.GoToNextItem()


class IsotetContour(VTKPythonAlgorithmBase):
    """A vtkAlgorithm like vtkContourFilter, for vtkUnstructuredGrid: it follows a moving isovalue.

    The grid is packed when many surfaces are expected (`SetExpectedSurfaces`) or were asked for, and not again while its
    cells and points are the same; another array or time step only stores values. Point and cell arrays are carried.

    Composite data are taken whole: the output has the same blocks, whose surfaces fit bit for bit. `SetController` does the
    same for the ranks of a vtkMultiProcessController.

    >>> import pyvista, isotet.vtk
    >>> sphere = pyvista.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    >>> sphere["r"] = ((sphere.points - 4.0) ** 2).sum(axis=1) ** 0.5
    >>> contour = isotet.vtk.IsotetContour()
    >>> contour.SetInputDataObject(sphere)
    >>> contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    >>> contour.SetValue(0, 2.5)
    >>> done = contour.Update()
    >>> pyvista.wrap(contour.GetOutputDataObject(0)).is_manifold
    True
    """

    def __init__(self):
        super().__init__(nInputPorts=1, inputType="vtkUnstructuredGrid", nOutputPorts=1, outputType="vtkPolyData")
        self._values: list[float] = [0.0]
        self._compute_normals, self._compute_scalars = False, True
        self._expected = 0
        self._precision = "float32"
        self._tolerance = 0.0
        self._controller = None
        self._sessions: dict[int, _Session] = {}  # of the blocks of the last execution, by their numbers
        self._frame: _isotet.Frame | None = None
        self._framed: list[tuple[int, ...]] | None = None  # modified times that the frame follows from
        self.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, 0)

    def _set(self, name: str, value) -> None:
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()

    def SetValue(self, i: int, value: float) -> None:
        values = self._values + [0.0] * (i + 1 - len(self._values))
        values[i] = float(value)
        self._set("_values", values)

    def GetValue(self, i: int) -> float:
        return self._values[i]

    def GetValues(self) -> list[float]:
        return list(self._values)

    def SetNumberOfContours(self, count: int) -> None:
        self._set("_values", (self._values + [0.0] * count)[:count])

    def GetNumberOfContours(self) -> int:
        return len(self._values)

    def GenerateValues(self, count: int, *lower_upper) -> None:
        """`count` values from the first to the last, both included."""
        lower, upper = lower_upper[0] if len(lower_upper) == 1 else lower_upper
        self._set("_values", _levels(lower, upper, count))

    def SetComputeNormals(self, compute: bool) -> None:
        """Normals along the gradient of the field, one a vertex."""
        self._set("_compute_normals", bool(compute))

    def GetComputeNormals(self) -> bool:
        return self._compute_normals

    def SetComputeScalars(self, compute: bool) -> None:
        self._set("_compute_scalars", bool(compute))

    def GetComputeScalars(self) -> bool:
        return self._compute_scalars

    def SetExpectedSurfaces(self, count: int) -> None:
        """How many surfaces will be asked for, over all isovalues and time steps; 0: not known."""
        self._expected = int(count)

    def GetExpectedSurfaces(self) -> int:
        return self._expected

    def SetPrecision(self, precision: str) -> None:
        """In "float32", or "float64": pieces of a grid in double precision meet without knowing of each other."""
        self._set("_precision", precision)

    def GetPrecision(self) -> str:
        return self._precision

    def SetTolerance(self, tolerance: float) -> None:
        """Above 0: quadratic cells are refined until the array is within this of their own field, as a share of its range: 0.001
        is 0.1 %. 0, the default: they are split at their nodes, as they are in pieces of a grid."""
        if not 0 <= tolerance <= 1:
            raise ValueError(f"the tolerance is {tolerance}, but must be a share of the range, 0 to 1")
        self._set("_tolerance", float(tolerance))

    def GetTolerance(self) -> float:
        return self._tolerance

    def SetController(self, controller) -> None:
        """Whose ranks have the pieces of the grid; None, the default: this process has all of it. Every rank must execute the
        filter, those without cells, too; an error on one is an error on all."""
        self._set("_controller", controller)

    def GetController(self):
        return self._controller

    def FillInputPortInformation(self, port, info) -> int:
        info.Set(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), self.InputType)
        info.Append(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), "vtkDataObjectTree")
        return 1

    def FillOutputPortInformation(self, port, info) -> int:
        info.Set(vtkDataObject.DATA_TYPE_NAME(), "vtkDataObject")
        return 1

    def RequestDataObject(self, request, inputs, outputs) -> int:
        data, out = vtkDataObject.GetData(inputs[0], 0), vtkDataObject.GetData(outputs, 0)
        kind = data.GetClassName() if isinstance(data, vtkDataObjectTree) else "vtkPolyData"
        if out is None or out.GetClassName() != kind:
            outputs.GetInformationObject(0).Set(vtkDataObject.DATA_OBJECT(), data.NewInstance() if kind != "vtkPolyData" else vtkPolyData())
        return 1

    def _scalars_of(self, grid):
        """The point array to contour; None where the grid has none."""
        info = self.GetInputArrayInformation(0)
        association = info.Get(vtkDataObject.FIELD_ASSOCIATION())
        if association is not None and association != vtkDataObject.FIELD_ASSOCIATION_POINTS:
            raise ValueError("isotet contours point data, but the array to process is of cells: use vtkCellDataToPointData before, in ParaView Cell Data to Point Data")
        name = info.Get(vtkDataObject.FIELD_NAME())
        return grid.GetPointData().GetArray(name) if name else grid.GetPointData().GetScalars()

    def _missing(self, grid) -> ValueError:
        name = self.GetInputArrayInformation(0).Get(vtkDataObject.FIELD_NAME())
        if not name:
            return ValueError("there are no active point scalars")
        text = f"there is no point array '{name}'"
        if grid.GetCellData().HasArray(name):
            text += ", but a cell array: use vtkCellDataToPointData before, in ParaView Cell Data to Point Data"
        return ValueError(text)

    def _match_sessions(self, blocks: list[_Block]) -> None:
        """Each block keeps the session that knows its cells, else that of its number, which compares what the cells hold.
        Sessions of blocks that are gone go, too."""
        before = dict(self._sessions)
        matched: dict[int, _Session] = {}
        numbers = {session._times: number for number, session in before.items()}
        for block in blocks:
            number = numbers.get(_Session.times_of(block.grid))
            if number in before:
                matched[block.number] = before.pop(number)
        self._sessions = {block.number: matched.get(block.number) or before.pop(block.number, None) or _Session() for block in blocks}

    def _blocks_of(self, data, out) -> tuple[list[_Block], Exception | None]:
        """The grids that have the array; of composite data others stay empty. And what to say if no grid has it."""
        blocks, missing = [], None
        for number, grid, surface in _leaves(data, out):
            if grid is None or grid.GetNumberOfCells() == 0:
                continue
            if not isinstance(grid, vtkUnstructuredGrid):
                raise ValueError(f"block {number} is a {grid.GetClassName()}, but isotet contours vtkUnstructuredGrid")
            surface.GetFieldData().PassData(grid.GetFieldData())
            scalars = self._scalars_of(grid)
            if scalars is not None:
                blocks.append(_Block(number, grid, scalars, surface))
            elif surface is out:
                raise self._missing(grid)
            else:
                missing = missing or self._missing(grid)
        return blocks, missing

    def _surveys_of(self, blocks: list[_Block], ranks: Ranks, *, carried: bool) -> list[bytes]:
        """Of all blocks of all ranks, with the carried fields or without."""
        mine, failure = [], None
        try:
            for block in blocks:
                fields = block.fields() if carried else []
                mine.append(self._sessions[block.number].survey(block.grid, block.scalars, fields))
        except BaseException as error:  # noqa: BLE001 - the other ranks wait for this one
            failure = error
        ranks.agree(failure)
        return [survey for surveys in ranks.gather_objects(mine) for survey in surveys]

    def _make_frame(self, blocks: list[_Block], ranks: Ranks) -> None:
        """One frame for all; None where there is no cell, or points or scalars are not of one type."""
        self._frame = None
        for carried in (True, False):  # carried fields need not be the same in all pieces
            surveys = self._surveys_of(blocks, ranks, carried=carried)
            try:
                self._frame = _isotet.make_frame(surveys) if surveys else None
                return
            except ValueError:  # on all ranks alike
                continue

    def _agree(self, blocks: list[_Block], missing: Exception | None,
               failure: BaseException | None) -> tuple[Ranks, bool]:
        """What all ranks must know before one extracts; and whether all points have global ids. Raises alike on all."""
        ranks = Ranks(self._controller)
        times = [block.times() for block in blocks] if failure is None else None
        failed, changed, found, lacks, many, unnumbered = ranks.any(
            [failure is not None, times is None or times != self._framed, bool(blocks), missing is not None, len(blocks) > 1,
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

    def _contour(self, block: _Block, framed: bool, numbered: bool) -> None:
        precision, frame, numbers = self._precision, None, None
        if framed:
            frame = self._frame
            precision = precision if frame is not None else "float64"  # fits where types differ, but for one rounding
            numbers = vtk_to_numpy(block.numbers) if numbered else None
        cell_fields = _arrays_of(block.grid.GetCellData())
        surface = self._sessions[block.number].contour(
            block.grid, block.scalars, self._values, normals=self._compute_normals, surfaces=self._expected,
            fields=block.fields(), cell_fields=cell_fields, precision=precision, numbers=numbers, frame=frame,
            tolerances=(None, None if framed else self._tolerance or None, 0.0, 0.0))  # fmt: skip
        own = any(name == "isovalue" for name, _ in cell_fields)
        _finish(surface, self._values, block.scalars, self._compute_scalars, own, block.out)

    def RequestData(self, request, inputs, outputs) -> int:
        blocks, missing, failure = [], None, None
        out = vtkDataObject.GetData(outputs, 0)
        try:
            try:
                blocks, missing = self._blocks_of(vtkDataObject.GetData(inputs[0], 0), out)
                self._match_sessions(blocks)
            except BaseException as error:  # noqa: BLE001 - the other ranks wait for this one
                failure = error
            ranks, numbered = self._agree(blocks, missing, failure)
            try:
                for block in blocks:
                    self._contour(block, self._framed is not None, numbered)
            except BaseException as error:  # noqa: BLE001
                failure = error
            ranks.agree(failure)
        except BaseException as error:  # noqa: BLE001 - VTK would say that a method failed, and not why
            for block in blocks:
                block.out.Initialize()
            if not isinstance(failure or error, Exception):  # as KeyboardInterrupt
                outputs.GetInformationObject(0).Set(vtkDemandDrivenPipeline.DATA_NOT_GENERATED(), 1)
                return _raised_later(failure or error)
            self._fail(error)
            return 0
        return 1

    def _fail(self, error: Exception) -> None:
        """Tells VTK's observers, or its log where there are none."""
        if self.HasObserver("ErrorEvent"):
            self.InvokeEvent("ErrorEvent", str(error))
        else:
            from vtkmodules.vtkCommonCore import vtkLogger

            vtkLogger.Log(vtkLogger.VERBOSITY_ERROR, __file__, 0, f"IsotetContour: {error}")
