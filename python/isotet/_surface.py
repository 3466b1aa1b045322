# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Surfaces, and what can be done with them."""

from __future__ import annotations

import base64
import html
import math
import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _isotet
from ._arrays import fields_in, points_in, values_in
from ._call import Progress, call_options

if TYPE_CHECKING:
    import meshio
    import numpy.typing as npt
    import pyvista
    import trimesh
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from ._grid import Grid


class Surface:
    """Triangles on shared vertices: V vertices, F triangles.

    Its arrays are read-only NumPy arrays. They own the memory they show, so each lives on without the surface; to change
    one, copy it. It has no len(), as surfaces of trimesh and PyVista have none: ``len(surface.triangles)``.

    A surface of your own, to check or to write:

    points
        V x 3, float32 or float64.
    triangles
        F x 3 integers, the vertices of each triangle.
    normals
        V x 3 or F x 3; one a vertex or one a triangle.
    fields, cell_fields
        A mapping from names to arrays: one row a vertex, or one row a triangle.

    Raises ValueError for wrong shapes, and for numbers of vertices that are not there.

    >>> import isotet
    >>> triangle = isotet.Surface([[0, 0, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> triangle.area
    1.0
    """

    __slots__ = ("_surface", "_how", "__weakref__")

    def __init__(self, points: Any, triangles: npt.ArrayLike, *, normals: npt.ArrayLike | None = None,
                 fields: Mapping[str, Any] | None = None, cell_fields: Mapping[str, Any] | None = None):  # fmt: skip
        corners = np.asarray(triangles)
        if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu":
            raise ValueError(
                f"triangles has shape {corners.shape} and type {corners.dtype}, but must have shape (F, 3) and integers")
        wide = corners.dtype.itemsize == 8 and corners.size > 0 and corners.max() >= 2**32
        if corners.size and corners.min() < 0:
            raise ValueError(f"triangles has the vertex {corners.min()}, but vertices are counted from 0")
        points = points_in(points)
        kind = "none"
        if normals is not None:
            normals = values_in("normals", normals).astype(np.float32)
            if normals.shape not in ((len(points), 3), (len(corners), 3)):
                raise ValueError(f"normals has shape {normals.shape}, but must have shape ({len(points)}, 3), one a vertex, "
                                 f"or ({len(corners)}, 3), one a triangle")  # fmt: skip
            kind = "gradient" if len(normals) == len(points) else "face"
        self._surface = _isotet.Surface(
            points, np.ascontiguousarray(corners, np.uint64 if wide else np.uint32), kind, normals, None, None, None,
            fields_in("fields", fields), fields_in("cell_fields", cell_fields))  # fmt: skip
        self._how = {}

    @classmethod
    def _of(cls, surface: _isotet.Surface, how: dict[str, Any] | None = None) -> Surface:
        self = cls.__new__(cls)
        self._surface, self._how = surface, how or {}
        return self

    @property
    def points(self) -> np.ndarray:
        """V x 3, in the coordinates of the grid: float32 where its points are float32, else float64."""
        return self._surface.points

    @property
    def triangles(self) -> np.ndarray:
        """F x 3, uint32 (uint64 from 2^32 vertices on); counter-clockwise seen from the side of higher values."""
        return self._surface.triangles

    @property
    def normals(self) -> np.ndarray | None:
        """None, or float32, unit length, towards higher values: V x 3 ("gradient", "vertex") or F x 3 ("face")."""
        return self._surface.normals

    @property
    def normals_kind(self) -> str:
        """"none"; "gradient" or "vertex", one a vertex; "face", one a triangle."""
        return self._surface.normals_kind

    @property
    def _has_vertex_normals(self) -> bool:
        return self.normals_kind in ("gradient", "vertex")

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """What was carried onto the vertices, by name: V rows each."""
        return self._surface.fields

    @property
    def cell_fields(self) -> dict[str, np.ndarray]:
        """What was copied to the triangles, by name: F rows each. "isovalue" where several were asked for."""
        return self._surface.cell_fields

    @property
    def edge_ends(self) -> np.ndarray | None:
        """None, or V x 2, int64: the points of the grid between which each vertex lies, the one below first."""
        return self._surface.edge_ends

    @property
    def edge_weights(self) -> np.ndarray | None:
        """None, or V numbers: 0 at the first end of the edge, 1 at the second."""
        return self._surface.edge_weights

    @property
    def source_cells(self) -> np.ndarray | None:
        """None, or F numbers, int64: the grid's cell of each triangle."""
        return self._surface.source_cells

    @property
    def solid(self) -> dict[str, Any] | None:
        """None, or of a solid: "volume", "grid_volume", "isosurface_area", "boundary_area", "isosurface_triangles" (the first
        ones), "open_edges" (0: closed), "seam_edges" (of the isosurface inside the grid, where points are doubled),
        "unfit_edges" (where cells of different sizes do not fit), and "patches": of those that the file names number, name,
        triangles and area; the cell field "patch" has the numbers."""
        return self._how.get("solid")

    @property
    def area(self) -> float:
        """Of all triangles, in the square of the unit of the points."""
        return self._surface.area()

    @property
    def notes(self) -> list[str]:
        """What the call that made the surface has to say: that memory was too little to pack, say."""
        return self._how.get("notes", [])

    @property
    def field_bound(self) -> float | None:
        """With `tolerance`, where there are curved cells: how far the field is at most from their own. Else None."""
        return self._how.get("field_bound")

    @property
    def method(self) -> str | None:
        """"direct" or "clusters": how the surface was made. Both give the same one, in another order."""
        return self._how.get("method")

    def keep_parts(self, kept: int | Iterable[int] = 0, *, threads: int = 0, progress: Progress | None = None) -> Surface:
        """The surface with some of its connected parts only, by their places in `parts` (0: the largest), and the cell field
        "part" with these numbers.

        Raises ValueError for a number that is not below that of the parts.
        """
        numbers = [kept] if isinstance(kept, (int, np.integer)) else [int(part) for part in kept]
        if any(part < 0 for part in numbers):
            raise ValueError(f"part {min(numbers)} is asked for, but parts are counted from 0")
        return self._changed(_isotet.keep_parts(self._surface, numbers, call_options(threads, progress)))

    def _changed(self, surface: _isotet.Surface) -> Surface:
        """This surface after some of its triangles went; of a solid, with the numbers of what is left."""
        how = dict(self._how)
        solid = how.get("solid")
        if solid is not None:
            left = _isotet.measure_solid(surface, call_options(0, None))
            by_number = {patch["number"]: patch for patch in left["patches"]}
            has_patches = "patch" in surface.cell_fields
            nothing = {"triangles": 0, "area": 0.0}
            patches = [{**patch, **{key: by_number.get(patch["number"], nothing)[key] for key in nothing}}
                       for patch in solid["patches"]] if has_patches else []  # fmt: skip
            how["solid"] = {**solid, **left, "patches": patches}
        return Surface._of(surface, how)

    def parts_touching(
        self, field: str, value: float | tuple[float, float], *, threads: int = 0, progress: Progress | None = None
    ) -> list[int]:
        """The connected parts that touch a region, for `keep_parts`: those with a triangle in a cell of it.

        field: a cell field that the surface carries; "boundary" of a solid is 1 on the grid's boundary
        value: the region's value, or the lowest and the highest of several

        Raises ValueError where the surface has no such cell field.
        """
        lower, upper = value if isinstance(value, tuple) else (value, value)
        return _isotet.parts_touching(self._surface, field, lower, upper, call_options(threads, progress))

    def reduce(
        self, share: float = 0.9, error: float | None = None, *, threads: int = 0, progress: Progress | None = None
    ) -> Surface:
        """The surface with fewer triangles: vertices are left out where that moves it least, by meshoptimizer.

        share: of the triangles that may go, from 0 to below 1
        error: how far the surface may move, in units of the grid, by meshoptimizer's measure: a mean, no bound

        Vertices that stay keep their point fields; closed surfaces stay closed, and cell fields but isovalue, part and
        boundary, edge_ends and source_cells are left out.
        """
        most = math.inf if error is None else float(error)
        return self._changed(_isotet.reduce(self._surface, share, most, call_options(threads, progress)))

    def write(
        self,
        path: str | os.PathLike[str],
        *,
        format: str = "",
        compression: str = "none",
        progress: Progress | None = None,
    ) -> list[str]:
        """Writes the surface: .vtp, .ply, .stl, .3mf, .obj, .glb, .usda, .vtk (legacy) or .ts (Gocad), whole or not at all.

        compression, of .vtp only: "zlib", which every VTK reads, or "lz4", which is read faster.

        Returns sentences on what the format could not hold.

        Raises OSError where the file cannot be written, ValueError for an unknown format.
        """
        return _isotet.write_surface(self._surface, os.fspath(path), format, compression, call_options(0, progress))

    def to_pyvista(self) -> pyvista.PolyData:
        """The surface as pyvista.PolyData, with its normals and fields. The arrays are copies."""
        import pyvista

        from ._vtk_data import to_polydata

        return pyvista.wrap(to_polydata(self))

    def to_vtk(self) -> vtkPolyData:
        """The surface as vtkPolyData, with its normals and fields. The arrays are copies."""
        from ._vtk_data import to_polydata

        return to_polydata(self)

    def to_trimesh(self) -> trimesh.Trimesh:
        """The surface as trimesh.Trimesh: the same vertices, faces and normals, the fields as attributes. The arrays are copies."""
        import trimesh

        points = {name: np.array(values) for name, values in self.fields.items()}
        faces = {name: np.array(values) for name, values in self.cell_fields.items()}
        return trimesh.Trimesh(
            np.array(self.points, np.float64), self.triangles.astype(np.int64), process=False,
            vertex_normals=np.array(self.normals) if self._has_vertex_normals else None,
            face_normals=np.array(self.normals) if self.normals_kind == "face" else None,
            vertex_attributes=points, face_attributes=faces)  # fmt: skip

    def to_meshio(self) -> meshio.Mesh:
        """The surface as meshio.Mesh, with its fields. The arrays are copies."""
        import meshio

        return meshio.Mesh(
            np.array(self.points), [("triangle", self.triangles.astype(np.int64))],
            point_data={name: np.array(values) for name, values in self.fields.items()},
            cell_data={name: [np.array(values)] for name, values in self.cell_fields.items()})  # fmt: skip

    def __repr__(self) -> str:
        surface = self._surface
        names = list(self.fields) + list(self.cell_fields)
        carried = f", fields {', '.join(names)}" if names else ""
        return f"<isotet.Surface: {surface.vertex_count} vertices, {surface.triangle_count} triangles{carried}>"

    def _repr_png_(self) -> bytes | None:
        """A picture for notebooks."""
        from ._picture import png_of, render

        return png_of(render(self, size=(800, 600))) if self._surface.triangle_count else None

    def _repr_html_(self) -> str:
        """A picture with a line of text, for notebooks."""
        picture, text = self._repr_png_(), html.escape(repr(self))
        if picture is None:
            return f"<pre>{text}</pre>"
        data = base64.b64encode(picture).decode()
        return f'<figure><img width="400" src="data:image/png;base64,{data}"/><figcaption>{text}</figcaption></figure>'

    def _ipython_display_(self) -> None:
        """Shows the surface in a notebook, by PyVista's backend where PyVista is installed, else by a picture."""
        try:
            import pyvista  # noqa: F401
        except ImportError:
            raise NotImplementedError from None  # IPython then asks for the others
        print(self)
        if self._surface.triangle_count:
            self.to_pyvista().plot(notebook=True, smooth_shading=self._has_vertex_normals)

    def __reduce__(self) -> tuple[Any, ...]:
        fields = {name: np.array(values) for name, values in self.fields.items()}
        cell_fields = {name: np.array(values) for name, values in self.cell_fields.items()}
        arrays = (self.normals, self.edge_ends, self.edge_weights, self.source_cells)
        copies = tuple(None if array is None else np.array(array) for array in arrays)
        return _restored, (np.array(self.points), np.array(self.triangles), self.normals_kind, *copies, fields, cell_fields,
                           dict(self._how))  # fmt: skip


def _restored(points, triangles, kind, normals, ends, weights, sources, fields, cell_fields, how) -> Surface:
    """A surface of a pickle."""
    surface = _isotet.Surface(points, triangles, kind, normals, ends, weights, sources, list(fields.items()),
                              list(cell_fields.items()))  # fmt: skip
    return Surface._of(surface, how)


class SurfaceReport(dict):
    """What a surface is, counted: a dict whose entries are attributes, too.

    ``sound``: nothing was found that was asked for. ``closed``: no edge is open. ``area`` and ``volume`` in the units of
    the points. ``findings``: sentences and places of the first faults.
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(name) from None

    def __dir__(self):
        return [*super().__dir__(), *self]


def parts(surface: Surface, *, threads: int = 0, progress: Progress | None = None) -> list[dict[str, Any]]:
    """The connected parts of a surface, largest area first: triangles, vertices, area, volume (None where it is not closed),
    closed, centre, lower, upper, and the means of its fields over the area.

    >>> import isotet
    >>> surface = isotet.make("kuhn", 12, ["gyroid"]).contour(0.95)
    >>> table = isotet.parts(surface)
    >>> sum(part["triangles"] for part in table) == len(surface.triangles)
    True
    """
    return _isotet.find_parts(surface._surface, call_options(threads, progress))


def check(surface: Surface, *, grid: Grid | None = None, field: npt.ArrayLike | str | None = None, closed: bool = False,
          weld: bool = False, max_findings: int = 5, threads: int = 0, progress: Progress | None = None) -> SurfaceReport:  # fmt: skip
    """Measures a surface and looks for what should not be there.

    closed
        Every open edge is a fault.
    grid
        The grid that the surface was extracted from: open edges are faults unless they lie in its boundary. The surface
        must have ``edge_ends``.
    field
        With `grid`, the contoured field, by name or as an array: cells without data are then no part of the grid.
    weld
        Join vertices of equal coordinates first, for surfaces from STL files.
    max_findings
        How many faults of each kind are described.

    Raises ValueError where a triangle has a vertex that is not there, or a point is not finite.

    >>> import isotet
    >>> grid = isotet.make("kuhn", 8, ["sphere"])
    >>> report = isotet.check(grid.contour(0.5, "sphere"), closed=True)
    >>> report.sound, report.euler
    (True, 2)
    """
    chosen = None
    if grid is not None and surface.edge_ends is None and len(surface.points):
        raise ValueError("the surface has no edge ends, but to check against a grid it needs them: contour it with edge_ends=True")
    if grid is not None and field is not None:
        chosen = grid._field(field)
    report = _isotet.check(surface._surface, closed, None if grid is None else grid._grid, chosen, weld, max_findings,
                           call_options(threads, progress))  # fmt: skip
    return SurfaceReport(report)


def read_surface(path: str | os.PathLike[str], *, format: str = "", progress: Progress | None = None) -> Surface:
    """Reads a surface from the file at `path`: VTP, PLY, STL, 3MF, OBJ, legacy VTK, Gocad TSurf; of the
    `format` that is named, or found out.

    Raises OSError where the file cannot be read, ValueError where its content is broken.
    """
    return Surface._of(_isotet.read_surface(os.fspath(path), format, call_options(0, progress)))
