# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A grid in three pieces, in files and in memory, and its surface; what scripts on several ranks and clients of pvserver share."""

import pickle

from support import *

NAME = "pieces"
VALUES = (0.3, 0.33)
COUNT = 3


def data():
    return lattice(10, dtype=np.float64, origin=5e5)


def piece_of(*pieces):
    """Random cells, with global ids: of one piece, or of some in one."""
    points, cells, field = data()
    owner = np.random.default_rng(3).integers(0, COUNT, len(cells))
    used, local = np.unique(cells[np.isin(owner, pieces)], return_inverse=True)
    return grid_of(points[used], local.reshape(-1, 4), {"r": field[used]}, ids=used)


def write_pieces():
    """One PVTU with all pieces."""
    for piece in range(COUNT):
        write(piece_of(piece), f"{NAME}_{piece}.vtu")
    with open(os.path.join(scratch, NAME + ".pvtu"), "w") as file:
        file.write('<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
                   '<PUnstructuredGrid GhostLevel="0"><PPointData GlobalIds="ids"><PDataArray type="Float64" Name="r"/>'
                   '<PDataArray type="Int64" IdType="1" Name="ids"/></PPointData><PPoints><PDataArray type="Float64" Name="Points" '
                   'NumberOfComponents="3"/></PPoints>')  # fmt: skip
        for piece in range(COUNT):
            file.write(f'<Piece Source="{NAME}_{piece}.vtu"/>')
        file.write("</PUnstructuredGrid></VTKFile>")


def read_pieces():
    return simple.XMLPartitionedUnstructuredGridReader(FileName=[os.path.join(scratch, NAME + ".pvtu")])


def whole_of(value):
    """The triangles of the grid in one piece."""
    return pickle.load(open(os.path.join(scratch, f"{NAME}-{value}"), "rb"))


def solid_of(source, value):
    return simple.IsotetSolid(Input=source, Scalars=["POINTS", "r"], Isovalues=[value])


def slice_of(source, value):
    """At a share of the width."""
    slice = simple.IsotetSlice(Input=source, SliceOffsetValues=[value])
    slice.SliceType.Origin, slice.SliceType.Normal = [5e5] * 3, [1, 0, 0]
    return slice


def clip_of(source, value):
    return simple.IsotetClip(Input=source, Scalars=["POINTS", "r"], Isovalues=[value])


def filter_of(kind, source):
    """The filter of the plugin in C++ ("plugin") or Python ("python")."""
    if not hasattr(simple, "IsotetContour"):
        load(kind)
    return contour(source, ComputeNormals=0, ExpectedSurfaces=100)
