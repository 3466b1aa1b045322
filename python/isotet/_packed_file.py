# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Packed grids in files."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import numpy.typing as npt

from . import _isotet
from ._arrays import direction_in, fields_in, isovalues_in, place_in, words_in
from ._call import Progress, call_options
from ._grid import PackedGrid
from ._surface import Surface


class PackedFile:
    """A packed grid in a file, made by `PackedGrid.save` or ``isotet pack``: opened by `open`, read where isovalues need it."""

    __slots__ = ("_file", "__weakref__")

    def __init__(self):
        raise TypeError("use isotet.open()")

    @classmethod
    def _of(cls, file: _isotet.PackedFile) -> PackedFile:
        self = cls.__new__(cls)
        self._file = file
        return self

    def grid(self, field: str = "", *, step: int = 0, fraction: float = 0, threads: int = 0,
             progress: Progress | None = None) -> PackedGrid:  # fmt: skip
        """The packed grid with a field at a step. What needs all of it, `PackedGrid.set_field` say, reads all of it.

        field
            A name in `fields`; not needed where the file has one field.
        fraction
            Of the way to the next step, 0 to 1: values are (1 - fraction) a + fraction b, of points likewise where they move.

        Raises ValueError for a field or step that there is not, and for a broken file; OSError.
        """
        return PackedGrid._of(self._file.grid(field, step, fraction, call_options(threads, progress)))

    def contour(self, isovalues: npt.ArrayLike, field: str = "", *, step: int = 0, fraction: float = 0,
                fields: Iterable[str] = (), cell_fields: Iterable[str] = (), normals: str = "none",
                edge_ends: bool = False, source_cells: bool = False, ties: str = "merge", threads: int = 0,
                progress: Progress | None = None) -> Surface:  # fmt: skip
        """The surface on which a field of the file has a value: the same as that of the grid that was saved.

        fraction
            As of `grid`; cell fields are those of the step.
        fields, cell_fields
            Names of fields of the file to carry onto the surface.

        The other parameters are those of `PackedGrid.contour`.

        Raises ValueError for wrong arguments, for what was not packed, and for a broken file; OSError, MemoryError.
        """
        words_in(normals=normals, ties=ties)
        call = call_options(threads, progress)
        packed = self._file.grid(field, step, fraction, call)
        options = _isotet.ContourOptions(normals, edge_ends, source_cells, ties, packed.precision, None, 0)
        return self._extract(packed, isovalues_in(isovalues), fields, cell_fields, step, fraction, options, call)

    def slice(self, normal: npt.ArrayLike | str = "x", origin: npt.ArrayLike | None = None, *,
              offsets: npt.ArrayLike | None = None, step: int = 0, fields: Iterable[str] | None = None,
              cell_fields: Iterable[str] | None = None, threads: int = 0, progress: Progress | None = None,
              ) -> Surface:  # fmt: skip
        """The cut along a plane, or along several parallel ones: all of the file but values is read once, within the limit.

        normal, origin, offsets
            As of `Grid.slice`.
        fields, cell_fields
            Names of fields of the file to carry; without them all of the step.

        Raises as `contour`.
        """
        direction = direction_in("normal", normal)
        if offsets is not None and origin is not None:
            raise ValueError("origin and offsets were given, but one of them says where the plane is")
        info = self._file.info()
        if offsets is None:
            moved = [points["bounds"] for points in info["moved_points"] if points["step"] <= step]
            lower, upper = moved[-1] if moved else info["bounds"]
            point = place_in("origin", [(a + b) / 2 for a, b in zip(lower, upper)] if origin is None else origin)
            offsets = [sum(a * b for a, b in zip(direction, point))]
        if fields is None:
            fields = [field["name"] for field in info["fields"] if field["step"] == step]
        if cell_fields is None:
            cell_fields = dict.fromkeys(field["name"] for field in info["cell_fields"] if field["step"] <= step)
        places, call = isovalues_in(offsets), call_options(threads, progress)
        packed = self._file.plane_grid(direction, places[0] if places else 0.0, step, call)
        options = _isotet.ContourOptions("none", False, False, "merge", packed.precision, None, 0)
        return self._extract(packed, places, fields, cell_fields, step, 0, options, call)

    def _extract(self, packed, isovalues, fields, cell_fields, step, fraction, options, call) -> Surface:
        carried = [self._file.grid(name, step, fraction, call) for name in fields]
        of_cells = {name: self._file.cell_field(name, step, call) for name in cell_fields}
        surface = packed.extract(isovalues, [], fields_in("cell_fields", of_cells), options, call, carried)
        return Surface._of(surface, {"method": "clusters"})

    @property
    def info(self) -> dict[str, Any]:
        """What the file holds: points and cells of the grid that was packed, bounds, those of steps whose points move in
        "moved_points", and for each field and step a dict in "fields", as opening the file tells it."""
        return self._file.info()

    @property
    def fields(self) -> list[str]:
        """Names of the fields."""
        return list(dict.fromkeys(field["name"] for field in self._file.info()["fields"]))

    @property
    def times(self) -> list[float]:
        """The times of the steps, where they are known."""
        return self._file.info()["times"]

    @property
    def residency(self) -> dict[str, int]:
        """Bytes that were read so far, and what is kept in memory of them: now, at most, and the limit."""
        return self._file.residency()

    def check(self, *, threads: int = 0, progress: Progress | None = None) -> None:
        """Reads all of the file.

        Raises ValueError where it is broken.
        """
        self._file.check(call_options(threads, progress))

    def __len__(self) -> int:
        """The number of cells of the grid that was packed."""
        return self._file.info()["cells"]

    def __repr__(self) -> str:
        info = self._file.info()
        return (f"<isotet.PackedFile: {info['points']} points, {info['cells']} cells, {info['steps']} steps, "
                f"fields {', '.join(self.fields)}>")  # fmt: skip


def open(path: str | os.PathLike[str], *, memory: int = 0) -> PackedFile:  # noqa: A001
    """Opens a packed file (.isotet), which reads its directory only.

    memory
        Bytes of the file to keep in memory; 0: half of what is free.

    Raises OSError where it is not there, ValueError where it is broken.

    >>> import isotet, os, tempfile
    >>> packed = isotet.pack(isotet.make("kuhn", 8, ["sphere"]))
    >>> path = os.path.join(tempfile.mkdtemp(), "grid.isotet")
    >>> packed.save(path)
    >>> isotet.open(path).contour(0.5).points.tolist() == packed.contour(0.5).points.tolist()
    True
    """
    return PackedFile._of(_isotet.PackedFile.open(os.fspath(path), memory, call_options(0, None)))
