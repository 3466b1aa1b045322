# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""IsotetContour in place of vtkContourFilter: old scripts run, and what isotet does not contour VTK does."""

import subprocess
import sys
import threading

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkContourFilter

from isotet.vtk import IsotetContour
from test_pyvista import cubes
from test_vtk import output, pipeline


def both(grid, name="r", *, values=(2.5,), association=0, **settings):
    """The outputs of our filter and of VTK's, set up in the same way."""
    out = []
    for kind in (IsotetContour, vtkContourFilter):
        contour = kind()
        contour.SetInputData(grid)
        contour.SetInputArrayToProcess(0, 0, 0, association, name)
        contour.SetNumberOfContours(len(values))
        for i, value in enumerate(values):
            contour.SetValue(i, value)
        for setting, value in settings.items():
            getattr(contour, f"Set{setting}")(value)
        contour.Update()
        out.append(pv.wrap(contour.GetOutput()))
    return out


def test_every_method_and_property_of_vtk_is_there():
    ours, theirs = IsotetContour(), vtkContourFilter()
    assert set(dir(theirs)) - set(dir(ours)) == set()
    read = [{name for name in dir(theirs) if name.islower() and hasattr(contour, name)} for contour in (ours, theirs)]
    assert read[0] == read[1] and "input_data" not in read[0], "which VTK only writes"
    for name in ("ComputeNormals", "ComputeScalars", "ComputeGradients", "GenerateTriangles", "UseScalarTree", "ArrayComponent",
                 "OutputPointsPrecision", "FastMode", "NumberOfContours", "ContourValues", "ScalarTree", "Locator"):  # fmt: skip
        assert getattr(ours, f"Get{name}")() == getattr(theirs, f"Get{name}")(), name
        snake = "".join("_" * letter.isupper() + letter.lower() for letter in name)[1:]
        assert getattr(ours, snake) == getattr(theirs, snake), name
    for name in ("ComputeNormals", "ComputeScalars", "ComputeGradients", "GenerateTriangles", "UseScalarTree", "FastMode"):
        for switch in ("On", "Off", "On"):
            for contour in (ours, theirs):
                getattr(contour, name + switch)()
            assert getattr(ours, f"Get{name}")() == getattr(theirs, f"Get{name}")()


def test_isovalues_are_set_as_vtk_sets_them():
    ours, theirs = IsotetContour(), vtkContourFilter()
    for contour in (ours, theirs):
        contour.SetContourValues([1, 2])
        contour.SetValue(0, 4)
        contour.SetValue(-1, 5)
    assert ours.GetContourValues() == theirs.GetContourValues() == (5.0, 2.0)
    assert [ours.GetValue(i) for i in (-1, 0, 1, 7)] == [theirs.GetValue(i) for i in (-1, 0, 1, 7)]
    for lower_upper in (((0, 1),), (0, 1)):
        for contour in (ours, theirs):
            contour.GenerateValues(3, *lower_upper)
        assert ours.contour_values == theirs.contour_values
    for contour in (ours, theirs):
        contour.SetNumberOfContours(-3)
    assert ours.GetNumberOfContours() == theirs.GetNumberOfContours() == 0
    filled = [0.0] * 2
    ours.contour_values = (3, 4)
    ours.GetValues(filled)
    assert filled == ours.values == [3.0, 4.0]


def test_properties_are_keywords():
    contour = IsotetContour(compute_normals=False, contour_values=[1, 2], expected_surfaces=7, input_data=cubes(), input_array="x")
    assert (contour.GetComputeNormals(), contour.GetContourValues(), contour.GetExpectedSurfaces()) == (0, (1.0, 2.0), 7)
    contour.Update()
    assert set(pv.wrap(contour.output)["x"]) == {1.0, 2.0}
    assert contour.input.GetNumberOfCells() == 512
    for kind in (IsotetContour, vtkContourFilter):
        with pytest.raises(TypeError, match="Unexpected keyword argument 'isovalue'"):
            kind(isovalue=1)


def test_it_is_called_and_piped_as_vtks_filters():
    grid = vtkUnstructuredGrid()  # PyVista's cannot be given to VTK's own filters in this way
    grid.ShallowCopy(cubes())
    for kind in (IsotetContour, vtkContourFilter):
        contour = kind(input_array="r", contour_values=[2.5])
        assert (vtkAppendFilter() >> contour)(grid).GetNumberOfCells() > 0
        assert contour(grid).GetNumberOfCells() > 0


def test_outputs_are_there_before_an_execution_and_can_be_set():
    contour = pipeline(cubes())
    assert contour.GetOutput() is None or contour.GetOutput().GetNumberOfCells() == 0
    own = pv.PolyData()
    contour.SetOutput(own)
    contour.Update()
    assert own.n_cells > 0
    empty = IsotetContour()
    assert empty.GetInput() is None and empty.GetPolyDataInput(0) is None


def test_defaults_give_the_arrays_of_vtk():
    ours, theirs = both(cubes())
    assert set(ours.point_data) == set(theirs.point_data) and "Normals" in ours.point_data
    assert set(ours.cell_data) == set(theirs.cell_data)
    assert ours.active_scalars_name == theirs.active_scalars_name == "r"
    ours, theirs = both(cubes(), ComputeScalars=0, ComputeNormals=0)
    assert set(ours.point_data) == set(theirs.point_data) == {"x", "v"}


@pytest.mark.parametrize("scalars", ["x", "r", None])
@pytest.mark.parametrize("settings", [{}, {"ComputeScalars": 0}, {"ComputeNormals": 0}], ids=str)
@pytest.mark.parametrize("with_others", [False, True])
def test_active_arrays_are_those_of_vtk(scalars, settings, with_others):
    grid = cubes()
    if with_others:
        grid = grid.merge(pv.examples.cells.Triangle().translate((2, 2, 2.3)), merge_points=False)
        grid["r"] = np.linalg.norm(grid.points - 4, axis=1)
    grid["upwards"] = np.tile(np.float32([0, 0, 1]), (grid.n_points, 1))
    points, cells = grid.GetPointData(), grid.GetCellData()
    points.SetActiveScalars(scalars)
    points.SetActiveVectors("v")
    points.SetActiveNormals("upwards")
    cells.SetActiveScalars("number")
    ours, theirs = both(grid, **settings)
    for data in ("GetPointData", "GetCellData"):
        for kind in ("GetScalars", "GetVectors", "GetNormals", "GetTCoords", "GetTensors"):
            active = [getattr(getattr(surface, data)(), kind)() for surface in (ours, theirs)]
            assert [array and array.GetName() for array in active] == [active[1] and active[1].GetName()] * 2, (data, kind)


def test_ids_are_carried_where_vtk_carries_them():
    grid = cubes()
    for data, count in ((grid.point_data, grid.n_points), (grid.cell_data, grid.n_cells)):
        for name in ("global", "pedigree"):
            data[name] = np.arange(count)
        data.SetActiveGlobalIds("global")
        data.SetActivePedigreeIds("pedigree")
    for ours, theirs in (both(grid), (grid.isotet.contour([2.5], "r"), grid.contour([2.5], "r"))):
        assert set(ours.point_data) == set(theirs.point_data) and "global" not in ours.point_data
        assert set(ours.cell_data) == set(theirs.cell_data) == {"number", "pedigree"}
    assert both(grid)[0].GetCellData().GetPedigreeIds().GetName() == "pedigree"


@pytest.mark.parametrize("points", [np.float32, np.float64])
@pytest.mark.parametrize("precision", [0, 1, 2])
def test_the_precision_of_points_holds(points, precision):
    grid = cubes()
    grid.points = grid.points.astype(points) - 4  # the middle is 0
    grid["v"] = grid["v"].astype(np.float32)
    grid["x"] = grid["x"].astype(np.float64)
    ours, theirs = both(grid, OutputPointsPrecision=precision)
    for name in ("r", "v", "x"):
        assert ours[name].dtype == theirs[name].dtype == grid[name].dtype, "which has nothing to do with that of points"
    assert ours.points.dtype == theirs.points.dtype == [np.float32, np.float64, points][precision]


def test_double_precision_is_that_of_the_computation():
    grid = cubes()
    grid.points = grid.points.astype(np.float32)
    fine, coarse = (both(grid, "r", values=(2.1,), OutputPointsPrecision=kind)[0].points for kind in (1, 0))
    assert np.abs(fine - fine.astype(np.float32)).max() > 0
    assert np.allclose(fine, coarse, atol=1e-5)


@pytest.mark.parametrize("cell", [cell for cell in ("Triangle", "Line", "ConvexPointSet") if hasattr(pv.examples.cells, cell)])
def test_other_cells_are_contoured_by_vtk(cell):
    grid = getattr(pv.examples.cells, cell)()
    grid["x"] = grid.points[:, 0]
    with pytest.warns(UserWarning, match="1 of 1 cells are contoured by vtkContourFilter"):
        ours, theirs = both(grid, "x", values=(0.3,))
    assert (ours.n_cells, ours.n_points) == (theirs.n_cells, theirs.n_points) and ours.n_points > 0


def test_cells_of_all_dimensions_together():
    whole = pv.merge([cubes(3), pv.Plane(center=(9, 0, 0), direction=(0, 0, 1)), pv.Line((20, 0, 0), (20, 3, 0))], merge_points=False)
    whole["y"] = whole.points[:, 1]
    with pytest.warns(UserWarning, match="101 of 109 cells are contoured by vtkContourFilter"):
        surface, theirs = both(whole, "y", values=(0.21,), ComputeNormals=0)
    assert (surface.n_lines, surface.n_verts) == (theirs.n_lines, theirs.n_verts) == (10, 1)
    assert surface.area == pytest.approx(theirs.area) and surface.area == pytest.approx(4)
    contour = pipeline(whole, "y", 0.21)
    heard = []
    contour.AddObserver("WarningEvent", lambda *_: heard.append(1))
    output(contour)
    contour.SetValue(0, 0.22)
    output(contour)
    assert heard == [1], "once"


@pytest.mark.parametrize("kind", ["image", "polydata", "rectilinear", "structured"])
def test_other_data_sets_are_contoured_by_vtk(kind):
    image = pv.ImageData(dimensions=(5, 5, 5))
    grid = {"image": image, "polydata": pv.Sphere(), "rectilinear": image.cast_to_rectilinear_grid(),
            "structured": image.cast_to_structured_grid()}[kind]  # fmt: skip
    grid["x"] = grid.points[:, 0] + 0.01 * grid.points[:, 1]
    with pytest.warns(UserWarning, match=f"{type(grid).__mro__[1].__name__.removesuffix('_')}|vtk.*is contoured by vtkContourFilter"):
        ours, theirs = both(grid, "x", values=(0.3,))
    assert (ours.n_cells, ours.n_points) == (theirs.n_cells, theirs.n_points) and ours.n_cells > 0
    assert set(ours.point_data) == set(theirs.point_data)


def test_a_block_that_is_none_of_ours_leaves_the_others_alone():
    sphere = pv.Sphere()
    sphere["r"] = 5 * sphere.points[:, 2]
    blocks = pv.MultiBlock([cubes(), sphere, None, pv.Table({"r": np.ones(1)}), pv.MultiBlock([cubes(6)]), cubes(3)])
    blocks[5].clear_data()
    with pytest.warns(UserWarning, match="vtkPolyData is contoured by vtkContourFilter"):
        surfaces = output(pipeline(blocks, value=2.0))
    assert [surfaces[i].n_cells > 0 for i in (0, 1)] == [True, True]
    assert surfaces[0].area == output(pipeline(cubes(), value=2.0)).area
    assert surfaces[4][0].n_cells > 0
    assert surfaces[5].n_cells == 0


def test_cell_arrays_are_averaged():
    grid = cubes()
    contour = pipeline(grid, value=300.0)
    contour.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "number")
    surface = output(contour)
    assert surface.area == pytest.approx(grid.cell_data_to_point_data().contour([300.0], "number").area, rel=0.02)
    assert set(surface.point_data["number"]) == {300.0} and len(surface.cell_data["number"]) == surface.n_cells
    contour.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS_THEN_CELLS, "number")
    assert output(contour).area == surface.area
    image = pv.ImageData(dimensions=(5, 5, 5))
    image.cell_data["number"] = np.arange(64)
    contour.SetInputData(image)
    contour.SetValue(0, 30.5)
    with pytest.warns(UserWarning, match="vtkImageData is contoured"):
        assert output(contour).area == pytest.approx(16, rel=0.05)


def test_components_are_chosen():
    grid = cubes()
    assert output(pipeline(grid, "v", 5.0)).bounds[:2] == (2.5, 2.5)
    contour = pipeline(grid, "v", 5.0)
    contour.SetArrayComponent(1)
    surface = output(contour)
    assert surface.bounds[2:4] == (2.5, 2.5) and set(surface["v_1"]) == {5.0}
    contour.SetInputArrayToProcess(0, 0, 0, "vtkDataObject::FIELD_ASSOCIATION_POINTS", "v", "L2Norm")
    surface = output(contour)
    assert np.allclose(np.linalg.norm(surface["v"], axis=1), 5, atol=0.5)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "v", 2)
    assert output(contour).bounds[4:] == (2.5, 2.5)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "v", 3)
    heard = []
    contour.AddObserver("ErrorEvent", lambda *_: heard.append(1))
    assert output(contour).n_cells == 0 and heard == [1]


@pytest.mark.parametrize("shape", ["cubes", "tets", "wedges"])
def test_polygons_are_those_of_the_cells(shape):
    grid = cubes()
    if shape == "tets":
        grid = grid.triangulate()
    if shape == "wedges":
        side = pv.Plane(i_resolution=6, j_resolution=6).triangulate().cast_to_unstructured_grid()
        grid = wedges(side)
        grid["r"] = np.linalg.norm(grid.points, axis=1) * 4
        grid.cell_data["number"] = np.arange(grid.n_cells)
    values = (1.3, 2.5) if shape != "wedges" else (1.1,)
    ours, theirs = both(grid, values=values, GenerateTriangles=0)
    assert ours.n_cells == theirs.n_cells and ours.n_points == theirs.n_points
    sizes = [sorted(np.diff(vtk_to_numpy(mesh.GetPolys().GetOffsetsArray())).tolist()) for mesh in (ours, theirs)]
    assert sizes[0] == sizes[1]
    assert ours.area == pytest.approx(theirs.area, rel=0.02)
    if shape != "wedges":  # of which VTK carries no cell data
        assert np.array_equal(np.sort(ours.cell_data["number"]), np.sort(theirs.cell_data["number"]))
    assert ours.triangulate().is_manifold == theirs.triangulate().is_manifold

def wedges(side):
    """Triangles extruded by one."""
    count = side.n_points
    corners = side.cells.reshape(-1, 4)[:, 1:]
    points = np.vstack([side.points - [0, 0, 0.5], side.points + [0, 0, 0.5]])
    return pv.UnstructuredGrid({pv.CellType.WEDGE: np.hstack([corners, corners + count])}, points)


CORNERS = {
    pv.CellType.TETRA: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    pv.CellType.PYRAMID: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)],
    pv.CellType.WEDGE: [(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 1), (1, 0, 1)],
    pv.CellType.VOXEL: [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)],
    pv.CellType.HEXAHEDRON: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
}


@pytest.mark.parametrize("cell", list(CORNERS), ids=lambda cell: cell.name)
def test_every_case_of_a_cell_cuts_the_edges_that_vtk_cuts(cell):
    """What VTK's tests of single cells ask, for all signs of the corners at once."""
    corners = np.array(CORNERS[cell], float)
    count = len(corners)
    cases = (np.arange(2**count)[:, None] >> np.arange(count)) & 1
    points = corners[None] + 3 * np.arange(2**count)[:, None, None] * [1, 0, 0]
    grid = pv.UnstructuredGrid({cell: np.arange(cases.size).reshape(-1, count)}, points.reshape(-1, 3))
    grid["r"] = cases.reshape(-1).astype(float)
    grid.cell_data["case"] = np.arange(2**count)
    ours, theirs = both(grid, values=(0.5,), ComputeNormals=0)
    assert ours.n_points == theirs.n_points > 0
    assert np.allclose(np.sort(ours.points, axis=0), np.sort(theirs.points, axis=0))
    assert set(ours.cell_data["case"]) == set(theirs.cell_data["case"]) == set(range(1, 2**count - 1))
    assert (ours.is_manifold, ours.n_open_edges > 0) == (False, True)


def test_a_constant_array_gives_nothing():
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    grid = pv.UnstructuredGrid({pv.CellType.TETRA: np.array([[0, 1, 2, 3]])}, points)
    grid["r"] = np.full(4, 1000.0)
    ours, theirs = both(grid, values=(1000.0,), UseScalarTree=1)
    assert ours.n_points == theirs.n_points == 0


def test_implicit_arrays_of_vtk_are_read():
    from vtkmodules.vtkCommonCore import vtkConstantArray

    grid = cubes()
    constant = vtkConstantArray["float64"]() if hasattr(vtkConstantArray, "__getitem__") else vtkConstantArray()
    constant.SetName("constant")
    constant.SetNumberOfTuples(grid.n_points)
    constant.ConstructBackend(4.0)
    grid.GetPointData().AddArray(constant)
    surface = output(pipeline(grid))
    assert set(np.asarray(surface.point_data["constant"])) == {4.0}


def test_without_isovalues_the_first_is_0():
    contour = IsotetContour()
    contour.SetNumberOfContours(0)
    assert contour.GetValue(0) == contour.GetValue(3) == 0, "VTK reads memory that is not its own"


def test_no_isovalues_give_the_shapes_of_a_surface():
    contour = pipeline(cubes())
    contour.SetNumberOfContours(0)
    surface = output(contour)
    assert surface.points.shape == (0, 3) and surface.n_cells == 0


def test_progress_is_told_in_this_thread_and_an_abort_ends_it():
    contour = pipeline(cubes(25).triangulate())
    contour.SetExpectedSurfaces(100)
    told, threads = [], set()

    def hear(caller, event):
        told.append(caller.GetProgress())
        threads.add(threading.get_ident())

    contour.AddObserver("ProgressEvent", hear)
    assert output(contour).n_cells > 0
    assert told == sorted(told) and len(told) > 2 and 0 <= told[0] <= told[-1] <= 1
    assert threads == {threading.get_ident()}
    contour = pipeline(cubes(25).triangulate())
    contour.SetExpectedSurfaces(100)
    contour.AddObserver("ProgressEvent", lambda caller, _: caller.AbortExecuteOn())
    contour.Update()
    assert pv.wrap(contour.GetOutput()).n_cells == 0


def test_what_the_last_execution_did_is_told():
    grid = cubes()
    contour = pipeline(grid)
    contour.SetExpectedSurfaces(100)
    contour.SetComputeNormals(0)
    output(contour)
    assert (contour.GetLastUpdate(), contour.GetUsedPackedGrids()) == ("grid", True)
    assert contour.GetPackedBytes() > 0 and contour.GetPackSeconds() > 0 and contour.GetExtractSeconds() > 0
    grid.cell_data["more"] = np.arange(grid.n_cells)
    contour.SetComputeNormals(1)
    assert "more" in output(contour).cell_data
    assert (contour.GetLastUpdate(), contour.GetPackSeconds()) == ("nothing", 0)
    contour.SetNumberOfThreads(1)
    assert contour.number_of_threads == 1 and output(contour).n_cells > 0


SERIES = """
import os, sys
import numpy as np, pyvista as pv
from isotet.vtk import IsotetContour

def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

contour = IsotetContour(contour_values=[2.0], compute_normals=False, expected_surfaces=10**6)
contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
for step in range(int(sys.argv[1])):
    grid = pv.ImageData(dimensions=(17,) * 3).cast_to_unstructured_grid()  # as a reader gives it: all arrays are new
    grid["r"] = np.linalg.norm(grid.points - 8, axis=1) * (1 + step % 7 / 10)
    contour.SetInputData(grid)
    contour.Update()
    assert len(contour._sessions) == 1 and contour.GetOutput().GetNumberOfCells() > 0
    assert step == 0 or contour.GetLastUpdate() == "field", contour.GetLastUpdate()
    if step == 9:
        early = resident()
print((resident() - early) >> 20)
"""


def test_a_series_stores_values_only_and_its_memory_is_flat():
    done = subprocess.run([sys.executable, "-c", SERIES, "80"], capture_output=True, text=True, timeout=250, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) < 10  # a session takes more than half a MB
