# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""PyVista's picture of a file with its defaults: five isosurfaces of the field, outline, scale. FILE FIELD TIME PICTURE; - is no field, no time"""

import sys

import numpy as np
import pyvista

file, field, time, picture = sys.argv[1:]
reader = pyvista.get_reader(file)
if time != "-" and hasattr(reader, "set_active_time_value"):
    reader.set_active_time_value(float(time))
mesh = reader.read()
if isinstance(mesh, pyvista.MultiBlock):
    mesh = mesh.combine()

base, _, part = field.partition(":")
if base in mesh.cell_data and base not in mesh.point_data:
    mesh = mesh.cell_data_to_point_data()
if part == "mag" and base in mesh.point_data:
    mesh.point_data[field] = np.linalg.norm(mesh.point_data[base], axis=1)
    base = field

plotter = pyvista.Plotter(off_screen=True, window_size=(800, 600))
plotter.add_mesh(mesh.outline())
if base in mesh.point_data:
    plotter.add_mesh(mesh.contour(5, scalars=base))
else:
    plotter.add_mesh(mesh)
plotter.screenshot(picture)
