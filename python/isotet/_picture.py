# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pictures of surfaces, drawn on the processor."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import _isotet
from ._call import Progress, call_options
from ._surface import Surface

if TYPE_CHECKING:
    from ._grid import PackedGrid


def png_of(picture: np.ndarray) -> bytes:
    """A picture of height x width x 4 bytes as a PNG file."""
    height, width, _ = picture.shape
    rows = np.hstack([np.zeros((height, 1), np.uint8), picture.reshape(height, -1)])  # each row begins with its filter, 0

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b"")


def _camera(view, parallel: bool) -> tuple[_isotet.Camera, bool]:
    """A camera, and whether it says where it stands."""
    if not isinstance(view, str):
        azimuth, elevation = view
        return _isotet.camera_of_angles(float(azimuth), float(elevation), parallel), False
    camera = _isotet.parse_camera(view)
    return (camera, True) if camera is not None else (_isotet.camera_of_view(view, parallel), False)


def _values(surfaces: Sequence[Surface], name: str) -> tuple[list[np.ndarray], bool]:
    """A field of all surfaces, and whether it is one value a triangle."""
    for of_triangles in (False, True):
        found = [(s.cell_fields if of_triangles else s.fields).get(name) for s in surfaces]
        if found and all(values is not None for values in found):
            if any(values.ndim != 1 for values in found):
                raise ValueError(f"color_by is '{name}', which has several components, but one number a place gives colours")
            return found, of_triangles
    known = sorted(set().union(*(list(s.fields) + list(s.cell_fields) for s in surfaces)))
    raise ValueError(f"color_by is '{name}', but the surfaces have no such field: there are {', '.join(known) or 'none'}")


def _text_or_file(text: str) -> str | tuple[str, str]:
    """Of "@FILE" or "@FILE:NAME" the text of the file and the name."""
    if not text.startswith("@"):
        return text
    file, name = text[1:], ""
    if not Path(file).exists() and ":" in file:
        file, _, name = file.rpartition(":")
    return Path(file).read_text(encoding="utf-8"), name


def _opacity(opacity: str | Sequence[tuple[float, float]]) -> str | tuple[str, str]:
    """An opacity: points as pairs, or text or a file as they are."""
    if isinstance(opacity, str):
        return _text_or_file(opacity)
    return ",".join(f"{float(value)!r}:{float(part)!r}" for value, part in opacity)


def render(surfaces: Surface | Sequence[Surface] = (), *, color_by: str | None = None, range: tuple[float, float] | None = None,
           color_map: str = "viridis", colors: str | Sequence[str] = (), opacity: float = 1,
           view: str | tuple[float, float] = "iso", parallel: bool = False, zoom: float = 1,
           size: tuple[int, int] = (1200, 900), samples: int = 3, background: str = "white", title: str = "",
           legend: bool = True, smooth: bool = True, volume: PackedGrid | None = None,
           volume_opacity: str | Sequence[tuple[float, float]] = "ramp", opacity_length: float | None = None,
           volume_isovalues: Sequence[float] = (), volume_shading: bool = False, occlusion: float = 0.8,
           threads: int = 0, progress: Progress | None = None) -> np.ndarray:  # fmt: skip
    """A picture of surfaces, of a volume, or of both: height x width x 4 numbers from 0 to 255, red, green, blue and opacity.
    No graphics card or window is needed; the same surfaces give the same bytes on every machine.

    surfaces
        One, or several.
    color_by, range, color_map
        A field that all surfaces carry, or a cell field ("isovalue"); the values at the ends of the map, or those of the
        field; "viridis", "cividis", "plasma", "turbo", "cool-warm", or "@FILE" or "@FILE:NAME", a colour map of ParaView in JSON.
    colors
        Without `color_by`: "#1f77b4" or a name such as "gray", one for all or one for each.
    opacity
        From 0 to 1: several surfaces shine through each other in the right order.
    view, parallel, zoom
        "iso", "+x", "-x" and so on; or azimuth and elevation in degrees; or all of a camera in one text, as
        ``isotet render -v`` prints it. With `parallel` there is no perspective.
    size, samples
        Width and height; each pixel is the mean of samples x samples.
    smooth
        Shade by normals of vertices; without, each triangle is flat.
    background, title, legend
        "white", "transparent", ...; a title over the colour scale, which `legend` draws beside the picture.
    volume, volume_opacity, opacity_length
        A packed grid whose field is drawn as a volume, with the surfaces in it; "ramp", "peaks", "peaks:5", "shell", or pairs of
        a value, ascending, and the opacity from 0 to 1 of a length of it, "" for none, or "@FILE", with points or a colour map of
        ParaView with its opacity; that length, or a tenth of the diagonal of the grid's box. The scale is then the volume's.
    volume_isovalues
        Isosurfaces of the volume that its rays meet, opaque, without being extracted.
    volume_shading
        Light the colours of the volume by the gradient of the field in each tet.
    occlusion
        How dark folds and hollows of opaque surfaces become, 0 to 1.

    Raises ValueError for wrong arguments, MemoryError.

    >>> import isotet
    >>> surface = isotet.make("kuhn", 8, ["sphere"]).contour(0.5)
    >>> isotet.render(surface, size=(160, 120)).shape
    (120, 160, 4)
    >>> packed = isotet.make("kuhn", 8, ["sphere"]).pack("sphere")
    >>> isotet.render(volume=packed, volume_opacity=[(0.3, 0), (0.5, 0.8), (0.7, 0)], size=(160, 120)).shape
    (120, 160, 4)
    """
    drawn = [surfaces] if isinstance(surfaces, Surface) else list(surfaces)
    names = [colors] * len(drawn) if isinstance(colors, str) else list(colors)
    if names and len(names) != len(drawn):
        raise ValueError(f"there are {len(names)} colors for {len(drawn)} surfaces")
    values, of_triangles = ([], False) if color_by is None else _values(drawn, color_by)
    camera, fitted = _camera(view, parallel)
    width, height = size
    pixels = _isotet.render([surface._surface for surface in drawn], names, values, of_triangles, _text_or_file(color_map), range,
                            float(opacity), camera, fitted, float(zoom), (width, height), samples, background,
                            title or color_by or (str(volume.field_report["name"]) if volume is not None else ""), legend, smooth,
                            None if volume is None else volume._packed, _opacity(volume_opacity), opacity_length,
                            [float(isovalue) for isovalue in volume_isovalues], volume_shading, float(occlusion),
                            call_options(threads, progress))  # fmt: skip
    return pixels.reshape(height, width, 4)
