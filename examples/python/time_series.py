# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A time series: the mesh stays, the field moves. What can be kept is kept."""

import numpy as np

import isotet

mesh = isotet.make("kuhn", 48, [])
x, y, z = mesh.points.T.astype(np.float64)
steps = 40

session = None
for step in range(steps):
    # Of a file: grid = isotet.read(path, fields=["p"], step=step), and "p" in place of the values.
    phase = 2 * np.pi * step / steps
    values = np.sin(3 * x + phase) + np.cos(4 * y) * np.cos(3 * z - phase)
    if session is None:
        session = isotet.Contour(mesh, values, fields=[], surfaces=steps)
        changed = "grid"
    else:
        changed = session.set(mesh, values, fields=[])
    surface = session.contour(0.5)
    surface.write(f"wave_{step:02}.vtp")
    if step < 2 or step == steps - 1:
        print(f"step {step}: {surface}, new: {changed}, {surface.method}")
