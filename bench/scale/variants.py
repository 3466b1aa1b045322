# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A grid of `isotet make` in other forms, and OpenFOAM cases.

    python bench/scale/variants.py wide GRID.vtu OUT.vtu FIELD       64-bit corners and global numbers, as pieces.py writes them
    python bench/scale/variants.py zlib GRID.vtu OUT.vtu FIELD
    python bench/scale/variants.py legacy GRID.vtu OUT.vtk FIELD     binary
    python bench/scale/variants.py vtkhdf GRID.vtu OUT.vtkhdf FIELD  not compressed; needs VTK 9.4 or later
    python bench/scale/variants.py exodus GRID.vtu OUT.e FIELD       by meshio
    python bench/scale/variants.py foam SIDE FOLDER FIELD [PARTS]    hexahedra, binary, a volScalarField; PARTS: decomposed
"""
import pathlib
import sys

import numpy as np

GYROID = 2 * np.pi  # periods along an edge


def read(path):
    from pieces import read as read_grid

    return read_grid(path)


def write_vtu(grid, path, compress):
    import vtk

    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(path))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    if compress:
        writer.SetCompressorTypeToZLib()
    else:
        writer.SetCompressorTypeToNone()
    writer.Write()


def wide(source, out, field):
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk

    grid = read(source)
    cells = grid.GetCells()
    cells.ConvertTo64BitStorage()
    numbers = numpy_to_vtk(np.arange(grid.GetNumberOfPoints(), dtype=np.int64), deep=True)
    numbers.SetName("GlobalNodeId")
    grid.GetPointData().AddArray(numbers)
    grid.GetPointData().SetActiveGlobalIds("GlobalNodeId")
    write_vtu(grid, out, False)


def zlib(source, out, field):
    write_vtu(read(source), out, True)


def legacy(source, out, field):
    import vtk

    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(read(source))
    writer.SetFileName(str(out))
    writer.SetFileTypeToBinary()
    writer.Write()


def vtkhdf(source, out, field):
    import vtk

    writer = vtk.vtkHDFWriter()
    writer.SetInputData(read(source))
    writer.SetFileName(str(out))
    writer.SetCompressionLevel(0)
    writer.Write()


def exodus(source, out, field):
    import meshio

    meshio.write(out, meshio.read(source))


def header(kind, name, note=""):
    return (f"FoamFile\n{{\n version 2.0;\n format binary;\n class {kind};\n arch \"LSB;label=32;scalar=64\";\n"
            f"{note} object {name};\n}}\n").encode()  # fmt: skip


def write_list(path, kind, name, values, note=""):
    with open(path, "wb") as file:
        file.write(header(kind, name, note) + f"{len(values)}\n(".encode())
        values.tofile(file)
        file.write(b")\n")


def write_faces(path, faces):
    begins = np.arange(0, 4 * len(faces) + 1, 4, dtype=np.int32)
    with open(path, "wb") as file:
        file.write(header("faceCompactList", "faces") + f"{len(begins)}\n(".encode())
        begins.tofile(file)
        file.write(f")\n{faces.size}\n(".encode())
        faces.astype(np.int32).tofile(file)
        file.write(b")\n")


def hexahedra(shape):
    """Faces with their owners and neighbours, in OpenFOAM's order, of nx x ny x nz cells; how many are inside."""
    nx, ny, nz = shape
    cell = np.arange(nx * ny * nz, dtype=np.int64).reshape(nz, ny, nx)
    k, j, i = np.meshgrid(np.arange(nz), np.arange(ny), np.arange(nx), indexing="ij")
    dx, dy, dz = 1, nx + 1, (nx + 1) * (ny + 1)
    corner = k * dz + j * dy + i

    def loop(first, a, b):
        return np.stack([first, first + a, first + a + b, first + b], axis=-1)

    owner, neighbour, loops = [], [], []
    for axis, (step, a, b) in enumerate(((dx, dy, dz), (dy, dz, dx), (dz, dx, dy))):
        inside = [slice(None)] * 3
        inside[2 - axis] = slice(0, -1)
        after = [slice(None)] * 3
        after[2 - axis] = slice(1, None)
        owner.append(cell[tuple(inside)].ravel())
        neighbour.append(cell[tuple(after)].ravel())
        loops.append(loop(corner[tuple(after)].ravel(), a, b))
    owner, neighbour, loops = np.concatenate(owner), np.concatenate(neighbour), np.concatenate(loops)
    order = np.lexsort((neighbour, owner))
    owner, neighbour, loops = owner[order], neighbour[order], loops[order]
    for axis, (step, a, b) in enumerate(((dx, dy, dz), (dy, dz, dx), (dz, dx, dy))):
        for last in (False, True):
            side = [slice(None)] * 3
            side[2 - axis] = slice(-1, None) if last else slice(0, 1)
            first = corner[tuple(side)].ravel() + (step if last else 0)
            owner = np.concatenate([owner, cell[tuple(side)].ravel()])
            loops = np.concatenate([loops, loop(first, a, b) if last else loop(first, b, a)])
    return loops, owner.astype(np.int32), neighbour.astype(np.int32)


def write_part(folder, time, field, side, low, high, number):
    """The layers [low, high) of a cube of `side`^3 hexahedra; `number`: of the processor, or nothing."""
    mesh = folder / "constant" / "polyMesh"
    mesh.mkdir(parents=True, exist_ok=True)
    (folder / time).mkdir(exist_ok=True)
    axis = np.linspace(-1, 1, side + 1)
    z, y, x = np.meshgrid(axis[low : high + 1], axis, axis, indexing="ij")
    write_list(mesh / "points", "vectorField", "points", np.stack([x, y, z], axis=-1).reshape(-1, 3))
    loops, owner, neighbour = hexahedra((side, side, high - low))
    cells = side * side * (high - low)
    note = f' note "nPoints:{x.size} nCells:{cells} nFaces:{len(owner)} nInternalFaces:{len(neighbour)}";\n'
    write_faces(mesh / "faces", loops)
    write_list(mesh / "owner", "labelList", "owner", owner, note)
    write_list(mesh / "neighbour", "labelList", "neighbour", neighbour, note)
    kind = "patch" if number is None else "processor"
    more = "" if number is None else f" myProcNo {number}; neighbProcNo 0;"
    (mesh / "boundary").write_bytes(
        header("polyBoundaryMesh", "boundary").replace(b"binary", b"ascii")
        + f"1\n(\n walls\n {{ type {kind}; nFaces {len(owner) - len(neighbour)}; startFace {len(neighbour)};{more} }}\n)\n".encode())  # fmt: skip
    if number is not None:
        first = low * (side + 1) ** 2
        write_list(mesh / "pointProcAddressing", "labelList", "pointProcAddressing",
                   np.arange(first, first + x.size, dtype=np.int32))  # fmt: skip
        write_list(mesh / "cellProcAddressing", "labelList", "cellProcAddressing",
                   np.arange(low * side * side, high * side * side, dtype=np.int32))  # fmt: skip
    middle = (axis[1:] + axis[:-1]) / 2
    z, y, x = (GYROID * v for v in np.meshgrid(middle[low:high], middle, middle, indexing="ij"))
    values = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    with open(folder / time / field, "wb") as file:
        file.write(header("volScalarField", field) + b"dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar>\n")
        file.write(f"{cells}\n(".encode())
        values.astype(np.float64).tofile(file)
        file.write(b");\nboundaryField\n{\n walls { type zeroGradient; }\n}\n")


def foam(side, folder, field, parts="1"):
    side, parts, folder = int(side), int(parts), pathlib.Path(folder)
    (folder / "system").mkdir(parents=True, exist_ok=True)
    (folder / "system" / "controlDict").write_bytes(header("dictionary", "controlDict").replace(b"binary", b"ascii"))
    cuts = [side * part // parts for part in range(parts + 1)]
    for part in range(parts):
        place = folder / f"processor{part}" if parts > 1 else folder
        write_part(place, "0", field, side, cuts[part], cuts[part + 1], part if parts > 1 else None)
    (folder / "case.foam").touch()


if __name__ == "__main__":
    {"wide": wide, "zlib": zlib, "legacy": legacy, "vtkhdf": vtkhdf, "exodus": exodus, "foam": foam}[sys.argv[1]](*sys.argv[2:])
