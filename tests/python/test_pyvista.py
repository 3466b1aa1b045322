# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""grid.isotet and plotter.isotet, with no import of isotet by the user; the same meaning as PyVista's own contour."""

import gc
import os
import subprocess
import sys
import threading
import weakref
from importlib.metadata import entry_points

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkFiltersCore import vtkAppendFilter

import isotet
import isotet.vtk


def cubes(side: int = 9) -> pv.UnstructuredGrid:
    grid = pv.ImageData(dimensions=(side,) * 3).cast_to_unstructured_grid()
    centre = grid.points - (side - 1) / 2
    grid["r"] = np.linalg.norm(centre, axis=1).astype(np.float32)
    grid["x"] = grid.points[:, 0].astype(np.float64)
    grid["v"] = grid.points * 2
    grid.cell_data["number"] = np.arange(grid.n_cells)
    grid.field_data["time"] = [1.5]
    grid.set_active_scalars("r")
    return grid


@pytest.fixture(params=["tets", "cubes"])
def grid(request) -> pv.UnstructuredGrid:
    whole = cubes()
    if request.param == "cubes":
        return whole
    tets = whole.triangulate()
    tets.field_data["time"] = [1.5]
    return tets


def both(grid, *args, **kwargs):
    return grid.isotet.contour(*args, **kwargs), grid.contour(*args, **kwargs)


def test_entry_points_need_no_import():
    code = (
        "import sys, pyvista as pv\n"
        "g = pv.ImageData(dimensions=(5, 5, 5)).cast_to_unstructured_grid(); g['x'] = g.points[:, 0]\n"
        "assert 'isotet' not in sys.modules\n"
        "print(g.isotet.contour([1.5], 'x').n_cells > 0, callable(pv.Plotter(off_screen=True).isotet.add_isovalue))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.split() == ["True", "True"], done.stderr
    assert done.returncode == 0


def test_the_arrays_are_those_of_pyvista(grid):
    for kwargs in ({}, {"compute_scalars": False}, {"compute_normals": True}, {"compute_gradients": True}):
        ours, theirs = both(grid, [1.2, 2.5], "r", **kwargs)
        assert set(ours.point_data) == set(theirs.point_data)
        assert set(ours.cell_data) == set(theirs.cell_data) | {"isovalue"}
        assert ours.field_data["time"].tolist() == [1.5]
        assert {name: ours[name].shape[1:] for name in ours.point_data} == {
            name: theirs[name].shape[1:] for name in theirs.point_data}  # fmt: skip
        assert ours.area == pytest.approx(theirs.area, rel=0.02)
    assert np.unique(both(grid, [1.2, 2.5], "r")[0]["r"]).tolist() == [np.float32(1.2), 2.5]


def test_tets_give_the_points_of_pyvista():
    grid = cubes().triangulate()
    ours, theirs = both(grid, [1.2], "r")
    assert (ours.n_points, ours.n_cells) == (theirs.n_points, theirs.n_cells)
    order = [np.lexsort(np.round(mesh.points, 4).T) for mesh in (ours, theirs)]
    assert np.allclose(ours.points[order[0]], theirs.points[order[1]], atol=1e-5)
    for name in ("x", "v"):
        assert np.allclose(ours[name][order[0]], theirs[name][order[1]], atol=1e-4)
    assert np.array_equal(np.sort(ours.cell_data["number"]), np.sort(theirs.cell_data["number"]))
    outwards = np.einsum("ij,ij->i", ours.face_normals, ours.cell_centers().points - 4)
    assert (outwards > 0).all(), "towards higher values"


def test_defaults_are_those_of_pyvista(grid):
    ours, theirs = both(grid)
    # At the ends of this range there is no surface; VTK has flat triangles at one of them.
    assert len(np.unique(ours["r"])) == 8
    assert set(np.unique(ours["r"])) <= set(np.unique(theirs["r"]))
    assert ours.active_scalars_name == theirs.active_scalars_name == "r"
    ours, theirs = both(grid, 3, "x")
    assert np.unique(ours["x"]).tolist() == np.unique(theirs["x"]).tolist() == [4, 8]
    ours, theirs = both(grid, 4, "x", rng=[1.5, 6.5])
    assert np.allclose(np.unique(ours["x"]), np.unique(theirs["x"]))
    ours, theirs = both(grid, [5.25], np.array(grid["x"]))
    assert set(ours.point_data) == set(theirs.point_data)
    assert ours["Contour Data"][0] == 5.25
    ours, theirs = both(grid, [99.0])
    assert (ours.n_cells, theirs.n_cells) == (0, 0)


def test_errors_are_those_of_pyvista(grid):
    empty = pv.UnstructuredGrid()
    for call in (grid.contour, grid.isotet.contour):
        with pytest.raises(TypeError, match="Contour filter only works on point data"):
            call([1], "number")
        with pytest.raises(TypeError, match="Invalid type for `scalars`"):
            call([1], 7)
        with pytest.raises(ValueError, match="Method 'cubes' is not supported"):
            call([1], method="cubes")
    with pytest.raises(KeyError, match="pressure"):  # PyVista says that it is no point data
        grid.isotet.contour([1], "pressure")
    with pytest.raises((ValueError, pv.core.errors.MissingDataError)):
        empty.isotet.contour([1])
    with pytest.raises(ValueError, match="isovalue"):
        grid.isotet.contour([np.nan], "r")
    with pytest.warns(UserWarning, match="method='marching_cubes' is ignored"):
        assert grid.isotet.contour([2.0], "r", method="marching_cubes").n_cells > 0


def test_cells_that_vtk_contours_are_appended_with_a_warning():
    triangle = pv.examples.cells.Triangle()
    mixed = cubes().triangulate().merge(triangle.translate((20, 0, 0)), merge_points=False)
    mixed["x"] = mixed.points[:, 0]
    with pytest.warns(UserWarning, match="leaves to VTK 1 of"):
        surface = mixed.isotet.contour([20.2], "x")
    assert (surface.n_cells, surface.n_lines) == (1, 1)
    with pytest.warns(UserWarning, match="leaves to VTK 1 of"):
        surface = mixed.isotet.contour([1.5, 20.2], "x", compute_normals=True)
    assert surface.n_lines == 1 and surface.n_cells > 1
    assert set(surface.point_data) == {"x", "Normals"}
    assert np.array_equal(surface.cell_data["isovalue"] == 20.2, np.arange(surface.n_cells) == 0), "lines come first"
    with pytest.warns(UserWarning, match="leaves to VTK 1 of"):
        assert mixed.isotet.slice("x", (20.2, 0, 0)).n_lines == 1


CELLS = ["Triangle", "Quadrilateral", "Line", "TriangleStrip", "Pixel", "ConvexPointSet", "structured"]


@pytest.mark.parametrize("cell", [cell for cell in CELLS if cell == "structured" or hasattr(pv.examples.cells, cell)])
def test_grids_of_other_cells_are_contoured_by_vtk_with_a_warning(cell):
    if cell == "structured":
        grid = pv.StructuredGrid(*np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0]))
    else:
        grid = getattr(pv.examples.cells, cell)()
    grid["x"] = grid.points[:, 0]
    grid.field_data["time"] = [2.5]
    with pytest.warns(UserWarning, match="leaves to VTK 1 of 1 cells"):
        surface = grid.isotet.contour([0.4], "x")
    theirs = grid.contour([0.4], "x")
    assert (surface.n_points, surface.n_cells) == (theirs.n_points, theirs.n_cells) and surface.n_points > 0
    assert surface.field_data["time"].tolist() == [2.5]


@pytest.mark.parametrize(
    ("error", "message", "how"),
    [
        (TypeError, "rng is {}, but must be two numbers", {"rng": {}}),
        (ValueError, "rng has shape .1,. which is not allowed", {"rng": [1]}),
        (ValueError, "rng is 2 to 1, but must be sorted", {"rng": [2, 1]}),
        (TypeError, "isovalues is '3', but must be a number", {"isosurfaces": "3"}),
        (TypeError, "isovalues is None, but must be a number", {"isosurfaces": None}),
        (TypeError, "isovalues is True, but must be a number", {"isosurfaces": True}),
        (TypeError, "isovalues is PolyData", {"isosurfaces": pv.PolyData()}),
        (ValueError, "the field has values from 0.0 to inf: give isovalues, or rng", {"isosurfaces": 3}),
    ],
)
def test_wrong_isovalues_are_said(error, message, how):
    grid = cubes(4)
    grid["r"][0] = np.inf
    grid["r"][1] = 0
    with pytest.raises(error, match=message):
        grid.isotet.contour(scalars="r", **how)


def test_what_changes_is_found_out(grid):
    grid.isotet.pack("r")
    accessor = grid.isotet

    def update():
        """What the next contour finds."""
        surface = accessor.contour([2.5], "r")
        assert surface.area == pytest.approx(grid.contour([2.5], "r").area, rel=0.03)
        return accessor.report["update"]

    assert update() == "nothing"
    grid["r"][:] = 2 + grid["x"] / 8
    assert update() == "field"
    np.asarray(grid["r"])[...] = 1 + grid["x"] / 4  # behind VTK's back
    assert update() == "field"
    points = np.asarray(grid.points)
    points *= 2  # behind VTK's back
    assert update() == "points"
    grid.points = np.array(grid.points) + 1
    assert update() == "points"
    assert update() == "nothing"
    grid["other"] = np.zeros(grid.n_points)
    assert update() == "nothing"
    grid.set_active_scalars("x")
    assert update() == "nothing"
    cells = grid.extract_cells(range(grid.n_cells // 2))
    grid.copy_from(cells)
    assert update() == "grid"
    assert update() == "nothing"


def test_copies_and_deleted_grids_have_nothing_in_common(grid):
    grid.isotet.pack("r")
    twin = grid.copy()
    assert twin.isotet is not grid.isotet
    twin["r"][:] = grid["x"]
    assert twin.isotet.contour([2.5], "r").area == pytest.approx(twin.contour([2.5], "r").area, rel=0.03)
    assert grid.isotet.contour([2.5], "r").area == pytest.approx(grid.contour([2.5], "r").area, rel=0.03)
    reference = weakref.ref(grid.isotet)
    assert reference() is grid.isotet, "it lives as long as the grid"
    own = cubes(4)
    reference = weakref.ref(own.isotet)
    own.isotet.contour([1.0], "r")
    del own
    gc.collect()
    assert reference() is None
    grid.isotet.clear()
    assert grid.isotet.contour([2.5], "r").n_cells > 0


def test_a_surface_outlives_its_grid(grid):
    surface = grid.isotet.contour([2.5], "r")
    area = surface.area
    del grid
    gc.collect()
    filler = [cubes(12).isotet.contour([3.0], "r") for _ in range(5)]
    assert surface.area == area
    assert surface.faces.max() < surface.n_points
    del filler


def test_many_contours_pack_the_grid(grid):
    for i in range(40):
        grid.isotet.contour([1 + i / 20], "r")
    assert grid.isotet._session._session.method(1) == "clusters"


def test_missing_values_are_left_out(grid):
    grid["r"][grid.points[:, 0] < 4] = np.nan
    surface = grid.isotet.contour([2.5], "r")
    assert 0 < surface.n_cells
    assert surface.points[:, 0].min() >= 4
    assert np.isfinite(surface.points).all()


def structured(kind: str):
    image = pv.ImageData(dimensions=(12, 11, 10), spacing=(1, 0.5, 2), origin=(3, 0, 0))
    grid = {"image": lambda: image, "rectilinear": image.cast_to_rectilinear_grid,
            "structured": image.cast_to_structured_grid, "hidden": image.cast_to_structured_grid,
            "explicit": lambda: image.cast_to_structured_grid().cast_to_explicit_structured_grid()}[kind]()  # fmt: skip
    if kind == "hidden":
        grid.hide_cells(np.arange(100), inplace=True)
    grid["wave"] = np.sin(grid.points[:, 0]) + grid.points[:, 1] + 0.2 * grid.points[:, 2]
    grid.cell_data["number"] = np.arange(grid.n_cells)
    return grid


@pytest.mark.parametrize("kind", ["image", "rectilinear", "structured", "hidden", "explicit"])
@pytest.mark.filterwarnings("error")
def test_structured_grids(kind):
    grid = structured(kind)

    def same():
        ours, theirs = both(grid, [2.1, 3.3], "wave")
        assert ours.n_cells == theirs.n_cells > 300
        assert ours.area == pytest.approx(theirs.area, rel=1e-3)
        used = theirs.points[np.unique(theirs.faces.reshape(-1, 4)[:, 1:])]  # VTK leaves points of hidden cells there
        assert np.allclose(ours.points.min(axis=0), used.min(axis=0), atol=1e-5)
        assert np.allclose(ours.points.max(axis=0), used.max(axis=0), atol=1e-5)
        assert set(ours.point_data) == set(theirs.point_data)
        assert set(ours.cell_data) == set(theirs.cell_data) | {"isovalue"}
        return ours

    same()
    grid.isotet.pack("wave")
    grid["wave"] *= 1.1
    same()
    if kind == "image":
        grid.spacing = (1, 1, 1)
    elif kind == "rectilinear":
        grid.x = grid.x * 2
    else:
        grid.points[:, 2] *= 1.5
    if kind == "hidden":
        grid.hide_cells(np.arange(200, 300), inplace=True)
    assert same().n_cells > 0
    grid.isotet.clear()
    same()
    with pytest.raises(TypeError, match="only works on point data"):
        grid.isotet.contour([1], "number")


def test_curved_cells_are_refined():
    made = isotet.make("tet10", 3, ["sphere"])
    grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: np.reshape(made.cells, (-1, 10))}, made.points)
    grid["r"] = (np.linalg.norm(grid.points, axis=1) ** 2).astype(np.float32)
    plain, coarse, fine = (grid.isotet.contour([0.5], "r", tolerance=t) for t in (None, "1%", 1e-3))
    assert 0 < plain.n_cells < coarse.n_cells < fine.n_cells
    same = made.contour(0.5, grid["r"], tolerance=1e-3)
    assert np.array_equal(fine.points, same.points)
    assert grid.isotet.contour([0.5], "r").n_cells == plain.n_cells
    with pytest.raises(ValueError, match="tolerance is 'fine'"):
        grid.isotet.contour([0.5], "r", tolerance="fine")


def test_slices_of_curved_cells_are_refined_for_their_arrays():
    made = isotet.make("tet10", 3, ["sphere"])
    made = isotet.Grid(made.points, made.cells, offsets=made.offsets, types=made.types, fields={"d": (made.points**2).sum(axis=1)})
    grid = made.to_pyvista()
    off = []
    for tolerance in (None, "0.1%", 0.01):
        ours, same = grid.isotet.slice("z", (0, 0, 0.3), tolerance=tolerance), made.slice("z", (0, 0, 0.3), tolerance=tolerance)
        assert np.array_equal(ours.points, same.points)
        off.append(np.abs(ours["d"] - (ours.points**2).sum(axis=1)).max())
    assert max(off[1:]) < off[0] / 2
    for several in (grid.isotet.slice_orthogonal, grid.isotet.slice_along_axis):
        assert sum(cut.n_cells for cut in several(tolerance="0.1%")) > sum(cut.n_cells for cut in several())
    with pytest.raises(ValueError, match="tolerance is 'fine'"):
        grid.isotet.slice(tolerance="fine")


def test_blocks():
    left, right = cubes(), cubes(5)
    right["r"] += 10
    inner = pv.MultiBlock({"image": pv.ImageData(dimensions=(4, 4, 4))})
    inner["image"]["r"] = inner["image"].points[:, 0]
    blocks = pv.MultiBlock({"left": left, "nothing": None, "right": right, "inner": inner, "other": pv.Sphere()})
    surfaces = blocks.isotet.contour(5, "r")
    assert surfaces.keys() == ["left", "nothing", "right", "inner", "other"]
    lower, upper = 0, right["r"].max()
    levels = np.linspace(lower, upper, 5, dtype=np.float32)
    found = np.unique(np.concatenate([surfaces["left"]["r"], surfaces["right"]["r"]]))
    assert set(found) <= set(levels), "one set of isovalues for all blocks"
    assert surfaces["left"].n_cells == left.isotet.contour(levels.tolist(), "r").n_cells
    assert surfaces["nothing"].n_cells == surfaces["other"].n_cells == 0
    assert blocks.isotet.contour([1.5], "r")["inner"]["image"].area == pytest.approx(9)
    with pytest.raises(ValueError, match="no block has point data 'pressure'"):
        blocks.isotet.contour(5, "pressure")


def test_several_isovalues_number_their_cells(grid):
    surface = grid.isotet.contour([1.2, 2.5], "r", compute_scalars=False)
    isovalues = surface.cell_data["isovalue"]
    assert np.unique(isovalues).tolist() == [1.2, 2.5]
    theirs = grid.contour([1.2, 2.5], "r", compute_scalars=False)
    assert surface.active_scalars_name == theirs.active_scalars_name == "number"
    for isovalue in (1.2, 2.5):
        one = grid.isotet.contour([isovalue], "r")
        assert one.n_cells == np.count_nonzero(isovalues == isovalue) and "isovalue" not in one.cell_data
    blocks = pv.MultiBlock([grid]).isotet.contour([1.2, 2.5], "r")
    assert np.array_equal(blocks[0].cell_data["isovalue"], isovalues)
    flat = pv.Plane(i_resolution=9, j_resolution=9)
    flat["x"] = flat.points[:, 0]
    with pytest.warns(UserWarning, match="leaves to VTK"):
        lines = flat.isotet.contour([-0.2, 0.1, 0.3], "x", compute_scalars=False)
    assert np.allclose(lines.cell_centers().points[:, 0], lines.cell_data["isovalue"])


def test_a_slider_is_followed():
    grid = cubes(12).triangulate()
    plotter = pv.Plotter(off_screen=True, window_size=(200, 150))
    actor = plotter.isotet.add_isovalue(grid, "r", color="tan", title="radius")

    def area():
        return pv.wrap(actor.mapper.GetInputDataObject(0, 0)).area

    before = area()
    slider = plotter.widgets.slider_widgets[0]
    first = plotter.screenshot(return_img=True)
    for value in (2.0, 3.0):
        slider.GetRepresentation().SetValue(value)
        slider.InvokeEvent("InteractionEvent")  # while dragging, not at its end
        plotter.render()
        assert area() == pytest.approx(grid.contour([value], "r").area)
    assert area() != before
    assert (first != plotter.screenshot(return_img=True)).any()
    plotter.close()
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.isotet.add_isovalue(grid, "r", value=3.0, rng=[2, 4], color_by="x", compute_normals=True)
    assert area() == pytest.approx(grid.contour([3.0], "r").area)
    assert actor.mapper.scalar_range == (0, 11)
    plotter.close()
    plotter = pv.Plotter(off_screen=True)
    image = structured("image")
    actor = plotter.isotet.add_isovalue(image, "wave", value=2.1)
    assert area() == pytest.approx(image.contour([2.1], "wave").area, rel=1e-3)
    plotter.close()
    with pytest.raises(TypeError, match="PointSets are 0-dimensional"):
        pv.Plotter(off_screen=True).isotet.add_isovalue(pv.PointSet([[0.0, 0, 0]]))
    with pytest.raises(TypeError, match="the mesh is a int"):
        pv.Plotter(off_screen=True).isotet.add_isovalue(3)


def test_a_slider_takes_what_pyvista_has():
    grid = cubes()
    sphere = pv.Sphere()
    sphere["r"] = sphere.points[:, 2].copy()
    source = vtkAppendFilter()
    source.AddInputData(grid)
    for mesh in (grid, pv.MultiBlock([grid, None, cubes(5)]), [grid, cubes(5)], source):
        plotter = pv.Plotter(off_screen=True)
        plotter.isotet.add_isovalue(mesh, "r", value=2.5)
        (surface,) = plotter.widgets.isovalue_meshes
        first = surface.combine() if isinstance(surface, pv.MultiBlock) else surface
        assert first.n_cells > 0
        plotter.widgets.slider_widgets[0].GetRepresentation().SetValue(1.5)
        plotter.widgets.slider_widgets[0].InvokeEvent("InteractionEvent")
        later = surface.combine() if isinstance(surface, pv.MultiBlock) else surface
        assert 0 < later.n_cells < first.n_cells or later is first
        plotter.close()
    plotter = pv.Plotter(off_screen=True)
    with pytest.warns(UserWarning, match="vtkPolyData is contoured by vtkContourFilter"):
        plotter.isotet.add_isovalue(sphere, "r")
    assert plotter.widgets.isovalue_meshes[0].n_lines > 0
    plotter.isotet.add_isovalue(grid, "number", preference="cell")
    assert plotter.widgets.isovalue_meshes[1].n_cells > 0
    with pytest.raises(TypeError, match="only works on point data"):
        plotter.isotet.add_isovalue(grid, "number")
    for name in ("v:y", "v:mag", "v"):
        plotter.isotet.add_isovalue(grid, name, False, False, True, "point", value=7.0)
        assert plotter.widgets.isovalue_meshes[-1].area == pytest.approx(grid.isotet.contour([7.0], name).area)
    grid.set_active_scalars("x")
    plotter.isotet.add_isovalue(grid, "r")
    assert plotter.widgets.isovalue_meshes[-1].active_scalars_name == "r", "what is contoured is shown"
    with pytest.raises(ValueError, match="a component is x, y, z, mag or a number"):
        plotter.isotet.add_isovalue(grid, "v:w")
    plotter.close()


def test_components_and_cell_arrays_are_contoured():
    grid = cubes()
    ours = grid.isotet.contour([5.0], "v")  # the first component; of grids VTK takes numbers in the order of memory
    assert ours.area == pytest.approx(64) and ours.bounds[:2] == (2.5, 2.5)
    assert set(ours.point_data) == set(grid.contour([5.0], "v").point_data), "without an array of isovalues"
    for name, values in (("v:y", grid["v"][:, 1]), ("v:2", grid["v"][:, 2]), ("v:mag", np.linalg.norm(grid["v"], axis=1))):
        surface = grid.isotet.contour([5.0], name)
        assert surface.area == pytest.approx(grid.copy().contour([5.0], values).area, rel=0.01)
        assert np.unique(surface[name]).tolist() == [5.0]
    with pytest.raises(ValueError, match="component"):
        grid.isotet.contour([5.0], "v:9")
    averaged = grid.cell_data_to_point_data()
    surface = grid.isotet.contour([300.0], "number", preference="cell")
    assert surface.area == pytest.approx(averaged.contour([300.0], "number").area, rel=0.02)
    assert surface.point_data["number"].tolist() == [300.0] * surface.n_points
    grid.cell_data["w"] = grid.cell_centers().points
    assert grid.isotet.contour([4.0], "w:y", preference="cell").area == pytest.approx(64, rel=0.01)
    image = structured("image")
    assert image.isotet.contour([500.0], "number", preference="cell").n_cells > 0
    for name, place in (("vel_x", 0), ("vel_y", 1), ("vel_z", 2)):
        grid[name] = grid["v"][:, place].copy()
    assert grid.isotet.contour([5.0], "sqrt(dot(v, v))").area == pytest.approx(grid.isotet.contour([5.0], "v:mag").area)
    assert grid.isotet.contour([5.0], "vel:mag").area == pytest.approx(grid.isotet.contour([5.0], "v:mag").area, rel=1e-3)


@pytest.mark.parametrize("dtype", [np.int8, np.uint8, np.int32, np.int64, np.float32, np.float64])
def test_carried_arrays_keep_their_type(dtype):
    grid = cubes()
    grid["carried"] = (np.arange(grid.n_points) % 100).astype(dtype)
    ours, theirs = both(grid, [2.5], "r")
    assert ours["carried"].dtype == theirs["carried"].dtype == dtype
    assert ours["carried"].max() <= 99
    ours, theirs = both(grid, [50], "carried")
    assert ours["carried"].dtype == theirs["carried"].dtype == dtype
    assert set(ours["carried"]) == {50}


def test_cell_arrays_and_normals_do_not_pack_again():
    grid = cubes()
    grid.isotet.pack("r")
    assert grid.isotet.contour([2.5], "r").n_cells > 0
    grid.cell_data["more"] = np.arange(grid.n_cells)
    assert "more" in grid.isotet.contour([2.5], "r").cell_data
    assert "Normals" in grid.isotet.contour([2.5], "r", compute_normals=True).point_data
    report = grid.isotet.report
    assert (report["update"], report["method"]) == ("nothing", "clusters")
    assert report["pack_seconds"] == 0 and report["packed_bytes"] > 0
    assert repr(grid.isotet) == f"<isotet of a UnstructuredGrid: packed, {report['packed_bytes']} bytes>"


def test_isolines_of_polydata():
    sphere = pv.Sphere()
    sphere["z"] = sphere.points[:, 2].copy()
    with pytest.warns(UserWarning, match="leaves to VTK"):
        lines = sphere.isotet.contour([0.1], "z")
    assert (lines.n_lines, lines.n_points) == (sphere.contour([0.1], "z").n_lines, sphere.contour([0.1], "z").n_points)


def test_surfaces_are_decimated_and_split():
    grid = cubes(17)
    grid["f"] = np.abs(grid.points[:, 0] - 8.0) + 0.05 * grid["r"]
    both_sides = grid.isotet.contour([3.0], "f")
    parts = both_sides.isotet.split_bodies()
    assert len(parts) == len(both_sides.isotet.parts()) == 2
    assert sum(part.n_cells for part in parts) == both_sides.n_cells
    assert both_sides.isotet.extract_largest().n_cells == parts[0].n_cells
    nothing = grid.isotet.contour([99.0], "r")
    assert nothing.isotet.extract_largest().n_cells == len(nothing.isotet.split_bodies()) == 0
    ball = grid.isotet.contour([5.0], "r")
    fewer = ball.isotet.decimate(0.5)
    assert 0.3 * ball.n_cells < fewer.n_cells < 0.6 * ball.n_cells
    assert fewer.is_manifold and set(fewer.point_data) == set(ball.point_data)


@pytest.mark.parametrize("beside", ["lines", "verts"])
def test_lines_and_vertices_beside_triangles_are_left_out(beside):
    ball = pv.Sphere(theta_resolution=8, phi_resolution=8)
    beside = {"lines": np.array([2, 0, 1, 2, 3, 4])} if beside == "lines" else {"verts": np.array([1, 0, 1, 5])}
    for faces in (ball.faces, [4, 0, 1, 2, 3, 4, 3, 2, 4, 5]):
        mesh = pv.PolyData(ball.points, faces=faces, **beside)
        mesh.cell_data["number"] = np.arange(mesh.n_cells)
        largest = mesh.isotet.extract_largest()
        assert largest.n_cells == pv.PolyData(ball.points, faces=faces).triangulate().n_cells
        assert set(largest["number"]) == set(range(2, mesh.n_cells))
        assert sum(body.n_cells for body in mesh.isotet.split_bodies()) == largest.n_cells


@pytest.mark.parametrize("dtype", ["i4", "i8", "u1", "u8", "f4", "f8"])
def test_cell_arrays_of_all_types_stay_beside_flat_cells(dtype):
    whole = cubes(5)
    flat = pv.Plane(center=(2, 2, 2), i_size=4, j_size=4, i_resolution=4, j_resolution=4).cast_to_unstructured_grid()
    grid = pv.merge([whole, flat], merge_points=False)
    grid.clear_data()
    grid["r"] = np.linalg.norm(grid.points - 2, axis=1)
    grid["t"] = np.arange(grid.n_points).astype(dtype)
    grid.cell_data["id"] = np.arange(grid.n_cells).astype(dtype)
    with pytest.warns(UserWarning, match="leaves to VTK 16 of"):
        for ours in (grid.isotet.contour([1.3], "r"), grid.isotet.slice("x", (2.1, 2, 2))):
            assert ours.cell_data["id"].dtype == ours.point_data["t"].dtype == dtype
            assert len(ours.cell_data["id"]) == ours.n_cells and ours.cell_data["id"].max() > whole.n_cells


def test_arrays_of_bools_and_complex_numbers_stay_so():
    grid = cubes()
    grid["wet"], grid["z"] = grid["x"] > 4, grid["x"] + 1j
    grid.cell_data["own"] = np.arange(grid.n_cells) % 2 == 0
    for mesh in (grid.isotet.contour([2.5], "r"), grid.isotet.slice("z"), *grid.isotet.clip_scalar("r", value=3.0, both=True),
                 grid.isotet.solid("r", below=3.0), grid.isotet.contour([2.5], "r").isotet.extract_largest()):  # fmt: skip
        assert mesh["wet"].dtype == mesh.cell_data["own"].dtype == bool and mesh["z"].dtype == complex
        assert mesh["wet"].shape == mesh["z"].shape == (mesh.n_points,)
        assert mesh["z"] == pytest.approx(mesh["x"] + 1j)
        assert mesh.points[mesh["wet"]][:, 0].min() > 3.4


def test_active_arrays_are_those_of_pyvista():
    grid = cubes()
    grid["other"] = grid["r"] * 2
    grid.set_active_vectors("v")
    for active in ("r", "other"):
        grid.set_active_scalars(active)
        for ours, theirs in ((grid.isotet.contour([2.5], "r"), grid.contour([2.5], "r")), (grid.isotet.slice("z"), grid.slice("z"))):
            assert ours.active_scalars_name == theirs.active_scalars_name == active
            assert ours.active_vectors_name == theirs.active_vectors_name == "v"


def test_solids_are_closed():
    grid = cubes()
    ball = grid.isotet.solid("r", below=3.0)
    assert ball.is_manifold and ball.field_data["volume"][0] == pytest.approx(ball.volume, rel=1e-5)
    for changed in (ball.isotet.decimate(0.7), grid.isotet.solid("r", above=6.0).isotet.extract_largest()):
        assert changed.field_data["volume"][0] == pytest.approx(changed.volume, rel=1e-5)
    assert set(ball.cell_data) == {"number", "boundary"} and {"x", "v", "r"} <= set(ball.point_data)
    assert grid.isotet.solid("number", above=100.0, preference="cell").is_manifold
    with pytest.raises(ValueError, match="above, below or both"):
        grid.isotet.solid("r")


def test_active_scalars_stay_active():
    grid = cubes()
    grid["other"] = grid["r"] * 2
    for name, association in (("r", "point"), ("other", "point"), ("number", "cell")):
        grid.set_active_scalars(name, preference=association)
        made = [grid.isotet.slice(), *grid.isotet.slice_orthogonal(), grid.isotet.solid("r", below=3.0),
                *grid.isotet.clip_scalar("r", value=2.0, both=True)]  # fmt: skip
        made += [made[0].isotet.extract_largest(), *made[0].isotet.split_bodies()]
        for mesh in made:
            assert mesh.active_scalars_info == grid.active_scalars_info
    assert grid.slice().active_scalars_name == "number"


def test_several_slices():
    grid = cubes()
    three = grid.isotet.slice_orthogonal()
    assert three.keys() == grid.slice_orthogonal().keys()
    assert [block.area for block in three] == pytest.approx([64] * 3)
    some = grid.isotet.slice_along_axis(3, "y")
    theirs = grid.slice_along_axis(3, "y")
    assert [piece.bounds for piece in grid.isotet.slice_along_axis(3, 1)] == [piece.bounds for piece in some]
    with pytest.raises(ValueError, match="axis is 3, but must be"):
        grid.isotet.slice_along_axis(3, 3)
    assert some.keys() == theirs.keys()
    assert [block.bounds[2] for block in some] == pytest.approx([block.bounds[2] for block in theirs])
    padded, theirs = (of.slice_along_axis(3, "y", tolerance=0.5) for of in (grid.isotet, grid))
    assert [block.bounds[2] for block in padded] == pytest.approx([block.bounds[2] for block in theirs])


def test_the_accessor_does_not_import_plotting():
    code = (
        "import sys, pyvista as pv\n"
        "g = pv.ImageData(dimensions=(5, 5, 5)).cast_to_unstructured_grid(); g['x'] = g.points[:, 0]\n"
        "g.isotet.contour([1.5], 'x')\n"
        "names = ('pyvista.plotting', 'matplotlib', 'vtkmodules.vtkRenderingCore', 'numpy.ma')\n"
        "print([name for name in names if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.strip() == "[]", done.stderr


def test_the_first_accessor_of_a_process_costs_little(tmp_path):
    """In CPU time, which does not depend on what else runs; once the byte code is there."""
    code = (
        "import time, pyvista as pv\n"
        "g = pv.UnstructuredGrid(); start = time.process_time(); g.isotet; print(time.process_time() - start)\n"
    )
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(tmp_path)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    taken = [float(subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=120,
                                  check=True).stdout) for _ in range(4)]  # fmt: skip
    assert min(taken) < 0.03


def test_grids_of_vtk_are_shared():
    grid = cubes().triangulate()
    mine = isotet.vtk.grid_of(grid)
    assert np.shares_memory(mine.points, grid.points)
    assert np.shares_memory(mine.cells, grid.cell_connectivity)
    assert set(mine.fields) == {"r", "x", "v"}
    assert mine.contour(2.5, "r").area == pytest.approx(grid.contour([2.5], "r").area, rel=1e-4)


@pytest.mark.parametrize("ending", ["ts", "3mf"])
def test_surfaces_in_formats_of_isotet_are_saved_and_read(tmp_path, ending):
    surface = cubes().isotet.contour([2.5], "r")
    surface.save(tmp_path / f"surface.{ending}")
    again = pv.read(tmp_path / f"surface.{ending}")
    assert (again.n_points, again.n_cells) == (surface.n_points, surface.n_cells)
    assert again.area == pytest.approx(surface.area, rel=1e-4)
    with pytest.raises(TypeError, match="takes surfaces"):
        cubes().save(tmp_path / f"grid.{ending}")
    surface.save(tmp_path / "surface.usda")
    assert (tmp_path / "surface.usda").read_text().startswith("#usda")


def test_grids_in_formats_of_isotet_are_read(tree):
    path = next((tree / "data/gocad").glob("*.so"))
    assert pv.read(path).n_cells == len(isotet.read(path))


def test_polyhedra_are_saved_packed(tmp_path):
    grid = cubes().isotet.clip_scalar("r", value=3.0)
    assert 42 in grid.celltypes
    grid.save(tmp_path / "grid.isotet")
    assert isotet.open(tmp_path / "grid.isotet").contour(2.9, "r").area == pytest.approx(grid.isotet.contour([2.9], "r").area, rel=1e-5)


def test_packed_grids_are_saved_and_read(tmp_path):
    grid = cubes()
    grid.save(tmp_path / "grid.isotet")
    file = isotet.open(tmp_path / "grid.isotet")
    assert sorted(file.fields) == ["r", "x"]
    assert file.contour(2.5, "r").area == pytest.approx(grid.isotet.contour([2.5], "r").area)
    again = pv.read(tmp_path / "grid.isotet")
    assert again.n_cells == grid.n_cells
    assert again.isotet.contour([2.5], "r").area == pytest.approx(grid.isotet.contour([2.5], "r").area)
    with pytest.raises(ValueError, match="there is no 'v'"):
        grid.save(tmp_path / "grid.isotet", scalars="v")


def test_pyvista_has_no_reader_of_its_own_for_these():
    from pyvista.core.utilities.reader import CLASS_READERS

    ours = {entry.name for entry in entry_points(group="pyvista.readers") if entry.value.startswith("isotet.")}
    assert len(ours) > 5 and not {f".{name}" for name in ours} & set(CLASS_READERS)
    known = {ending[1:] for kind in isotet.formats() for ending in kind["extensions"] if kind["reads_grid"] or kind["reads_surface"]}
    assert ours <= known


def test_clip_scalar_keeps_the_side_that_pyvista_keeps():
    grid = cubes(7)
    for invert in (True, False):
        ours, theirs = (kind.clip_scalar(scalars="r", invert=invert, value=2.0) for kind in (grid.isotet, grid))
        assert abs(ours.volume - theirs.volume) < 0.03 * theirs.volume
        assert (ours.cell_data["number"] == ours.cell_data["source_cell"]).all()
        assert ((ours["r"] <= 2.0 + 1e-5) if invert else (ours["r"] >= 2.0 - 1e-5)).all()
    below, above = grid.isotet.clip_scalar("r", value=2.0, both=True)
    assert below.n_cells > 0 and above.n_cells > 0
    same = grid.copy()
    assert same.isotet.clip_scalar("r", value=2.0, inplace=True) is same
    assert same.n_cells == below.n_cells
    with pytest.raises(TypeError):
        grid.isotet.clip_scalar("number")


@pytest.mark.parametrize("ends", [(1.5, 2.5), [1.5, np.inf], np.array([1, 3])], ids=str)
def test_clip_scalar_takes_a_range(ends):
    grid = cubes(7)
    ours, theirs = (kind.clip_scalar(scalars="r", value=ends) for kind in (grid.isotet, grid))
    assert abs(ours.volume - theirs.volume) < 0.03 * theirs.volume > 0
    assert ends[0] - 1e-5 <= ours["r"].min() and ours["r"].max() <= ends[1] + 1e-5
    for how in ({"invert": False}, {"both": True}):
        with pytest.raises(ValueError, match="must be one number"):
            grid.isotet.clip_scalar("r", value=ends, **how)
        with pytest.raises(ValueError, match="range clip"):
            grid.clip_scalar(scalars="r", value=ends, **how)


@pytest.mark.parametrize(
    ("error", "message", "value"),
    [(ValueError, "value is 2 to 1, but must be sorted", (2, 1)), (ValueError, "has shape", [1]), (TypeError, "must be two", ["a", "b"]),
     (ValueError, "must be finite", np.nan)],
)  # fmt: skip
def test_wrong_values_of_clip_scalar_are_said(error, message, value):
    with pytest.raises(error, match=message):
        cubes().isotet.clip_scalar("r", value=value)


def test_empty_clips_are_empty_grids():
    grid = cubes()
    for part in (grid.isotet.clip_scalar("r", value=-1.0), *grid.isotet.clip_scalar("r", value=99.0, invert=False, both=True)[:1],
                 grid.isotet.clip_scalar("r", value=(98.0, 99.0))):  # fmt: skip
        assert type(part) is pv.UnstructuredGrid and part.n_cells == 0 and part.n_points == 0
        assert part.isotet.clip_scalar("r", value=1.0).n_cells == 0
        assert part.isotet.solid("r", below=1.0).n_cells == 0
    same = grid.copy()
    assert same.isotet.clip_scalar("r", value=-1.0, inplace=True).n_cells == 0 == same.n_cells


@pytest.mark.filterwarnings("error")
def test_hidden_cells_are_no_cause_of_a_warning():
    grid = isotet.make("kuhn", 5, ["sphere"]).to_pyvista()
    whole = grid.isotet.contour([0.9], "sphere").n_cells
    marks = np.where(np.arange(grid.n_cells) % 2, 0, 32).astype(np.uint8)
    grid.cell_data["vtkGhostType"] = marks
    assert 0 < grid.isotet.contour([0.9], "sphere").n_cells < whole
    grid.cell_data["vtkGhostType"] = np.full_like(marks, 32)
    assert grid.isotet.contour([0.9], "sphere").n_cells == 0
    assert grid.isotet.slice("x").n_cells == 0


def test_one_accessor_serves_many_threads():
    grid = isotet.make("kuhn", 16, ["sphere", "gyroid"]).to_pyvista()
    alone = {name: grid.isotet.contour([0.4], scalars=name).n_points for name in ("sphere", "gyroid")}
    wrong = []

    def contour(first: int) -> None:
        for i in range(25):
            name = ("sphere", "gyroid")[(first + i) % 2]
            if grid.isotet.contour([0.4], scalars=name).n_points != alone[name]:
                wrong.append(name)

    threads = [threading.Thread(target=contour, args=(first,)) for first in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
