# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""face.py LIBRARY: the C functions by ctypes alone: what another language's binding does."""

import ctypes as c
import sys


class Array(c.Structure):
    _fields_ = [("data", c.c_void_p), ("type", c.c_int), ("rows", c.c_uint64), ("columns", c.c_uint64),
                ("release", c.c_void_p), ("context", c.c_void_p)]  # fmt: skip


def array(values, kind, number, columns=1):
    memory = (kind * len(values))(*values)
    made = Array(c.cast(memory, c.c_void_p), number, len(values) // columns, columns, None, None)
    made.keep = memory
    return made


lib = c.CDLL(sys.argv[1])
lib.isotet_last_error.restype = lib.isotet_version.restype = c.c_char_p
lib.isotet_surface_area.restype = c.c_double
for name in ("grid_free", "session_free", "surface_free"):
    getattr(lib, "isotet_" + name).restype = None


def check(status):
    if status:
        raise RuntimeError(lib.isotet_last_error().decode())


points = array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], c.c_double, 9, 3)
corners = array([0, 1, 2, 3], c.c_int64, 6)
values = array([0, 1, 1, 1], c.c_float, 8)
grid, session, surface = c.c_void_p(), c.c_void_p(), c.c_void_p()
check(lib.isotet_grid_create(c.byref(points), c.byref(corners), None, None, c.c_uint8(10), c.byref(grid)))
check(lib.isotet_grid_add_field(grid, b"T", 0, c.byref(values)))
check(lib.isotet_session_create(grid, b"2*T", None, c.c_uint64(0), None, c.byref(session)))
check(lib.isotet_session_extract(session, (c.c_double * 1)(1.0), c.c_uint64(1), c.byref(surface)))
positions = Array()
check(lib.isotet_surface_array(surface, 0, c.byref(positions)))
assert (positions.rows, positions.columns, positions.type) == (3, 3, 9), "float64, as the points"
place = c.cast(positions.data, c.POINTER(c.c_double))
assert sorted(place[i] for i in range(9)) == [0.0] * 6 + [0.5] * 3
assert abs(lib.isotet_surface_area(surface) - 3**0.5 / 8) < 1e-6
assert lib.isotet_session_create(grid, b"p", None, c.c_uint64(0), None, c.byref(session)) == 1
assert b"the field is 'p'" in lib.isotet_last_error()
lib.isotet_surface_free(surface)
lib.isotet_session_free(session)
lib.isotet_grid_free(grid)
print(f"isotet {lib.isotet_version().decode()} by ctypes")
