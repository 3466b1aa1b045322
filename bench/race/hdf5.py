# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Chunked, deflated HDF5 files through HDF5's own C library: neither VTK 9.1 nor Debian's Python packages write VTKHDF."""
import ctypes
import ctypes.util
import pathlib

CHUNK = 1 << 16  # tuples
DEFLATE = 6
_KINDS = {"float32": "H5T_NATIVE_FLOAT_g", "float64": "H5T_NATIVE_DOUBLE_g", "int64": "H5T_NATIVE_LLONG_g",
          "uint8": "H5T_NATIVE_UCHAR_g"}


def library():
    places = pathlib.Path("/usr/lib").glob("*/hdf5/serial/libhdf5.so*")
    name = next((str(place) for place in sorted(places)), None) or ctypes.util.find_library("hdf5_serial")
    if not name:
        raise OSError("libhdf5 was not found")
    loaded = ctypes.CDLL(name)
    for function in ("H5Fcreate", "H5Gcreate2", "H5Gopen2", "H5Screate_simple", "H5Screate", "H5Dcreate2", "H5Pcreate",
                     "H5Acreate2", "H5Tcopy"):
        getattr(loaded, function).restype = ctypes.c_int64
    loaded.H5open()
    return loaded


class File:
    """An HDF5 file that is written; arrays are anything with the buffer protocol."""

    def __init__(self, path):
        self.c = library()
        self.file = self.c.H5Fcreate(str(path).encode(), 2, self._id(0), self._id(0))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.c.H5Fclose(self._id(self.file))

    @staticmethod
    def _id(value):
        return ctypes.c_int64(value)

    def _kind(self, name):
        return self._id(ctypes.c_int64.in_dll(self.c, name).value)

    def _space(self, shape):
        sizes = (ctypes.c_uint64 * len(shape))(*shape)
        return self._id(self.c.H5Screate_simple(len(shape), sizes, None))

    def group(self, name):
        none = self._id(0)
        self.c.H5Gclose(self._id(self.c.H5Gcreate2(self._id(self.file), name.encode(), none, none, none)))

    def attribute(self, group, name, value):
        none = self._id(0)
        owner = self._id(self.c.H5Gopen2(self._id(self.file), group.encode(), none))
        if isinstance(value, str):
            kind = self._id(self.c.H5Tcopy(self._kind("H5T_C_S1_g")))
            self.c.H5Tset_size(kind, ctypes.c_size_t(len(value)))
            space, content = self._id(self.c.H5Screate(0)), value.encode()
        else:
            kind = self._kind("H5T_NATIVE_LLONG_g")
            space, content = self._space((len(value),)), (ctypes.c_int64 * len(value))(*value)
        attribute = self._id(self.c.H5Acreate2(owner, name.encode(), kind, space, none, none))
        self.c.H5Awrite(attribute, kind, content)
        self.c.H5Aclose(attribute)
        self.c.H5Gclose(owner)

    def data(self, name, kind_name, shape, array):
        none = self._id(0)
        kind, space = self._kind(_KINDS[kind_name]), self._space(shape)
        options = self._id(self.c.H5Pcreate(self._kind("H5P_CLS_DATASET_CREATE_ID_g")))
        chunk = (min(CHUNK, shape[0]),) + shape[1:]
        self.c.H5Pset_chunk(options, len(chunk), (ctypes.c_uint64 * len(chunk))(*chunk))
        self.c.H5Pset_deflate(options, DEFLATE)
        data = self._id(self.c.H5Dcreate2(self._id(self.file), name.encode(), kind, space, none, options, none))
        self.c.H5Dwrite(data, kind, none, none, none, bytes(memoryview(array).cast("B")))
        self.c.H5Dclose(data)
