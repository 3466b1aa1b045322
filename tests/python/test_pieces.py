# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of pieces are together the surface of the whole."""

import pickle

import numpy as np
import pytest

import isotet


def corners(surface):
    """The triangles by their corners, in an order of their own."""
    places = surface.points[surface.triangles]
    first = np.array([min(range(3), key=lambda k: tuple(triangle[k])) for triangle in places])
    turned = np.stack([places[np.arange(len(places)), (first + k) % 3] for k in range(3)], axis=1)
    return sorted(map(tuple, turned.reshape(len(places), 9)))


@pytest.fixture
def whole():
    """A grid far from the origin with large values, whose storage depends on bounds and range."""
    made = isotet.make("mixed", 6, ["gyroid"])
    values = 100_000 + 13.1 * made.fields["gyroid"].astype(np.float64)
    return isotet.Grid(made.points.astype(np.float64) * 777.77 + 400_000.3, made.cells, offsets=made.offsets, types=made.types,
                       fields={"p": values}, cell_fields={"c": np.arange(len(made), dtype=np.float64)})  # fmt: skip


@pytest.mark.parametrize("how", [{"method": "direct"}, {"method": "clusters"}, {"split_cells": True}])
def test_pieces_fit_with_a_frame_and_only_then(whole, how):
    pieces = [whole.piece(k, 3) for k in range(3)]
    frame = isotet.make_frame(piece.survey("p", split_cells="split_cells" in how) for piece in pieces)
    expected = corners(whole.contour(100_003, "p", **how))
    fitting = [piece.contour(100_003, "p", frame=pickle.loads(pickle.dumps(frame)), **how) for piece in pieces]
    assert sorted(sum(map(corners, fitting), [])) == expected
    loose = [piece.contour(100_003, "p", **how) for piece in pieces]
    assert sorted(sum(map(corners, loose), [])) != expected


def test_packed_pieces_and_sessions_take_frames(whole):
    expected = corners(whole.contour(100_003, "p", method="clusters"))
    pieces = [whole.piece(k, 2) for k in range(2)]
    frame = isotet.make_frame([piece.survey("p") for piece in pieces])
    packed = [isotet.pack(piece, values="p", frame=frame).contour(100_003) for piece in pieces]
    assert sorted(sum(map(corners, packed), [])) == expected
    sessions = [isotet.Contour(piece, "p", method="clusters", frame=frame) for piece in pieces]
    assert sorted(sum((corners(session.contour(100_003)) for session in sessions), [])) == expected
    later = [isotet.Grid(piece.points, piece.cells, offsets=piece.offsets, types=piece.types,
                         point_numbers=piece.point_numbers, fields={"p": piece.fields["p"] * 2}) for piece in pieces]  # fmt: skip
    frame = isotet.make_frame([piece.survey("p") for piece in later])
    assert [session.set(piece, "p", frame=frame) for session, piece in zip(sessions, later)] == ["field", "field"]
    doubled = isotet.Grid(whole.points, whole.cells, offsets=whole.offsets, types=whole.types,
                          fields={"p": whole.fields["p"] * 2})  # fmt: skip
    expected = corners(doubled.contour(200_006, "p", method="clusters"))
    assert sorted(sum((corners(session.contour(200_006)) for session in sessions), [])) == expected


def test_frames_know_ranges_and_compare(whole):
    frame = isotet.make_frame([whole.piece(k, 4).survey("p") for k in range(4)])
    values = whole.fields["p"]
    assert frame.range("p") == (values.min(), values.max())
    assert frame == isotet.make_frame([whole.survey("p")])
    assert hash(frame) == hash(isotet.make_frame([whole.survey("p")]))
    assert frame != isotet.make_frame([whole.piece(0, 2).survey("p")])
    with pytest.raises(KeyError, match="does not know the field 'q'"):
        frame.range("q")


def test_ghost_cells_are_left_out(whole):
    marks = np.arange(len(whole)) % 2
    left = whole.without_cells(marks)
    rest = whole.without_cells(1 - marks)
    frame = isotet.make_frame([left.survey("p"), rest.survey("p")])
    both = [grid.contour(100_003, "p", frame=frame) for grid in (left, rest)]
    assert sorted(sum(map(corners, both), [])) == corners(whole.contour(100_003, "p"))
    with pytest.raises(ValueError, match="3 marks, but the grid has"):
        whole.without_cells([0, 1, 0])


def test_wrong_pieces_are_refused(whole):
    with pytest.raises(ValueError, match="index is 3, but must be from 0 to 2"):
        whole.piece(3, 3)
    with pytest.raises(ValueError, match="a survey has 3 bytes, but must have"):
        isotet.make_frame([b"abc"])
    with pytest.raises(ValueError, match="no piece|is empty|are empty"):
        isotet.make_frame([])
    narrow = isotet.make_frame([whole.piece(0, 8).survey("p")])
    with pytest.raises(ValueError, match="the frame is for"):
        whole.contour(100_003, "p", frame=narrow)
    with pytest.raises(TypeError):
        isotet.Frame()
    with pytest.raises(ValueError, match="point_numbers has shape"):
        isotet.Grid(whole.points, whole.cells, offsets=whole.offsets, types=whole.types, point_numbers=np.zeros((2, 2), int))


@pytest.mark.parametrize("shape", ["kuhn", "hex"])
def test_solids_of_pieces_are_together_that_of_the_whole(shape):
    whole = isotet.make(shape, 4, ["gyroid"])
    frame = isotet.make_frame([whole.piece(k, 2).survey("gyroid") for k in range(2)])
    of_whole = isotet.Solids(whole, "gyroid")
    expected = of_whole.solid(above=0.2)
    half = len(whole) // 2
    marks = np.arange(len(whole)) >= half
    parts = [isotet.Solids(whole, "gyroid", ghosts=ghosts.astype(np.uint8), frame=frame) for ghosts in (marks, ~marks)]
    assert sum(part.grid_volume for part in parts) == pytest.approx(of_whole.grid_volume)
    solids = [part.solid(above=0.2) for part in parts]
    assert sum(solid.solid["volume"] for solid in solids) == pytest.approx(expected.solid["volume"])
    assert sum(len(solid.triangles) for solid in solids) == len(expected.triangles)
    with pytest.raises(ValueError, match="frame"):
        isotet.Solids(whole, "gyroid", ghosts=np.zeros(len(whole), np.uint8))
    with pytest.raises(ValueError, match="one a cell"):
        isotet.Solids(whole, "gyroid", ghosts=[0, 1], frame=frame)
