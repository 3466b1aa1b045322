# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Data sets of VTK and PyVista as isotet's grids, and surfaces as vtkPolyData."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_ID_TYPE
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData, vtkUnstructuredGrid

from . import _isotet
from ._arrays import points_in, scalars_in, values_in
from ._call import call_options
from ._grid import Grid
from ._meshes import expanded, faces_of
from ._surface import Surface

_TETRAHEDRON, _POLYHEDRON = 10, 42
_GHOSTS, _DUPLICATE = 57, 1  # marks of cells that are another piece's (1), refined, outside or hidden


def types_of(grid):
    """The array of cell types: its method has another name since VTK 9.6."""
    types = grid.GetCellTypes() if hasattr(grid, "GetDistinctCellTypes") else grid.GetCellTypesArray()
    return types if hasattr(types, "GetMTime") else grid.GetCellTypesArray()


def cells_of(grid, marked: int = _GHOSTS) -> _isotet.Cells:
    """The cells of a vtkUnstructuredGrid, shared, without those whose ghost marks have one of the bits `marked`."""
    types = types_of(grid)
    if grid.GetNumberOfCells() == 0 or types is None:
        return _isotet.Cells(np.empty(0, np.int64), None, None, _TETRAHEDRON)
    types = vtk_to_numpy(types)
    if (ghosts := grid.GetCellGhostArray()) is not None:
        types = np.where(vtk_to_numpy(ghosts) & marked, 0, types).astype(np.uint8)
    cells = grid.GetCells()
    connectivity = np.ascontiguousarray(vtk_to_numpy(cells.GetConnectivityArray()))
    if types[0] == _TETRAHEDRON and (types == _TETRAHEDRON).all():
        return _isotet.Cells(connectivity, None, None, _TETRAHEDRON)
    offsets = np.ascontiguousarray(vtk_to_numpy(cells.GetOffsetsArray()))
    return _isotet.Cells(connectivity, offsets, types, _TETRAHEDRON, *_faces_of(grid, types))


def cells_shown(grid) -> tuple[_isotet.Cells, np.ndarray]:
    """All cells but those that are refined, outside or hidden, and for each 1 where it is of another piece."""
    ghosts = grid.GetCellGhostArray()
    marks = np.zeros(grid.GetNumberOfCells(), np.uint8) if ghosts is None else vtk_to_numpy(ghosts) & _DUPLICATE
    return cells_of(grid, _GHOSTS & ~_DUPLICATE), marks.astype(np.uint8)


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


def points_of(grid) -> np.ndarray:
    points = grid.GetPoints()
    return np.empty((0, 3), np.float32) if points is None else points_in(vtk_to_numpy(points.GetData()))


def arrays_of(attributes, leave_out: str | None = None) -> list[tuple[str, np.ndarray]]:
    """The named arrays of numbers of point or cell data, shared."""
    out = []
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(i)  # None for strings
        if array is not None and array.GetName() and array.GetName() != leave_out:
            out.append((array.GetName(), values_in(array.GetName(), vtk_to_numpy(array))))
    return out


def carried_of(attributes, leave_out: str | None = None) -> list[tuple[str, np.ndarray]]:
    """The arrays that VTK's filters carry onto a surface: no global ids, and of points no pedigree ids."""
    ids = [attributes.GetGlobalIds(), attributes.GetPedigreeIds() if attributes.IsA("vtkPointData") else None]
    names = [array.GetName() for array in ids if array is not None]
    return [named for named in arrays_of(attributes, leave_out) if named[0] not in names]


def unstructured_of(data) -> Any:
    """Any vtkDataSet as a vtkUnstructuredGrid: others are converted."""
    if isinstance(data, vtkUnstructuredGrid):
        return data
    if not data.IsA("vtkDataSet"):
        raise TypeError(f"the mesh is a {data.GetClassName()}, but must be one vtkDataSet: take its blocks one by one")
    from vtkmodules.vtkFiltersCore import vtkAppendFilter

    convert = vtkAppendFilter()
    convert.AddInputData(data)
    convert.Update()
    return convert.GetOutput()


def grid_in(data) -> _isotet.Grid:
    """Any vtkDataSet, with fields and global ids. Arrays of unstructured grids are shared."""
    grid = unstructured_of(data)
    ids = grid.GetPointData().GetGlobalIds()
    numbers = None if ids is None else vtk_to_numpy(ids)
    return _isotet.Grid(points_of(grid), cells_of(grid), arrays_of(grid.GetPointData()), arrays_of(grid.GetCellData()), numbers)


def to_unstructured(grid: Grid) -> vtkUnstructuredGrid:
    """A grid as vtkUnstructuredGrid. The arrays are copies."""
    return fill_unstructured(vtkUnstructuredGrid(), grid)


def fill_unstructured(out, grid: Grid, *, kinds: Mapping[str, np.dtype] = MappingProxyType({}), points=None):
    """`kinds` and `points` as of fill()."""
    places = vtkPoints()
    places.SetData(numpy_to_vtk(grid.points if points is None else grid.points.astype(points, copy=False), deep=True))
    out.SetPoints(places)
    connectivity, offsets, types = expanded(grid._grid)
    of_types, cells = numpy_to_vtk(types.astype(np.uint8), deep=True), _cell_array(connectivity, offsets)
    if (types == _POLYHEDRON).any():
        _set_polyhedra(out, grid, of_types, cells)
    else:
        out.SetCells(of_types, cells)
    for name, values in grid.fields.items():
        _add_array(out.GetPointData(), name, kept_type(values, kinds.get(name, values.dtype)), copy=True)
    for name, values in grid.cell_fields.items():
        _add_array(out.GetCellData(), name, values, copy=True)
    return out


def _set_polyhedra(out, grid: Grid, types, cells) -> None:
    if hasattr(out, "SetPolyhedralCells"):
        corners, sizes, counts = faces_of(grid)
        faces = _cell_array(corners, np.append(0, np.cumsum(sizes)))
        out.SetPolyhedralCells(types, cells, _cell_array(np.arange(len(sizes)), np.append(0, np.cumsum(counts))), faces)
        return
    starts = np.asarray(grid.face_offsets, np.int64)  # before VTK 9.4
    places = np.where(np.diff(starts) > 0, starts[:-1], -1)
    out.SetCells(types, cells, *(numpy_to_vtk(array, deep=True, array_type=VTK_ID_TYPE)
                                 for array in (places, np.asarray(grid.faces, np.int64))))  # fmt: skip


def grid_of(grid) -> Grid:
    """A vtkUnstructuredGrid, or pyvista.UnstructuredGrid, as `isotet.Grid`: arrays are shared, and must not change meanwhile."""
    return Grid._of(grid_in(grid))


class Scalars(NamedTuple):
    """What is contoured: one value a point."""

    name: str  # of the array of isovalues on the surface; empty: there is none
    array: Any  # of VTK
    values: np.ndarray

    @property
    def replaced(self) -> str | None:
        """The name of a point array in whose place the surface has isovalues."""
        return self.name if self.name == self.array.GetName() else None


MAGNITUDE = -2  # vtkArrayComponents::L2Norm


def _one_component(array, component: int) -> tuple[str, np.ndarray]:
    """Of an array with several: the first has no array of isovalues of its own, as with VTK."""
    values, name = vtk_to_numpy(array), array.GetName() or "scalars"
    if values.ndim == 1:
        return name, values
    if component == MAGNITUDE:
        return f"{name}_Magnitude", np.linalg.norm(values.astype(np.float64), axis=1)
    if not 0 <= component < values.shape[1]:
        raise ValueError(f"component {component} of '{name}' is asked for, but it has {values.shape[1]}")
    return f"{name}_{component}" if component else "", np.ascontiguousarray(values[:, component])


def scalars_of(grid, array, of_cells: bool = False, component: int = 0) -> Scalars:
    """An array of points, or one of cells, which is averaged to the points by the volumes of the cells around."""
    name, values = _one_component(array, component)
    if not of_cells:
        return Scalars(name, array, scalars_in(name or array.GetName(), values))
    if not isinstance(grid, vtkUnstructuredGrid) or len(other_cells(grid)) == grid.GetNumberOfCells():
        return Scalars(name, array, np.empty(0, np.float32))  # VTK averages what it contours
    only = [("values", np.ascontiguousarray(values))]
    whole = _isotet.Grid(points_of(grid), cells_of(grid, _GHOSTS & ~_DUPLICATE), [], only)
    return Scalars(name, array, _isotet.find_field(whole, "values", True, False, call_options(0, None)).values)


@functools.cache
def _is_contoured() -> np.ndarray:
    """Which of VTK's numbers of cell types isotet contours."""
    return np.array([_isotet.contours_cell(kind) for kind in range(256)])


def other_cells(grid) -> np.ndarray:
    """Numbers of the cells that isotet does not contour, ghosts aside."""
    types = types_of(grid)
    if types is None:
        return np.empty(0, np.int64)
    types = vtk_to_numpy(types)
    others = ~_is_contoured()[types] & (types != 0)
    if others.any() and (ghosts := grid.GetCellGhostArray()) is not None:
        others &= vtk_to_numpy(ghosts) & _GHOSTS == 0
    return np.flatnonzero(others)


def some_cells(grid, chosen: np.ndarray):
    """A vtkUnstructuredGrid of some cells, none of them a polyhedron, with all points."""
    out = vtkUnstructuredGrid()
    out.SetPoints(grid.GetPoints())
    out.GetPointData().ShallowCopy(grid.GetPointData())
    connectivity, offsets = _parts_of(grid.GetCells())
    sizes = np.diff(offsets)[chosen].astype(np.int64)
    ends = np.cumsum(sizes)
    places = np.arange(ends[-1] if len(ends) else 0) + np.repeat(offsets[chosen] - (ends - sizes), sizes)
    cells = _cell_array(connectivity[places], np.append(0, ends))
    out.SetCells(numpy_to_vtk(vtk_to_numpy(types_of(grid))[chosen], deep=True), cells)
    for name, values in arrays_of(grid.GetCellData()):
        _add_array(out.GetCellData(), name, values[chosen], copy=True)
    return out


def kept_type(values: np.ndarray, kind: np.dtype) -> np.ndarray:
    """Interpolated values in the type that they came in: integers are rounded."""
    if kind.kind == "f" or values.dtype == kind:
        return values.astype(kind, copy=False)
    limits = np.iinfo(kind)
    if kind.itemsize == 8:  # the limits are no numbers of float64
        return np.clip(np.rint(values), float(limits.min), np.nextafter(float(limits.max), 0)).astype(kind)
    return np.clip(np.rint(values), limits.min, limits.max).astype(kind)


def _add_array(attributes, name: str, values: np.ndarray, copy: bool):
    # Of int64 NumPy has two types, long and long long, and so has VTK, which appends arrays of one type alone: NumPy's own is long.
    array = numpy_to_vtk(values.view(values.dtype.str), deep=copy)
    array.SetName(name)
    attributes.AddArray(array)
    return array


def keep_active(source, out) -> None:
    """The active arrays of a data set are active in a surface of it, if it has them, as in VTK's filters: scalars in place of
    those that are, others where none are."""
    scalars = vtkDataSetAttributes.SCALARS
    kinds = (*range(scalars, vtkDataSetAttributes.TENSORS + 1), vtkDataSetAttributes.PEDIGREEIDS)
    for its, mine in ((source.GetPointData(), out.GetPointData()), (source.GetCellData(), out.GetCellData())):
        for kind in kinds:
            active = its.GetAbstractAttribute(kind)
            name = active.GetName() if active is not None else None
            if name and mine.HasArray(name) and (kind == scalars or mine.GetAbstractAttribute(kind) is None):
                mine.SetActiveAttribute(name, kind)


def _polygons_alone(mesh):
    """A vtkPolyData without its vertices and lines, of which vtkTriangleFilter leaves cell arrays too short."""
    before = mesh.GetVerts().GetNumberOfCells() + mesh.GetLines().GetNumberOfCells()
    if before == 0:
        return mesh
    out = vtkPolyData()
    out.SetPoints(mesh.GetPoints())
    out.GetPointData().ShallowCopy(mesh.GetPointData())
    out.SetPolys(mesh.GetPolys())
    out.SetStrips(mesh.GetStrips())
    for name, values in arrays_of(mesh.GetCellData()):
        _add_array(out.GetCellData(), name, values[before:], copy=True)
    return out


def _triangulated(mesh):
    mesh = _polygons_alone(mesh)
    if mesh.GetStrips().GetNumberOfCells() == 0 and (np.diff(_parts_of(mesh.GetPolys())[1]) == 3).all():
        return mesh
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter

    cut = vtkTriangleFilter()
    cut.SetInputData(mesh)
    cut.Update()
    return cut.GetOutput()


def surface_of(mesh) -> Surface:
    """The faces of a vtkPolyData as a surface, with its arrays. Faces are cut into triangles, lines and vertices left out."""
    mesh = _triangulated(mesh)
    triangles = _parts_of(mesh.GetPolys())[0].reshape(-1, 3)
    normals = mesh.GetPointData().GetNormals()
    name = None if normals is None else normals.GetName()
    return Surface(points_of(mesh), triangles, normals=None if normals is None else vtk_to_numpy(normals),
                   fields=dict(arrays_of(mesh.GetPointData(), name)), cell_fields=dict(arrays_of(mesh.GetCellData())))  # fmt: skip


def to_polydata(surface: Surface):
    """A surface as vtkPolyData, with its normals ("Normals") and fields. The arrays are copies."""
    return fill(vtkPolyData(), surface, copy=True)


def _triangles_of(surface: Surface) -> vtkCellArray:
    triangles = surface.triangles.reshape(-1)
    fits = triangles.dtype == np.uint32 and len(surface.points) < 2**31
    triangles = triangles.view(np.int32) if fits else triangles.astype(np.int64)
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(triangles, deep=True))
    return cells


def _cell_array(connectivity: np.ndarray, offsets: np.ndarray) -> vtkCellArray:
    cells = vtkCellArray()
    cells.SetData(*(numpy_to_vtk(array.astype(np.int64), deep=True, array_type=VTK_ID_TYPE) for array in (offsets, connectivity)))
    return cells


def fill(out, surface: Surface, *, copy: bool, kinds: Mapping[str, np.dtype] = MappingProxyType({}), points=None,
         polygons: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None):  # fmt: skip
    """Without `copy` the surface must be left alone afterwards: VTK may write to its points and fields. Fields of the names
    `kinds` get these types. The type of points is `points`, else that of the surface. `polygons` stand in place of triangles.

    Triangles are always copied: vtkCellArray.SetData() makes arrays of its own on the memory of those given, and lets go
    of the Python object that keeps that memory.
    """
    places = surface.points if points is None else surface.points.astype(points, copy=False)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(places, deep=copy))
    out.SetPoints(points)
    out.SetPolys(_triangles_of(surface) if polygons is None else _cell_array(*polygons[:2]))
    for name, values in surface.fields.items():
        _add_array(out.GetPointData(), name, kept_type(values, kinds.get(name, values.dtype)), copy)
    for name, values in surface.cell_fields.items():
        _add_array(out.GetCellData(), name, values if polygons is None else values[polygons[2]], copy)
    normals = surface.normals
    if normals is not None:
        array = numpy_to_vtk(normals, deep=copy)
        array.SetName("Normals")
        (out.GetPointData() if surface._has_vertex_normals else out.GetCellData()).SetNormals(array)
    return out


