# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet in PyVista, found by entry points: no import of this is needed.

``mesh.isotet.contour(...)`` for all grids, PolyData and MultiBlock; ``plotter.isotet.add_isovalue(...)``.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyvista
from vtkmodules.util.numpy_support import numpy_to_vtk

from . import _isotet
from ._arrays import direction_in, isovalues_in, place_in, tolerances_in
from ._call import call_options
from ._grid import Clipper, Grid, Solids
from ._surface import Surface, parts
from ._vtk_data import Scalars, arrays_of, carried_of, cells_of, fill, fill_unstructured, keep_active, points_of, scalars_of, some_cells, other_cells, surface_of, to_polydata
from ._vtk_fallback import REASON, Wishes, append, append_other_cells, contour_by_vtk
from ._vtk_session import Session, contour_all, finish, levels

_STRUCTURED = (pyvista.StructuredGrid, pyvista.ExplicitStructuredGrid, pyvista.RectilinearGrid, pyvista.ImageData)
MANY = 1 << 20  # surfaces that a slider may ask for


class MissingArrayError(TypeError, KeyError):
    """There is no such array: a TypeError as PyVista's, and a KeyError."""


def _check_method(method: str) -> None:
    if method not in ("contour", "marching_cubes", "flying_edges"):
        raise ValueError(f"Method '{method}' is not supported")
    if method != "contour":
        warnings.warn(f"isotet has a method of its own: method='{method}' is ignored", stacklevel=4)


def _scalars_name(mesh, scalars) -> str:
    """The name of the array to contour; an array is stored as "Contour Data", as pyvista does."""
    if isinstance(scalars, str):
        return scalars
    if scalars is None:
        if mesh.active_scalars_name is None:
            from pyvista.core.utilities.arrays import set_default_active_scalars

            set_default_active_scalars(mesh)
        return mesh.active_scalars_name
    if isinstance(scalars, (Sequence, np.ndarray)):
        mesh["Contour Data"] = scalars
        return "Contour Data"
    raise TypeError(f"Invalid type for `scalars` ({type(scalars)}). Should be either a numpy.ndarray, a string, or None.")


def find_scalars(mesh, scalars, preference: str) -> tuple[str, bool]:
    """The name of an array, or of a component as "v:x" or "v:mag", and whether it is one of cells. These are taken where
    `preference` is "cell"."""
    if preference not in ("point", "cell"):
        raise ValueError(f"preference is {preference!r}, but must be 'point' or 'cell'")
    if mesh.n_arrays < 1 and not isinstance(scalars, (Sequence, np.ndarray)):
        raise ValueError("Input dataset for the contour filter must have scalar.")
    name = _scalars_name(mesh, scalars)
    for found in (name, name.rpartition(":")[0]):
        if preference == "cell" and found in mesh.cell_data:
            return name, True
        if found in mesh.point_data:
            return name, False
        if found in mesh.cell_data:
            raise TypeError(f"Contour filter only works on point data. '{found}' is cell data: with preference='cell' it is "
                            "averaged to the points.")  # fmt: skip
    if ":" in name or _isotet.looks_like_expression(name):  # the vector may be stored as several arrays
        return name, preference == "cell"
    raise MissingArrayError(f"there is no array '{name}': the mesh has {', '.join(mesh.array_names) or 'none'}")


def _component(mesh, cells, name: str, of_cells: bool) -> Scalars:
    arrays = arrays_of(mesh.GetCellData() if of_cells else mesh.GetPointData())
    grid = _isotet.Grid(points_of(cells), cells_of(cells), *(([], arrays) if of_cells else (arrays, [])))
    values = _isotet.find_field(grid, name, False, False, call_options(0, None)).values
    array = numpy_to_vtk(values)
    array.SetName(name)
    return Scalars(name, array, values)


def _isovalues(isosurfaces, rng, range_of_data) -> list[float]:
    if not isinstance(isosurfaces, (int, np.integer)) or isinstance(isosurfaces, bool):
        return isovalues_in(isosurfaces)
    ends = [float(end) for end in range_of_data()] if rng is None else _ends_of("rng", rng)
    if not np.isfinite(ends).all():
        raise ValueError(f"the field has values from {ends[0]} to {ends[1]}: give isovalues, or rng")
    return levels(ends[0], ends[1], int(isosurfaces))


def _ends_of(what: str, ends) -> list[float]:
    array = np.asarray(ends)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{what} is {ends!r}, but must be two numbers")
    if array.shape != (2,):
        raise ValueError(f"{what} has shape {array.shape} which is not allowed: it must be two numbers")
    lower, upper = array.tolist()
    if not lower <= upper:
        raise ValueError(f"{what} is {lower} to {upper}, but must be sorted: it must ascend")
    return [float(lower), float(upper)]


def _clips(value, invert: bool, both: bool) -> list[dict[str, float]]:
    """What `Clipper.clip` takes, for each grid that clip_scalar returns."""
    if np.ndim(value):
        lower, upper = _ends_of("value", value)
        if both or not invert:
            raise ValueError(f"value is the range {lower} to {upper}, but with invert=False or both=True must be one number")
        return [{"above": lower, "below": upper}]
    if not np.isfinite(value):
        raise ValueError(f"value is {value}, but must be finite")
    sides = [{"below": float(value)}, {"above": float(value)}]
    return (sides if invert else sides[::-1])[: 2 if both else 1]


def _keep_meta(mesh, out) -> None:
    """Of the arrays that `out` has of `mesh`, what PyVista's own filters keep: which are active, bool and complex ones."""
    keep_active(mesh, out)
    out.copy_meta_from(mesh, deep=True)
    found = mesh.active_scalars_info
    of_cells = found.association == pyvista.FieldAssociation.CELL
    if found.name and found.name in (out.cell_data if of_cells else out.point_data):
        out.set_active_scalars(found.name, preference="cell" if of_cells else "point")


class GridAccessor:
    """``grid.isotet`` of a pyvista.UnstructuredGrid."""

    def __init__(self, grid: pyvista.UnstructuredGrid):
        self._grid = grid
        self._session = Session()
        self._expected = 0

    def __repr__(self) -> str:
        return f"<isotet of a {type(self._grid).__name__}: {self._session!r}>"

    def _unstructured(self) -> pyvista.UnstructuredGrid:
        """Its cells and points; arrays are taken from `_grid`."""
        return self._grid

    def _scalars(self, scalars, preference: str) -> tuple[Scalars, bool]:
        name, of_cells = find_scalars(self._grid, scalars, preference)
        data = self._grid.GetCellData() if of_cells else self._grid.GetPointData()
        array, cells = data.GetArray(name), self._unstructured()
        if array is None:
            return _component(self._grid, cells, name, of_cells), False
        return scalars_of(cells, array, of_cells), of_cells

    def _range_of(self, scalars: Scalars) -> tuple[float, float]:
        name = scalars.array.GetName()
        if scalars.replaced is None and name:  # a vector: the range of all components, as PyVista's
            return self._grid.get_data_range(name, preference="point")
        values = scalars.values[~np.isnan(scalars.values)] if scalars.values.dtype.kind == "f" else scalars.values
        return (values.min(), values.max()) if len(values) else (np.nan, np.nan)

    def contour(self, isosurfaces: int | Sequence[float] = 10, scalars=None, compute_normals: bool = False,
                compute_gradients: bool = False, compute_scalars: bool = True, rng=None, preference: str = "point",
                method: str = "contour", progress_bar: bool = False, *, tolerance: float | str | None = None,
                geometry_tolerance: float = 0.0, distance: float = 0.0) -> pyvista.PolyData:  # fmt: skip
        """Isosurfaces, as of `pyvista.UnstructuredGrid.contour`, whose parameters and array names these are.

        isosurfaces
            How many, evenly over the range with both ends; or isovalues. Of several each cell has its own as the cell array
            "isovalue".
        scalars
            The name of an array, or of a component of it, as "v:x", "v:2" or "v:mag", without which a vector's first is
            taken; or one value a point, which is stored as "Contour Data"; else the active scalars.
        compute_normals
            Normals of the field's gradient, one a vertex, as "Normals".
        compute_scalars
            The isovalue at each vertex, under the name of the scalars.
        rng
            The range for a number of isosurfaces; else that of the data.
        preference
            "cell": a cell array is taken where there is one of that name, and averaged to the points by volumes.
        compute_gradients, progress_bar
            Accepted, without effect. `method` is, too, with a warning.
        tolerance, geometry_tolerance, distance
            Curved cells are refined for the isovalues, as by `isotet.Grid.contour`: 0.1 or "0.1%"; without it they are
            split at their nodes.

        Cells that isotet does not contour VTK does, with a warning.

        The grid is packed when this pays; what was packed is kept, and used while cells and points are the same. After
        cells were changed in place through NumPy, call ``grid.Modified()`` of their arrays, as for VTK's filters.

        Raises TypeError for cell data without ``preference="cell"`` and for arrays that are not there, ValueError for broken
        grids and isovalues that are not finite.
        """
        _check_method(method)
        chosen, of_cells = self._scalars(scalars, preference)
        values = _isovalues(isosurfaces, rng, lambda: self._range_of(chosen))
        out = pyvista.PolyData()
        if self._grid.n_cells == 0 or not values:
            return out
        self._extract(
            chosen, values, out, compute_scalars, normals=compute_normals,
            tolerances=tolerances_in(tolerance, geometry_tolerance, distance))  # fmt: skip
        self._add_others(Wishes(values, compute_normals, compute_scalars, cell_isovalues=True), chosen, of_cells, out)
        out.GetFieldData().PassData(self._grid.GetFieldData())
        _keep_meta(self._grid, out)
        return out

    def _extract(self, scalars: Scalars, values: list[float], out, compute_scalars: bool, *, normals: bool, **how) -> None:
        """What isotet contours of the grid."""
        grid, cells = self._grid, self._unstructured()
        fields, cell_fields = carried_of(grid.GetPointData(), scalars.replaced), carried_of(grid.GetCellData())
        if normals:
            fields = [named for named in fields if named[0] != "Normals"]
        how.update(grid=cells, scalars=scalars, normals=normals, surfaces=self._expected, fields=fields, cell_fields=cell_fields)
        session = self._session
        with session.lock:
            session.look_at(cells)
            if session.others == cells.n_cells:
                return
            (surface,) = contour_all([(session, how)], values)
            known = session.others + session.empty_cells
        left_out = cells.n_cells if surface is None else surface._how["cells_left_out"]
        self._warn_of_cells("leaves out", left_out and left_out - known)
        if surface is None:
            return
        finish(surface, values, scalars, fields, compute_scalars, True, out)

    def _add_others(self, wishes: Wishes, scalars: Scalars, of_cells: bool, out) -> None:
        """What VTK contours of it."""
        cells = self._unstructured()
        others = self._session.others
        if others and others == cells.n_cells:
            append(contour_by_vtk(self._grid, scalars, of_cells, wishes), out)
        elif others:
            append_other_cells(self._grid, scalars, of_cells, wishes, out)
        self._warn_of_cells("leaves to VTK", others)

    def _warn_of_cells(self, what: str, count: int) -> None:
        if count > 0:
            warnings.warn(f"isotet {what} {count} of {self._grid.n_cells} cells: {REASON}", stacklevel=4)

    def slice(self, normal="x", origin=None, generate_triangles: bool = False, contour: bool = False,
              progress_bar: bool = False, *, tolerance: float | str | None = None, geometry_tolerance: float = 0.0,
              distance: float = 0.0) -> pyvista.PolyData:  # fmt: skip
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
        tolerance, geometry_tolerance, distance
            Curved cells are refined, for the carried arrays, too, as by `isotet.Grid.slice`.

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
        field = _isotet.plane_field(points_of(cells), (0.0, 0.0, 0.0), direction, offset, call_options(0, None))
        heights = numpy_to_vtk(field.values)
        self._extract(
            Scalars("", heights, field.values), [offset], out, False, normals=False, refine_for_fields=True,
            tolerances=tolerances_in(tolerance, geometry_tolerance, distance))  # fmt: skip
        if others := self._session.others:
            flat = grid if others == cells.n_cells else pyvista.wrap(some_cells(grid, other_cells(grid)))
            append(flat.slice(direction, origin=point), out)
            self._warn_of_cells("leaves to VTK", others)
        out.GetFieldData().PassData(grid.GetFieldData())
        if not contour or grid.active_scalars_name in out.point_data:
            _keep_meta(grid, out)
        return out.contour() if contour else out

    def slice_orthogonal(self, x=None, y=None, z=None, **tolerances) -> pyvista.MultiBlock:
        """Three slices, as of `pyvista.DataSet.slice_orthogonal`: blocks "YZ", "XZ" and "XY" through a point; else the centre.
        `tolerances` are those of `slice`."""
        centre = self._grid.center
        point = [centre[i] if place is None else float(place) for i, place in enumerate((x, y, z))]
        names = {"YZ": "x", "XZ": "y", "XY": "z"}
        return pyvista.MultiBlock({name: self.slice(axis, point, **tolerances) for name, axis in names.items()})

    def slice_along_axis(self, n: int = 5, axis: str | int = "x", tolerance: float | str | None = None,
                         **tolerances) -> pyvista.MultiBlock:  # fmt: skip
        """`n` slices evenly along an axis, "x" or 0 and so on, from end to end, as of `pyvista.DataSet.slice_along_axis`: blocks
        "slice0" and on. A number as `tolerance` is PyVista's: how far the first and the last are from the ends, else a
        hundredth of the whole. A text such as "0.1%" and `tolerances` are those of `slice`."""
        if axis not in ("x", "y", "z", 0, 1, 2):
            raise ValueError(f"axis is {axis!r}, but must be 'x', 'y' or 'z', or 0, 1 or 2")
        along = "xyz".index(axis) if isinstance(axis, str) else int(axis)
        bounds, centre = self._grid.bounds, list(self._grid.center)
        ends = np.array(bounds[2 * along : 2 * along + 2], float)
        if tolerance is None or isinstance(tolerance, str):
            padding = (ends[1] - ends[0]) * 0.01  # a cut in the boundary may be empty
            tolerances["tolerance"] = tolerance
        else:
            padding = tolerance
        ends += np.array([1, -1]) * padding
        out = pyvista.MultiBlock()
        for i, place in enumerate(np.linspace(*ends, n)):
            centre[along] = place
            out.append(self.slice("xyz"[along], centre, **tolerances), f"slice{i}")
        return out

    def solid(self, scalars=None, *, above: float | None = None, below: float | None = None, preference: str = "point",
              compute_normals: bool = False) -> pyvista.PolyData:  # fmt: skip
        """The part of the grid where an array is at least `above` and less than `below`, as a closed surface whose triangles
        face outwards; all arrays are carried. Its cell array "boundary" is 0 on isosurfaces and 1 on the boundary of the grid,
        its field data "volume" that of the solid.

        Raises ValueError where neither is given, and as `contour`.
        """
        chosen, _ = self._scalars(scalars, preference)
        cells, grid = self._unstructured(), self._grid
        out = pyvista.PolyData()
        if grid.n_cells == 0:
            return out
        fields, cell_fields = arrays_of(grid.GetPointData()), arrays_of(grid.GetCellData())
        whole = Grid._of(_isotet.Grid(points_of(cells), cells_of(cells), fields, cell_fields))
        solids = Solids(whole, chosen.values, fields=dict(fields), cell_fields=dict(cell_fields),
                        normals="vertex" if compute_normals else "none")  # fmt: skip
        surface = solids.solid(above=above, below=below)
        fill(out, surface, copy=False, kinds={name: values.dtype for name, values in fields})
        out.GetFieldData().PassData(grid.GetFieldData())
        out.field_data["volume"] = [surface.solid["volume"]] if surface.solid else [0.0]
        _keep_meta(grid, out)
        return out

    def clip_scalar(self, scalars=None, invert: bool = True, value: float | Sequence[float] = 0.0, inplace: bool = False,
                    progress_bar: bool = False, both: bool = False):  # fmt: skip
        """The cells on one side of an isovalue, cut there, as of `pyvista.DataSet.clip_scalar`, whose parameters these are. Whole
        cells stay as they are; the pieces of others fit together, and may be polyhedra. The cell array "source_cell" has the
        number of the cell that each comes from.

        value
            The isovalue; or two, between which cells are kept.
        invert
            True keeps what is below the value, False what is not.
        both
            Returns both sides: that which `invert` asks for, and the other.
        inplace
            The grid becomes the result; an UnstructuredGrid only.
        progress_bar
            Accepted, without effect.

        Raises TypeError for cell data, ValueError for broken grids, for a value that is not finite, and for two with both or
        without invert.
        """
        grid, cells = self._grid, self._unstructured()
        chosen, _ = self._scalars(scalars, "point")
        if inplace and not isinstance(grid, pyvista.UnstructuredGrid):
            raise TypeError(f"a {type(grid).__name__} cannot become its clipped cells: inplace must be False")
        clips = _clips(value, invert, both)
        fields, cell_fields = arrays_of(grid.GetPointData()), arrays_of(grid.GetCellData(), "source_cell")
        whole = Grid._of(_isotet.Grid(points_of(cells), cells_of(cells), fields, cell_fields))
        if grid.n_cells:
            clipper = Clipper(whole, chosen.values, fields=dict(fields), cell_fields=dict(cell_fields))
            kinds = {name: values.dtype for name, values in fields}
            sides = [fill_unstructured(pyvista.UnstructuredGrid(), clipper.clip(**clip), kinds=kinds) for clip in clips]
        else:
            sides = [pyvista.UnstructuredGrid() for _ in clips]
        for side in sides:
            side.GetFieldData().PassData(grid.GetFieldData())
            _keep_meta(grid, side)
        if inplace:
            grid.copy_from(sides[0])
            sides[0] = grid
        return tuple(sides) if both else sides[0]

    def pack(self, scalars=None, *, compute_normals: bool = False, preference: str = "point") -> None:
        """Packs the grid now, and keeps it packed for all contours to come, instead of when so many were asked for that it pays.
        Cell arrays and normals may come later."""
        self._expected = MANY
        chosen, _ = self._scalars(scalars, preference)
        session = self._session
        with session.lock:
            session.look_at(self._unstructured())
            session.pack(self._unstructured(), chosen, normals=compute_normals, surfaces=MANY, fields=[], cell_fields=[])

    @property
    def report(self) -> dict[str, Any]:
        """Of the last surface: "update", what was found to differ from the one before ("nothing", "field", "points" or "grid");
        "method", "direct" or "clusters"; "pack_seconds" and "extract_seconds"; and "packed_bytes", 0 where nothing is packed."""
        return self._session.report

    def clear(self) -> None:
        """Frees what was packed."""
        self._session, self._expected = Session(), 0


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
        if grid.IsA("vtkPointSet"):
            self._cells.SetPoints(grid.GetPoints())
        return self._cells

    def clear(self) -> None:
        super().clear()
        self._cells = None


class PolyDataAccessor(GridAccessor):
    """``mesh.isotet`` of a pyvista.PolyData: isolines by VTK, and what can be done with surfaces of triangles."""

    def _unstructured(self) -> pyvista.UnstructuredGrid:
        return self._grid.cast_to_unstructured_grid()

    def _surface(self) -> Surface:
        return surface_of(self._grid)

    def _polydata(self, surface: Surface) -> pyvista.PolyData:
        out = pyvista.wrap(to_polydata(surface))
        out.GetFieldData().PassData(self._grid.GetFieldData())
        if "volume" in out.field_data and "boundary" in surface.cell_fields:  # a solid's
            out.field_data["volume"] = [_isotet.measure_solid(surface._surface, call_options(0, None))["volume"]]
        _keep_meta(self._grid, out)
        return out

    def decimate(self, target_reduction: float = 0.5, *, error: float | None = None) -> pyvista.PolyData:
        """Fewer triangles, by the share `target_reduction`, as of `pyvista.PolyData.decimate`, by meshoptimizer: closed surfaces
        stay closed, point arrays are kept. `error`: how far it may move, as of `isotet.Surface.reduce`."""
        return self._polydata(self._surface().reduce(target_reduction, error))

    def extract_largest(self) -> pyvista.PolyData:
        """The connected part with the largest area, as of `pyvista.DataSet.extract_largest`; of nothing, nothing."""
        surface = self._surface()
        return self._polydata(surface.keep_parts(0) if len(surface.triangles) else surface)

    def split_bodies(self) -> pyvista.MultiBlock:
        """The connected parts, largest area first, as of `pyvista.DataSet.split_bodies`."""
        surface = self._surface()
        return pyvista.MultiBlock([self._polydata(surface.keep_parts(i)) for i in range(len(parts(surface)))])

    def parts(self) -> list[dict[str, Any]]:
        """The connected parts in numbers, as `isotet.parts` tells them."""
        return parts(self._surface())


class BlocksAccessor:
    """``blocks.isotet`` of a pyvista.MultiBlock."""

    def __init__(self, blocks: pyvista.MultiBlock):
        self._blocks = blocks

    def contour(self, isosurfaces: int | Sequence[float] = 10, scalars: str | None = None, compute_normals: bool = False,
                compute_gradients: bool = False, compute_scalars: bool = True, rng=None, preference: str = "point",
                method: str = "contour", progress_bar: bool = False, **tolerances) -> pyvista.MultiBlock:  # fmt: skip
        """Isosurfaces of every block, in a MultiBlock of the same structure: the same isovalues for all of them.

        The parameters are those of `GridAccessor.contour`; `scalars` is a name. Blocks that are None, or do not have the
        scalars, give an empty pyvista.PolyData.
        """
        _check_method(method)
        blocks = [block for block in self._leaves(self._blocks) if block is not None]
        if scalars is None:
            scalars = next((block.active_scalars_name for block in blocks if block.active_scalars_name), None)
        if not isinstance(scalars, str):
            raise TypeError("scalars of a MultiBlock must be the name of an array")
        have = [block for block in blocks if _has(block, scalars, preference)]
        if not have:
            raise ValueError(f"no block has {preference} data '{scalars}'")

        def range_of_data():
            ranges = np.array([_range_in(block, scalars, preference) for block in have], float)
            return np.nanmin(ranges[:, 0]), np.nanmax(ranges[:, 1])

        values = _isovalues(isosurfaces, rng, range_of_data)
        how = {"compute_normals": compute_normals, "compute_scalars": compute_scalars, "preference": preference, **tolerances}
        return self._contour_all(self._blocks, values, scalars, how)

    def _leaves(self, blocks):
        for block in blocks:
            if isinstance(block, pyvista.MultiBlock):
                yield from self._leaves(block)
            else:
                yield block

    def _contour_all(self, blocks, values, scalars, how) -> pyvista.MultiBlock:
        out = pyvista.MultiBlock()
        for name, block in zip(blocks.keys(), blocks, strict=True):
            if isinstance(block, pyvista.MultiBlock):
                surface = self._contour_all(block, values, scalars, how)
            elif block is None or not _has(block, scalars, how["preference"]):
                surface = pyvista.PolyData()
            else:
                surface = block.isotet.contour(values, scalars, **how)
            out.append(surface, name)
        return out


def _has(block, scalars: str, preference: str) -> bool:
    """Whether it can be contoured by these scalars."""
    if not hasattr(block, "isotet") or block.n_cells == 0:
        return False
    data = block.cell_data if preference == "cell" else block.point_data
    return scalars in data or scalars.rpartition(":")[0] in data or (preference == "cell" and scalars in block.point_data)


def _range_in(block, scalars: str, preference: str) -> tuple[float, float]:
    return block.isotet._range_of(block.isotet._scalars(scalars, preference)[0])


pyvista.register_dataset_accessor("isotet", pyvista.UnstructuredGrid)(GridAccessor)
for _kind in _STRUCTURED:
    pyvista.register_dataset_accessor("isotet", _kind)(StructuredAccessor)
pyvista.register_dataset_accessor("isotet", pyvista.PolyData)(PolyDataAccessor)
pyvista.register_dataset_accessor("isotet", pyvista.MultiBlock)(BlocksAccessor)
