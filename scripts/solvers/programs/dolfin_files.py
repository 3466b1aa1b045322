# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: python3-dolfin python3-h5py openmpi-bin
# files: *.xdmf *.pvd
# isotet: --merge-points 1e-9
"""FEniCS (legacy): functions of several elements on tetrahedra, over time, in XDMF (write, checkpoints) and VTK."""
import subprocess
import sys

if len(sys.argv) == 1:
    for processes in (1, 2):
        subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(processes), sys.executable, "-B",
                        __file__, str(processes)], check=True)
    sys.exit()

from dolfin import (Expression, File, Function, FunctionSpace, MeshFunction, MPI, UnitCubeMesh, VectorFunctionSpace,
                    XDMFFile)

tag = f"_np{sys.argv[1]}"
mesh = UnitCubeMesh(4, 4, 4)
wave = lambda time: Expression("sin(3*x[0]) + cos(2*x[1])*x[2] + t", t=time, degree=2)
spaces = {"P1": ("CG", 1), "P2": ("CG", 2), "DG0": ("DG", 0), "DG1": ("DG", 1), "P3": ("CG", 3)}
for name, (family, degree) in spaces.items():
    u = Function(FunctionSpace(mesh, family, degree), name="u")
    vector = Function(VectorFunctionSpace(mesh, family, degree), name="v")
    vector.interpolate(Expression(("x[0]", "x[1]*x[0]", "1"), degree=2))
    with XDMFFile(mesh.mpi_comm(), f"{name}{tag}.xdmf") as file, \
            XDMFFile(mesh.mpi_comm(), f"{name}_checkpoint{tag}.xdmf") as checkpoint:
        file.parameters["flush_output"] = True
        file.parameters["functions_share_mesh"] = True
        for step in range(3):
            u.interpolate(wave(0.1 * step))
            file.write(u, 0.1 * step)
            file.write(vector, 0.1 * step)
            checkpoint.write_checkpoint(u, "u", 0.1 * step, XDMFFile.Encoding.HDF5, step > 0)
            checkpoint.write_checkpoint(vector, "v", 0.1 * step, XDMFFile.Encoding.HDF5, True)
    series = File(f"{name}{tag}.pvd")
    for step in range(2):
        u.interpolate(wave(0.5 * step))
        series << (u, 0.5 * step)
regions = MeshFunction("size_t", mesh, 3, 7)
regions.rename("regions", "")
for i in range(0, mesh.num_cells(), 3):
    regions[i] = 2
with XDMFFile(mesh.mpi_comm(), f"regions{tag}.xdmf") as file:
    file.write(regions)
with XDMFFile(mesh.mpi_comm(), f"mesh{tag}.xdmf") as file:
    file.write(mesh)
File(f"regions{tag}.pvd") << regions
