# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Blood flow in an artery, with PyVista: one line is another. isotet need not be imported."""

from pathlib import Path

import pyvista as pv

grid = pv.read(Path(__file__).parents[2] / "data/vtu/artery_flow_tet_wedge.vtu")
print(grid.array_names)

# Instead of grid.contour([0.1, 0.2, 0.3], scalars="Umag"):
surfaces = grid.isotet.contour([0.1, 0.2, 0.3], scalars="Umag", compute_normals=True)
print(f"{surfaces.n_points} points, {surfaces.n_cells} triangles, arrays {surfaces.array_names}")

plotter = pv.Plotter(off_screen=True)
plotter.add_mesh(grid.extract_surface(algorithm=None), color="white", opacity=0.15)
plotter.add_mesh(surfaces, scalars="p", cmap="viridis", smooth_shading=True)
plotter.screenshot("artery.png")
plotter.close()

# A slider that is followed while it is dragged; in a window, without off_screen.
plotter = pv.Plotter(off_screen=True)
plotter.isotet.add_isovalue(grid, "Umag", value=0.2, title="speed", cmap="viridis")
plotter.show(screenshot="slider.png")
