# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Packed grids in files."""

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
