# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Isosurfaces of large unstructured grids: tetrahedra, hexahedra, wedges and pyramids.

    surface = isotet.contour(points, cells, values, 0.5)    # arrays in, arrays out
    surface.points, surface.triangles, surface.area

    packed = isotet.pack(points, cells, values)             # once, then many surfaces in milliseconds
    surface = packed.contour([0.1, 0.2], fields={"p": p})

    grid = isotet.read("artery.vtu")                        # files
    grid.contour(0.2, "Umag").write("speed.vtp")

With PyVista, and without an import: ``grid.isotet.contour(...)`` and ``plotter.isotet.add_isovalue(...)``. A filter for VTK's
pipelines is in `isotet.vtk`.

Surfaces are closed, but for the boundary of the grid; vertices are shared; the same arrays give the same bytes on every
machine. Functions may be called from many threads; they let other Python threads run meanwhile.

Errors are ValueError (wrong arguments, broken data), TypeError (what is no number), MemoryError, OSError (files), and
`Error` for all else, each with a sentence: what, the value seen, the rule.
"""

from typing import TYPE_CHECKING

from ._grid import Clipper, Contour, Grid, PackedGrid, Solids, contour, formats, inspect, make, pack, read, solid
from ._packed_file import PackedFile, open
from ._page import Page, html
from ._picture import render
from ._pieces import Frame, make_frame, number_points
from ._surface import Surface, SurfaceReport, check, parts, read_surface

if TYPE_CHECKING:

    class Error(Exception):
        """What is no ValueError, MemoryError or OSError: the system refused something, or isotet is at fault."""

    __version__: str
else:
    from ._isotet import Error, __version__

__all__ = [
    "Clipper", "Contour", "Error", "Frame", "Grid", "PackedFile", "PackedGrid", "Page", "Solids", "Surface", "SurfaceReport", "__version__", "check", "contour", "formats",
    "html", "inspect", "make", "make_frame", "number_points", "open", "pack", "parts", "read", "read_surface", "render", "solid",
]  # fmt: skip
