# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: ngsolve==6.2.2608
# files: *.vtu *.pvd *.vtk
# isotet: --merge-points 1e-9
"""NGSolve: Poisson on curved tetrahedra, hexahedra and prisms, by VTKOutput; each cell has points of its own."""
from netgen.csg import CSGeometry, OrthoBrick, Pnt, Sphere
from ngsolve import H1, BilinearForm, GridFunction, LinearForm, Mesh, VTKOutput, dx, grad, x, y, z
from ngsolve.meshes import MakeHexMesh, MakeStructured3DMesh


def solved(mesh, order):
    space = H1(mesh, order=order, dirichlet=".*")
    u, v = space.TnT()
    a, f = BilinearForm(grad(u) * grad(v) * dx).Assemble(), LinearForm(10 * (1 + x) * v * dx).Assemble()
    solution = GridFunction(space)
    solution.vec.data = a.mat.Inverse(space.FreeDofs()) * f.vec
    return solution


def write(name, mesh, u, **options):
    return VTKOutput(mesh, coefs=[u, grad(u), x * y + z], names=["u", "grad u", "xy+z"], filename=name, **options)


geometry = CSGeometry()
geometry.Add(OrthoBrick(Pnt(-1, -1, -1), Pnt(1, 1, 1)) - Sphere(Pnt(0, 0, 0), 0.5))
curved = Mesh(geometry.GenerateMesh(maxh=0.7)).Curve(3)
meshes = {"tet": curved, "hex": MakeHexMesh(nx=4, secondorder=False),
          "prism": MakeStructured3DMesh(hexes=False, nx=3, prism=True)}
for name, mesh in meshes.items():
    u = solved(mesh, 3)
    for subdivision in (0, 1, 2):
        write(f"{name}_sub{subdivision}", mesh, u, subdivision=subdivision).Do()
    write(f"{name}_single", mesh, u, floatsize="single").Do()
    write(f"{name}_legacy", mesh, u, legacy=True).Do()
    try:
        write(f"{name}_order2", mesh, u, order=2).Do()
    except Exception as problem:
        print(name, problem)
    series = write(f"{name}_series", mesh, u)
    for time in (0, 0.5, 1):
        u.vec.data = (1 + time) * u.vec
        series.Do(time=time)
