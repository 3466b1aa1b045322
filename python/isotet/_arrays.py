# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Which Python objects become which arrays. Without a copy where isotet takes the array as it is."""

from __future__ import annotations

import numbers
import operator
import re
import sys

import numpy as np

from . import _isotet

# VTK's numbers of meshio's cell types. Those that are not contoured are left out by isotet, which counts them.
VTK_TYPES = {
    "vertex": 1, "line": 3, "triangle": 5, "polygon": 7, "quad": 9, "tetra": 10, "hexahedron": 12, "wedge": 13,
    "pyramid": 14, "penta_prism": 15, "hexa_prism": 16, "line3": 21, "triangle6": 22, "quad8": 23, "tetra10": 24,
    "hexahedron20": 25, "wedge15": 26, "pyramid13": 27, "quad9": 28, "hexahedron27": 29, "wedge18": 32, "hexahedron24": 33,
    "triangle7": 34, "line4": 35, "VTK_LAGRANGE_CURVE": 68, "VTK_LAGRANGE_TRIANGLE": 69, "VTK_LAGRANGE_QUADRILATERAL": 70,
    "VTK_LAGRANGE_TETRAHEDRON": 71, "VTK_LAGRANGE_HEXAHEDRON": 72, "VTK_LAGRANGE_WEDGE": 73, "VTK_LAGRANGE_PYRAMID": 74,
}  # fmt: skip
_SOLID = ("tetra", "hexahedron", "wedge", "pyramid")
_FLAT = re.compile(r"(empty|vertex|line|pixel|triangle|quad|polygon)\d*|VTK_BEZIER_(CURVE|TRIANGLE|QUADRILATERAL)")
_POLYHEDRON = 42
_TYPE_OF_CORNERS = {4: 10, 8: 12, 6: 13, 5: 14}


def _has_masked(array) -> bool:
    """Whether it is a masked array with masked values. There is none where numpy.ma, which is slow to import, was not."""
    ma = sys.modules.get("numpy.ma")
    return ma is not None and isinstance(array, ma.MaskedArray) and bool(ma.is_masked(array))


def _native(what: str, array, integers_only: bool = False) -> np.ndarray:
    """A contiguous array of a type that isotet has."""
    if _has_masked(array):
        raise ValueError(f"{what} is a masked array with masked values: only values may have some, which are no data")
    if hasattr(array, "__dlpack__") and not hasattr(array, "__array__"):
        array = np.from_dlpack(array)
    array = np.asarray(array)
    kind, bits = array.dtype.kind, 8 * array.dtype.itemsize
    if integers_only and kind in "bf":
        raise TypeError(f"{what} has type {array.dtype}, but must have integers")
    if kind == "b":
        array = array.astype(np.uint8)
    elif kind == "f" and bits == 16:
        array = array.astype(np.float32)
    elif kind not in "iuf" or bits > 64:
        raise TypeError(f"{what} has type {array.dtype}, but must have integers, float16, float32 or float64")
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    return np.ascontiguousarray(array)


def points_in(points) -> np.ndarray:
    """float32 or float64, N x 3."""
    array = _native("points", points)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"points has shape {array.shape}, but must have shape (N, 3)")
    return array if array.dtype.kind == "f" else array.astype(np.float64)


def values_in(what: str, values) -> np.ndarray:
    """One or two dimensions; masked values become NaN."""
    if _has_masked(values):
        keeps = values.dtype.kind == "f"
        values = (values if keeps else values.astype(np.float64)).filled(np.nan)
    array = _native(what, values)
    if array.ndim not in (1, 2):
        raise ValueError(f"{what} has shape {array.shape}, but must have one or two dimensions")
    if array.ndim == 2 and array.shape[1] == 0:
        raise ValueError(f"{what} has shape {array.shape}, but must have at least one component")
    return array


def scalars_in(what: str, values) -> np.ndarray:
    """One value a point."""
    array = values_in(what, values)
    if array.ndim == 2 and array.shape[1] != 1:
        raise ValueError(f"{what} has shape {array.shape}, but one value a point is contoured: shape (N,)")
    return array.reshape(-1)


def numbers_in(what: str, numbers) -> np.ndarray:
    """One integer each."""
    array = _native(what, numbers, integers_only=True)
    if array.ndim != 1:
        raise ValueError(f"{what} has shape {array.shape}, but must have one dimension")
    return array


def fields_in(what: str, fields) -> list[tuple[str, np.ndarray]]:
    """Names and arrays, of a mapping."""
    if fields is None or (isinstance(fields, (list, tuple)) and not fields):
        return []
    if not hasattr(fields, "items"):
        raise TypeError(f"{what} is a {type(fields).__name__}, but must map names to arrays")
    return [(str(name), values_in(f"{what}[{name!r}]", values)) for name, values in fields.items()]


def _indices(what: str, array) -> np.ndarray:
    array = _native(what, array, integers_only=True)
    if array.dtype == np.uint64 and array.size and array.max() >= 2**63:
        raise ValueError(f"{what} has the number {array.max()}, but numbers must be below 2^63")
    return array if array.dtype.itemsize >= 4 else array.astype(np.int32)


def _check_meshio_type(name: str) -> None:
    if name in VTK_TYPES or _FLAT.fullmatch(name) or re.fullmatch(r"polyhedron\d*", name):
        return
    if re.fullmatch(rf"({'|'.join(_SOLID)})\d+", name):
        raise ValueError(f"cells of the type '{name}' have an order of nodes that isotet does not know: "
                         "give them as VTK's Lagrange cells")  # fmt: skip
    raise ValueError(f"there is no type of cells '{name}': there are {', '.join(VTK_TYPES)} and polyhedron")


def _corners_in(name: str, corners) -> np.ndarray:
    corners = _indices(f"cells[{name!r}]", corners)
    if corners.ndim != 2:
        raise ValueError(f"cells[{name!r}] has shape {corners.shape}, but must have one row a cell")
    return corners


def _with_polyhedra(blocks) -> _isotet.Cells:
    """Blocks of which some are polyhedra: for each cell its faces, each the numbers of its points."""
    corners, sizes, types, stream, places = [], [], [], [], [0]
    for name, cells in blocks:
        if not name.startswith("polyhedron"):
            rows = _corners_in(name, cells)
            corners.extend(rows)
            sizes.extend([rows.shape[1]] * len(rows))
            types.extend([VTK_TYPES.get(name, 0)] * len(rows))
            places.extend(places[-1:] * len(rows))
            continue
        for cell in cells:
            faces = [_indices(f"a face of cells[{name!r}]", face).reshape(-1) for face in cell]
            parts = [np.array([len(faces)]), *(part for face in faces for part in ([len(face)], face))]
            stream.extend(parts)
            corners.append(np.unique(np.concatenate(faces)) if faces else np.empty(0, np.int64))
            sizes.append(len(corners[-1]))
            types.append(_POLYHEDRON)
            places.append(places[-1] + sum(map(len, parts)))
    joined = [np.concatenate([np.empty(0, np.int64), *(np.asarray(part, np.int64) for part in parts)]) for parts in (corners, stream)]
    return _isotet.Cells(joined[0], np.cumsum([0, *sizes], dtype=np.int64), np.array(types, np.uint8), 10, joined[1],
                         np.array(places, np.int64))  # fmt: skip


def _blocks_in(blocks) -> _isotet.Cells:
    """meshio's cells: pairs of a type and an array of corners, one row a cell; of polyhedra lists of faces."""
    blocks = list(blocks)
    for name, _ in blocks:
        _check_meshio_type(name)
    if any(name.startswith("polyhedron") for name, _ in blocks):
        return _with_polyhedra(blocks)
    arrays = [_corners_in(name, corners) for name, corners in blocks]
    types = [VTK_TYPES.get(name, 0) for name, _ in blocks]
    if len(arrays) == 1 and types[0] in _TYPE_OF_CORNERS.values() and _TYPE_OF_CORNERS.get(arrays[0].shape[1]) == types[0]:
        return _isotet.Cells(arrays[0].reshape(-1), None, None, types[0])
    counts = [len(corners) for corners in arrays]
    connectivity = np.concatenate([corners.reshape(-1) for corners in arrays]) if arrays else np.empty(0, np.int64)
    if connectivity.dtype.kind not in "iu":  # int64 and uint64 together
        connectivity = np.concatenate([corners.reshape(-1).astype(np.int64) for corners in arrays])
    offsets = np.zeros(sum(counts) + 1, np.int64)
    np.cumsum(np.repeat([corners.shape[1] for corners in arrays], counts), out=offsets[1:])
    return _isotet.Cells(connectivity, offsets, np.repeat(np.array(types, np.uint8), counts), 10)


def cells_in(cells, offsets=None, types=None, faces=None, face_offsets=None) -> _isotet.Cells:
    """Cells as the functions of isotet take them."""
    if isinstance(cells, _isotet.Cells):
        return cells
    if hasattr(cells, "items") and not hasattr(cells, "__array__"):  # a table of pandas has both
        return _blocks_in(cells.items())
    if isinstance(cells, (list, tuple)) and cells and not np.isscalar(cells[0]):
        first = cells[0]
        if hasattr(first, "type") and hasattr(first, "data"):
            return _blocks_in((block.type, block.data) for block in cells)
        if isinstance(first, (list, tuple)) and first and isinstance(first[0], str):
            return _blocks_in(cells)
    corners = _indices("cells", cells)
    if offsets is None and types is None:
        if corners.ndim != 2 or corners.shape[1] not in _TYPE_OF_CORNERS:
            raise ValueError(
                f"cells has shape {corners.shape}, but without offsets and types must have shape (N, 4) for tetrahedra, "
                "(N, 5) for pyramids, (N, 6) for wedges or (N, 8) for hexahedra"
            )
        return _isotet.Cells(corners.reshape(-1), None, None, _TYPE_OF_CORNERS[corners.shape[1]])
    if (faces is None) != (face_offsets is None):
        raise ValueError("polyhedra need faces and face_offsets, or neither of them")
    if offsets is None or types is None:
        raise ValueError("cells need offsets and types, or neither of them")
    if corners.ndim != 1:
        raise ValueError(f"cells has shape {corners.shape}, but with offsets must have one dimension")
    types = _native("types", types, integers_only=True)
    if types.dtype != np.uint8:
        if types.size and not (0 <= types.min() and types.max() <= 255):
            raise ValueError(f"types has the values {types.min()} to {types.max()}, but VTK's numbers are 0 to 255")
        types = types.astype(np.uint8)
    shells = () if faces is None else (_indices("faces", faces).reshape(-1), _indices("face_offsets", face_offsets).reshape(-1))
    return _isotet.Cells(corners, _indices("offsets", offsets).reshape(-1), types.reshape(-1), 10, *shells)


def isovalues_in(isovalues) -> list[float]:
    """One number, or any sequence of them."""
    try:
        array = np.asarray(isovalues)
    except ValueError:  # lists of different lengths
        array = np.empty(0, object)
    array = array.reshape(-1)
    if array.dtype.kind == "O" and array.size and all(isinstance(value, numbers.Real) and not isinstance(value, bool) for value in array):
        try:
            return [float(value) for value in array]
        except OverflowError:
            raise ValueError("an isovalue is beyond the range of float64") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"isovalues is {_shortened(isovalues)}, but must be a number, or several")
    if _has_masked(isovalues):
        raise ValueError("isovalues is a masked array with masked values")
    return array.astype(np.float64).tolist()


def place_in(what: str, place) -> tuple[float, float, float]:
    """Three numbers."""
    array = np.asarray(place)
    if array.shape != (3,) or array.dtype.kind not in "iuf":
        raise TypeError(f"{what} is {_shortened(place)}, but must be three numbers")
    x, y, z = array.astype(np.float64).tolist()
    return x, y, z


def direction_in(what: str, direction) -> tuple[float, float, float]:
    """ "x", "-x" (y and z alike), or three numbers."""
    if not isinstance(direction, str):
        return place_in(what, direction)
    sign, axis = (-1.0, direction[1:]) if direction.startswith("-") else (1.0, direction)
    if axis not in ("x", "y", "z"):
        raise ValueError(f"{what} is {direction!r}, but must be x, y or z, with a minus too, or three numbers")
    return tuple(sign if axis == one else 0.0 for one in "xyz")


def middle_of(points: np.ndarray) -> np.ndarray:
    """That of the bounds; of no points the origin."""
    if len(points) == 0:
        return np.zeros(3)
    return (points.min(axis=0).astype(np.float64) + points.max(axis=0)) / 2


def _shortened(value) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def number_in(what: str, value) -> int:
    """An integer."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{what} is {_shortened(value)}, but must be an integer") from None


def words_in(**words) -> None:
    """Raises TypeError for what is no word."""
    for what, value in words.items():
        if not isinstance(value, str):
            raise TypeError(f"{what} is {_shortened(value)}, but must be text")


def tolerances_in(tolerance, geometry_tolerance, distance) -> tuple[float | None, float | None, float, float]:
    """A number, or text as "0.1%", which is a share of the field's range: (number, share, and both lengths)."""
    lengths = float(geometry_tolerance), float(distance)
    if tolerance is None:
        if geometry_tolerance and not distance:
            raise ValueError(f"geometry_tolerance is {geometry_tolerance}, but needs a tolerance or distance beside it")
        return None, None, *lengths
    if isinstance(tolerance, str):
        number, percent, rest = tolerance.partition("%")
        if percent != "%" or rest:
            raise ValueError(f"tolerance is '{tolerance}', but must be a number, or text such as '0.1%'")
        return None, float(number) / 100, *lengths
    return float(tolerance), None, *lengths
