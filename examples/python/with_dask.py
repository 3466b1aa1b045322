# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pieces of a grid on the workers of a Dask cluster: together they give the surface of the whole, bit for bit."""

import numpy as np
from dask.distributed import Client

import isotet

COUNT = 64


def survey(piece: isotet.Grid) -> bytes:
    return piece.survey("gyroid")


def contour(piece: isotet.Grid, frame: isotet.Frame) -> isotet.Surface:
    return piece.contour(0.4, "gyroid", frame=frame, threads=1)


def in_order(rows: np.ndarray) -> np.ndarray:
    ordered: np.ndarray = rows[np.lexsort(rows.T)]
    return ordered


def corners_of(surface: isotet.Surface) -> np.ndarray:
    """The coordinates of each triangle's corners, in an order that does not depend on pieces."""
    return in_order(surface.points[surface.triangles].reshape(-1, 9))


def main() -> None:
    whole = isotet.make("mixed", 16, ["gyroid"])
    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        # A grid in files is read where it is contoured: client.map(isotet.read, paths).
        pieces = client.scatter([whole.piece(k, COUNT) for k in range(COUNT)])
        frame = isotet.make_frame(client.gather(client.map(survey, pieces)))
        surfaces = client.gather(client.map(contour, pieces, frame=frame))
    joined = in_order(np.vstack([corners_of(surface) for surface in surfaces]))
    same = np.array_equal(joined, corners_of(whole.contour(0.4, "gyroid")))
    print(f"{COUNT} pieces, {len(joined)} triangles, the same as those of the whole: {same}")


if __name__ == "__main__":
    main()
