# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: meshio==5.3.5 h5py==3.14.0 netCDF4==1.7.2 lxml==6.0.0
# files: *.vtk *.vtu *.xdmf *.msh *.mesh *.meshb *.med *.avs *.e *.node
"""meshio: meshes of every kind of cell, in every format with cells that have a volume."""
import itertools
import pathlib

import meshio
import numpy

FORMS = {"vtk": {"vtk42": ("vtk42", {}), "vtk51": ("vtk51", {}), "vtk51a": ("vtk51", {"binary": False}),
                 "vtk42a": ("vtk42", {"binary": False})},
         "vtu": {"zlib": ("vtu", {}), "lzma": ("vtu", {"compression": "lzma"}), "plain": ("vtu", {"compression": None}),
                 "ascii": ("vtu", {"binary": False})},
         "xdmf": {"hdf": ("xdmf", {}), "xml": ("xdmf", {"data_format": "XML"}),
                  "binary": ("xdmf", {"data_format": "Binary"})},
         "msh": {"gmsh22": ("gmsh22", {}), "gmsh22a": ("gmsh22", {"binary": False}), "gmsh": ("gmsh", {}),
                 "gmsha": ("gmsh", {"binary": False}), "gmsh40": ("gmsh40", {})},
         "mesh": {"": ("medit", {})}, "meshb": {"": ("medit", {})}, "med": {"": ("med", {})},
         "avs": {"": ("avsucd", {})},
         "e": {"": ("exodus", {})}, "node": {"": ("tetgen", {})}}
# What meshio leaves the cells out of, or writes half; its CGNS files are HDF5 without the structure of CGNS.
UNFIT = {"mesh": ("hex20", "tet10"), "meshb": ("hex20", "tet10"), "avs": ("hex20", "tet10"),
         "node": ("hex", "hex20", "mixed", "pyramid", "tet10")}

HEXAHEDRON_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))


def lattice(n, order=1):
    """Hexahedra of n^3 cells; the points between corners, too, for order 2."""
    side = order * n + 1
    places = numpy.array(list(itertools.product(range(side), repeat=3)), float)[:, ::-1] / (order * n)
    places[:, 0] += 0.1 * places[:, 1] * places[:, 2]
    at = lambda i, j, k: i + side * (j + side * k)
    cells = []
    for k, j, i in itertools.product(range(0, side - 1, order), repeat=3):
        corner = [at(i + order * a, j + order * b, k + order * c)
                  for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        if order == 2:
            middle = lambda p, q: (numpy.array(p) + q) // 2
            units = [(a, b, c) for c in (0, 2) for a, b in ((0, 0), (2, 0), (2, 2), (0, 2))]
            for p, q in HEXAHEDRON_EDGES:
                a, b, c = middle(units[p], units[q])
                corner.append(at(i + a, j + b, k + c))
        cells.append(corner)
    return places, numpy.array(cells)


def compact(points, blocks):
    used = numpy.unique(numpy.concatenate([cells.ravel() for _, cells in blocks]))
    number = numpy.full(len(points), -1)
    number[used] = numpy.arange(len(used))
    return points[used], [(kind, number[cells]) for kind, cells in blocks]


KUHN = numpy.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])


def meshes():
    points, hexahedra = lattice(4)
    tets = hexahedra[:, KUHN].reshape(-1, 4)
    yield "tet", points, [("tetra", tets)]
    yield "hex", points, [("hexahedron", hexahedra)]
    half = len(hexahedra) // 2
    wedges = hexahedra[half:][:, [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]].reshape(-1, 6)
    yield "mixed", points, [("hexahedron", hexahedra[:half]), ("wedge", wedges),
                            ("triangle", wedges[:5, :3]), ("tetra", tets[:0])][:3]
    yield "pyramid", *with_pyramids(points, hexahedra)
    yield "hex20", *compact(*(lambda p, c: (p, [("hexahedron20", c)]))(*lattice(3, 2)))
    middles = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    yield "tet10", *with_middles(points, tets, middles)


def with_pyramids(points, hexahedra):
    faces = [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
    centres = points[hexahedra].mean(axis=1)
    apex = len(points) + numpy.arange(len(hexahedra))
    cells = numpy.concatenate([numpy.column_stack([hexahedra[:, face], apex]) for face in faces])
    return numpy.concatenate([points, centres]), [("pyramid", cells)]


def with_middles(points, cells, edges):
    ends = numpy.sort(cells[:, edges].reshape(-1, 2), axis=1)
    unique, inverse = numpy.unique(ends, axis=0, return_inverse=True)
    places = numpy.concatenate([points, points[unique].mean(axis=1)])
    return places, [("tetra10", numpy.column_stack([cells, len(points) + inverse.reshape(len(cells), -1)]))]


def mesh_of(points, blocks, with_data=True):
    x, y, z = points.T
    wave = numpy.sin(4 * x) + numpy.cos(3 * y) * z
    if not with_data:
        return meshio.Mesh(points, blocks)
    return meshio.Mesh(points, blocks, point_data={"wave": wave, "single": wave.astype("f4"), "place": points},
                       cell_data={"number": [numpy.arange(len(cells), dtype=float) for _, cells in blocks]})


def write(mesh, name, kind, options):
    """Formats refuse cells or data that they do not know, each with an error of its own."""
    try:
        meshio.write(name, mesh, file_format=kind, **options)
        return True
    except Exception as problem:
        print(name, repr(problem))
        pathlib.Path(name).unlink(missing_ok=True)
        return False


for name, points, blocks in meshes():
    for ending, forms in FORMS.items():
        for form, (kind, options) in forms.items() if name not in UNFIT.get(ending, ()) else ():
            file = f"{name}_{form}.{ending}" if form else f"{name}.{ending}"
            for with_data in (True, False):
                if write(mesh_of(points, blocks, with_data), file, kind, options):
                    break
    for form in ("HDF", "XML"):
        with meshio.xdmf.TimeSeriesWriter(f"{name}_series_{form}.xdmf", data_format=form) as writer:
            writer.write_points_cells(points, blocks)
            for time in (0.0, 0.1, 0.3):
                data = mesh_of(points, blocks)
                writer.write_data(time, point_data={"wave": data.point_data["wave"] + time},
                                  cell_data=data.cell_data)
