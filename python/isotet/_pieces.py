# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What the pieces of a grid agree on, so that their surfaces fit."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from . import _isotet
from ._arrays import points_in
from ._call import Progress, call_options

if TYPE_CHECKING:
    import numpy.typing as npt


class Frame:
    """How all pieces of a grid store coordinates and values, made by `make_frame`. Can be pickled.

    >>> import isotet
    >>> whole = isotet.make("mixed", 8, ["gyroid"])
    >>> pieces = [whole.piece(k, 3) for k in range(3)]
    >>> frame = isotet.make_frame(piece.survey("gyroid") for piece in pieces)
    >>> surfaces = [piece.contour(0.1, "gyroid", frame=frame) for piece in pieces]
    >>> sum(len(surface.triangles) for surface in surfaces) == len(whole.contour(0.1, "gyroid").triangles)
    True
    """

    __slots__ = ("_frame",)

    def __init__(self):
        raise TypeError("use isotet.make_frame()")

    @classmethod
    def _of(cls, frame: _isotet.Frame) -> Frame:
        self = cls.__new__(cls)
        self._frame = frame
        return self

    def range(self, field: str) -> tuple[float, float]:
        """The smallest and the largest finite value of a field in the whole grid.

        Raises KeyError for a field that was not surveyed.
        """
        return self._frame.range(field)

    def __eq__(self, other: object) -> bool:
        return self._frame.survey() == other._frame.survey() if isinstance(other, Frame) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._frame.survey())

    def __reduce__(self):
        return make_frame, ([self._frame.survey()],)

    def __repr__(self) -> str:
        return "<isotet.Frame>"


def make_frame(surveys: Iterable[bytes]) -> Frame:
    """The frame of a grid.

    surveys
        What `Grid.survey` gave for each of its pieces, in any order.

    With mpi4py: ``frame = isotet.make_frame(comm.allgather(piece.survey("p")))``.

    Raises ValueError where pieces were surveyed with other fields or types, and where there is no piece.
    """
    return Frame._of(_isotet.make_frame(list(surveys)))


def number_points(points: npt.ArrayLike, *, threads: int = 0, progress: Progress | None = None) -> np.ndarray:
    """Numbers for ``Grid(..., point_numbers=...)`` where the points of a grid have none: their ranks by x, then y, then z.
    Pieces rank the points that they share alike.

    points
        N x 3 numbers.

    >>> import isotet
    >>> isotet.number_points([[1, 0, 0], [0, 2, 0], [0, 1, 0]]).tolist()
    [2, 1, 0]
    """
    return _isotet.number_points(points_in(points), call_options(threads, progress))
