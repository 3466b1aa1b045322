# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Packed grids in files."""

import subprocess

import numpy as np
import pytest

import isotet


@pytest.fixture
def saved(tmp_path):
    grid = isotet.make("mixed", 8, ["gyroid", "sphere"])
    packed = isotet.pack(grid, values="gyroid", gradients=True, source_cells=True)
    path = tmp_path / "grid.isotet"
    packed.save(path, fields={"sphere": grid.fields["sphere"]}, time=0.5)
    return grid, packed, path


def test_surfaces_are_those_of_the_grid_that_was_saved(saved):
    grid, packed, path = saved
    for memory in (0, 100_000):
        file = isotet.open(path, memory=memory)
        a = file.contour([0.1, 0.3], "gyroid", fields=["sphere"], normals="gradient", edge_ends=True, source_cells=True)
        b = packed.contour([0.1, 0.3], fields={"sphere": grid.fields["sphere"]}, normals="gradient", edge_ends=True,
                           source_cells=True)  # fmt: skip
        for x, y in [(a.points, b.points), (a.triangles, b.triangles), (a.normals, b.normals), (a.edge_ends, b.edge_ends),
                     (a.source_cells, b.source_cells), (a.fields["sphere"], b.fields["sphere"])]:  # fmt: skip
            assert np.array_equal(x, y)


def test_the_directory_is_told(saved):
    grid, _, path = saved
    file = isotet.open(path)
    assert file.fields == ["gyroid", "sphere"]
    assert file.times == [0.5]
    assert len(file) == len(grid)
    assert file.residency["bytes_read"] < file.info["bytes"]
    file.check()


def test_a_grid_of_the_file_is_a_packed_grid(saved):
    grid, packed, path = saved
    from_file = isotet.open(path).grid("gyroid")
    assert from_file.range == packed.range
    from_file.set_field(grid.fields["sphere"])
    packed.set_field(grid.fields["sphere"])
    assert np.array_equal(from_file.contour(0.5).points, packed.contour(0.5).points)


def test_slices_are_those_of_the_grid(saved):
    grid, _, path = saved
    file = isotet.open(path, memory=100_000)
    cut, whole = file.slice("z", offsets=0.3), grid.slice("z", offsets=0.3)
    assert cut.area == pytest.approx(whole.area)
    assert sorted(cut.fields) == ["gyroid", "sphere"]
    assert np.allclose(np.sort(cut.fields["gyroid"]), np.sort(whole.fields["gyroid"]))
    assert file.slice("x").area == pytest.approx(4)
    with pytest.raises(ValueError):
        file.slice((0, 0, 0))


@pytest.fixture
def series(tmp_path):
    grid = isotet.make("mixed", 8, ["gyroid"])
    region = np.arange(len(grid), dtype=np.int32)
    paths = []
    for step in range(2):
        values = grid.fields["gyroid"] + np.float32(0.25 * step)
        step_grid = isotet.Grid(grid.points * (1 + step), grid.cells, offsets=grid.offsets, types=grid.types,
                                fields={"p": values}, cell_fields={"region": region})  # fmt: skip
        paths.append(tmp_path / f"step{step}.vtu")
        step_grid.write(paths[-1])
    return grid, region, paths, tmp_path / "run.isotet"


def test_the_carried_cell_fields_and_fractions_of_steps(series, program):
    grid, region, paths, packed = series
    for path, options in zip(paths, (["--cell-fields", "region"], ["--append"])):
        subprocess.run([program, "pack", path, packed, "-q", *options], check=True)
    file = isotet.open(packed)
    surface = file.contour(0.1, "p", cell_fields=["region"], source_cells=True)
    assert np.array_equal(surface.cell_fields["region"], region[surface.source_cells])
    areas = [file.contour(0.1, "p", fraction=f).area for f in (0, 0.25, 0.5, 0.75, 1)]
    assert areas == sorted(areas)
    assert file.contour(0.1, "p", fraction=1).area == file.contour(0.1, "p", step=1).area
    with pytest.raises(ValueError, match="fraction"):
        file.contour(0.1, "p", fraction=2)
    assert [points["step"] for points in file.info["moved_points"]] == [1]
    assert file.slice("x", step=1).area == pytest.approx(16), "in the middle of the points of that step"


def test_what_is_wrong_is_told(saved, tmp_path):
    path = saved[2]
    with pytest.raises(ValueError, match="which has 'gyroid', 'sphere'"):
        isotet.open(path).contour(0, "nothing")
    with pytest.raises(OSError):
        isotet.open(tmp_path / "nothing.isotet")
    path.write_bytes(path.read_bytes()[:5000])
    with pytest.raises(ValueError, match="cut short"):
        isotet.open(path)
    with pytest.raises(TypeError):
        isotet.PackedFile()


def test_pack_takes_the_field_behind_a_grid():
    grid = isotet.make("hex", 6, ["sphere", "gyroid"])
    area = grid.contour(0.5, "gyroid").area
    assert isotet.pack(grid, "gyroid").contour(0.5).area == pytest.approx(area)
    assert isotet.pack(grid, grid.fields["gyroid"]).contour(0.5).area == pytest.approx(area)
    assert isotet.pack(grid, values="gyroid").contour(0.5).area == pytest.approx(area)
    with pytest.raises(ValueError):
        isotet.pack(grid, "nope")
    with pytest.raises(TypeError):
        isotet.pack(grid, grid.fields["sphere"], "gyroid")
