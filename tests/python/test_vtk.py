# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""IsotetContour in a pipeline of VTK's."""

import signal
import time
from unittest import mock

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkContourFilter, vtkPolyDataNormals

import isotet
import isotet.vtk
from isotet.vtk import IsotetContour, grid_of
from conftest import errors_of
from test_pyvista import cubes


def pipeline(grid, name="r", value=2.5):
    contour = IsotetContour()
    contour.SetInputDataObject(grid)
    contour.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, name)
    contour.SetValue(0, value)
    return contour


def output(contour):
    contour.Update()
    return pv.wrap(contour.GetOutputDataObject(0))


def test_it_has_the_methods_of_vtkcontourfilter():
    grid = cubes().triangulate()
    ours, theirs = pipeline(grid), vtkContourFilter()
    theirs.SetInputData(grid)
    theirs.SetInputArrayToProcess(0, 0, 0, 0, "r")
    for contour in (ours, theirs):
        contour.SetComputeNormals(False)
        contour.GenerateValues(3, 1.0, 3.0)
    assert ours.GetValues() == [theirs.GetValue(i) for i in range(theirs.GetNumberOfContours())]
    one, other = output(ours), output(theirs)
    assert one.area == pytest.approx(other.area, rel=1e-3)
    assert set(one.point_data) == set(other.point_data)
    ours.SetNumberOfContours(1)
    ours.SetComputeScalars(False)
    ours.SetComputeNormals(True)
    assert (ours.GetNumberOfContours(), ours.GetComputeScalars(), ours.GetComputeNormals()) == (1, False, True)
    assert set(output(ours).point_data) == {"x", "v", "Normals"}


def test_a_tolerance_refines_quadratic_cells(tmp_path):
    isotet.make("tet10", 6, fields=["sphere"]).write(tmp_path / "curved.vtu")
    grid = pv.read(tmp_path / "curved.vtu")
    contour = pipeline(grid, "sphere", 0.7)
    sizes = [output(contour).n_cells]
    for tolerance in (0.01, 0.001):
        contour.SetTolerance(tolerance)
        assert contour.GetTolerance() == tolerance
        surface = output(contour)
        sizes.append(surface.n_cells)
        assert surface.is_manifold
        direct = isotet.vtk.grid_of(grid).contour(0.7, "sphere", tolerance=f"{100 * tolerance}%")
        assert surface.n_cells == len(direct.triangles)
    assert sizes == sorted(sizes) and sizes[0] < sizes[2]
    with pytest.raises(ValueError, match="the tolerance is 2, but must be a share of the range"):
        contour.SetTolerance(2)


def test_it_runs_when_something_was_modified_and_only_then():
    grid = cubes().triangulate()
    contour = pipeline(grid)
    runs = []
    contour.AddObserver("StartEvent", lambda *_: runs.append(1))
    first = output(contour).area
    output(contour)
    assert len(runs) == 1
    contour.SetValue(0, 2.5)  # the same
    output(contour)
    assert len(runs) == 1
    contour.SetValue(0, 2.0)
    assert output(contour).area < first
    assert len(runs) == 2
    grid["r"] *= 2
    grid.GetPointData().GetArray("r").Modified()
    assert output(contour).area == pytest.approx(grid.contour([2.0], "r").area, rel=1e-3)
    assert len(runs) == 3
    contour.SetInputArrayToProcess(0, 0, 0, 0, "x")
    assert output(contour).area == pytest.approx(64)


def test_pipelines_on_both_sides():
    append = vtkAppendFilter()
    append.AddInputData(cubes())
    contour = IsotetContour()
    contour.SetInputConnection(append.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    contour.SetValue(0, 2.5)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(contour.GetOutputPort())
    assert output(normals).is_manifold
    contour.SetValue(0, 1.5)
    assert output(normals).area == pytest.approx(4 * np.pi * 1.5**2, rel=0.2)


def test_active_scalars_are_the_default():
    contour = IsotetContour()
    contour.SetInputDataObject(cubes())
    contour.SetValue(0, 2.5)
    assert output(contour).n_cells > 0


def test_composite_data_sets_come_block_by_block():
    blocks = pv.MultiBlock([cubes(), cubes(6)])
    contour = pipeline(blocks)
    contour.SetExpectedSurfaces(100)
    surfaces = output(contour)
    assert [surface.n_cells > 0 for surface in surfaces] == [True, True]
    assert len(contour._sessions) == 2
    kept = list(contour._sessions.values())
    contour.SetValue(0, 2.0)
    output(contour)
    assert list(contour._sessions.values()) == kept


def test_a_series_with_the_same_cells_in_new_arrays_is_one_session():
    contour = pipeline(cubes())
    contour.SetExpectedSurfaces(1000)
    output(contour)
    for step in range(3):
        grid = cubes()  # as a reader gives it: all arrays are new
        grid["r"] = grid["r"] * (1 + step)
        contour.SetInputDataObject(grid)
        assert output(contour).area == pytest.approx(grid.contour([2.5], "r").area, rel=0.02)
        assert len(contour._sessions) == 1
        assert contour._sessions[0].update in ("nothing", "field")  # not packed again


def test_sessions_go_with_their_blocks_and_any_number_stays():
    blocks = pv.MultiBlock([cubes(2) for _ in range(100)])
    contour = pipeline(blocks, value=1.0)
    contour.SetExpectedSurfaces(1000)
    output(contour)
    kept = list(contour._sessions.values())
    contour.SetValue(0, 0.9)
    output(contour)
    assert len(kept) == 100 and list(contour._sessions.values()) == kept
    assert {session.update for session in kept} == {"nothing"}
    last = pv.MultiBlock([blocks[99], blocks[98]])  # other numbers, the same cells
    contour.SetInputDataObject(last)
    output(contour)
    assert list(contour._sessions.values()) == [kept[99], kept[98]]
    assert {session.update for session in contour._sessions.values()} == {"nothing"}


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_points_have_the_type_of_the_input(dtype):
    grid = cubes(4).triangulate()
    grid.points = grid.points.astype(dtype) - dtype(2)  # the middle is 0
    assert output(pipeline(grid, value=1.5)).points.dtype == dtype
    assert grid.isotet.contour([1.5], "r").points.dtype == dtype


def test_no_isovalues_give_nothing():
    contour = pipeline(cubes())
    contour.SetNumberOfContours(0)
    heard = []
    contour.AddObserver("ErrorEvent", lambda *_: heard.append(1))
    surface = output(contour)
    assert surface.n_points == surface.n_cells == 0 and not heard
    assert cubes().isotet.contour([], "r").n_points == 0


@pytest.mark.parametrize("through", ["itself", "another filter"])
def test_an_interrupt_arrives(through):
    grid = cubes(40)
    contour = pipeline(grid)
    last = contour
    if through == "another filter":
        last = vtkPolyDataNormals()
        last.SetInputConnection(contour.GetOutputPort())
    with mock.patch.object(isotet._vtk_session.Session, "inputs", side_effect=lambda *_, **__: signal.raise_signal(signal.SIGINT)):
        with pytest.raises(KeyboardInterrupt):
            last.Update()
            time.sleep(10)
    assert contour.GetOutputDataObject(0).GetNumberOfCells() == 0
    assert output(contour).n_cells > 0, "it was not done"
    contour.Modified()
    assert output(last).n_cells > 0


def test_an_exit_arrives():
    contour = pipeline(cubes())
    with mock.patch.object(isotet._vtk_session.Session, "inputs", side_effect=SystemExit):
        with pytest.raises(SystemExit):
            contour.Update()
            time.sleep(10)


def test_surfaces_of_blocks_fit_bit_for_bit():
    whole = cubes(8)
    whole.points = whole.points.astype(np.float64) / 7 + 5e5
    whole["r"] = whole["r"].astype(np.float64) / 7
    left = whole.cell_centers().points[:, 0] < 5e5 + 0.6
    blocks = pv.MultiBlock([whole.extract_cells(left), whole.extract_cells(~left)])
    both = output(pipeline(blocks, value=0.31)).combine().extract_geometry().clean(tolerance=0, absolute=True)
    assert both.n_cells > 0 and both.n_open_edges == output(pipeline(whole, value=0.31)).n_open_edges


def test_composite_data_without_the_array_are_an_error():
    contour = pipeline(pv.MultiBlock([cubes(), cubes(6)]), "pressure")
    assert errors_of(contour)[0] == "there is no point array 'pressure'"


@pytest.mark.parametrize("storage", ["Use32BitStorage", "Use64BitStorage", "UseFixedSize32BitStorage", "UseFixedSize64BitStorage"])
def test_every_storage_of_cells(storage):
    grid = cubes().triangulate()
    wanted = output(pipeline(grid))
    cells = vtkCellArray()
    if "Fixed" in storage:
        getattr(cells, storage)(4)
    else:
        getattr(cells, storage)()
    cells.Append(grid.GetCells())
    grid.SetCells(10, cells)
    assert output(pipeline(grid)).area == wanted.area


def test_empty_grids_give_empty_surfaces():
    assert output(pipeline(pv.UnstructuredGrid())).n_cells == 0


def test_errors_say_why():
    assert errors_of(pipeline(cubes(), "pressure"))[0] == "there is no point array 'pressure'"
    assert errors_of(pipeline(cubes(), "number"))[0].startswith("there is no point array 'number', but a cell array")


def test_polyhedra_come_with_their_faces(tree):
    path = tree / "data/vtu/polyhedron_two_pieces.vtu"
    ours, theirs = isotet.read(path, merge_pieces=True), grid_of(pv.read(path))
    for cell in range(len(ours)):
        stream, other = (g.faces[g.face_offsets[cell] : g.face_offsets[cell + 1]] for g in (ours, theirs))
        assert len(stream) == len(other)
        if len(stream):
            assert stream[0] == other[0] and sorted(lengths(stream)) == sorted(lengths(other))
    surface = theirs.contour(0.5, theirs.points[:, 0].copy())
    assert surface.area == pytest.approx(ours.contour(0.5, "x").area)
    again = isotet.Grid(theirs.points, theirs.cells, offsets=theirs.offsets, types=theirs.types, faces=theirs.faces,
                        face_offsets=theirs.face_offsets)  # fmt: skip
    assert np.array_equal(again.contour(0.5, "x").points, theirs.contour(0.5, "x").points)
    with pytest.raises(ValueError, match="faces and face_offsets"):
        isotet.Grid(theirs.points, theirs.cells, offsets=theirs.offsets, types=theirs.types, faces=theirs.faces)


def lengths(stream):
    """How many points each face has."""
    at, out = 1, []
    while at < len(stream):
        out.append(stream[at])
        at += stream[at] + 1
    return out


@pytest.mark.parametrize("shape", ["kuhn", "hex", "wedge", "mixed"])
def test_clipped_cells_are_upright_and_whole_in_vtk(shape):
    mine = isotet.make(shape, 5, ["gyroid"])
    volume = mine.solid("gyroid", above=0.2, precision="float64").solid["volume"]
    clipped = mine.clip("gyroid", above=0.2, precision="float64")
    part = clipped.to_vtk()
    assert part.GetNumberOfCells() == len(clipped.types)
    total = 0.0  # by faces: VTK takes polyhedra for convex
    for i in range(part.GetNumberOfCells()):
        cell = part.GetCell(i)
        points = cell.GetPoints()
        centre = np.mean([points.GetPoint(k) for k in range(cell.GetNumberOfPoints())], axis=0)
        six_volumes = 0.0
        for f in range(cell.GetNumberOfFaces()):
            face = cell.GetFace(f).GetPoints()
            corners = np.array([face.GetPoint(k) for k in range(face.GetNumberOfPoints())]) - centre
            for k in range(1, len(corners) - 1):
                six_volumes += np.dot(corners[0], np.cross(corners[k], corners[k + 1]))
        if cell.GetCellType() == 42:
            assert six_volumes > 0  # faces outwards
        total += abs(six_volumes) / 6
    assert abs(total - volume) < 1e-9 * volume
