# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Writes data/vtu/mfem_levels_hex.vtu, mfem_levels_wedge.vtu and data/vtk/mfem_levels_tet.vtk with MFEM (pip install mfem):
cubes of cells that are refined twice near a sphere, without closing (MFEM's non-conforming meshes), as
ParaViewDataCollection and PrintVTK write them: each cell has points of its own. The field is the distance from
the corner at 0, at hanging points constrained to what the larger cells have.

    python make_mfem_levels.py FOLDER
"""

import io
import math
import os
import shutil
import sys

import mfem.ser as mfem

RADIUS = 0.6


class Distance(mfem.PyCoefficient):
    def EvalValue(self, x):
        return math.sqrt(x[0] ** 2 + x[1] ** 2 + x[2] ** 2)


def refine_at_sphere(mesh):
    """Cells that the sphere meets, by their corners; in the second round those of one half."""
    mesh.EnsureNCMesh(True)
    for lowest in (1.0, 0.3):
        places = mesh.GetVertexArray()
        cells = []
        for cell in range(mesh.GetNE()):
            corners = [places[i] for i in mesh.GetElementVertices(cell)]
            inside = {math.dist(place, (0, 0, 0)) < RADIUS for place in corners}
            if len(inside) == 2 and min(place[0] for place in corners) < lowest:
                cells.append(cell)
        mesh.GeneralRefinement(mfem.intArray(cells), 1, 2)


def made(cell_type, side):
    mesh = mfem.Mesh.MakeCartesian3D(side, side, side, cell_type)
    refine_at_sphere(mesh)
    collection = mfem.H1_FECollection(1, 3)
    space = mfem.FiniteElementSpace(mesh, collection)
    field = mfem.GridFunction(space)
    field.ProjectCoefficient(Distance())
    free = mfem.Vector()
    field.GetTrueDofs(free)
    field.SetFromTrueDofs(free)
    return mesh, collection, space, field


def write_vtu(folder, name, cell_type, side):
    mesh, _, _, field = made(cell_type, side)
    collection = mfem.ParaViewDataCollection(name, mesh)
    collection.SetPrefixPath(folder)
    collection.SetDataFormat(mfem.VTKFormat_BINARY32)
    collection.SetCompressionLevel(0)
    collection.RegisterField("distance", field)
    collection.Save()
    os.replace(f"{folder}/{name}/Cycle000000/proc000000.vtu", f"{folder}/{name}.vtu")
    shutil.rmtree(f"{folder}/{name}")


def write_vtk(folder, name, cell_type, side):
    mesh, _, _, field = made(cell_type, side)
    text = io.StringIO()
    mesh.PrintVTK(text, 1)
    field.SaveVTK(text, "distance", 1)
    with open(f"{folder}/{name}.vtk", "w") as file:
        file.write(text.getvalue())


if __name__ == "__main__":
    write_vtu(sys.argv[1], "mfem_levels_hex", mfem.Element.HEXAHEDRON, 3)
    write_vtu(sys.argv[1], "mfem_levels_wedge", mfem.Element.WEDGE, 2)
    write_vtk(sys.argv[1], "mfem_levels_tet", mfem.Element.TETRAHEDRON, 2)
