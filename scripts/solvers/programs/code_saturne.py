# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: gmsh==4.15.2
# debian: code-saturne
# files: */postprocessing/MESH_GROUPS.case */postprocessing/RESULTS_FLUID_DOMAIN.case
"""code_saturne: its check of meshes of hexahedra, prisms, tetrahedra and of all, as EnSight Gold."""
import os
import pathlib
import subprocess

import gmsh

PROGRAMS = pathlib.Path("/usr/lib/code_saturne")
AS_ROOT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def write_mesh(name, layers, recombined):
    """A ball in a box without layers, else squares drawn out to prisms, or to hexahedra where recombined."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 1)
    shapes = gmsh.model.occ
    if layers:
        bottom = [shapes.addRectangle(x, 0, 0, 1, 1) for x in (0, 1)]
        shapes.fragment([(2, bottom[0])], [(2, bottom[1])])
        shapes.extrude([(2, face) for face in bottom], 0, 0, 1, [layers], recombine=True)
    else:
        shapes.fragment([(3, shapes.addBox(-1, -1, -1, 2, 2, 2))], [(3, shapes.addSphere(0, 0, 0, 0.6))])
    shapes.synchronize()
    for face in recombined:
        gmsh.model.mesh.setRecombine(2, face)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.35)
    for number, (_, volume) in enumerate(gmsh.model.getEntities(3), 1):
        gmsh.model.addPhysicalGroup(3, [volume], number)
    gmsh.model.addPhysicalGroup(2, [face for _, face in gmsh.model.getEntities(2)], 7)
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.write(f"{name}/{name}.msh")
    gmsh.finalize()


for name, layers, recombined in (("tet", 0, ()), ("prism", 3, ()), ("hex", 3, (1, 2)), ("mixed", 3, (1,))):
    pathlib.Path(name).mkdir()
    write_mesh(name, layers, recombined)
    for command in ([PROGRAMS / "cs_preprocess", "-o", "mesh_input", f"{name}.msh"],
                    [PROGRAMS / "cs_solver", "--quality"]):
        done = subprocess.run(command, cwd=name, env=AS_ROOT, capture_output=True, text=True, check=False)
        if done.returncode:
            print(name, command, done.stdout[-800:], done.stderr[-800:], flush=True)
