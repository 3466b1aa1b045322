# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: python3-sfepy
# files: *_state.vtk *_state.vtu *_state.xdmf *.mesh
"""SfePy: heat in a block of hexahedra and of tetrahedra, and their meshes in the formats that it writes."""
import numpy
from sfepy.base.base import Struct
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.conditions import Conditions, EssentialBC
from sfepy.discrete.fem import FEDomain, Field
from sfepy.mesh.mesh_generators import gen_block_mesh
from sfepy.mesh.mesh_tools import triangulate
from sfepy.solvers.ls import ScipyDirect
from sfepy.solvers.nls import Newton
from sfepy.terms import Term


def solve(name, mesh):
    domain = FEDomain("domain", mesh)
    whole = domain.create_region("Omega", "all")
    ends = [domain.create_region(side, f"vertices in x {where}", "facet")
            for side, where in (("Left", "< 0.001"), ("Right", "> 0.999"))]
    field = Field.from_args("fu", numpy.float64, "scalar", whole, approx_order=1)
    u, v = FieldVariable("u", "unknown", field), FieldVariable("v", "test", field, primary_var_name="u")
    integral = Integral("i", order=2)
    flow = Term.new("dw_laplace(m.val, v, u)", integral, whole, m=Material("m", val=1.0), v=v, u=u)
    source = Term.new("dw_volume_lvf(f.val, v)", integral, whole, f=Material("f", val=[[10.0]]), v=v)
    problem = Problem("heat", equations=Equations([Equation("balance", flow - source)]))
    problem.set_bcs(ebcs=Conditions([EssentialBC(end.name, end, {"u.all": value})
                                     for end, value in zip(ends, (0.0, 1.0))]))
    problem.set_solver(Newton({}, lin_solver=ScipyDirect({})))
    out = problem.solve().create_output_dict()
    numbers = numpy.arange(mesh.n_el, dtype=float)
    out["number"] = Struct(name="number", mode="cell", data=numbers.reshape(-1, 1, 1, 1))
    for ending in ("vtk", "vtu", "xdmf"):
        mesh.write(f"{name}_state.{ending}", io="auto", out=out)


hexahedra = gen_block_mesh([1, 1, 1], [5, 5, 5], [0.5, 0.5, 0.5], name="block", verbose=False)
for kind, cells in (("hex", hexahedra), ("tet", triangulate(hexahedra))):
    solve(kind, cells)
    cells.write(f"{kind}.mesh", io="auto")
