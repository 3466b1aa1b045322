# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: python3-dolfinx openmpi-bin
# files: *.xdmf *.pvd
# isotet: --merge-points 1e-9
"""FEniCSx: functions of several elements on tetrahedra and hexahedra, in XDMF and VTK, on one process and two."""
import subprocess
import sys

if len(sys.argv) == 1:
    for processes in (1, 2):
        subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(processes), sys.executable, "-B",
                        __file__, str(processes)], check=True)
    sys.exit()

import numpy
from dolfinx import fem, io, mesh
from mpi4py import MPI

world, tag = MPI.COMM_WORLD, f"_np{sys.argv[1]}"
wave = lambda x: numpy.sin(3 * x[0]) + numpy.cos(2 * x[1]) * x[2]


def function(domain, family, degree, name, vector=False, of=wave):
    space = (fem.VectorFunctionSpace if vector else fem.FunctionSpace)(domain, (family, degree))
    made = fem.Function(space)
    made.name = name
    made.interpolate((lambda x: numpy.vstack([of(x), x[1], x[2]])) if vector else of)
    return made


for kind, cell in (("tet", mesh.CellType.tetrahedron), ("hex", mesh.CellType.hexahedron)):
    domain = mesh.create_unit_cube(world, 4, 4, 4, cell)
    linear, vector = function(domain, "CG", 1, "u"), function(domain, "CG", 1, "two words", True)
    of_cells, flow = function(domain, "DG", 0, "k"), function(domain, "DG", 0, "flow", True)
    with io.XDMFFile(world, f"{kind}{tag}.xdmf", "w") as file:
        file.write_mesh(domain)
        for time in (0.0, 0.1, 0.2):
            linear.interpolate(lambda x: wave(x) + time)
            for made in (linear, vector, of_cells):
                file.write_function(made, time)
        file.write_function(flow, 0.2)
    with io.XDMFFile(world, f"{kind}_ascii{tag}.xdmf", "w", encoding=io.XDMFFile.Encoding.ASCII) as file:
        file.write_mesh(domain)
        file.write_function(linear)
    count = domain.topology.index_map(3).size_local
    tags = mesh.meshtags(domain, 3, numpy.arange(count, dtype=numpy.int32), numpy.arange(count, dtype=numpy.int32) % 3)
    tags.name = "materials"
    with io.XDMFFile(world, f"{kind}_tags{tag}.xdmf", "w") as file:
        file.write_mesh(domain)
        file.write_meshtags(tags)
    for family, degree in (("CG", 1), ("CG", 2), ("CG", 3), ("DG", 1), ("DG", 2)):
        made = function(domain, family, degree, "u")
        with io.VTKFile(world, f"{kind}_{family}{degree}{tag}.pvd", "w") as file:
            for time in (0.0, 0.5):
                made.interpolate(lambda x: wave(x) + time)
                try:
                    file.write_function(made, time)
                except RuntimeError as refused:
                    print(kind, family, degree, refused)
    with io.VTKFile(world, f"{kind}_several{tag}.pvd", "w") as file:
        file.write_function([linear, vector, of_cells], 0.0)
