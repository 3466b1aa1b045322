# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet in VTK's pipelines, from Python. Needs the package vtk.

`IsotetContour` is a filter with the methods of vtkContourFilter; `IsotetSlice`, `IsotetSolid` and `IsotetClip` stand beside it,
`IsotetReader` reads packed files; `grid_of` and `to_polydata` convert data sets.
"""

from ._vtk_contour import IsotetContour
from ._vtk_data import grid_of, to_polydata
from ._vtk_parts import IsotetClip, IsotetSolid
from ._vtk_reader import IsotetReader
from ._vtk_slice import IsotetSlice

__all__ = ["IsotetClip", "IsotetContour", "IsotetReader", "IsotetSlice", "IsotetSolid", "grid_of", "to_polydata"]
