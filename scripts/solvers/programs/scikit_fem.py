# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: scikit-fem==12.0.2 meshio==5.3.5
# files: *.vtk *.vtu *.msh *.mesh
"""scikit-fem: Poisson on a cube of tetrahedra and hexahedra, and curved meshes, in what it writes."""
import numpy
import skfem
from skfem.models.poisson import laplace, unit_load


def solved(mesh, element):
    basis = skfem.Basis(mesh, element)
    values = skfem.solve(*skfem.condense(laplace.assemble(basis), unit_load.assemble(basis), D=basis.get_dofs()))
    return values[basis.nodal_dofs[0]]


side = numpy.linspace(0, 1, 7)
tets = skfem.MeshTet.init_tensor(side, side, side)
hexahedra = skfem.MeshHex.init_tensor(side, side, side)
waves = lambda places: numpy.sin(3 * places[0]) + places[1] * places[2]
curved_tets, curved_hexahedra = skfem.MeshTet2.from_mesh(tets), skfem.MeshHex2.from_mesh(hexahedra)
cases = {"tet": (tets, solved(tets, skfem.ElementTetP1())), "hex": (hexahedra, solved(hexahedra, skfem.ElementHex1())),
         "tet10": (curved_tets, waves(curved_tets.doflocs)),
         "hex27": (curved_hexahedra, waves(curved_hexahedra.doflocs))}
for name, (mesh, u) in cases.items():
    centres = mesh.doflocs[:, mesh.t[:4]].mean(axis=1)
    for ending in ("vtk", "vtu", "msh"):
        mesh.save(f"{name}.{ending}", point_data={"u": u, "place": mesh.doflocs.T.copy()},
                  cell_data={"c": [waves(centres)]})
    if len(name) == 3:
        mesh.save(f"{name}.mesh")
