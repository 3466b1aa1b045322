# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What the tests share."""

import os
from pathlib import Path

import numpy as np
import pytest

import isotet

TREE = Path(__file__).resolve().parents[2]


@pytest.fixture
def tree() -> Path:
    """The root of the source tree."""
    return TREE


@pytest.fixture
def program() -> str:
    """The program isotet of the same build."""
    return os.environ["ISOTET_PROGRAM"]


@pytest.fixture
def reader(program) -> str:
    """The program isotet-reader beside it."""
    return str(Path(program).resolve().with_name("isotet-reader"))


@pytest.fixture
def data(tree) -> Path:
    """The real grids."""
    return tree / "data"


@pytest.fixture
def sphere() -> isotet.Grid:
    return isotet.make("kuhn", 6, ["sphere", "gyroid"])


@pytest.fixture
def tet():
    """One tetrahedron: points, cells, values."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    return points, np.array([[0, 1, 2, 3]]), np.array([0, 1, 1, 1], np.float32)


def same(one: isotet.Surface, other: isotet.Surface) -> bool:
    """Bit by bit, fields included."""

    def arrays(surface):
        yield from (surface.points, surface.triangles, surface.normals, surface.edge_ends, surface.edge_weights)
        yield surface.source_cells
        for fields in (surface.fields, surface.cell_fields):
            yield from fields.values()

    def equal(a, b):
        if a is None or b is None:
            return a is b
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()

    names = list(one.fields) == list(other.fields) and list(one.cell_fields) == list(other.cell_fields)
    return names and all(equal(a, b) for a, b in zip(arrays(one), arrays(other), strict=True))


def errors_of(filter) -> list[str]:
    """What a VTK filter says is wrong, when it runs."""
    told = []

    def hear(caller, event, text):
        told.append(text)

    hear.CallDataType = "string0"
    filter.AddObserver("ErrorEvent", hear)
    filter.Update()
    return told
