# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: mfem==4.10.0.1
# files: *.vtk *.vtu */*.pvd
# isotet: --merge-points 1e-6
"""MFEM: functions of order 1 to 3 on tetrahedra, hexahedra and wedges, also with hanging nodes, as ParaView data."""
import math

import mfem.ser as mfem

KINDS = {"tet": mfem.Element.TETRAHEDRON, "hex": mfem.Element.HEXAHEDRON, "wedge": mfem.Element.WEDGE}
FORMS = {"ascii": mfem.VTKFormat_ASCII, "binary": mfem.VTKFormat_BINARY, "binary32": mfem.VTKFormat_BINARY32}


class Wave(mfem.PyCoefficient):
    def EvalValue(self, place):
        return math.sin(3 * place[0]) + math.cos(2 * place[1]) * place[2]


def cube(kind, order, hanging):
    mesh = mfem.Mesh.MakeCartesian3D(3, 3, 3, kind)
    if order > 1:
        mesh.SetCurvature(order)
    if hanging:
        mesh.EnsureNCMesh(True)
        mesh.GeneralRefinement(mfem.intArray([0, 4, 13]), 1)
    return mesh


def write_series(name, mesh, u, order):
    for form, number in FORMS.items():
        for curved in (False, True):
            collection = mfem.ParaViewDataCollection(f"{name}_{form}{'_curved' * curved}", mesh)
            collection.SetDataFormat(number)
            collection.SetHighOrderOutput(curved)
            collection.SetLevelsOfDetail(order)
            collection.RegisterField("u", u)
            for step in range(2):
                collection.SetCycle(step)
                collection.SetTime(0.5 * step)
                collection.Save()


for kind, element in KINDS.items():
    for order in (1, 2, 3):
        for hanging in (False, True) if order < 3 else (False,):
            mesh = cube(element, order, hanging)
            # What holds the function must outlive it.
            elements = mfem.H1_FECollection(order, 3)
            space = mfem.FiniteElementSpace(mesh, elements)
            u = mfem.GridFunction(space)
            u.ProjectCoefficient(Wave())
            name = f"{kind}{order}{'_hanging' * hanging}"
            write_series(name, mesh, u, order)
            if order < 3 and not hanging:
                mesh.PrintVTU(name, mfem.VTKFormat_BINARY, order > 1)
                mesh.PrintVTK(f"{name}.vtk")
