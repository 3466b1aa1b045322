# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By mpirun and pvbatch: pieces of files on several ranks. First `write` on one process, then `check` on any number."""

import pickle

from support import *

NAME = "pieces"
VALUES = (0.3, 0.33)


def data():
    return lattice(10, dtype=np.float64, origin=5e5)


def write_pieces(count):
    """One PVTU with random pieces, with global ids."""
    points, cells, field = data()
    owner = np.random.default_rng(3).integers(0, count, len(cells))
    for piece in range(count):
        used, local = np.unique(cells[owner == piece], return_inverse=True)
        write(grid_of(points[used], local.reshape(-1, 4), {"r": field[used]}, ids=used), f"{NAME}_{piece}.vtu")
    with open(os.path.join(scratch, NAME + ".pvtu"), "w") as file:
        file.write('<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
                   '<PUnstructuredGrid GhostLevel="0"><PPointData GlobalIds="ids"><PDataArray type="Float64" Name="r"/>'
                   '<PDataArray type="Int64" IdType="1" Name="ids"/></PPointData><PPoints><PDataArray type="Float64" Name="Points" '
                   'NumberOfComponents="3"/></PPoints>')  # fmt: skip
        for piece in range(count):
            file.write(f'<Piece Source="{NAME}_{piece}.vtu"/>')
        file.write("</PUnstructuredGrid></VTKFile>")


def check():
    load()
    reader = simple.XMLPartitionedUnstructuredGridReader(FileName=[os.path.join(scratch, NAME + ".pvtu")])
    filter = contour(reader, ComputeNormals=0, ExpectedSurfaces=100)
    for value in VALUES:
        filter.Isosurfaces = [value]
        filter.UpdatePipeline()
        out = os.path.join(scratch, f"surface-{ranks}.pvtp")
        writer = simple.servermanager.writers.XMLPPolyDataWriter(Input=filter, FileName=out, DataMode="Binary")
        writer.UpdatePipeline()
        if rank == 0:
            surface, wanted = read(out), pickle.load(open(os.path.join(scratch, f"whole-{value}"), "rb"))
            assert corners_of(surface) == wanted, (len(corners_of(surface)), len(wanted))
            assert open_edges(surface) == 0
    if rank == 0:
        print("ok", ranks, flush=True)


def read(name):
    from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader

    reader = vtkXMLPPolyDataReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def write_whole():
    """The triangles of the grid in one piece."""
    load()
    points, cells, field = data()
    source = made(grid_of(points, cells, {"r": field}))
    for value in VALUES:
        pickle.dump(corners_of(fetch(contour(source, value, ComputeNormals=0))), open(os.path.join(scratch, f"whole-{value}"), "wb"))


if sys.argv[1] == "write":
    write_pieces(3)
    write_whole()
    print("ok")
else:
    check()
