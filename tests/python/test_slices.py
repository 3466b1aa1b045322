# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Cuts along planes, spheres and cylinders, and isovalues by their share."""

import math

import numpy as np
import pytest
import pyvista as pv

import isotet


@pytest.mark.parametrize("kind", ["kuhn", "hex", "mixed"])
def test_slices_have_the_area_of_the_cut_cube(kind):
    grid = isotet.make(kind, 7, ["gyroid"])
    assert grid.slice("z", (0, 0, 0.3)).area == pytest.approx(4, rel=1e-5)
    assert grid.slice().area == pytest.approx(4, rel=1e-5), "through the middle"
    assert grid.slice((1, 1, 1), (0, 0, 0)).area == pytest.approx(3 * math.sqrt(3), rel=1e-5)
    several = grid.slice("-x", offsets=[0.1, 0.2])
    assert several.area == pytest.approx(8, rel=1e-5)
    assert set(np.round(several.points[:, 0].astype(float), 6).tolist()) == {-0.1, -0.2}


def test_slices_carry_all_fields_and_take_the_options_of_contour():
    grid = isotet.make("hex", 6, ["gyroid"])
    numbers = np.arange(len(grid), dtype=np.int32)
    grid = isotet.Grid(grid.points, grid.cells, fields={"p": grid.points}, cell_fields={"number": numbers})
    cut = grid.slice("y", (0, 0.1, 0), source_cells=True, method="clusters")
    assert np.allclose(cut.fields["p"], cut.points, atol=1e-6)
    assert np.array_equal(cut.cell_fields["number"], cut.source_cells)
    assert cut.method == "clusters"
    assert grid.slice("y", (0, 0.1, 0), fields=[], cell_fields=[]).fields == {}
    assert len(grid.slice("y", offsets=9).triangles) == 0


def test_spheres_and_cylinders():
    grid = isotet.make("kuhn", 24, ["gyroid"])
    ball = grid.slice_sphere((0.1, 0, 0), 0.5)
    assert isotet.check(ball).closed
    assert ball.area == pytest.approx(math.pi, rel=0.01)
    assert grid.slice_sphere((0, 0, 0), [0.3, 0.6]).area == pytest.approx(4 * math.pi * (0.09 + 0.36), rel=0.02)
    assert grid.slice_cylinder((0, 0, 5), "z", 0.5).area == pytest.approx(2 * math.pi, rel=0.01)


def test_what_is_no_shape_is_refused():
    grid = isotet.make("kuhn", 2, ["gyroid"])
    with pytest.raises(ValueError, match="normal is 'w', but must be x, y or z"):
        grid.slice("w")
    with pytest.raises(ValueError, match="the plane's normal is"):
        grid.slice((0, 0, 0))
    with pytest.raises(TypeError, match="origin is"):
        grid.slice("x", (1, 2))
    with pytest.raises(ValueError, match="origin and offsets"):
        grid.slice("x", (0, 0, 0), offsets=1)
    with pytest.raises(ValueError, match="the radius is -1"):
        grid.slice_sphere((0, 0, 0), [1, -1])
    with pytest.raises(ValueError, match="the radius is nan"):
        grid.slice_cylinder((0, 0, 0), "z", math.nan)


def test_isovalues_by_share():
    grid = isotet.make("perturbed", 8, ["gyroid"])
    low, high = grid.isovalues_at([10, 90])
    measured = grid.volumes([high, low])
    assert measured["volume_below"] == pytest.approx(np.array([0.9, 0.1]) * measured["volume"], rel=1e-11)
    assert measured["area"][0] == pytest.approx(grid.contour(high).area, rel=1e-5)
    values = grid.fields["gyroid"]
    assert grid.isovalues_at([5, 95], of="points") == np.percentile(values, [5, 95], method="inverted_cdf").tolist()
    with pytest.raises(ValueError, match="from 0 to 100"):
        grid.isovalues_at(101)
    with pytest.raises(ValueError, match="of is 'cells'"):
        grid.isovalues_at(50, of="cells")


def test_pyvista_slices():
    image = pv.ImageData(dimensions=(9, 9, 9))
    grid = image.cast_to_unstructured_grid()
    grid["r"] = np.linalg.norm(grid.points - 4, axis=1)
    grid.cell_data["number"] = np.arange(grid.n_cells)
    for mesh in (grid, image):
        for how in ({}, {"normal": "z", "origin": (0, 0, 1.5)}, {"normal": (1, 2, 0.5)}):
            ours, theirs = mesh.isotet.slice(**how), mesh.slice(**how)
            assert ours.area == pytest.approx(theirs.area, rel=1e-5)
            assert set(ours.array_names) == set(theirs.array_names)
    assert grid.isotet.slice("x", (99, 0, 0)).n_cells == 0
    grid.isotet.pack("r")
    assert grid.isotet.slice("y", (0, 3.25, 0)).area == pytest.approx(64, rel=1e-5), "from what is packed"
    assert grid.isotet.slice("y", contour=True).n_lines > 0
