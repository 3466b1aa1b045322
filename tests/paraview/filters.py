# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvbatch or, with the port of a pvserver, by pvpython: solids, slices, clips and packed files, by the plugin that
ISOTET_PLUGINS names, loaded on both sides."""

import subprocess
import xml.etree.ElementTree as xml

from support import *

if sys.argv[1].isdigit():
    simple.Connect("localhost", int(sys.argv[1]))
load(os.environ["ISOTET_PLUGINS"])
own = f"filters-{os.environ['ISOTET_PLUGINS']}-{os.getpid()}"
points, cells, field = lattice(8)


def write_step(step):
    """The field "r" times a number, one that falls, and a field of whole numbers of the cells."""
    grid = grid_of(points, cells, {"r": field * (1 + step), "s": 1 - field, "n": np.arange(len(points), dtype=np.int32)})
    add(grid.GetCellData(), "material", np.arange(len(cells), dtype=np.int16))
    return write(grid, f"{own}-{step}.vtu")


def volume_of(source):
    """Of cells, by ParaView, which subtracts those whose corners are in the other order."""
    sizes = fetch(simple.CellSize(Input=source, ComputeSum=0)).GetCellData().GetArray("Volume")
    return np.abs(vtk_to_numpy(sizes)).sum()


def enclosed(surface):
    a, b, c = (points_of(surface)[triangles_of(surface)[:, k]].astype(float) for k in range(3))
    return (a * np.cross(b, c)).sum() / 6


def arrays(data):
    return names(data.GetPointData()), names(data.GetCellData())


steps = [write_step(step) for step in range(3)]
source = simple.XMLUnstructuredGridReader(FileName=[steps[0]])
source.UpdatePipeline()
whole = volume_of(source)

# Both plugins have the properties, defaults and ranges of this XML: that of the plugin in C++.
for wanted in xml.parse(os.environ["ISOTET_XML"]).iter("SourceProxy"):
    proxy = servermanager.ProxyManager().NewProxy("sources" if wanted.get("name") == "IsotetReader" else "filters", wanted.get("name"))
    assert proxy.GetXMLLabel() == wanted.get("label"), proxy.GetXMLLabel()
    for element in wanted:
        if not element.tag.endswith("Property"):
            continue
        property = proxy.GetProperty(element.get("name"))
        assert property and property.GetDocumentation().GetDescription(), (wanted.get("name"), element.get("name"))
        domains = {domain.get("name") for domain in element if domain.tag.endswith("Domain")}
        assert all(property.GetDomain(name) for name in domains), (element.get("name"), domains)
        given = [property.GetElement(i) for i in range(property.GetNumberOfElements())] if hasattr(property, "GetElement") else []
        if element.get("default_values") and not element.get("information_only"):
            assert [float(x) for x in given] == [float(element.get("default_values"))], (element.get("name"), given)
        assert property.GetXMLLabel().replace(" ", "") == (element.get("label") or element.get("name")).replace(" ", "")

# Solids: closed, one for each side, which make up the grid.
solid = simple.IsotetSolid(Input=source)
assert list(solid.Scalars)[0] == "POINTS" and solid.Side == "Above" and len(solid.Isovalues) == 1
solid.Scalars = ["POINTS", "r"]
volumes = {}
for side, values in (("Above", [0.3]), ("Below", [0.3]), ("Between", [0.4, 0.3]), ("Below", [0.4])):
    solid.Side, solid.Isovalues = side, values
    surface = fetch(solid)
    assert open_edges(surface) == 0 and arrays(surface) == (["n", "r", "s"], ["boundary", "material"]), arrays(surface)
    assert surface.GetPointData().GetArray("n").GetDataType() == 6
    assert set(vtk_to_numpy(surface.GetCellData().GetArray("boundary"))) <= {0, 1}
    volumes[side, values[0]] = enclosed(surface)
assert min(volumes.values()) > 0
assert abs(volumes["Above", 0.3] + volumes["Below", 0.3] - whole) < 1e-5, (volumes, whole)
assert abs(volumes["Below", 0.3] + volumes["Between", 0.4] - volumes["Below", 0.4]) < 1e-5

# Clips: the cells of these solids.
clip = simple.IsotetClip(Input=source, Scalars=["POINTS", "r"], Polyhedra=0)
for side, values in (("Above", [0.3]), ("Below", [0.3]), ("Between", [0.4, 0.3])):
    clip.Side, clip.Isovalues = side, values
    part = fetch(clip)
    assert part.IsA("vtkUnstructuredGrid") and arrays(part) == (["n", "r", "s"], ["material"]), arrays(part)
    assert part.GetPointData().GetArray("n").GetDataType() == 6 and part.GetCellData().GetArray("material").GetDataType() == 4
    assert abs(volume_of(clip) - volumes[side, values[0]]) < 1e-5, (side, volume_of(clip), volumes)
theirs = simple.Clip(Input=source, ClipType="Scalar", Scalars=["POINTS", "r"], Value=0.3, Invert=1)
assert abs(volume_of(theirs) - volumes["Below", 0.3]) < 1e-5
clip.Side, clip.Isovalues, clip.Polyhedra = "Between", [0.29, 0.31], 1
assert 42 in {fetch(clip).GetCellType(c) for c in range(fetch(clip).GetNumberOfCells())}

# Slices: as ParaView's, along each of its functions.
slice = simple.IsotetSlice(Input=source)
assert np.allclose(slice.SliceType.Origin, simple.Slice(Input=source).SliceType.Origin)
slice.SliceType.Normal = [1, 2, 3]
theirs = simple.Slice(Input=source)
theirs.SliceType.Normal = [1, 2, 3]
surface = fetch(slice)
assert abs(area_of(surface) - area_of(fetch(theirs))) < 1e-5 and arrays(surface) == (["n", "r", "s"], ["material"])
slice.SliceOffsetValues = [-0.25, 0.0, 0.25]
distances = (points_of(fetch(slice)) - slice.SliceType.Origin) @ np.array([1, 2, 3]) / 14**0.5
assert np.allclose(np.unique(np.round(distances, 4)), [-0.25, 0, 0.25])
slice.SliceOffsetValues = [0.0]
for kind, settings in (("Sphere", {"Radius": 0.4}), ("Cylinder", {"Radius": 0.3, "Axis": [0, 1, 1]}),
                       ("Box", {"Position": [0.2, 0.2, 0.2], "Length": [0.5, 0.5, 0.5]})):  # fmt: skip
    slice.SliceType = kind
    theirs.SliceType = kind
    for name, value in settings.items():
        setattr(slice.SliceType, name, value)
        setattr(theirs.SliceType, name, value)
    areas = area_of(fetch(slice)), area_of(fetch(theirs))
    assert areas[1] > 0.1 and abs(areas[0] - areas[1]) < 0.02 * areas[1], (kind, areas)

# Composite data.
blocks = simple.GroupDatasets(Input=[source, simple.XMLUnstructuredGridReader(FileName=[steps[0]])])
for filter in (simple.IsotetSolid(Input=blocks, Scalars=["POINTS", "r"], Isovalues=[0.3]), simple.IsotetSlice(Input=blocks),
               simple.IsotetClip(Input=blocks, Scalars=["POINTS", "r"], Isovalues=[0.3])):  # fmt: skip
    output = fetch(filter)
    assert output.IsA("vtkDataObjectTree") and output.GetNumberOfCells() > 0

# A packed file, with its time steps, by the file dialog's way.
packed = os.path.join(scratch, own + ".isotet")
with open(os.path.join(scratch, own + ".pvd"), "w") as series:
    series.write('<VTKFile type="Collection"><Collection>')
    series.writelines(f'<DataSet timestep="{10 * step}" file="{os.path.basename(name)}"/>' for step, name in enumerate(steps))
    series.write("</Collection></VTKFile>")
subprocess.run([os.environ["ISOTET_PROGRAM"], "pack", series.name, packed, "--all-steps", "--fields", "r,s"], check=True,
               stdout=subprocess.DEVNULL)  # fmt: skip
reader = simple.OpenDataFile(packed)
assert type(reader).__name__ == "IsotetReader", type(reader)
reader.UpdatePipelineInformation()
assert list(reader.TimestepValues) == [0, 10, 20] and list(reader.PointArrays) == ["r", "s"], reader.PointArrays
assert abs(volume_of(reader) - whole) < 1e-5
for time, step in ((0, 0), (10, 1), (15, 1), (20, 2)):
    reader.UpdatePipeline(time)
    grid = fetch(reader)
    assert (grid.GetNumberOfPoints(), grid.GetNumberOfCells()) == (len(points), len(cells))
    assert np.allclose(vtk_to_numpy(grid.GetPointData().GetArray("r")), field * (1 + step)), (time, step)
    assert np.allclose(points_of(grid), points)
reader.PointArrays = ["s"]
reader.UpdatePipeline(20)
assert names(fetch(reader).GetPointData()) == ["s"]
count = fetch(contour(reader, 1 - 0.3, by="s", ComputeNormals=0)).GetNumberOfPolys()
assert count == fetch(contour(source, 0.3, ComputeNormals=0)).GetNumberOfPolys() > 0

# A state is read again.
slice.SliceType = "Plane"
counts = {type(proxy).__name__: fetch(proxy).GetNumberOfCells() for proxy in (solid, clip, slice, reader)}
for proxy in (blocks, theirs, filter):
    simple.Delete(proxy)
if not servermanager.ActiveConnection.IsRemote():
    state = os.path.join(scratch, own + ".pvsm")
    for proxy in list(simple.GetSources().values()):
        if proxy not in (source, solid, clip, slice, reader):
            simple.Delete(proxy)
    servermanager.SaveState(state)
    simple.ResetSession()
    simple.LoadState(state)
    again = {type(proxy).__name__: proxy for proxy in simple.GetSources().values()}
    for name, count in counts.items():
        assert fetch(again[name]).GetNumberOfCells() == count > 0, name
    os.remove(state)
else:  # drawn by the server
    view = simple.CreateRenderView(ViewSize=[160, 120], OrientationAxesVisibility=0)
    view.RemoteRenderThreshold = 0
    for proxy in (clip, slice, reader):
        simple.Show(proxy, view)
    simple.Hide(reader, view)
    simple.ResetCamera(view)
    picture = os.path.join(scratch, own + ".png")
    simple.SaveScreenshot(picture, view)
    drawn = pixels_of(picture)
    assert 0.05 < (np.abs(drawn - drawn[0]).max(axis=1) > 30).mean() < 0.95
    os.remove(picture)
for name in (*steps, packed, series.name):
    os.remove(name)
print("ok")
