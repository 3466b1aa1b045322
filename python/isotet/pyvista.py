# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet in PyVista, found by entry points: no import of this is needed.

``grid.isotet.contour(...)`` for UnstructuredGrid, the structured ones and MultiBlock, ``plotter.isotet.add_isovalue(...)``.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import pyvista
from vtkmodules.util.numpy_support import numpy_to_vtk

from . import _isotet
from ._arrays import direction_in, isovalues_in, place_in, tolerances_in
from ._call import call_options
from .vtk import IsotetContour, _arrays_of, _fill, _finish, _levels, _points_of, _says_nothing_to_contour, _Session

_STRUCTURED = (pyvista.StructuredGrid, pyvista.ExplicitStructuredGrid, pyvista.RectilinearGrid, pyvista.ImageData)
_MANY = 1 << 20  # surfaces that a slider may ask for


def _check_method(method: str) -> None:
    if method not in ("contour", "marching_cubes", "flying_edges"):
        raise ValueError(f"Method '{method}' is not supported")
    if method != "contour":
        warnings.warn(f"isotet has a method of its own: method='{method}' is ignored", stacklevel=4)


def _scalars_name(grid, scalars) -> str:
    """The name of the array to contour; an array is stored as "Contour Data", as pyvista does."""
    if isinstance(scalars, str):
        return scalars
    if scalars is None:
        if grid.active_scalars_name is None:
            from pyvista.core.utilities.arrays import set_default_active_scalars

            set_default_active_scalars(grid)
        return grid.active_scalars_name
    if isinstance(scalars, (Sequence, np.ndarray)):
        grid["Contour Data"] = scalars
        return "Contour Data"
    raise TypeError(f"Invalid type for `scalars` ({type(scalars)}). Should be either a numpy.ndarray, a string, or None.")


def _isovalues(isosurfaces, rng, range_of_data) -> list[float]:
    if not isinstance(isosurfaces, (int, np.integer)) or isinstance(isosurfaces, bool):
        return isovalues_in(isosurfaces)
    ends = [float(end) for end in range_of_data()] if rng is None else _ends_of(rng)
    if not np.isfinite(ends).all():
        raise ValueError(f"the field has values from {ends[0]} to {ends[1]}: give isovalues, or rng")
    return _levels(ends[0], ends[1], int(isosurfaces))


def _ends_of(rng) -> list[float]:
    array = np.asarray(rng)
    if array.shape != (2,) or array.dtype.kind not in "iuf":
        raise TypeError(f"rng is {rng!r}, but must be two numbers")
    lower, upper = array.tolist()
    if not lower <= upper:
        raise ValueError(f"rng is {lower} to {upper}, but must ascend")
    return [float(lower), float(upper)]


class GridAccessor:
    """``grid.isotet`` of a pyvista.UnstructuredGrid."""

    def __init__(self, grid: pyvista.UnstructuredGrid):
        self._grid = grid
        self._session = _Session()
        self._expected = 0
        self._blank = 0  # cells that are hidden

    def _unstructured(self) -> pyvista.UnstructuredGrid:
        """Its cells and points; arrays are taken from `_grid`."""
        return self._grid

    def _scalars(self, scalars, preference: str):
        grid = self._grid
        if grid.n_arrays < 1 and not isinstance(scalars, (Sequence, np.ndarray)):
            raise ValueError("Input dataset for the contour filter must have scalar.")
        name = _scalars_name(grid, scalars)
        association = grid.get_array_association(name, preference=preference)
        if association != pyvista.FieldAssociation.POINT:
            raise TypeError("Contour filter only works on point data.")
        return grid.GetPointData().GetArray(name)

    def contour(self, isosurfaces: int | Sequence[float] = 10, scalars=None, compute_normals: bool = False,
                compute_gradients: bool = False, compute_scalars: bool = True, rng=None, preference: str = "point",
                method: str = "contour", progress_bar: bool = False, *, tolerance: float | str | None = None,
                geometry_tolerance: float = 0.0, distance: float = 0.0) -> pyvista.PolyData:  # fmt: skip
        """Isosurfaces, as of `pyvista.UnstructuredGrid.contour`, whose parameters and array names these are.

        isosurfaces
            How many, evenly over the range with both ends; or isovalues.
        scalars
            A name of point data, or one value a point, which is stored as "Contour Data"; else the active scalars.
        compute_normals
            Normals of the field's gradient, one a vertex, as "Normals".
        compute_scalars
            The isovalue at each vertex, under the name of the scalars.
        rng
            The range for a number of isosurfaces; else that of the data.
        preference
            "point" or "cell" where both have an array of that name; cells cannot be contoured.
        compute_gradients, progress_bar
            Accepted, without effect. `method` is, too, with a warning.
        tolerance, geometry_tolerance, distance
            Curved cells are refined for the isovalues, as by `isotet.Grid.contour`: 0.1 or "0.1%"; without it they are
            split at their nodes.

        The grid is packed when this pays; what was packed is kept, and used while cells and points are the same. After
        cells were changed in place through NumPy, call ``grid.Modified()`` of their arrays, as for VTK's filters.

        Raises TypeError for cell data, ValueError for broken grids and isovalues that are not finite.
        """
        _check_method(method)
        grid = self._grid
        array = self._scalars(scalars, preference)
        values = _isovalues(isosurfaces, rng, lambda: grid.get_data_range(array.GetName(), preference="point"))
        out = pyvista.PolyData()
        if grid.n_cells == 0 or not values:
            return out
        cell_fields = _arrays_of(grid.GetCellData())
        try:
            surface = self._session.contour(
                self._unstructured(), array, values, normals=compute_normals, surfaces=self._expected,
                fields=_arrays_of(grid.GetPointData(), array.GetName()), cell_fields=cell_fields,
                tolerances=tolerances_in(tolerance, geometry_tolerance, distance))  # fmt: skip
        except ValueError as error:
            if not _says_nothing_to_contour(error):
                raise
            self._warn_of_cells(grid.n_cells - self._blank)
            out.GetFieldData().PassData(grid.GetFieldData())
            return out
        self._warn_of_cells(surface._how["cells_left_out"] - self._blank)
        _finish(surface, values, array, compute_scalars, any(name == "isovalue" for name, _ in cell_fields), out)
        out.GetFieldData().PassData(grid.GetFieldData())
        return out

    def slice(self, normal="x", origin=None, generate_triangles: bool = False, contour: bool = False,
              progress_bar: bool = False) -> pyvista.PolyData:  # fmt: skip
        """The cut along a plane, as of `pyvista.DataSet.slice`, whose parameters these are. Its triangles share vertices; all
        arrays of points and cells are carried. What was packed for `contour` serves here, too.

        normal
            "x", "y", "z", with a minus too, or three numbers.
        origin
            A point of the plane; else the centre of the grid.
        contour
            The outlines of the active scalars on the cut, instead of it.
        generate_triangles, progress_bar
            Accepted, without effect.

        Raises ValueError for a normal of 0 and for broken grids.
        """
        grid = self._grid
        direction = direction_in("normal", normal)
        point = place_in("origin", grid.center if origin is None else origin)
        out = pyvista.PolyData()
        if grid.n_cells == 0:
            return out
        cells = self._unstructured()
        offset = direction[0] * point[0] + direction[1] * point[1] + direction[2] * point[2]
        field = _isotet.plane_field(_points_of(cells), (0.0, 0.0, 0.0), direction, offset, call_options(0, None))
        heights = numpy_to_vtk(field.values)
        heights.SetName(field.name)
        try:
            surface = self._session.contour(
                cells, heights, [offset], normals=False, surfaces=self._expected,
                fields=_arrays_of(grid.GetPointData()), cell_fields=_arrays_of(grid.GetCellData()))  # fmt: skip
        except ValueError as error:
            if not _says_nothing_to_contour(error):
                raise
            self._warn_of_cells(grid.n_cells - self._blank)
            return out
        self._warn_of_cells(surface._how["cells_left_out"] - self._blank)
        _fill(out, surface, copy=False)
        out.GetFieldData().PassData(grid.GetFieldData())
        if contour and grid.active_scalars_name in out.point_data:
            out.set_active_scalars(grid.active_scalars_name, preference="point")
        return out.contour() if contour else out

    def _warn_of_cells(self, left_out: int) -> None:
        if left_out:
            warnings.warn(f"isotet leaves out {left_out} of {self._grid.n_cells} cells: it contours three-dimensional cells of "
                          "degree 1 to 10, and polyhedra with faces", stacklevel=3)  # fmt: skip

    def pack(self, scalars=None, *, compute_normals: bool = False) -> None:
        """Packs the grid now, and keeps it packed for all contours to come, instead of when so many were asked for that it pays."""
        self._expected = _MANY
        array = self._scalars(scalars, "point")
        cell_fields = _arrays_of(self._grid.GetCellData())
        self._session.set(self._unstructured(), array, normals=compute_normals, surfaces=_MANY, fields=[], cell_fields=cell_fields)
        self._session.prepare()

    def clear(self) -> None:
        """Frees what was packed."""
        self._session, self._expected = _Session(), 0


class StructuredAccessor(GridAccessor):
    """``grid.isotet`` of a pyvista.StructuredGrid, ExplicitStructuredGrid, RectilinearGrid or ImageData: hexahedra."""

    def __init__(self, grid: pyvista.DataSet):
        super().__init__(grid)
        self._cells: pyvista.UnstructuredGrid | None = None
        self._shape: tuple = ()

    def _unstructured(self) -> pyvista.UnstructuredGrid:
        """Made again where the shape has changed. Points of a StructuredGrid are shared, and compared by the session."""
        grid = self._grid
        hidden = [data.GetArray("vtkGhostType") for data in (grid.GetPointData(), grid.GetCellData())]
        shape = (grid.dimensions, [None if array is None else array.GetMTime() for array in hidden])
        if isinstance(grid, pyvista.ImageData):
            shape += (grid.origin, grid.spacing, grid.extent, grid.direction_matrix.tobytes())
        elif isinstance(grid, pyvista.RectilinearGrid):
            shape += (grid.x.tobytes(), grid.y.tobytes(), grid.z.tobytes())
        elif isinstance(grid, pyvista.ExplicitStructuredGrid):
            shape += (grid.GetCells().GetMTime(),)
        if self._cells is None or shape != self._shape:
            bare = grid.copy(deep=False)
            bare.clear_data()
            for data, array in zip((bare.GetPointData(), bare.GetCellData()), hidden, strict=True):
                if array is not None:
                    data.AddArray(array)
            self._cells, self._shape = bare.cast_to_unstructured_grid(), shape
            self._blank = np.count_nonzero(self._cells.celltypes == pyvista.CellType.EMPTY_CELL)
        if grid.IsA("vtkPointSet"):
            self._cells.SetPoints(grid.GetPoints())
        return self._cells

    def clear(self) -> None:
        super().clear()
        self._cells = None


class BlocksAccessor:
    """``blocks.isotet`` of a pyvista.MultiBlock."""

    def __init__(self, blocks: pyvista.MultiBlock):
        self._blocks = blocks

    def contour(self, isosurfaces: int | Sequence[float] = 10, scalars: str | None = None, compute_normals: bool = False,
                compute_gradients: bool = False, compute_scalars: bool = True, rng=None, preference: str = "point",
                method: str = "contour", progress_bar: bool = False) -> pyvista.MultiBlock:  # fmt: skip
        """Isosurfaces of every block, in a MultiBlock of the same structure: the same isovalues for all of them.

        The parameters are those of `GridAccessor.contour`; `scalars` is a name. Blocks that are None, or do not have the
        scalars as point data, give an empty pyvista.PolyData; blocks of other types than grids are converted.
        """
        _check_method(method)
        blocks = [block for block in self._leaves(self._blocks) if block is not None]
        if scalars is None:
            scalars = next((block.active_scalars_name for block in blocks if block.active_scalars_name), None)
        if not isinstance(scalars, str):
            raise TypeError("scalars of a MultiBlock must be the name of an array")
        have = [block for block in blocks if scalars in block.point_data]
        if not have:
            raise ValueError(f"no block has point data '{scalars}'")

        def range_of_data():
            ranges = np.array([block.get_data_range(scalars, preference="point") for block in have], float)
            return np.nanmin(ranges[:, 0]), np.nanmax(ranges[:, 1])

        values = _isovalues(isosurfaces, rng, range_of_data)
        return self._contour_all(self._blocks, values, scalars, compute_normals, compute_scalars)

    def _leaves(self, blocks):
        for block in blocks:
            if isinstance(block, pyvista.MultiBlock):
                yield from self._leaves(block)
            else:
                yield block

    def _contour_all(self, blocks, values, scalars, compute_normals, compute_scalars) -> pyvista.MultiBlock:
        out = pyvista.MultiBlock()
        for name, block in zip(blocks.keys(), blocks, strict=True):
            if isinstance(block, pyvista.MultiBlock):
                surface = self._contour_all(block, values, scalars, compute_normals, compute_scalars)
            elif block is None or scalars not in block.point_data:
                surface = pyvista.PolyData()
            else:
                ours = isinstance(block, (pyvista.UnstructuredGrid, *_STRUCTURED))
                grid = block if ours else block.cast_to_unstructured_grid()
                surface = grid.isotet.contour(values, scalars, compute_normals=compute_normals, compute_scalars=compute_scalars)
            out.append(surface, name)
        return out


class PlotterComponent:
    """``plotter.isotet`` of a pyvista.Plotter."""

    def __init__(self, plotter: pyvista.Plotter):
        self._plotter = plotter

    def add_isovalue(self, grid: pyvista.DataSet, scalars: str | None = None, compute_normals: bool = False,
                     compute_scalars: bool = True, value: float | None = None, rng=None, color_by: str | None = None,
                     title: str | None = None, pointa=(0.4, 0.9), pointb=(0.9, 0.9), widget_color=None,
                     **kwargs):  # fmt: skip
        """An isosurface and a slider for its isovalue, which it follows while the slider is dragged.

        As `pyvista.Plotter.add_mesh_isovalue`; the grid is packed before the plot opens.

        grid
            A pyvista.UnstructuredGrid; others are converted once.
        scalars
            A name of point data; else the active scalars.
        value
            The isovalue at first; else the middle of the range.
        rng
            Both ends of the slider; else the range of the data.
        color_by
            Point data that colours the surface, over its range in the grid; else the scalars do.
        kwargs
            For `pyvista.Plotter.add_mesh`.

        Returns the actor of the surface. Raises TypeError for other meshes and for cell data.
        """
        if not isinstance(grid, (pyvista.UnstructuredGrid, *_STRUCTURED)):
            raise TypeError(f"the mesh is a {type(grid).__name__}, but must be a grid of cells, such as UnstructuredGrid")
        name = _scalars_name(grid, scalars)
        if grid.get_array_association(name, preference="point") != pyvista.FieldAssociation.POINT:
            raise TypeError(f"Contour filter only works on Point data. Array ({name}) is in the Cell data.")
        if not isinstance(grid, pyvista.UnstructuredGrid):
            grid = grid.cast_to_unstructured_grid()
        lower, upper = grid.get_data_range(name, preference="point") if rng is None else rng
        contour = IsotetContour()
        contour.SetExpectedSurfaces(_MANY)
        contour.SetComputeNormals(compute_normals)
        contour.SetComputeScalars(compute_scalars)
        contour.SetInputDataObject(grid)
        contour.SetInputArrayToProcess(0, 0, 0, 0, name)
        contour.SetValue(0, (lower + upper) / 2 if value is None else value)
        contour.Update()

        def moved(value: float) -> None:
            contour.SetValue(0, value)
            contour.Update()

        self._plotter.add_slider_widget(moved, [lower, upper], value=contour.GetValue(0), title=title or name,
                                        pointa=pointa, pointb=pointb, color=widget_color, interaction_event="always")  # fmt: skip
        if color_by is None:
            kwargs.setdefault("clim", [lower, upper])
        else:
            kwargs.setdefault("clim", grid.get_data_range(color_by, preference="point"))
            kwargs["scalars"] = color_by
        return self._plotter.add_mesh(contour, **kwargs)


pyvista.register_dataset_accessor("isotet", pyvista.UnstructuredGrid)(GridAccessor)
for _kind in _STRUCTURED:
    pyvista.register_dataset_accessor("isotet", _kind)(StructuredAccessor)
pyvista.register_dataset_accessor("isotet", pyvista.MultiBlock)(BlocksAccessor)
pyvista.register_plotter_component("isotet")(PlotterComponent)
