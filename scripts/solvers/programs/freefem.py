# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: freefem++ libfreefem++
# files: *.mesh *.meshb *.vtu *.vtk
"""FreeFem++: Poisson on a cube, as Medit meshes with solutions of order 0 and 1, and VTK in its forms."""
import os
import pathlib
import subprocess

SCRIPT = """
load "msh3" load "medit" load "iovtk"
int[int] labels = [1, 2, 3, 4, 5, 6];
mesh3 Th = cube(5, 5, 4, [x, y, 1.5 * z + 0.1 * x * y]);
fespace V(Th, P1); fespace W(Th, P0);
V u, v, ux = x - y, uy = sin(3 * x), uz = z;
solve poisson(u, v) = int3d(Th)(dx(u) * dx(v) + dy(u) * dy(v) + dz(u) * dz(v)) - int3d(Th)(10 * (1 + x) * v)
    + on(1, 2, 3, u = 0);
W k = x + y * z, kx = x, ky = y, kz = z;
savemesh(Th, "order1.mesh"); savesol("order1.sol", Th, u, [ux, uy, uz], order = 1);
savemesh(Th, "order0.mesh"); savesol("order0.sol", Th, k, [kx, ky, kz], order = 0);
savemesh(Th, "binary1.meshb"); savesol("binary1.solb", Th, u, [ux, uy, uz], order = 1);
savemesh(Th, "binary0.meshb"); savesol("binary0.solb", Th, k, order = 0);
savemesh(Th, "tensor.mesh"); savesol("tensor.sol", Th, [ux, uy, uz, ux, uy, uz], order = 1);
int[int] both = [1, 0], points = [1];
savevtk("file.vtu", Th, u, k, dataname = "u k");
savevtk("text.vtu", Th, u, [ux, uy, uz], k, dataname = "u velocity k", bin = false);
savevtk("single.vtu", Th, u, dataname = "u", floatmesh = true, floatsol = true);
savevtk("points.vtu", Th, u, [ux, uy, uz], dataname = "u velocity", order = both);
savevtk("file.vtk", Th, u, k, dataname = "u k");
savevtk("text.vtk", Th, u, [ux, uy, uz], k, dataname = "u velocity k", bin = false);
"""
pathlib.Path("case.edp").write_text(SCRIPT)
plugins = {**os.environ, "FF_LOADPATH": "/usr/lib/freefem++/"}  # Debian's build looks for them elsewhere
subprocess.run(["FreeFem++", "-nw", "-ne", "case.edp"], env=plugins, check=True)
