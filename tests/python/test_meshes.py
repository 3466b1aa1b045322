# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Grids of other packages, in and out; in other processes, too."""

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import meshio
import numpy as np
import pytest
import pyvista as pv

import isotet
from conftest import same

SHAPES = ["kuhn", "hex", "wedge", "pyramid", "mixed", "tet10"]


@pytest.fixture(params=SHAPES)
def grid(request) -> isotet.Grid:
    made = isotet.make(request.param, 4, ["sphere", "gyroid"])
    marks = np.arange(len(made), dtype=np.int32)
    return isotet.Grid(made.points, made.cells, offsets=made.offsets, types=made.types, fields=made.fields, cell_fields={"mark": marks})


@pytest.mark.parametrize("package", ["pyvista", "vtk", "meshio"])
def test_grids_go_out_and_come_back(grid, package):
    back = isotet.Grid(getattr(grid, f"to_{package}")())
    assert set(back.fields) == {"sphere", "gyroid"} and back.cell_fields["mark"].dtype == np.int32
    how = {"fields": ["gyroid"], "cell_fields": ["mark"]}
    assert same(back.contour(0.4, "sphere", **how), grid.contour(0.4, "sphere", **how))


def test_polyhedra_go_to_vtk_and_come_back(tree):
    grid = isotet.read(tree / "data/vtu/polyhedron_two_pieces.vtu")
    mesh = grid.to_pyvista()
    assert mesh.volume == pytest.approx(pv.read(tree / "data/vtu/polyhedron_two_pieces.vtu").volume)
    back = isotet.Grid(mesh)
    assert np.array_equal(back.faces, grid.faces) and np.array_equal(back.face_offsets, grid.face_offsets)
    with pytest.raises(ValueError, match="VTK's type 42, for which meshio has no name"):
        grid.to_meshio()


def test_voxels_are_hexahedra_for_meshio():
    image = pv.ImageData(dimensions=(4, 4, 4))
    image["x"] = image.points[:, 0]
    grid = isotet.Grid(image)
    assert len(grid) == 27 and grid.contour(1.5).area == 9
    assert isotet.Grid(grid.to_meshio()).contour(1.5).area == 9
    assert grid.to_pyvista().volume == 27


def test_fields_that_are_given_take_the_place_of_the_meshs():
    mesh = isotet.make("hex", 4, ["sphere"]).to_pyvista()
    mesh.point_data.active_scalars_name = None
    mesh["id"] = np.arange(mesh.n_points)
    mesh.GetPointData().SetGlobalIds(mesh.GetPointData().GetArray("id"))
    grid = isotet.Grid(mesh, fields={"x": mesh.points[:, 0]})
    assert list(grid.fields) == ["x"] and grid.point_numbers.tolist() == list(range(mesh.n_points))
    assert np.shares_memory(isotet.Grid(mesh).points, mesh.points)


@pytest.mark.parametrize("mesh", [3, [[0.0, 0, 0]], pv.MultiBlock(), pv.Table()])
def test_other_objects_are_type_errors(mesh):
    with pytest.raises(TypeError, match="the mesh is a"):
        isotet.Grid(mesh)


def test_orders_of_nodes_that_are_not_known_are_named():
    points = np.random.default_rng(1).random((20, 3))
    with pytest.raises(ValueError, match="cells of the type 'tetra20' have an order of nodes"):
        isotet.Grid(meshio.Mesh(points, [("tetra20", np.arange(20).reshape(1, 20))]))
    cells = meshio.Mesh(points, [("VTK_LAGRANGE_TETRAHEDRON", np.arange(20).reshape(1, 20)), ("line5", np.arange(5).reshape(1, 5))])
    assert isotet.Grid(cells).types.tolist() == [71, 0]


@pytest.mark.parametrize("name", ["prism", "tet", "tetrahedron", "hexahedra"])
def test_types_of_cells_that_meshio_does_not_have_are_an_error(name):
    with pytest.raises(ValueError, match=f"there is no type of cells '{name}': there are .*wedge"):
        isotet.Grid(np.zeros((8, 3)), {"hexahedron": np.arange(8)[None], name: np.arange(6)[None]})


def test_polyhedra_come_from_meshio():
    points = isotet.make("hex", 1, ["plane"]).points
    sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    more = np.concatenate([points, points[:4] + [0, 0, 4]])  # a prism of four faces more, of lists of several lengths
    other = [[4, 6, 10], [5, 11, 7], [4, 5, 7, 6], [4, 10, 11, 5], [6, 7, 11, 10]]
    blocks = [("polyhedron8", np.array([sides])), ("polyhedron6", [other]), ("tetra", [[0, 1, 2, 4]]), ("line", [[0, 1]])]
    grid = isotet.Grid(meshio.Mesh(more, blocks))
    assert grid.types.tolist() == [42, 42, 10, 3] and np.diff(grid.offsets).tolist() == [8, 6, 4, 2]
    assert np.diff(grid.face_offsets).tolist() == [31, 24, 0, 0]
    alone = isotet.Grid(more, {"polyhedron8": [sides]})
    whole = isotet.Grid(more, {"hexahedron": [[0, 1, 3, 2, 4, 5, 7, 6]]})
    assert alone.contour(0.25, more[:, 0]).area == pytest.approx(whole.contour(0.25, more[:, 0]).area)


def test_tensors_of_meshio_are_rows_of_components(tet):
    points, cells, _ = tet
    tensors = np.arange(36.0).reshape(4, 3, 3)
    mesh = meshio.Mesh(points, [("tetra", cells)], point_data={"S": tensors}, cell_data={"c": [tensors[:1]]})
    grid = isotet.Grid(mesh)
    assert grid.fields["S"].tolist() == tensors.reshape(4, 9).tolist()
    assert grid.cell_fields["c"].shape == (1, 9)
    mesh.cells.append(meshio.CellBlock("tetra", cells))
    mesh.cell_data["c"].append(np.zeros(1))
    with pytest.raises(ValueError, match=r"cell_data\['c'\] has blocks of shape \(1, 9\) and \(1,\), but"):
        isotet.Grid(mesh)


class OnlyDlpack:
    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **how):
        return self.array.__dlpack__(**how)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


def test_arrays_come_by_dlpack(tet):
    points, cells, values = tet
    surface = isotet.contour(*(OnlyDlpack(np.array(array)) for array in (points, cells, values)), 0.5)
    assert same(surface, isotet.contour(points, cells, values, 0.5))


def test_tables_of_pandas_are_arrays(tet):
    pandas = pytest.importorskip("pandas")
    points, cells, values = tet
    table = pandas.DataFrame({"T": values, "p": 2 * values})
    surface = isotet.contour(pandas.DataFrame(points), pandas.DataFrame(cells), table["T"], 0.5, fields=table)
    assert np.allclose(surface.fields["p"], 1.0)


def test_grids_are_pickled_and_copied(grid):
    how = {"fields": ["gyroid"], "cell_fields": ["mark"], "normals": "gradient"}
    wanted = grid.contour(0.4, "sphere", **how)
    for other in (pickle.loads(pickle.dumps(grid)), copy.copy(grid), copy.deepcopy(grid)):
        assert same(other.contour(0.4, "sphere", **how), wanted)
    assert np.shares_memory(copy.copy(grid).points, grid.points)
    assert not np.shares_memory(copy.deepcopy(grid).points, grid.points)
    piece = grid.piece(0, 2)
    assert pickle.loads(pickle.dumps(piece)).point_numbers.tolist() == piece.point_numbers.tolist()


def test_what_files_say_is_pickled(tree):
    grid = isotet.read(tree / "data/vtu/polyhedron_two_pieces.vtu")
    other = pickle.loads(pickle.dumps(grid))
    assert (other.info, other.step, other.notes) == (grid.info, grid.step, grid.notes)
    assert np.array_equal(other.faces, grid.faces)


def test_sessions_are_pickled_and_copied(grid):
    session = isotet.Contour(grid, "sphere", fields=["gyroid"], normals="face", surfaces=100)
    wanted = session.contour(0.4)
    session.set(grid, "gyroid", fields=["sphere"])
    session.set(grid, "sphere", fields=["gyroid"])
    for other in (pickle.loads(pickle.dumps((grid, session)))[1], copy.copy(session)):
        assert same(other.contour(0.4), wanted)
    gone = isotet.Contour(isotet.Grid(grid.to_meshio()), "sphere")
    with pytest.raises(TypeError, match="the isotet.Grid of the session is gone"):
        pickle.dumps(gone)


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_packed_grids_are_pickled_and_copied(precision):
    made = isotet.make("mixed", 4, ["sphere", "gyroid"])
    grid = isotet.Grid(made.to_vtk(), cell_fields={"mark": np.arange(len(made))})
    packed = grid.pack("sphere", gradients=True, source_cells=True, precision=precision)
    how = {"normals": "gradient", "cell_fields": {"mark": grid.cell_fields["mark"]}, "edge_ends": True}
    wanted = packed.contour(0.4, **how)
    for other in (pickle.loads(pickle.dumps(packed)), copy.copy(packed), copy.deepcopy(packed)):
        assert same(other.contour(0.4, **how), wanted)
        assert repr(other) == repr(packed)
        other.set_field(grid.fields["gyroid"])
        assert same(other.contour(0.2), grid.pack("gyroid", precision=precision).contour(0.2))
    assert same(packed.contour(0.4, **how), wanted), "it stays as it is"


def area_of(grid: isotet.Grid) -> float:
    return grid.contour(0.5, "sphere", threads=1).area


def test_pools_of_processes_take_grids(sphere):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert list(pool.map(area_of, [sphere, sphere])) == [area_of(sphere)] * 2


def test_grids_of_flat_cells_alone_say_that_there_is_nothing_to_contour():
    grid = isotet.Grid([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2], offsets=[0, 3], types=[5], fields={"f": [0.0, 1.0, 2.0]})
    for use in (lambda: grid.contour(0.5, "f"), lambda: grid.pack("f"), lambda: grid.slice("x"), lambda: grid.clip("f", below=1)):
        with pytest.raises(ValueError, match=r"no cell that can be contoured \(1 x triangle\)"):
            use()
    assert isinstance(grid.survey("f"), bytes), "it may be a piece of a grid that has others"
