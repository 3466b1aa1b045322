# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvbatch: a picture of the filter's surface, coloured by another array. The argument is the file."""

from support import *

load()
points, cells, field = lattice(32)
wave = (np.sin(12 * points[:, 2]) * np.cos(9 * points[:, 1])).astype(np.float32)
filter = contour(made(grid_of(points, cells, {"r": field, "wave": wave})), [0.2, 0.3, 0.4])
clip = simple.Clip(Input=filter, ClipType="Plane")
clip.ClipType.Origin, clip.ClipType.Normal = [0.5, 0.5, 0.5], [0.45, -1, 0.35]
view = simple.CreateRenderView(ViewSize=[640, 480], Background=[1, 1, 1], UseColorPaletteForBackground=0, OrientationAxesVisibility=0)
shown = simple.Show(clip, view)
simple.ColorBy(shown, ("POINTS", "wave"))
shown.SetScalarBarVisibility(view, False)
simple.ResetCamera(view)
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0.9, -1.4, 1.1], [0.5, 0.5, 0.47], [0, 0, 1]
simple.ResetCamera(view)
view.GetActiveCamera().Zoom(1.3)
simple.SaveScreenshot(sys.argv[1], view)
if ranks == 1:
    pixels = pixels_of(sys.argv[1])
    drawn = (pixels.min(axis=1) < 250).mean()
    assert 0.1 < drawn < 0.9, drawn
    colourful = (np.ptp(pixels, axis=1) > 60).mean()
    assert colourful > 0.05, colourful
print("ok")
