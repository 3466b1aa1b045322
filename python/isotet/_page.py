# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Grids as web pages of one file."""

from __future__ import annotations

import base64
import html as escaping
import json
import os
import tempfile
import zlib
from collections.abc import Iterable, Mapping
from importlib import resources
from typing import Any

from . import _isotet
from ._arrays import scalars_in
from ._call import Progress, call_options
from ._grid import Grid, PackedGrid

_SAVED = '<script type="application/json" id="saved">{}</script>\n'
_TITLE = "<title>isotet</title>"


class Page:
    """A web page of one file with a grid in it: made by `html`, shown by notebooks, and by any browser once it is saved."""

    __slots__ = ("_name", "text")

    text: str
    """The HTML document, which loads nothing."""

    def __init__(self) -> None:
        raise TypeError("use isotet.html()")

    @classmethod
    def _of(cls, text: str, name: str) -> Page:
        self = cls.__new__(cls)
        self.text, self._name = text, name
        return self

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page; OSError where it cannot be."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self.text)

    def _repr_html_(self) -> str:
        title = escaping.escape(f"{self._name}: isosurfaces")
        return f'<iframe title="{title}" srcdoc="{escaping.escape(self.text)}" style="width: 100%; height: 600px; border: 0"></iframe>'

    def __len__(self) -> int:
        return len(self.text)

    def __repr__(self) -> str:
        return f"<isotet.Page of {self._name}: {len(self.text):,} bytes>"


def _unfilled() -> str:
    page = resources.files(__package__) / "page.html"
    if not page.is_file():
        raise _isotet.Error("this isotet has no page in it: scripts/wheel.sh takes one from ISOTET_PAGE, which `isotet docs page` prints")
    return page.read_text(encoding="utf-8")


def _packed_bytes(packed: PackedGrid, fields: Iterable[_isotet.PointField], call: _isotet.CallOptions) -> bytes:
    with tempfile.TemporaryDirectory(prefix="isotet-") as folder:
        path = os.path.join(folder, "grid.isotet")
        packed._save(path, fields, None, call)
        with open(path, "rb") as file:
            return file.read()


def _wanted_fields(grid: Grid, fields: Mapping[str, Any] | Iterable[str] | None, color_by: str | None,
                   call: _isotet.CallOptions) -> dict[str, _isotet.PointField]:  # fmt: skip
    """Fields by their names, each once."""
    if isinstance(fields, Mapping):
        wanted = {name: _isotet.PointField(name, scalars_in(name, values)) for name, values in fields.items()}
    else:
        wanted = {name: grid._field(name, call) for name in fields or ()}
    if color_by is not None and color_by not in wanted:
        wanted[color_by] = grid._field(color_by, call)
    return wanted


def _first_look(grid: Grid, color_by: str | None) -> dict[str, Any]:
    """What a page begins with where no field and no value is named: the boundary, where isosurfaces say little."""
    view = grid.first_view
    if view["draw"] == "isosurfaces":
        return {}
    look: dict[str, Any] = {"isosurfaces": False, "boundary": 1}
    if view["draw"] == "field_on_boundary" and not view["cell_field"] and color_by in (None, view["field"]):
        look |= {"color_by": view["field"], "colored_boundary": True}
    return look


def _json_in_html(value: Any) -> str:
    return json.dumps(value).replace("<", "\\u003c")


def html(grid: Any, field: str | None = None, *, isovalue: float | None = None, color_by: str | None = None,
         fields: Mapping[str, Any] | Iterable[str] | None = None, name: str = "grid", threads: int = 0,
         progress: Progress | None = None) -> Page:  # fmt: skip
    """A page of one file in which the isosurface follows a slider, with the packed grid and isotet as WebAssembly in it.
    Notebooks show it, and it goes on without them; `Page.save` writes it for mail, web sites and documentation.

    grid
        A `Grid`, or what `Grid` takes: a mesh of PyVista, VTK or meshio.
    field, isovalue
        What is shown first; without, what `Grid.first_view` says, and a value in the middle.
    color_by, fields
        Fields that the page has, too: names, or a mapping from names to arrays of one value a point.
        Vectors go by components: "U:mag".
    name
        What the page calls the grid.

    Raises ValueError for wrong arguments and broken grids; MemoryError; `Error` where isotet was built without the page.
    """
    unfilled, call = _unfilled(), call_options(threads, progress)
    grid = grid if isinstance(grid, Grid) else Grid(grid)
    first, others = grid._field(field, call), _wanted_fields(grid, fields, color_by, call)
    others.pop(first.name, None)
    packed = _packed_bytes(grid.pack(first, threads=threads, progress=progress), others.values(), call)
    state = {"field": first.name, "isovalues": [] if isovalue is None else [float(isovalue)], "color_by": color_by or ""}
    if field is None and isovalue is None:
        state |= _first_look(grid, color_by)
    saved = _json_in_html({"file": name, "version": _isotet.__version__, "state": state, "notes": []})
    parts = (f'<script type="application/json" id="saved">{saved}</script>\n'
             f'<script type="text/plain" id="grid">{base64.b64encode(zlib.compress(packed, 6)).decode()}</script>\n')  # fmt: skip
    title = f"<title>{escaping.escape(name)} – isotet</title>"
    return Page._of(unfilled.replace(_TITLE, title, 1).replace(_SAVED, parts, 1), name)
