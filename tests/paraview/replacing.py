# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvbatch, with ISOTET_REPLACE_CONTOUR=1: ParaView's own Contour is carried out by isotet once the plugin is loaded."""

from support import *

points, cells, field = lattice(12)
# Many points have the isovalue: VTK's own surface has triangles without an area there, isotet's has none.
field = np.round(field * 16) / 16
name = write(grid_of(points, cells, {"r": field.astype(np.float32)}), f"replacing-{ranks}-{os.getpid()}.vtu")


def reader():
    return simple.XMLUnstructuredGridReader(FileName=[name])


def contour_of(value):
    return fetch(simple.Contour(Input=reader(), ContourBy=["POINTS", "r"], Isosurfaces=[value], ComputeNormals=0))


def flat(surface):
    corners = points_of(surface)[triangles_of(surface)]
    return sum(len({tuple(corner) for corner in triangle}) < 3 for triangle in corners)


before = contour_of(0.25)
load()
after = contour_of(0.25)
ours = fetch(contour(reader(), 0.25, ComputeNormals=0))
assert corners_of(after) == corners_of(ours), (after.GetNumberOfPolys(), ours.GetNumberOfPolys())
assert after.GetNumberOfPoints() > 0 and flat(after) == 0
assert corners_of(before) != corners_of(after)
image = simple.Wavelet()
assert fetch(simple.Contour(Input=image, ContourBy=["POINTS", "RTData"], Isosurfaces=[150])).GetNumberOfCells() > 0
os.remove(name)
print("ok")
