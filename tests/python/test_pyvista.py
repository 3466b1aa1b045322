# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""grid.isotet and plotter.isotet, with no import of isotet by the user; the same meaning as PyVista's own contour."""

import gc
import subprocess
import sys
import weakref

import numpy as np
import pytest
import pyvista as pv

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
        assert set(ours.cell_data) == set(theirs.cell_data)
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


def test_cells_left_out_are_said():
    triangle = pv.examples.cells.Triangle()
    mixed = cubes().triangulate().merge(triangle.translate((20, 0, 0)), merge_points=False)
    mixed["x"] = mixed.points[:, 0]
    with pytest.warns(UserWarning, match="leaves out 1 of"):
        mixed.isotet.contour([1.5], "x")


@pytest.mark.parametrize("cell", ["Triangle", "Quadrilateral", "Line", "PolyVertex", "TriangleStrip", "Pixel", "structured"])
def test_grids_without_cells_to_contour_give_nothing_and_a_warning(cell):
    if cell == "structured":
        grid = pv.StructuredGrid(*np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0]))
    else:
        grid = getattr(pv.examples.cells, cell)()
    grid["x"] = grid.points[:, 0]
    grid.field_data["time"] = [2.5]
    with pytest.warns(UserWarning, match="leaves out 1 of 1 cells"):
        surface = grid.isotet.contour([0.5], "x")
    assert surface.n_points == surface.n_cells == 0
    assert surface.field_data["time"].tolist() == [2.5]


@pytest.mark.parametrize(
    ("error", "message", "how"),
    [
        (TypeError, "rng is {}, but must be two numbers", {"rng": {}}),
        (TypeError, "rng is .1., but must be two numbers", {"rng": [1]}),
        (ValueError, "rng is 2 to 1, but must ascend", {"rng": [2, 1]}),
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
        seen = []
        original = accessor._session._session

        class Spy:
            def set(self, *args):
                seen.append(original.set(*args))
                return seen[-1]

            def extract(self, *args):
                return original.extract(*args)

        accessor._session._session = Spy()
        surface = accessor.contour([2.5], "r")
        accessor._session._session = original
        assert surface.area == pytest.approx(grid.contour([2.5], "r").area, rel=0.03)
        return seen[0]

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
        assert set(ours.cell_data) == set(theirs.cell_data)
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
    with pytest.raises(TypeError, match="must be a grid of cells"):
        pv.Plotter(off_screen=True).isotet.add_isovalue(pv.Sphere())
    with pytest.raises(TypeError, match="Cell data"):
        pv.Plotter(off_screen=True).isotet.add_isovalue(grid, "number")


def test_grids_of_vtk_are_shared():
    grid = cubes().triangulate()
    mine = isotet.vtk.grid_of(grid)
    assert np.shares_memory(mine.points, grid.points)
    assert np.shares_memory(mine.cells, grid.cell_connectivity)
    assert set(mine.fields) == {"r", "x", "v"}
    assert mine.contour(2.5, "r").area == pytest.approx(grid.contour([2.5], "r").area, rel=1e-4)
