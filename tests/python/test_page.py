# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of one file: what html() puts into the page that isotet was built with. tests/view has the page in a browser."""
import base64
import json
import re
import zlib

import isotet
import numpy as np
import pytest
from isotet import _page

UNFILLED = ('<!doctype html><title>isotet</title><script type="application/json" id="saved">{}</script>\n'
            '<script type="text/plain" id="engine">AAAA</script>')


@pytest.fixture
def unfilled(monkeypatch):
    monkeypatch.setattr(_page, "_unfilled", lambda: UNFILLED)


def part(text, name):
    return re.search(rf'<script type="[a-z/]*" id="{name}">(.*?)</script>', text).group(1)


def test_the_grid_in_the_page_is_the_packed_one(unfilled, tmp_path):
    grid = isotet.make("kuhn", 5, ["gyroid", "plane"])
    page = isotet.html(grid, "gyroid", isovalue=0.25, color_by="plane", fields=["x"], name="<b>&")
    packed = tmp_path / "grid.isotet"
    packed.write_bytes(zlib.decompress(base64.b64decode(part(page.text, "grid"))))
    file = isotet.open(packed)
    assert sorted(file.fields) == ["gyroid", "plane", "x"]
    assert np.array_equal(file.contour(0.25, "gyroid").points, grid.pack("gyroid").contour(0.25).points)
    saved = json.loads(part(page.text, "saved"))
    assert saved["state"] == {"field": "gyroid", "isovalues": [0.25], "color_by": "plane"}
    assert saved["file"] == "<b>&" and "<b>" not in page.text


def test_notebooks_and_files_have_the_same_page(unfilled, tmp_path):
    page = isotet.html(isotet.make("kuhn", 3, ["plane"]))
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.text
    frame = page._repr_html_()
    assert frame.startswith("<iframe") and page.text.count("<") + 2 == frame.count("&lt;") + frame.count("<")


def test_pages_begin_with_the_boundary_where_the_viewer_does(unfilled):
    grid = isotet.make("kuhn", 4, ["plane"])
    regions = isotet.Grid(grid.points, grid.cells, cell_fields={"region": np.arange(len(grid.cells)) // 100})
    state = json.loads(part(isotet.html(regions).text, "saved"))["state"]
    assert regions.first_view["draw"] != "isosurfaces"
    assert state["isosurfaces"] is False and state["boundary"] == 1
    assert "isosurfaces" not in json.loads(part(isotet.html(regions, isovalue=1).text, "saved"))["state"]


def test_arrays_are_fields_too(unfilled):
    grid = isotet.make("kuhn", 3, ["plane"])
    page = isotet.html(grid, fields={"mine": np.arange(len(grid.points), dtype=float)}, color_by="mine")
    assert json.loads(part(page.text, "saved"))["state"]["color_by"] == "mine"


def test_wrong_fields_are_errors(unfilled):
    grid = isotet.make("kuhn", 3, ["plane"])
    with pytest.raises(ValueError, match="pressure"):
        isotet.html(grid, "pressure")
    with pytest.raises(ValueError, match="pressure"):
        isotet.html(grid, color_by="pressure")
    with pytest.raises(ValueError):
        isotet.html(grid, fields={"short": np.zeros(2)})


def test_without_the_page_there_is_a_sentence(monkeypatch, tmp_path):
    monkeypatch.setattr(_page.resources, "files", lambda package: tmp_path)
    with pytest.raises(isotet.Error, match="no page in it: .* ISOTET_PAGE"):
        isotet.html(isotet.make("kuhn", 3, ["plane"]))
