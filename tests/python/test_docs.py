# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What docstrings, docs/python.md and the README say in Python runs."""

import doctest
import importlib
import inspect
import pydoc
import re

import numpy as np
import pytest

import isotet
from conftest import TREE

MODULES = ["isotet", "isotet._arrays", "isotet._grid", "isotet._surface", "isotet._vtk_contour", "isotet._vtk_parts", "isotet._vtk_reader",
           "isotet._vtk_slice", "isotet.pyvista"]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name):
    module = importlib.import_module(name)
    result = doctest.testmod(module, optionflags=doctest.ELLIPSIS)
    assert result.failed == 0
    assert result.attempted > 0 or name in ("isotet", "isotet._arrays", "isotet.pyvista")


def blocks(path) -> list[str]:
    return re.findall(r"```python\n(.*?)```", path.read_text(), re.DOTALL)


@pytest.mark.parametrize("path", ["docs/python.md", "README.md"])
def test_documents_run(path, tmp_path, monkeypatch):
    """All blocks of a document, one after another, beside a file artery.vtu."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "artery.vtu").symlink_to(TREE / "data/vtu/artery_flow_tet_wedge.vtu")
    grid = isotet.make("kuhn", 8, ["sphere", "gyroid"])
    known = {"points": grid.points, "tets": grid.cells, "temperature": grid.fields["sphere"] * 10,
             "pressure": grid.fields["gyroid"], "np": np}  # fmt: skip
    found = blocks(TREE / path)
    assert found
    for block in found:
        exec(compile(block, path, "exec"), known)  # noqa: S102


def test_every_public_function_is_documented():
    text = (TREE / "docs/python.md").read_text()
    for name in isotet.__all__:
        assert f"`{name}" in text or f"isotet.{name}" in text or f"`isotet.{name}" in text, name


@pytest.mark.parametrize("name", [name for name in isotet.__all__ if name[0].islower()] + ["Grid", "Contour", "PackedGrid.contour"])
def test_parameters_are_described(name):
    """Each parameter stands in the text of its function, or of one that it refers to."""
    thing = isotet
    for part in name.split("."):
        thing = getattr(thing, part)
    if not callable(thing):
        return
    text = inspect.getdoc(thing) + inspect.getdoc(isotet.Grid.contour) + inspect.getdoc(isotet.Grid)
    for parameter in set(inspect.signature(thing).parameters) - {"self"}:
        assert re.search(rf"\b{parameter}\b", text), (name, parameter)


def test_help_reads_well():
    text = pydoc.plain(pydoc.render_doc(isotet))
    for line in ("surface = isotet.contour(points, cells, values, 0.5)", "class Surface", "contour(points, cells, values"):
        assert line in text
