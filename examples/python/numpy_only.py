# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""NumPy only: arrays in, a closed surface out, measured and written."""

import numpy as np

import isotet

# A grid of your own: points, four corners for each tetrahedron, one value for each point. Here a torus in a cube.
grid = isotet.make("perturbed", 40, [])
points, tets = grid.points, grid.cells
x, y, z = points.T
values = np.hypot(np.hypot(x, y) - 0.6, z)

surface = isotet.contour(points, tets, values, 0.25, normals="gradient", fields={"height": z})
print(surface)

report = isotet.check(surface, closed=True)
print(f"closed: {report.closed}, handles: {report.genus}, area {report.area:.3f}, volume {report.volume:.3f}")
print(f"of the smooth torus: area {4 * np.pi**2 * 0.6 * 0.25:.3f}, volume {2 * np.pi**2 * 0.6 * 0.25**2:.3f}")

# Centres of the triangles, say, are NumPy from here on.
corners = surface.points[surface.triangles]
print("centres of the first triangles:", corners.mean(axis=1)[:2].tolist())

# Many isovalues: pack once.
packed = isotet.pack(points, tets, values)
lower, upper = packed.range
areas = [packed.contour(isovalue).area for isovalue in np.linspace(lower, upper, 50)[1:-1]]
print(f"{len(areas)} surfaces of {packed}; the largest has area {max(areas):.3f}")

surface.write("torus.ply")
