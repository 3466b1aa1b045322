# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: kratosmultiphysics==10.4.4
# files: out/*.vtk
"""Kratos: model parts of tetrahedra, hexahedra and prisms with nodal and elemental values, by its VTK output."""
import itertools
import math

import KratosMultiphysics as Kratos

SPLITS = {"Element3D8N": [range(8)], "Element3D6N": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
          "Element3D4N": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]}


def model_part(model, name, element):
    part = model.CreateModelPart(name)
    part.AddNodalSolutionStepVariable(Kratos.TEMPERATURE)
    part.AddNodalSolutionStepVariable(Kratos.VELOCITY)
    part.ProcessInfo[Kratos.DOMAIN_SIZE] = 3
    side = 5
    at = lambda i, j, k: 1 + i + side * (j + side * k)
    for k, j, i in itertools.product(range(side), repeat=3):
        part.CreateNewNode(at(i, j, k), i / 4, j / 4, k / 4)
    properties = part.CreateNewProperties(1)
    half, numbers = part.CreateSubModelPart("half"), []
    for k, j, i in itertools.product(range(side - 1), repeat=3):
        corners = [at(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        for split in SPLITS[element]:
            number = part.NumberOfElements() + 1
            part.CreateNewElement(element, number, [corners[c] for c in split], properties)
            if k < 2:
                numbers.append(number)
    half.AddElements(numbers)
    half.AddNodes([at(i, j, k) for k in range(3) for j in range(side) for i in range(side)])
    return part


def set_values(part, time):
    part.ProcessInfo[Kratos.TIME] = time
    part.ProcessInfo[Kratos.STEP] += 1
    for node in part.Nodes:
        node.SetSolutionStepValue(Kratos.TEMPERATURE, math.sin(3 * node.X) + math.cos(2 * node.Y) * node.Z + time)
        node.SetSolutionStepValue(Kratos.VELOCITY, [node.X, node.Y * node.Z, 1])
    for element in part.Elements:
        element.SetValue(Kratos.PRESSURE, element.Id)


model = Kratos.Model()
for name, element in (("tet", "Element3D4N"), ("hex", "Element3D8N"), ("prism", "Element3D6N")):
    part = model_part(model, name, element)
    for form in ("ascii", "binary"):
        set_values(part, 0.5)
        Kratos.VtkOutput(part, Kratos.Parameters(f"""{{"model_part_name": "{name}", "file_format": "{form}",
            "output_precision": 12, "output_path": "out", "custom_name_prefix": "{form}_",
            "output_sub_model_parts": true,
            "nodal_solution_step_data_variables": ["TEMPERATURE", "VELOCITY"],
            "element_data_value_variables": ["PRESSURE"]}}""")).PrintOutput()
