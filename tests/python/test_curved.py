# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Curved cells, refined to a tolerance."""

import numpy as np
import pytest

import isotet

MIDDLES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]


def ball():
    """Two quadratic tetrahedra with the squared distance from a point."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
    points, known, cells = [*corners], {}, []
    for tet in ([0, 1, 2, 3], [1, 2, 3, 4]):
        nodes = list(tet)
        for a, b in MIDDLES:
            pair = tuple(sorted((tet[a], tet[b])))
            if pair not in known:
                known[pair] = len(points)
                points.append((corners[pair[0]] + corners[pair[1]]) / 2)
            nodes.append(known[pair])
        cells += nodes
    points = np.array(points)
    return isotet.Grid(points, cells, offsets=[0, 10, 20], types=[24, 24], fields={"d": (points**2).sum(axis=1)})


@pytest.mark.parametrize(("tolerance", "least"), [(0.01, 0.01), ("0.5%", 0.015)])
def test_surfaces_keep_a_tolerance(tolerance, least):
    grid = ball()
    session = isotet.Contour(grid, "d", tolerance=tolerance)
    for surface in (grid.contour(0.5, "d", tolerance=tolerance), session.contour(0.5)):
        assert 0 < surface.field_bound <= least
        assert np.abs((surface.points.astype(float) ** 2).sum(axis=1) - 0.5).max() <= least + 1e-6
        assert len(surface.triangles) > len(grid.contour(0.5, "d").triangles)


def test_without_a_tolerance_there_is_no_bound():
    assert ball().contour(0.5, "d").field_bound is None
    assert isotet.make("kuhn", 4, ["sphere"]).contour(0.5, tolerance=0.1).field_bound is None


@pytest.mark.parametrize("tolerance", ["1", "1%%", -1.0, 0.0, float("nan")])
def test_wrong_tolerances_are_told(tolerance):
    with pytest.raises(ValueError, match="tolerance"):
        ball().contour(0.5, "d", tolerance=tolerance)


def test_a_geometry_tolerance_alone_is_an_error():
    with pytest.raises(ValueError, match="geometry_tolerance"):
        ball().contour(0.5, "d", geometry_tolerance=0.1)


def test_a_distance_takes_the_place_of_a_tolerance():
    coarse, fine = (ball().contour(0.5, "d", distance=distance) for distance in (0.1, 0.01))
    assert len(coarse.triangles) < len(fine.triangles)
    assert np.abs(np.linalg.norm(fine.points, axis=1) - np.sqrt(0.5)).max() <= 0.01


def test_exact_vertices_lie_on_the_quadratic_field():
    exact, linear = (ball().contour(0.5, "d", precision="float64", exact_vertices=exact) for exact in (True, False))
    off = [np.abs((surface.points**2).sum(axis=1) - 0.5).max() for surface in (exact, linear)]
    assert off[0] < 1e-12 < 1e-3 < off[1]
    assert (exact.triangles == linear.triangles).all()
    session = isotet.Contour(ball(), "d", precision="float64", exact_vertices=True)
    assert (session.contour(0.5).points == exact.points).all()


def test_cuts_follow_the_fields_that_they_carry():
    """A cut is straight, but the fields on it are not."""
    grid = ball()
    for cut_by in (lambda **how: grid.slice("z", (0, 0, 0.3), **how), lambda **how: grid.slice_sphere((0, 0, 0), 0.6, **how)):
        off = []
        for tolerance in (None, "0.1%"):
            cut = cut_by(tolerance=tolerance)
            off.append(np.abs(cut.fields["d"] - (cut.points.astype(float) ** 2).sum(axis=1)).max())
        assert off[1] < off[0] / 3
    plane = [grid.slice("z", (0, 0, 0.3), tolerance="0.1%", fields=fields) for fields in (None, [])]
    assert len(plane[0].triangles) > len(plane[1].triangles)
