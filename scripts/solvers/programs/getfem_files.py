# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: python3-getfem
# files: *.vtk *.vtu *.msh
"""GetFEM: functions of degree 1 and 2 on tetrahedra, hexahedra and prisms, in VTK's formats, text and binary."""
import getfem
import numpy

side = numpy.linspace(0, 1, 5)
meshes = {"tet": (getfem.Mesh("regular simplices", side, side, side), "FEM_PK(3,{0})"),
          "hex": (getfem.Mesh("cartesian", side, side, side), "FEM_QK(3,{0})"),
          "prism": (getfem.Mesh("prismatic", getfem.Mesh("regular simplices", side, side), 4), "FEM_PK_PRISM(3,{0})")}
for name, (mesh, element) in meshes.items():
    for degree in (1, 2):
        space = getfem.MeshFem(mesh, 1)
        space.set_fem(getfem.Fem(element.format(degree)))
        x, y, z = space.basic_dof_nodes()
        u, v = numpy.sin(3 * x) + numpy.cos(2 * y) * z, numpy.array([x, y * z, z])
        file = f"{name}{degree}"
        for form in ("", "ascii"):
            options = [form] if form else []
            space.export_to_vtk(f"{file}{form}.vtk", *options, space, u, "u", space, v, "v")
            space.export_to_vtu(f"{file}{form}.vtu", *options, space, u, "u", space, v, "v")
