# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The first contour: a file, an isovalue, a surface, a picture. Usage: first_contour.py [FILE FIELD ISOVALUE]"""

import sys
from pathlib import Path

import isotet

data = Path(__file__).parents[2] / "data/vtu/artery_flow_tet_wedge.vtu"
path, field, isovalue = sys.argv[1:] or (data, "Umag", 0.2)

grid = isotet.read(path)
print(grid)
surface = grid.contour(float(isovalue), field, normals="gradient")
print(surface, f"area {surface.area:.4g}")
surface.write("surface.vtp")  # for ParaView; .ply, .stl and .obj, too

mesh = surface.to_pyvista()
other = next(name for name in surface.fields if surface.fields[name].ndim == 1 and name != field)
mesh.plot(scalars=other, smooth_shading=True, off_screen=True, screenshot="surface.png")
