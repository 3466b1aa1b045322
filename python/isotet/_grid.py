# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Grids, and their surfaces."""

from __future__ import annotations

import math
import os
import tempfile
import weakref
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _isotet
from ._arrays import (
    cells_in, direction_in, fields_in, isovalues_in, middle_of, numbers_in, place_in, points_in, scalars_in, tolerances_in, words_in,
)  # fmt: skip
from ._call import Progress, call_options
from ._meshes import grid_of_mesh, to_meshio
from ._pieces import Frame
from ._surface import Surface

if TYPE_CHECKING:
    import meshio
    import numpy.typing as npt
    import pyvista
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid


class Grid:
    """Points, cells and fields, as they are: arrays are shared with whoever gave them, and must not change meanwhile.

    points
        N x 3 numbers; float32 or float64 are not copied. Or, without cells, a mesh of VTK, PyVista or meshio, whose arrays are
        its fields where none are given; images and structured grids are converted.
    cells, offsets, types
        One of: integers of shape (M, 4) for tetrahedra, (M, 5) pyramids, (M, 6) wedges, (M, 8) hexahedra, with VTK's order
        of corners; meshio's cells (a mapping from "tetra", "hexahedron" and so on to such arrays, or its list of blocks);
        or corners of all cells one after another, with `offsets` (M + 1) and `types` (M, VTK's numbers). Cells that are
        not contoured are left out.
    faces, face_offsets
        With polyhedra (VTK's type 42): for each cell its number of faces, then for each face its number of points and these
        points, in any winding; and M + 1 places where each cell's part begins. Cells of other types have none.
    fields, cell_fields
        Mappings from names to arrays: one row a point, one row a cell.
    point_numbers
        One integer a point, of a piece of a grid: the numbers of its points in the whole grid, which then decide where
        numbers do. See `Frame`.

    Raises ValueError for wrong shapes, TypeError for types that are no numbers. What is wrong inside the arrays is found
    when the grid is contoured.

    >>> import isotet
    >>> grid = isotet.Grid([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]], fields={"T": [0.0, 1.0, 1.0, 1.0]})
    >>> grid
    <isotet.Grid: 4 points, 1 cells, fields T>
    >>> grid.contour(0.5).points.tolist()
    [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]]
    """

    __slots__ = ("_grid", "info", "step", "notes", "__weakref__")

    def __init__(self, points: Any, cells: Any = None, *, offsets: npt.ArrayLike | None = None, types: npt.ArrayLike | None = None,
                 faces: npt.ArrayLike | None = None, face_offsets: npt.ArrayLike | None = None,
                 fields: Mapping[str, Any] | None = None, cell_fields: Mapping[str, Any] | None = None,
                 point_numbers: npt.ArrayLike | None = None) -> None:  # fmt: skip
        self.info: dict[str, Any] = {}
        self.step = 0
        self.notes: list[str] = []
        if cells is None:
            self._grid = grid_of_mesh(points, fields, cell_fields, point_numbers)
            return
        numbers = None if point_numbers is None else numbers_in("point_numbers", point_numbers)
        self._grid = _isotet.Grid(points_in(points), cells_in(cells, offsets, types, faces, face_offsets),
                                  fields_in("fields", fields), fields_in("cell_fields", cell_fields), numbers)  # fmt: skip

    @classmethod
    def _of(cls, grid: _isotet.Grid, info: dict[str, Any] | None = None, step: int = 0, notes: Iterable[str] = ()) -> Grid:
        self = cls.__new__(cls)
        self._grid, self.info, self.step, self.notes = grid, info or {}, step, list(notes)
        return self

    @property
    def points(self) -> np.ndarray:
        """N x 3."""
        return self._grid.points

    @property
    def cells(self) -> np.ndarray:
        """M x corners where all cells are of one type and were given so, else the corners one after another."""
        connectivity, offsets, _, uniform, *_ = self._grid.cells.arrays()
        return connectivity if offsets is not None else connectivity.reshape(-1, {10: 4, 12: 8, 13: 6, 14: 5, 11: 8}[uniform])

    @property
    def offsets(self) -> np.ndarray | None:
        """None where all cells are of one type, else M + 1: where the corners of each cell begin."""
        return self._grid.cells.arrays()[1]

    @property
    def types(self) -> np.ndarray | None:
        """None where all cells are of one type, else M of VTK's numbers."""
        return self._grid.cells.arrays()[2]

    @property
    def faces(self) -> np.ndarray | None:
        """None without polyhedra, else their faces."""
        return self._grid.cells.arrays()[4]

    @property
    def face_offsets(self) -> np.ndarray | None:
        """None without polyhedra, else M + 1: where the faces of each cell begin."""
        return self._grid.cells.arrays()[5]

    @property
    def point_numbers(self) -> np.ndarray | None:
        """One number a point where the grid has them."""
        return self._grid.point_numbers

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """Arrays with one row a point, by name."""
        return self._grid.fields

    @property
    def cell_fields(self) -> dict[str, np.ndarray]:
        """Arrays with one row a cell, by name."""
        return self._grid.cell_fields

    @property
    def first_view(self) -> dict[str, Any]:
        """What to show of the grid where nothing is said, by the rule of the program: "field", a name that `contour` takes, or
        None; "draw": "isosurfaces", or what is drawn of the boundary: "field_on_boundary" where the field jumps from cell to
        cell, "regions_on_boundary" where there are only numbers of regions, "boundary" where nothing varies; "cell_field",
        whether it is one; "why".

        The array that the file marks as its scalars comes first, then names that people contour (alpha, temperature, velocity,
        pressure and others), then what varies most. Ids, ranks, weights, sizes, centres and errors are never taken.

        >>> import isotet
        >>> isotet.make("kuhn", 4, ["plane", "integer"]).first_view["field"]
        'plane'
        """
        return _isotet.first_view(self._grid, self.info.get("marked", []))

    def _field(self, field, call: _isotet.CallOptions | None = None, for_pieces: bool = False,
               centre: str = "mean") -> _isotet.PointField:  # fmt: skip
        """A field by name, or of values."""
        if centre not in ("mean", "own"):
            raise ValueError(f"centre is {centre!r}, but must be 'mean' or 'own'")
        own = centre == "own"
        if own and for_pieces:
            raise ValueError("centre is 'own', but pieces of a grid take 'mean' only")
        if field is None and len(self.fields) + len(self.cell_fields) > 1:
            field = self.first_view["field"]
        if isinstance(field, _isotet.PointField):
            found = field
        elif field is None or isinstance(field, str):
            found = _isotet.find_field(self._grid, field or "", for_pieces, own, call or call_options(0, None))
        else:
            found = _isotet.PointField("values", scalars_in("field", field))
        if own and not found.averaged:
            raise ValueError("centre is 'own', but the field is one of points: it takes the name of a cell field")
        return found

    def _carried(self, fields, of: str) -> list[tuple[str, np.ndarray]]:
        """Fields to carry: of a mapping; or names of fields of the grid."""
        if fields is None:
            return list(self.fields.items()) if of == "fields" else []
        if hasattr(fields, "items"):
            return fields_in(of, fields)
        if isinstance(fields, (str, np.ndarray)):
            raise TypeError(f"{of} is a {type(fields).__name__}, but must be names, or map names to arrays")
        own = getattr(self, of)
        return [(name, own[name] if name in own else self._computed(name, of)) for name in fields]

    def _computed(self, name: str, of: str) -> np.ndarray:
        """An expression or a component, at the points."""
        if of != "fields" or not (_isotet.looks_like_expression(name) or ":" in name):
            raise ValueError(f"{of} has no '{name}': there are {', '.join(getattr(self, of)) or 'none'}")
        return _isotet.find_field(self._grid, name, False, False, call_options(0, None)).values

    def contour(self, isovalues: npt.ArrayLike, field: npt.ArrayLike | str | None = None, *, normals: str = "none",
                fields: Mapping[str, Any] | Iterable[str] | None = None,
                cell_fields: Mapping[str, Any] | Iterable[str] | None = None, edge_ends: bool = False,
                source_cells: bool = False, ties: str = "merge", precision: str = "float32", method: str | None = None,
                split_cells: bool = False, frame: Frame | None = None, tolerance: float | str | None = None,
                geometry_tolerance: float = 0.0, distance: float = 0.0, exact_vertices: bool = False, centre: str = "mean",
                threads: int = 0, progress: Progress | None = None) -> Surface:  # fmt: skip
        """The surface on which a field has a value. Nothing is kept: for many surfaces see `pack` and `Contour`.

        isovalues
            A number in the unit of the field; or several, which give one surface with the cell field "isovalue".
        field
            A name ("p"; "velocity:x" or "velocity:mag" of a vector, also one that is stored as velocity_x, velocity_y and
            velocity_z; a cell field is averaged to the points), or one value a point. Without it that of `first_view`.
        normals
            "none"; "gradient", one a vertex, along the field's gradient; "vertex", one a vertex, the mean of its triangles',
            which follows the surface on thin cells, too; "face", one a triangle.
        fields, cell_fields
            What the surface carries: names (of points also expressions and components), or mappings from names to arrays.
            Without them all `fields` and no `cell_fields`, as the program does.
        edge_ends, source_cells
            Where each vertex lies, and of which cell each triangle is.
        ties
            "merge": edges that meet in a point whose value is the isovalue share a vertex; "keep": one each.
        precision
            Of positions and values inside: "float32" or "float64".
        method
            "direct" or "clusters"; chosen by the number of surfaces otherwise.
        split_cells
            Hexahedra, wedges and pyramids are split into tets, which gives more and smaller triangles.
        frame
            The grid is a piece of one with this frame: its surface is a part of the surface of the whole, bit for bit.
        tolerance
            Curved cells are refined until the field is within this of their own: a number in its unit, or "0.1%" of its
            range; `Surface.field_bound` is what was reached. None: they are split at their nodes, without a bound.
        geometry_tolerance
            With `tolerance`: the tets are at most this far from the curved cells. 0: edges leave them by a hundredth of their
            length at most.
        distance
            Curved cells are refined until the surface is within this of the quadratic field's, by estimate; without a tolerance,
            or beside one.
        exact_vertices
            Vertices are put to where the quadratic field of curved cells has the isovalue on their edges.
        centre
            Of a cell field: the value at the point inside a polyhedron that it is split around. "mean": of its points; "own": the
            cell's own, which may be beyond those around.
        threads
            At most so many; 0: all.
        progress
            Called with the step and the fraction done; an exception of it stops the work, as Ctrl-C does.

        Raises ValueError for wrong arguments or data, MemoryError before more memory is taken than is free.
        """
        values = isovalues_in(isovalues)
        call = call_options(threads, progress)
        words_in(normals=normals, ties=ties, precision=precision)
        options = _isotet.ContourOptions(normals, edge_ends, source_cells, ties, precision, method, len(values),
                                         split_cells, frame and frame._frame,
                                         *tolerances_in(tolerance, geometry_tolerance, distance),
                                         exact_vertices, expected_isovalues=values)  # fmt: skip
        carried = self._carried(fields, "fields")
        if isinstance(field, _isotet.PointField):  # of a cut
            options.refine_for(carried)
        session = _isotet.Contour(self._grid, self._field(field, call, frame is not None, centre), carried,
                                  self._carried(cell_fields, "cell_fields"), options, call)  # fmt: skip
        return Surface._of(*session.extract(values, call))

    def slice(self, normal: npt.ArrayLike | str = "x", origin: npt.ArrayLike | None = None, *,
              offsets: npt.ArrayLike | None = None, **options: Any) -> Surface:  # fmt: skip
        """The cut along a plane, or along several parallel ones, as a surface that carries all fields of points and cells.

        normal
            "x", "y", "z", with a minus for the other way, or three numbers of any length. Triangles face along it.
        origin
            A point of the plane; else the middle of the points' bounds.
        offsets
            In place of an origin: the products of normal and point in the plane (z of the normal "z"), one or several.
        options
            `fields`, `cell_fields` and all else that `contour` takes, but for isovalues and field. With a tolerance curved cells
            are refined for the carried fields, too.

        Raises ValueError for a normal of 0, and as `contour`.

        >>> import isotet
        >>> round(isotet.make("hex", 8, ["sphere"]).slice("z", (0, 0, 0.25)).area, 6)
        4.0
        """
        direction = direction_in("normal", normal)
        if offsets is not None and origin is not None:
            raise ValueError("origin and offsets were given, but one of them says where the plane is")
        if offsets is not None:
            places = isovalues_in(offsets)
        else:
            point = place_in("origin", middle_of(self.points) if origin is None else origin)
            places = [direction[0] * point[0] + direction[1] * point[1] + direction[2] * point[2]]
        return self._cut(_isotet.plane_field, (0, 0, 0), direction, places, options)

    def slice_sphere(self, centre: npt.ArrayLike, radius: npt.ArrayLike, **options: Any) -> Surface:
        """The cut along a sphere, or along several around one point; facing outwards. `options` as for `slice`.

        Raises ValueError for a negative radius, and as `contour`.
        """
        return self._cut(_isotet.sphere_field, place_in("centre", centre), (0, 0, 1), isovalues_in(radius), options)

    def slice_cylinder(self, point: npt.ArrayLike, axis: npt.ArrayLike | str, radius: npt.ArrayLike,
                       **options: Any) -> Surface:  # fmt: skip
        """The cut along a cylinder without ends, or along several around one axis through `point`. `axis` as the `normal` of
        `slice`, `options` as there.

        Raises ValueError for an axis of 0 and a negative radius, and as `contour`.
        """
        place, direction = place_in("point", point), direction_in("axis", axis)
        return self._cut(_isotet.cylinder_field, place, direction, isovalues_in(radius), options)

    def _cut(self, field_of, place, direction, sizes: list[float], options: dict[str, Any]) -> Surface:
        call = call_options(options.get("threads", 0), None)
        field = field_of(self.points, place, direction, min(sizes, default=0.0), call)
        options.setdefault("cell_fields", list(self.cell_fields))
        return self.contour(sizes, field, **options)

    def isovalues_at(self, percents: npt.ArrayLike, field: npt.ArrayLike | str | None = None, *, of: str = "volume",
                     threads: int = 0, progress: Progress | None = None) -> list[float]:  # fmt: skip
        """Isovalues by what lies below them, in percent.

        of
            "volume": of the grid, where the field is linear in each tet; "points": of the point values, that is percentiles, by
            NumPy's method "inverted_cdf".

        Raises ValueError for percents that are not from 0 to 100, and for a field without a finite value.
        """
        if of not in ("volume", "points"):
            raise ValueError(f"of is {of!r}, but must be 'volume' or 'points'")
        call = call_options(threads, progress)
        return _isotet.isovalues_at(self._grid, self._field(field, call), isovalues_in(percents), of == "volume", call)

    def volumes(self, isovalues: npt.ArrayLike, field: npt.ArrayLike | str | None = None, *, threads: int = 0,
                progress: Progress | None = None) -> dict[str, Any]:  # fmt: skip
        """Area of the isosurfaces and volume below them, without making them: "area" and "volume_below", one an isovalue, and the
        "volume" of the grid where the field has values. In any order of the isovalues.

        Raises ValueError as `contour`.
        """
        call = call_options(threads, progress)
        values = np.array(isovalues_in(isovalues))
        order = np.argsort(values, kind="stable")
        measured = _isotet.contour_spectrum(self._grid, self._field(field, call), values[order].tolist(), call)
        places = np.empty_like(order)
        places[order] = np.arange(len(order))
        return {**measured, "area": measured["area"][places], "volume_below": measured["volume_below"][places]}

    def pack(self, field: npt.ArrayLike | str | None = None, *, gradients: bool = False, source_cells: bool = False,
             split_cells: bool = False, precision: str = "float32", frame: Frame | None = None, threads: int = 0,
             progress: Progress | None = None) -> PackedGrid:  # fmt: skip
        """Packs the grid once, to contour it many times: `pack` of this grid and field."""
        return pack(self, values=field, gradients=gradients, source_cells=source_cells, split_cells=split_cells,
                    precision=precision, frame=frame, threads=threads, progress=progress)  # fmt: skip

    def survey(self, field: npt.ArrayLike | str | None = None, *, fields: Mapping[str, Any] | Iterable[str] | None = None,
               split_cells: bool = False, threads: int = 0, progress: Progress | None = None) -> bytes:  # fmt: skip
        """What this piece of a grid says of itself, some 800 bytes: `make_frame` joins those of all pieces.

        field, fields, split_cells
            As they will be given to `contour`; the first 16 fields count.

        Raises ValueError as `contour` does.
        """
        call = call_options(threads, progress)
        return _isotet.survey(self._grid, self._field(field, call, True), self._carried(fields, "fields"), split_cells, call)

    def piece(self, index: int, count: int) -> Grid:
        """The piece `index`, from 0, of `count` pieces of equally many cells, in their order; with fields and `point_numbers`.

        Raises ValueError when there is no such piece.
        """
        if not 0 <= index < count:
            raise ValueError(f"index is {index}, but must be from 0 to {count - 1}")
        return Grid._of(_isotet.take_piece(self._grid, index, count, call_options(0, None)))

    def solid(self, field: npt.ArrayLike | str | None = None, *, above: float | None = None, below: float | None = None,
              fields: Mapping[str, Any] | Iterable[str] | None = None,
              cell_fields: Mapping[str, Any] | Iterable[str] | None = None, normals: str = "none", edge_ends: bool = False,
              source_cells: bool = False, precision: str = "float32", split_cells: bool = False,
              tolerance: float | str | None = None, geometry_tolerance: float = 0.0, distance: float = 0.0, threads: int = 0,
              progress: Progress | None = None) -> Surface:  # fmt: skip
        """The part of the grid where a field is at least `above` and less than `below`, as a closed surface: one of
        `Solids`, which is faster for several.

        Raises ValueError as `Grid.contour`, and where neither end is given.
        """
        solids = Solids(self, field, fields=fields, cell_fields=cell_fields, normals=normals, edge_ends=edge_ends,
                        source_cells=source_cells, precision=precision, split_cells=split_cells, tolerance=tolerance,
                        geometry_tolerance=geometry_tolerance, distance=distance, threads=threads,
                        progress=progress)  # fmt: skip
        return solids.solid(above=above, below=below, threads=threads, progress=progress)

    def clip(self, field: npt.ArrayLike | str | None = None, *, above: float | None = None, below: float | None = None,
             fields: Mapping[str, Any] | Iterable[str] | None = None,
             cell_fields: Mapping[str, Any] | Iterable[str] | None = None, polyhedra: bool = True, edge_ends: bool = False,
             precision: str = "float32", split_cells: bool = False, tolerance: float | str | None = None,
             geometry_tolerance: float = 0.0, distance: float = 0.0, threads: int = 0,
             progress: Progress | None = None) -> Grid:  # fmt: skip
        """The cells where a field is at least `above` and less than `below`: one of `Clipper`, which is faster for several.

        Raises ValueError as `Grid.contour`, and where neither end is given.

        >>> import isotet
        >>> part = isotet.make("hex", 8, ["sphere"]).clip("sphere", below=0.6)
        >>> part.info["whole_cells"], part.info["cut_cells"]
        (8, 128)
        """
        clipper = Clipper(self, field, fields=fields, cell_fields=cell_fields, edge_ends=edge_ends, precision=precision,
                          split_cells=split_cells, tolerance=tolerance, geometry_tolerance=geometry_tolerance,
                          distance=distance, threads=threads, progress=progress)  # fmt: skip
        return clipper.clip(above=above, below=below, polyhedra=polyhedra, threads=threads, progress=progress)

    def without_cells(self, marks: npt.ArrayLike, *, bits: int = 57) -> Grid:
        """The grid without cells whose `marks`, one integer a cell, have one of the `bits`: those of VTK's ghost cells. Cells
        keep their numbers.

        Raises ValueError when there is not one mark a cell.
        """
        numbers = numbers_in("marks", marks)
        return Grid._of(_isotet.leave_out_cells(self._grid, numbers, bits, call_options(0, None)))

    def merge_points(self, tolerance: float = 0.0, *, values: str = "lowest", threads: int = 0) -> tuple[Grid, dict[str, Any]]:
        """The grid with points that are at most `tolerance` apart joined (0: of equal coordinates), and a report of it: `merged`
        points, `collapsed_cells`, and the largest jump of each field at joined points. Points keep their numbers.

        values
            What joined points have: "lowest", the value of the lowest number, or "mean".

        Raises ValueError when the tolerance is negative or so large that every cell collapses.
        """
        if values not in ("lowest", "mean"):
            raise ValueError(f"values is '{values}', but must be lowest or mean")
        grid, report = _isotet.merge_points(self._grid, tolerance, values == "mean", call_options(threads, None))
        return Grid._of(grid, self.info, self.step, self.notes), report

    def close_hanging_points(self, *, interpolate: bool = False, threads: int = 0) -> tuple[Grid, dict[str, Any]]:
        """The grid with points on faces and edges of larger cells listed by these, as polyhedra, so that surfaces are closed
        there, and a report of it: hanging `points`, `levels` (n: an edge meets up to 2^n smaller ones), `cells` that list them,
        `faces` that smaller ones cover, `near_faces` of these whose points are up to `largest_distance` beside them,
        `open_faces` that stay open, `curved_cells`, of those that list points, above degree 1, and `differences`: by how much
        each point field differs from the larger cells there.

        interpolate
            Hanging points get the values of the larger cells.
        """
        grid, report = _isotet.close_hanging_points(self._grid, interpolate, call_options(threads, None))
        return Grid._of(grid, self.info, self.step, self.notes), report

    def write(self, path: str | os.PathLike[str], *, format: str = "", compression: str = "none",
              progress: Progress | None = None) -> list[str]:  # fmt: skip
        """Writes the grid as .vtu or legacy .vtk, whole or not at all. Returns sentences on what the format could not hold.

        compression, of .vtu only: "zlib", which every VTK reads, or "lz4", which is read faster.

        Raises OSError where the file cannot be written, ValueError for an unknown format.
        """
        return _isotet.write_grid(self._grid, os.fspath(path), format, compression, call_options(0, progress))

    def to_vtk(self) -> vtkUnstructuredGrid:
        """The grid as vtkUnstructuredGrid, with its fields. The arrays are copies."""
        from ._vtk_data import to_unstructured

        return to_unstructured(self)

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The grid as pyvista.UnstructuredGrid, with its fields. The arrays are copies."""
        import pyvista

        return pyvista.wrap(self.to_vtk())

    def to_meshio(self) -> meshio.Mesh:
        """The grid as meshio.Mesh, with its fields. The arrays are copies.

        Raises ValueError for cells that meshio has no name for, polyhedra among them.
        """
        return to_meshio(self)

    def __reduce__(self) -> tuple[Any, ...]:
        grid = self._grid
        return _restored_grid, (grid.points, grid.cells.arrays(), grid.fields, grid.cell_fields, grid.point_numbers,
                                (self.info, self.step, self.notes))  # fmt: skip

    def __len__(self) -> int:
        """The number of cells."""
        return len(self._grid.cells)

    def __repr__(self) -> str:
        names = list(self.fields) + list(self.cell_fields)
        carried = f", fields {', '.join(names)}" if names else ""
        return f"<isotet.Grid: {len(self.points)} points, {len(self)} cells{carried}>"


def _restored_grid(points, cells, fields, cell_fields, numbers, told) -> Grid:
    """A grid of a pickle."""
    connectivity, offsets, types, uniform, faces, face_offsets = cells
    own = _isotet.Cells(connectivity, offsets, types, uniform, faces, face_offsets)
    return Grid._of(_isotet.Grid(points, own, list(fields.items()), list(cell_fields.items()), numbers), *told)


class PackedGrid:
    """A grid in clusters, made by `pack`: the arrays it was made of are not needed any more."""

    __slots__ = ("_packed", "_linear", "__weakref__")

    def __init__(self):
        raise TypeError("use isotet.pack()")

    @classmethod
    def _of(cls, packed: _isotet.PackedGrid, linear: _isotet.LinearGrid | None = None) -> PackedGrid:
        """`linear`: how its cells came from the user's, where these were split."""
        self = cls.__new__(cls)
        self._packed, self._linear = packed, linear
        return self

    def contour(self, isovalues: npt.ArrayLike, *, normals: str = "none",
                fields: Mapping[str, Any] | None = None, cell_fields: Mapping[str, Any] | None = None,
                edge_ends: bool = False, source_cells: bool = False, ties: str = "merge", threads: int = 0,
                progress: Progress | None = None) -> Surface:  # fmt: skip
        """The surface on which the packed field has a value, in a time that grows with the surface, not with the grid.

        The parameters are those of `Grid.contour`; `normals="gradient"` needs ``pack(..., gradients=True)``, `source_cells`
        and `cell_fields` need ``pack(..., source_cells=True)``. `fields` are arrays of the grid that was packed.

        Raises ValueError for wrong arguments, and where something was not packed; MemoryError.
        """
        words_in(normals=normals, ties=ties)
        options = _isotet.ContourOptions(normals, edge_ends, source_cells, ties, self._packed.precision, None, 0)
        surface = self._packed.extract(isovalues_in(isovalues), fields_in("fields", fields),
                                       fields_in("cell_fields", cell_fields), options,
                                       call_options(threads, progress), [], self._linear)  # fmt: skip
        return Surface._of(surface, {"method": "clusters"})

    def save(self, path: str | os.PathLike[str], *, fields: Mapping[str, Any] | None = None, time: float | None = None,
             threads: int = 0, progress: Progress | None = None) -> None:  # fmt: skip
        """Saves the packed grid into a file (.isotet) that `open` reads in parts.

        fields
            More fields: a mapping from names to arrays of one value a point.
        time
            Of the step.

        Raises OSError where it cannot be written, ValueError for wrong arrays and for source cells of polyhedra and quadratic
        cells, which a file does not have, MemoryError.
        """
        if self._linear is not None and self._packed.has_source_cells:
            raise ValueError("source cells of polyhedra and quadratic cells are not kept in packed files: pack without source_cells")
        more = {name: _isotet.PointField(name, scalars_in(name, values)) for name, values in (fields or {}).items()}
        self._save(path, more.values(), time, call_options(threads, progress))

    def _save(self, path: str | os.PathLike[str], fields: Iterable[_isotet.PointField], time: float | None,
              call: _isotet.CallOptions) -> None:  # fmt: skip
        more = [self._packed.with_field(field, call, self._linear) for field in fields]
        _isotet.save_packed(self._packed, os.fspath(path), more, time, call)

    def set_field(self, values: npt.ArrayLike, *, name: str = "values", frame: Frame | None = None, threads: int = 0,
                  progress: Progress | None = None) -> None:  # fmt: skip
        """Another field on the same cells, or its next time step: one value a point. Surfaces that exist stay as they are.

        Raises ValueError where the number of values is not that of the points; the grid is then as before.
        """
        field = _isotet.PointField(name, scalars_in("values", values))
        self._packed = self._framed(frame).with_field(field, call_options(threads, progress), self._linear)

    def _framed(self, frame: Frame | None) -> _isotet.PackedGrid:
        return self._packed if frame is None else self._packed.with_frame(frame._frame)

    def set_points(self, points: Any, *, frame: Frame | None = None, threads: int = 0,
                   progress: Progress | None = None) -> None:  # fmt: skip
        """Other coordinates of the same points: a mesh that moves.

        Raises ValueError for another number of points, and where a cell turned over: pack again. The grid is then as before.
        """
        self._packed = self._framed(frame).with_points(points_in(points), call_options(threads, progress), self._linear)

    def unpack(self, *, threads: int = 0, progress: Progress | None = None) -> Grid:
        """The grid as arrays again: points by their numbers, cells in the order in which they are packed, and the field, as far
        as packing kept them. Cells that were split stay so, and points inside them come last.
        """
        return Grid._of(self._packed.unpack(call_options(threads, progress)))

    @property
    def range(self) -> tuple[float, float]:
        """The smallest and the largest finite value at the points of the cells; the first is larger where there is none."""
        field = self._packed.field()
        return field["lower"], field["upper"]

    @property
    def report(self) -> dict[str, Any]:
        """What packing found: tets, clusters, cells left out, inverted and repeated tets, and the bytes it takes."""
        return self._packed.report()

    @property
    def field_report(self) -> dict[str, Any]:
        """How values are stored: points without data, whether values are unchanged."""
        return self._packed.field()

    @property
    def nbytes(self) -> int:
        """Memory of the packed grid."""
        return self._packed.report()["bytes"]

    def __reduce__(self) -> tuple[Any, ...]:
        """A packed grid is pickled as the bytes of its file."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "grid.isotet")
            self._save(path, (), None, call_options(0, None))
            return _restored_packed, (path.read_bytes(), self._linear)

    def __copy__(self) -> PackedGrid:
        """Shares the clusters, which never change."""
        return PackedGrid._of(self._packed, self._linear)

    def __deepcopy__(self, memo: Any) -> PackedGrid:
        return self.__copy__()

    def __len__(self) -> int:
        """The number of cells of the grid that was packed."""
        return self._packed.cell_count if self._linear is None else self._linear.user_cells

    def __repr__(self) -> str:
        report = self._packed.report()
        return (f"<isotet.PackedGrid: {report['points']} points, {len(self)} cells, "
                f"field {self._packed.field()['name']}, {report['bytes']} bytes>")  # fmt: skip


def _restored_packed(data: bytes, linear: _isotet.LinearGrid | None = None) -> PackedGrid:
    """A packed grid of a pickle."""
    call = call_options(0, None)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "grid.isotet")
        path.write_bytes(data)
        return PackedGrid._of(_isotet.PackedFile.open(str(path), 0, call).load("", 0, call), linear)


class Contour:
    """A session: answers isovalues of one grid and field after another, and keeps what may be kept.

    It extracts directly, and packs the grid when so many surfaces were asked for that this pays; `set` finds out what is the
    same as before.

    grid, field, fields, cell_fields, normals, edge_ends, source_cells, ties, precision, method, split_cells, frame, tolerance,
    geometry_tolerance, distance, exact_vertices, centre
        As for `Grid.contour`. With a tolerance curved cells are refined for each isovalue, field and step again.
    surfaces
        How many surfaces will be asked for in all; 0: not known.
    extract_while_packing
        `prepare`, called by another thread, packs while this one extracts directly: the first surface comes at once.

    >>> import isotet
    >>> grid = isotet.make("kuhn", 8, ["sphere", "gyroid"])
    >>> session = isotet.Contour(grid, "sphere", surfaces=100)
    >>> session.contour(0.5).method
    'clusters'
    >>> session.set(grid, "gyroid")
    'field'
    """

    __slots__ = ("_session", "_options", "_refinement", "_centre", "_grid", "_given", "__weakref__")

    def __init__(self, grid: Grid, field: npt.ArrayLike | str | None = None, *,
                 fields: Mapping[str, Any] | Iterable[str] | None = None,
                 cell_fields: Mapping[str, Any] | Iterable[str] | None = None, normals: str = "none", edge_ends: bool = False,
                 source_cells: bool = False, ties: str = "merge", precision: str = "float32", method: str | None = None,
                 split_cells: bool = False, surfaces: int = 0, frame: Frame | None = None,
                 tolerance: float | str | None = None, geometry_tolerance: float = 0.0, distance: float = 0.0,
                 exact_vertices: bool = False, extract_while_packing: bool = False, centre: str = "mean"):  # fmt: skip
        call = call_options(0, None)
        words_in(normals=normals, ties=ties, precision=precision)
        self._centre = centre
        self._refinement = (*tolerances_in(tolerance, geometry_tolerance, distance), exact_vertices, extract_while_packing)
        self._options = (normals, edge_ends, source_cells, ties, precision, method, surfaces, split_cells)
        self._remember(grid, field, fields, cell_fields, frame)
        self._session = _isotet.Contour(grid._grid, grid._field(field, call, frame is not None, centre),
                                        grid._carried(fields, "fields"), grid._carried(cell_fields, "cell_fields"), self._options_with(frame),
                                        call)  # fmt: skip

    def _options_with(self, frame: Frame | None) -> _isotet.ContourOptions:
        return _isotet.ContourOptions(*self._options, frame and frame._frame, *self._refinement)

    def set(self, grid: Grid, field: npt.ArrayLike | str | None = None, *,
            fields: Mapping[str, Any] | Iterable[str] | None = None,
            cell_fields: Mapping[str, Any] | Iterable[str] | None = None, frame: Frame | None = None, threads: int = 0,
            progress: Progress | None = None) -> str:  # fmt: skip
        """Another grid, field or time step. Arrays may be the same, the same in other memory, or changed in place.

        Returns what differs: "nothing", "field", "points" (and perhaps the field) or "grid".

        Raises ValueError as `Grid.contour`; the session is then as before.
        """
        call = call_options(threads, progress)
        now = Grid._of(grid._grid.renewed())  # what its arrays hold is compared, not whose they are
        update = self._session.set(now._grid, now._field(field, call, frame is not None, self._centre),
                                   now._carried(fields, "fields"), now._carried(cell_fields, "cell_fields"),
                                   self._options_with(frame), call)  # fmt: skip
        self._remember(grid, field, fields, cell_fields, frame)
        return update

    def _remember(self, grid: Grid, *given: Any) -> None:
        """For pickles. A packed session lets its grid go, and so does this."""
        self._grid, self._given = weakref.ref(grid), given

    def __reduce__(self) -> tuple[Any, ...]:
        """A session is pickled and copied as its grid, field and options: the other one packs for itself."""
        grid = self._grid()
        if grid is None:
            raise TypeError("the isotet.Grid of the session is gone: keep it while the session is pickled or copied")
        return _restored_session, (grid, self._given, self._options, self._refinement, self._centre)

    def contour(self, isovalues: npt.ArrayLike, *, threads: int = 0, progress: Progress | None = None) -> Surface:
        """The surface of one isovalue, or one of several with the cell field "isovalue".

        Raises ValueError for an isovalue that is not finite and for broken grids; MemoryError.
        """
        return Surface._of(*self._session.extract(isovalues_in(isovalues), call_options(threads, progress)))

    def prepare(self, *, threads: int = 0, progress: Progress | None = None) -> None:
        """Packs now what the next surface would pack first; nothing where surfaces are extracted directly, unless
        `extract_while_packing` is set."""
        self._session.prepare(call_options(threads, progress))

    @property
    def range(self) -> tuple[float, float]:
        """The smallest and the largest finite value of the field; the first is larger where there is none."""
        field = self._session.field(call_options(0, None))
        return field["lower"], field["upper"]

    @property
    def method(self) -> str:
        """How the next surface is extracted: "direct" or "clusters"."""
        return self._session.method(1)

    @property
    def nbytes(self) -> int:
        """Memory of the packed grid; 0 where nothing is packed."""
        return self._session.packed_bytes()

    def __repr__(self) -> str:
        size = self.nbytes
        return f"<isotet.Contour: {f'packed, {size} bytes' if size else 'not packed'}, next {self.method}>"


def _restored_session(grid: Grid, given: tuple[Any, ...], options: tuple[Any, ...], refinement: tuple[Any, ...],
                      centre: str) -> Contour:  # fmt: skip
    """A session of a pickle, which keeps the grid that came with it."""
    session = Contour.__new__(Contour)
    session._options, session._refinement, session._centre = options, refinement, centre
    field, fields, cell_fields, frame = given
    call = call_options(0, None)
    session._session = _isotet.Contour(grid._grid, grid._field(field, call, frame is not None, centre), grid._carried(fields, "fields"),
                                       grid._carried(cell_fields, "cell_fields"), session._options_with(frame), call)  # fmt: skip
    session._remember(grid, *given)
    return session


class Solids:
    """Makes closed solids of one grid and field: its boundary is found once, for one range of values after another.

    grid, field, fields, cell_fields, edge_ends, source_cells, precision, method, split_cells, tolerance, geometry_tolerance,
    distance
        As for `Grid.contour`; curved cells are refined for all isovalues.
    normals
        "none", "face" or "vertex".
    ghosts, frame
        The grid is a piece of one with this frame, and comes with the cells of other pieces beside its own: `ghosts` has an
        integer a cell, not 0 for these. Solids of all pieces are together those of the whole, volumes are their shares;
        faces between pieces are no boundary, and open edges are not counted.

    >>> import isotet
    >>> solids = isotet.Solids(isotet.make("kuhn", 8, ["sphere"]), "sphere")
    >>> above, below = solids.solid(above=0.7), solids.solid(below=0.7)
    >>> round(above.solid["volume"] + below.solid["volume"], 5), round(solids.grid_volume, 5)
    (8.0, 8.0)
    """

    __slots__ = ("_solids", "__weakref__")

    def __init__(self, grid: Grid, field: npt.ArrayLike | str | None = None, *,
                 fields: Mapping[str, Any] | Iterable[str] | None = None,
                 cell_fields: Mapping[str, Any] | Iterable[str] | None = None, normals: str = "none", edge_ends: bool = False,
                 source_cells: bool = False, precision: str = "float32", method: str | None = None, split_cells: bool = False,
                 tolerance: float | str | None = None, geometry_tolerance: float = 0.0, distance: float = 0.0,
                 ghosts: npt.ArrayLike | None = None, frame: Frame | None = None, centre: str = "mean",
                 threads: int = 0, progress: Progress | None = None):  # fmt: skip
        call = call_options(threads, progress)
        options = _isotet.ContourOptions(normals, edge_ends, source_cells, "merge", precision, method, 0, split_cells,
                                         frame and frame._frame,
                                         *tolerances_in(tolerance, geometry_tolerance, distance))  # fmt: skip
        marks = None if ghosts is None else numbers_in("ghosts", ghosts)
        self._solids = _isotet.Solids(grid._grid, grid._field(field, call, frame is not None, centre),
                                      grid._carried(fields, "fields"), grid._carried(cell_fields, "cell_fields"), options,
                                      marks, call)  # fmt: skip

    def solid(self, *, above: float | None = None, below: float | None = None, threads: int = 0,
              progress: Progress | None = None) -> Surface:  # fmt: skip
        """The part of the grid where the field is at least `above` and less than `below`, one of them or both, as a closed
        surface: the isosurfaces and the boundary of the grid between, triangles facing outwards. Its cell field "boundary" is 0
        for isosurfaces and 1 for the boundary; `Surface.solid` tells its volume.

        Raises ValueError where neither is given, or `above` is not less than `below`; MemoryError.
        """
        if above is None and below is None:
            raise ValueError("a solid needs above, below or both")
        lower = -math.inf if above is None else float(above)
        upper = math.inf if below is None else float(below)
        return Surface._of(*self._solids.extract(lower, upper, call_options(threads, progress)))

    @property
    def grid_volume(self) -> float:
        """Of all cells with data."""
        return self._solids.grid_volume

    def __repr__(self) -> str:
        return f"<isotet.Solids: of a volume of {self.grid_volume:.6g}>"


class Clipper:
    """Clips one grid by one field, for one range of values after another.

    grid, field, edge_ends, precision, method, split_cells, tolerance, geometry_tolerance, distance, centre
        As for `Grid.contour`; curved cells are refined for all isovalues.
    fields, cell_fields
        What the cells carry: names, or mappings from names to arrays. Without them all fields.

    >>> import isotet
    >>> clipper = isotet.Clipper(isotet.make("kuhn", 8, ["sphere"]), "sphere")
    >>> band = clipper.clip(above=0.4, below=0.6)
    >>> sorted({int(t) for t in band.types})  # VTK's numbers of tetrahedra, wedges and polyhedra
    [10, 13, 42]
    """

    __slots__ = ("_clipper", "__weakref__")

    def __init__(self, grid: Grid, field: npt.ArrayLike | str | None = None, *,
                 fields: Mapping[str, Any] | Iterable[str] | None = None,
                 cell_fields: Mapping[str, Any] | Iterable[str] | None = None, edge_ends: bool = False,
                 precision: str = "float32", method: str | None = None, split_cells: bool = False,
                 tolerance: float | str | None = None, geometry_tolerance: float = 0.0, distance: float = 0.0,
                 centre: str = "mean", threads: int = 0, progress: Progress | None = None):  # fmt: skip
        call = call_options(threads, progress)
        options = _isotet.ContourOptions("none", edge_ends, True, "merge", precision, method, 0, split_cells, None,
                                         *tolerances_in(tolerance, geometry_tolerance, distance))  # fmt: skip
        if cell_fields is None:
            cell_fields = {name: values for name, values in grid.cell_fields.items() if name != "source_cell"}
        self._clipper = _isotet.Clipper(grid._grid, grid._field(field, call, False, centre), grid._carried(fields, "fields"),
                                        grid._carried(cell_fields, "cell_fields"), options, call)  # fmt: skip

    def clip(self, *, above: float | None = None, below: float | None = None, polyhedra: bool = True, threads: int = 0,
             progress: Progress | None = None) -> Grid:  # fmt: skip
        """The cells where the field is at least `above` and less than `below`, one of them or both, cut there. Cells in the range
        stay as they are; the pieces of others are tetrahedra, pyramids, wedges, hexahedra and polyhedra. Their boundary is
        `Solids.solid` of the same range.

        polyhedra
            False: polyhedra are split around a point inside.

        The grid's cell field "source_cell" has the number of the cell that each comes from; `Grid.info` has "whole_cells",
        "cut_cells", "polyhedra" and "cells_left_out", and "flat_pieces" that were left out at ties.

        Raises ValueError where neither end is given, or `above` is not less than `below`; MemoryError.
        """
        if above is None and below is None:
            raise ValueError("clipping needs above, below or both")
        lower = -math.inf if above is None else float(above)
        upper = math.inf if below is None else float(below)
        grid, told, notes = self._clipper.clip(lower, upper, bool(polyhedra), True, call_options(threads, progress))
        return Grid._of(grid, told, 0, notes)

    def __repr__(self) -> str:
        return "<isotet.Clipper>"


def solid(points: Any, cells: Any, values: npt.ArrayLike, *, above: float | None = None, below: float | None = None,
          offsets: npt.ArrayLike | None = None, types: npt.ArrayLike | None = None, fields: Mapping[str, Any] | None = None,
          cell_fields: Mapping[str, Any] | None = None, normals: str = "none", precision: str = "float32",
          split_cells: bool = False, threads: int = 0, progress: Progress | None = None) -> Surface:  # fmt: skip
    """The part of a grid between isovalues as a closed surface: `Solids.solid` of arrays as `contour` takes them.

    above, below
        The solid is where values are at least `above` and less than `below`; one of them may be left out.

    The other parameters are those of `contour`.

    >>> import isotet
    >>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> corner = isotet.solid(points, [[0, 1, 2, 3]], [0.0, 1.0, 1.0, 1.0], below=0.5)
    >>> corner
    <isotet.Surface: 4 vertices, 4 triangles, fields boundary>
    >>> round(corner.solid["volume"], 6)
    0.020833
    """
    grid = Grid(points, cells, offsets=offsets, types=types)
    return grid.solid(values, above=above, below=below, fields=fields, cell_fields=cell_fields, normals=normals,
                      precision=precision, split_cells=split_cells, threads=threads, progress=progress)  # fmt: skip


def contour(points: Any, cells: Any, values: npt.ArrayLike, isovalues: npt.ArrayLike, *, offsets: npt.ArrayLike | None = None,
            types: npt.ArrayLike | None = None, normals: str = "none", fields: Mapping[str, Any] | None = None,
            cell_fields: Mapping[str, Any] | None = None, edge_ends: bool = False, source_cells: bool = False,
            ties: str = "merge", precision: str = "float32", method: str | None = None, split_cells: bool = False,
            frame: Frame | None = None, tolerance: float | str | None = None, geometry_tolerance: float = 0.0,
            distance: float = 0.0, exact_vertices: bool = False, threads: int = 0,
            progress: Progress | None = None) -> Surface:  # fmt: skip
    """The surface on which values at the points of a grid, linear in each tetrahedron, equal an isovalue.

    points, cells, offsets, types
        The grid, as `Grid` takes it.
    values
        One number a point; NaN, and masked values of a masked array, are no data: cells with such a corner give nothing.
    isovalues
        One number in the unit of `values`; or several, which give one surface with the cell field "isovalue".

    The other parameters are those of `Grid.contour`.

    Raises ValueError for wrong shapes and broken grids, TypeError for types that are no numbers, MemoryError.

    >>> import isotet
    >>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> surface = isotet.contour(points, [[0, 1, 2, 3]], [0.0, 1.0, 1.0, 1.0], 0.25)
    >>> surface
    <isotet.Surface: 3 vertices, 1 triangles>
    >>> surface.points.tolist()
    [[0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 0.25]]
    """
    grid = Grid(points, cells, offsets=offsets, types=types)
    return grid.contour(isovalues, values, normals=normals, fields=fields, cell_fields=cell_fields, edge_ends=edge_ends,
                        source_cells=source_cells, ties=ties, precision=precision, method=method,
                        split_cells=split_cells, frame=frame, tolerance=tolerance, geometry_tolerance=geometry_tolerance,
                        distance=distance, exact_vertices=exact_vertices,
                        threads=threads, progress=progress)  # fmt: skip


def pack(points: Any, cells: Any = None, values: npt.ArrayLike | str | None = None, *, offsets: npt.ArrayLike | None = None,
         types: npt.ArrayLike | None = None, gradients: bool = False, source_cells: bool = False, split_cells: bool = False,
         precision: str = "float32", frame: Frame | None = None, threads: int = 0,
         progress: Progress | None = None) -> PackedGrid:  # fmt: skip
    """Packs a grid once, to contour it many times: about 10 bytes a tetrahedron stay. Polyhedra and quadratic cells are split
    into linear cells first, as by `contour`.

    points, cells, values, offsets, types
        As for `contour`. Or a `Grid`, and behind it the name of a field or one value a point: ``pack(grid, "p")``.
    gradients
        Keep a gradient at each point, for ``contour(normals="gradient")``: 4 bytes a point.
    source_cells
        Keep the cell of each tetrahedron, for cell fields: 4 bytes a tetrahedron.
    split_cells
        Split pyramids, wedges and hexahedra into tetrahedra first: 2 to 3 times the triangles.
    frame
        As for `Grid.contour`. `PackedGrid.set_field` and `set_points` keep it, or take another.

    Raises ValueError for wrong shapes and broken grids, MemoryError before more memory is taken than is free.

    >>> import isotet
    >>> packed = isotet.pack(isotet.make("kuhn", 8, ["sphere"]))
    >>> packed.contour(0.5).triangles.shape == packed.contour([0.5]).triangles.shape
    True
    """
    if isinstance(points, Grid):
        if offsets is not None or types is not None or (cells is not None and values is not None):
            raise TypeError("pack() takes a Grid and values, or points, cells and values: a Grid has its own cells")
        grid, values = points, cells if values is None else values
    else:
        if values is None:
            raise TypeError("pack() needs values")
        grid = Grid(points, cells, offsets=offsets, types=types)
    call = call_options(threads, progress)
    return PackedGrid._of(*_isotet.pack(grid._grid, grid._field(values, call, frame is not None), precision, source_cells,
                                        split_cells, gradients, frame and frame._frame, call))  # fmt: skip


def read(path: str | os.PathLike[str], *, fields: Iterable[str] | None = None, cell_fields: Iterable[str] | None = None,
         step: int | None = None, blocks: Iterable[str | int] = (), format: str = "", merge_pieces: bool = True,
         allow_outside: bool = False, displace: str = "", reader_program: str = "",
         progress: Progress | None = None) -> Grid:  # fmt: skip
    """Reads a grid: VTU, PVTU, VTM, legacy VTK, Gmsh, Medit, TetGen, Gocad, GRDECL and more (`formats`).

    path, format
        The file; its format is found out by its content, then its name, unless it is named.
    fields, cell_fields
        Names of the fields to read; without them all.
    step
        Which of several time steps, from 0.
    blocks
        Names or numbers of the blocks, zones or parts to read, as `inspect` lists them; without them all.
    merge_pieces
        Join points of equal coordinates where pieces have no global numbers.
    allow_outside
        Index files (.pvd, .pvtu and so on) may name files outside their own folder.
    displace
        A vector field of the points by which they are moved; "disp" for disp_x, disp_y and disp_z.
    reader_program
        The program `isotet-reader`, which reads what C libraries parse (Exodus, CGNS, MED, EnSight, XDMF, VTKHDF). Without it:
        the one in PATH.

    Grid.info has the fields, blocks and times of the file, Grid.notes what was noticed.

    Raises OSError where the file cannot be read or its format is not known, ValueError where its content is broken or a
    field, block or step is not there.
    """
    names = None if fields is None else [str(name) for name in fields]
    cell_names = None if cell_fields is None else [str(name) for name in cell_fields]
    if isinstance(blocks, str):
        raise TypeError(f"blocks is '{blocks}', but must be a list of names or numbers")
    how = _isotet.ReadOptions(format, reader_program, names, cell_names, step, merge_pieces, allow_outside, displace,
                              [str(block) for block in blocks])  # fmt: skip
    return Grid._of(*_isotet.read(os.fspath(path), how, call_options(0, progress)))


def inspect(path: str | os.PathLike[str], *, format: str = "", reader_program: str = "") -> dict[str, Any]:
    """What the file at `path` holds, without reading it whole: format, fields and cell_fields (type and columns), times, blocks
    (number, name, kind and cells), and regions: what numbers of a cell field are called (field, number, name).

    `format` and `reader_program` are those of `read`. Raises OSError and ValueError as it does.
    """
    return _isotet.inspect(os.fspath(path), _isotet.ReadOptions(format, reader_program), call_options(0, None))


def make(shape: str = "kuhn", side: int = 32, fields: Sequence[str] = ("sphere", "gyroid"), seed: int = 1) -> Grid:
    """A test grid on the cube from -1 to 1: "kuhn", "perturbed", "shuffled", "hex", "wedge", "pyramid", "mixed" and others.

    side
        Cubes along an edge.
    fields
        Of "sphere", "torus", "plane", "gyroid", "wavelet", "integer".
    seed
        Of what is drawn: another one gives another grid of the same kind.

    Raises ValueError for unknown names, with those that there are.

    >>> import isotet
    >>> isotet.make("hex", 4, ["sphere"])
    <isotet.Grid: 125 points, 64 cells, fields sphere>
    """
    return Grid._of(_isotet.make(shape, side, list(fields), seed, call_options(0, None)))


def formats() -> list[dict[str, Any]]:
    """The file formats: name, title, extensions, what is read and written, and whether the program is needed to read it.

    >>> import isotet
    >>> [format["name"] for format in isotet.formats() if format["writes_grid"]]
    ['vtu', 'vtk']
    """
    return _isotet.formats()
