# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: gmsh==4.15.2
# files: *.msh *.vtk *.mesh *.med *.cgns
"""Gmsh: a ball in a box with physical groups, by order and form; partitions; views of every kind."""
import functools
import itertools
import math
import subprocess
import sys

import gmsh

WITH_BINARY_FORM = (2.0, 2.2, 4.1)


def ball_in_box(order, recombined=False):
    gmsh.clear()
    gmsh.model.add("two words")
    box = gmsh.model.occ.addBox(-1, -1, -1, 2, 2, 2)
    if not recombined:
        ball = gmsh.model.occ.addSphere(0, 0, 0, 0.6)
        gmsh.model.occ.fragment([(3, box)], [(3, ball)])
    gmsh.model.occ.synchronize()
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    gmsh.model.addPhysicalGroup(3, volumes[:1], name="first part")
    if volumes[1:]:
        gmsh.model.addPhysicalGroup(3, volumes[1:], name="rest")
    gmsh.model.addPhysicalGroup(2, [gmsh.model.getEntities(2)[0][1]], name="a wall")
    if recombined:
        gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 2)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 1.2 if recombined else 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1.5 if recombined else 0.6)
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 0)
    gmsh.model.mesh.setOrder(order)


def write(name, version=None, binary=0, **options):
    gmsh.option.setNumber("Mesh.Binary", binary)
    if version:
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
    for key, value in options.items():
        gmsh.option.setNumber("Mesh." + key, value)
    gmsh.write(name)
    for key in options:
        gmsh.option.setNumber("Mesh." + key, 0)


def wave(x, y, z):
    return math.sin(3 * x) + math.cos(2 * y) * z


def add_view(name, kind, times=(0.0, 0.5), components=1, partial=1):
    tags, places, _ = gmsh.model.mesh.getNodes()
    at = dict(zip(tags, zip(places[::3], places[1::3], places[2::3])))
    view = gmsh.view.add(name)
    value = lambda place, time: [wave(*place) + time] if components == 1 else [wave(*place), *place][:components]
    for step, time in enumerate(times):
        if kind == "NodeData":
            gmsh.view.addModelData(view, step, gmsh.model.getCurrent(), kind, tags[::partial],
                                   [value(at[tag], time) for tag in tags[::partial]], time)
            continue
        cells = [(tag, nodes[i * count:(i + 1) * count]) for elements, nodes, count in solid_elements()
                 for i, tag in enumerate(elements)]
        data = []
        for _, nodes in cells:
            middle = [sum(at[node][axis] for node in nodes) / len(nodes) for axis in range(3)]
            data.append(value(middle, time) if kind == "ElementData" else
                        [number for node in nodes for number in value(at[node], time)])
        gmsh.view.addModelData(view, step, gmsh.model.getCurrent(), kind, [tag for tag, _ in cells], data, time)
    return view


def solid_elements():
    kinds, elements, nodes = gmsh.model.mesh.getElements(3)
    return [(tags, its_nodes, len(its_nodes) // len(tags)) for _, tags, its_nodes in zip(kinds, elements, nodes)]


def write_shape(shape, order):
    ball_in_box(order, shape == "hex")
    name = f"{shape}{order}"
    for version in (1, 2.0, 2.2, 4.0, 4.1):
        write(f"{name}.v{version}.msh", version)
        if version in WITH_BINARY_FORM:
            write(f"{name}.v{version}b.msh", version, 1)
    write(f"{name}.parametric.msh", 4.1, 0, SaveParametric=1)
    write(f"{name}.all.msh", 4.1, 0, SaveAll=1)
    for ending in ("vtk", "mesh", "med", "cgns"):
        if order < 3:
            gmsh.write(f"{name}.{ending}")
    if order < 3:  # Gmsh 4.15 dies on VTK files of hexahedra of order 3
        write(f"{name}.binary.vtk", None, 1)


def write_views():
    ball_in_box(1)
    for version, binary, appended in itertools.product((2.2, 4.1), (0, 1), (0, 1)):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.option.setNumber("PostProcessing.Binary", binary)
        gmsh.option.setNumber("PostProcessing.SaveMesh", appended)
        file = f"views.v{version}{'b' * binary}{'a' * appended}.msh"
        gmsh.write(file)
        for view in (add_view("node data", "NodeData"), add_view("vector", "NodeData", components=3),
                     add_view("in cells", "ElementData"), add_view("at corners", "ElementNodeData"),
                     add_view("partial", "NodeData", partial=3)):
            gmsh.view.write(view, file, append=True)
            gmsh.view.remove(view)


def write_partitions():
    ball_in_box(1)
    gmsh.model.mesh.partition(3)
    for version in (2.2, 4.0, 4.1):
        write(f"partitioned.v{version}.msh", version)
        if version in WITH_BINARY_FORM:
            write(f"partitioned.v{version}b.msh", version, 1)
    gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
    gmsh.option.setNumber("Mesh.PartitionSplitMeshFiles", 1)
    write("split.msh", 4.1)


CASES = {"views": write_views, "partitions": write_partitions,
         **{f"{shape}{order}": functools.partial(write_shape, shape, order)
            for shape in ("tet", "hex") for order in (1, 2, 3)}}
if len(sys.argv) == 1:
    for case in CASES:  # each by itself: Gmsh 4.15 dies on some sequences
        subprocess.run([sys.executable, "-B", __file__, case], check=False)
else:
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    CASES[sys.argv[1]]()
    gmsh.finalize()
