# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvpython and pvbatch: the plugin's filter on one process."""

from support import *

load()


def told(filter, name):
    filter.UpdatePipeline()
    filter.SMProxy.UpdatePropertyInformation()
    return filter.SMProxy.GetProperty(name).GetElement(0)


# Properties, domains and defaults.
grid = lattice(8)
source = made(grid_of(grid[0], grid[1], {"r": grid[2], "s": 1 - grid[2]}))
filter = simple.IsotetContour(Input=source)
assert list(filter.ContourBy) == ["POINTS", "r"], filter.ContourBy
assert len(filter.Isosurfaces) == 1 and grid[2].min() < filter.Isosurfaces[0] < grid[2].max(), filter.Isosurfaces
assert filter.GetProperty("Isosurfaces").GetDomain("scalar_range") is not None
assert filter.ComputeNormals == 1 and filter.ComputeScalars == 1
for name in filter.ListProperties():
    documentation = filter.GetProperty(name).SMProperty.GetDocumentation()
    assert name in ("Input", "PointMergeMethod") or (documentation and documentation.GetDescription()), name

# The surface of ParaView's Contour, and its arrays.
filter.Isosurfaces = [0.3]
ours = fetch(filter)
theirs = fetch(simple.Contour(Input=source, ContourBy=["POINTS", "r"], Isosurfaces=[0.3]))
assert ours.GetNumberOfPoints() == theirs.GetNumberOfPoints(), (ours.GetNumberOfPoints(), theirs.GetNumberOfPoints())
assert names(ours.GetPointData()) == names(theirs.GetPointData()), names(ours.GetPointData())
assert open_edges(ours) == 0

# A cell array that is chosen as one of points is averaged by ParaView's pipeline, for this filter as for Contour.
of_cells = grid_of(grid[0], grid[1], {"r": grid[2]})
add(of_cells.GetCellData(), "c", grid[2][grid[1]].mean(axis=1))
of_cells = made(of_cells)
counts = [fetch(kind(Input=of_cells, ContourBy=["POINTS", "c"], Isosurfaces=[0.3])).GetNumberOfCells()
          for kind in (simple.IsotetContour, simple.Contour)]  # fmt: skip
assert counts[0] == counts[1] > 0, counts

# A moving isovalue keeps the cells, another array the cells, too.
filter.ExpectedSurfaces = 100
fetch(filter)
filter.Isosurfaces = [0.31]
assert told(filter, "LastUpdate") == 0
assert told(filter, "PackedBytes") > 0
filter.ContourBy = ["POINTS", "s"]
filter.Isosurfaces = [0.69]
assert told(filter, "LastUpdate") == 1

# Composite data, by ParaView's own filter.
blocks = simple.GroupDatasets(Input=[source, made(grid_of(*lattice(4)[:2], {"r": lattice(4)[2]}))])
filter = contour(blocks)
out = fetch(filter)
assert out.IsA("vtkDataObjectTree") and filter.GetDataInformation().GetNumberOfCells() > 0

# What isotet does not contour is contoured all the same.
image = simple.Wavelet()
ours = contour(image, [150.0], "RTData")
assert fetch(ours).GetNumberOfCells() == fetch(simple.Contour(Input=image, ContourBy=["POINTS", "RTData"], Isosurfaces=[150])).GetNumberOfCells()

# A state is read again, and gives the same surface.
simple.ResetSession()
cube = write(grid_of(*grid[:2], {"r": grid[2]}), f"serial-{os.getpid()}.vtu")
count = fetch(contour(simple.XMLUnstructuredGridReader(FileName=[cube]))).GetNumberOfCells()
state = os.path.join(scratch, f"serial-{os.getpid()}.pvsm")
servermanager.SaveState(state)
simple.ResetSession()
simple.LoadState(state)
again = [proxy for proxy in simple.GetSources().values() if type(proxy).__name__ == "IsotetContour"]
assert len(again) == 1 and count > 0 and fetch(again[0]).GetNumberOfCells() == count
os.remove(state)
os.remove(cube)
print("ok")
