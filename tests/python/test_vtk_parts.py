# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Slices, solids, clips and packed files in pipelines of VTK's."""

import subprocess

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkBox, vtkCylinder, vtkPlane, vtkSphere
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

import isotet
from isotet.vtk import IsotetClip, IsotetReader, IsotetSlice, IsotetSolid
from conftest import errors_of
from test_pyvista import cubes


def output(filter):
    filter.Update()
    return pv.wrap(filter.GetOutputDataObject(0))


def test_a_plane_that_moves_along_its_normal_keeps_the_field():
    plane, updates = vtkPlane(), []
    cut = IsotetSlice(cut_function=plane, input_data=cubes(), expected_surfaces=100)
    for origin, normal in ((2.5, (0, 3, 4)), (1.5, (0, 3, 4)), (1.5, (0, 0.6, 0.8)), (1.5, (1, 0, 0))):
        plane.SetOrigin([origin] * 3)
        plane.SetNormal(normal)
        surface = output(cut)  # which sees that the plane was changed
        updates.append(cut.GetLastUpdate())
        assert np.abs((surface.points - origin) @ np.array(normal)).max() < 1e-5
        assert set(surface.point_data) == {"r", "x", "v"}
    assert updates == ["grid", "nothing", "nothing", "field"]


@pytest.mark.parametrize("function", [vtkSphere, vtkCylinder, vtkBox])
def test_slices_follow_any_function(function):
    grid = cubes(24)
    along, middle = function(), np.array(grid.center)
    if function is vtkBox:
        along.SetBounds(*(x for m in middle for x in (m - 2.2, m + 2.2)))
    else:
        along.SetCenter(middle)
        along.SetRadius(2.2)
    surface = output(IsotetSlice(cut_function=along, input_data=grid))
    assert surface.n_cells > 0
    assert np.abs([along.FunctionValue(point) for point in surface.points]).max() < 0.6


def test_slices_of_other_data_sets_are_vtks():
    image = pv.ImageData(dimensions=(9, 9, 9))
    image["x"] = image.points[:, 0]
    plane = vtkPlane()
    plane.SetOrigin(0, 0, 2.5)
    cut = IsotetSlice(cut_function=plane, input_data=image)
    with pytest.warns(UserWarning, match="IsotetSlice: vtkImageData is contoured by vtkContourFilter"):
        surface = output(cut)
    assert surface.area == pytest.approx(64) and list(surface.point_data) == ["x"]


def test_solids_and_clips_make_up_the_grid():
    grid = cubes(8)
    grid["n"] = np.arange(grid.n_points, dtype=np.int32)
    grid.cell_data["material"] = np.arange(grid.n_cells, dtype=np.int16)
    volumes = []
    for side, values in (("below", [2.5]), (3, [3.5, 2.5]), ("above", [3.5])):
        options = {"side": side, "input_data": grid, "input_array": "r", "values": values}
        solid, clip = output(IsotetSolid(**options)), output(IsotetClip(**options, polyhedra=False))
        assert solid.is_manifold and set(solid["boundary"]) <= {0, 1}
        assert set(solid.point_data) == set(clip.point_data) == set(grid.point_data)
        assert clip["n"].dtype == np.int32 and clip["material"].dtype == np.int16
        assert clip.volume == pytest.approx(solid.volume, rel=1e-4)
        volumes.append(solid.volume)
    assert sum(volumes) == pytest.approx(grid.volume, rel=1e-4)


def test_blocks_are_solids_and_clips_of_their_own():
    blocks = pv.MultiBlock([cubes(6), None, cubes(8)])
    for kind in (IsotetSolid, IsotetClip):
        parts = output(kind(side="below", input_data=blocks, input_array="r", values=[2.5]))
        alone = output(kind(side="below", input_data=blocks[2], input_array="r", values=[2.5]))
        assert parts[1] is None and parts[0].n_cells > 0 and parts[2].n_cells == alone.n_cells


def test_clips_of_images_are_grids():
    image = pv.ImageData(dimensions=(9, 9, 9))
    image["x"] = image.points[:, 0]
    part = output(IsotetClip(input_data=image, input_array="x", values=[2.5]))
    assert isinstance(part, pv.UnstructuredGrid) and part.volume == pytest.approx(5.5 * 64)


def test_they_say_why_there_is_nothing():
    grid = cubes(4)
    assert "takes two of them" in errors_of(IsotetSolid(side="between", input_data=grid, input_array="r"))[0]
    assert "but there are 2" in errors_of(IsotetClip(input_data=grid, input_array="r", values=[1, 2]))[0]
    assert "no CutFunction" in errors_of(IsotetSlice(input_data=grid))[0]
    assert "a Solid was asked for" in errors_of(IsotetSolid(input_data=pv.ImageData(dimensions=(3, 3, 3)).elevation()))[0]
    with pytest.raises(ValueError, match="one of above, below, between"):
        IsotetSolid(side="left")


def test_points_of_a_packed_file_move_with_its_steps(tmp_path, program):
    grid = isotet.make("hex", 4, ["sphere"])
    packed = tmp_path / "run.isotet"
    for step in range(2):
        path = tmp_path / f"{step}.vtu"
        isotet.Grid(grid.points * (1 + step), grid.cells, offsets=grid.offsets, types=grid.types, fields=grid.fields).write(path)
        subprocess.run([program, "pack", path, packed, "-q", *["--append"][:step]], check=True)
    reader = IsotetReader(file_name=packed)
    for time, side in ((0, 2), (1, 4), (0, 2)):
        reader.UpdateTimeStep(time)
        assert pv.wrap(reader.GetOutput()).bounds[1] - pv.wrap(reader.GetOutput()).bounds[0] == pytest.approx(side)


def test_packed_files_are_read_with_their_steps(tmp_path):
    grid = isotet.make("hex", 6, ["sphere"])
    packed = isotet.pack(grid)
    packed.save(tmp_path / "grid.isotet", time=3.0)
    again = packed.unpack()
    assert np.array_equal(again.points, grid.points) and len(again.offsets) - 1 == len(grid.cells)
    assert np.array_equal(again.fields["sphere"], grid.fields["sphere"])
    reader = IsotetReader(file_name=tmp_path / "grid.isotet")
    reader.UpdateInformation()
    steps = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    assert steps in (3.0, (3.0,)), steps
    assert np.array_equal(output(reader)["sphere"], grid.fields["sphere"])
    reader.GetPointDataArraySelection().DisableAllArrays()
    assert list(output(reader).point_data) == []
    reader.SetFileName(tmp_path / "gone.isotet")
    assert "gone.isotet" in errors_of(reader)[0]
