# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What is raced: each method by a contestant, the command that runs it, and how often."""

from dataclasses import dataclass

SERIAL_LIMIT = 5_100_000  # tets; vtkContourGrid takes a second for each 3 to 6 million


@dataclass(frozen=True)
class Method:
    key: str
    label: str
    contestant: str
    command: tuple[str, ...]  # "{isovalue}" is replaced
    per_isovalue: bool = True  # else once a round, at the middle isovalue
    most_tets: int | None = None


METHODS = [
    Method("clusters", "isotet, packed before", "isotet", ("extract", "main", "{isovalue}")),
    Method("face_normals", "isotet, face normals", "isotet", ("extract", "main", "{isovalue}", "face_normals")),
    Method("gradient_normals", "isotet, gradient normals", "isotet", ("extract", "full", "{isovalue}", "gradient_normals")),
    Method("point_field", "isotet, one point field", "isotet", ("extract", "main", "{isovalue}", "point_field")),
    Method("source_cells", "isotet, source cells", "isotet", ("extract", "full", "{isovalue}", "source_cells")),
    Method("vtk_unmerged", "VTK linear grid, points not merged", "vtk", ("contour", "unmerged", "{isovalue}")),
    Method("vtk_merged", "VTK linear grid, merged", "vtk", ("contour", "merged", "{isovalue}")),
    Method("vtk_span_space", "VTK linear grid, merged, span space built before", "vtk", ("contour", "span_space", "{isovalue}")),
    Method("vtk_normals", "VTK linear grid, merged, normals", "vtk", ("contour", "merged_normals", "{isovalue}")),
    Method("vtk_attributes", "VTK linear grid, merged, attributes", "vtk", ("contour", "merged_attributes", "{isovalue}")),
    Method("vtk_contour_grid", "VTK contour grid (serial)", "vtk", ("contour", "contour_grid", "{isovalue}"),
           most_tets=SERIAL_LIMIT),
    Method("wheel_merged", "VTK wheel, merged", "wheel", ("contour", "merged", "{isovalue}")),
    Method("wheel_span_space", "VTK wheel, merged, span space built before", "wheel", ("contour", "span_space", "{isovalue}")),
    Method("pack", "isotet, pack", "isotet", ("pack", "main"), per_isovalue=False),
    Method("pack_full", "isotet, pack with gradients and source cells", "isotet",
           ("pack", "full", "gradients", "source_cells"), per_isovalue=False),
    Method("once", "isotet, pack and extract, nothing kept", "isotet", ("once", "{isovalue}"), per_isovalue=False),
    Method("new_field", "isotet, new field on a packed grid", "isotet", ("set_field", "main"), per_isovalue=False),
    Method("vtk_tree", "VTK span space and one surface", "vtk", ("tree", "{isovalue}"), per_isovalue=False),
    Method("wheel_tree", "VTK wheel, span space and one surface", "wheel", ("tree", "{isovalue}"), per_isovalue=False),
]

BY_KEY = {method.key: method for method in METHODS}

# The work is the same, a welded surface without normals: the faster of them is what isotet is measured against.
MERGED_RIVALS = ("vtk_merged", "wheel_merged")

# What goes before the first round: packed grids and trees that methods above rest on.
PREPARATIONS = ("pack", "pack_full", "vtk_tree", "wheel_tree")

# Peak memory is measured in processes of their own, of these methods; some need another one first.
MEASURED_FOR_MEMORY = {"pack": (), "once": (), "clusters": ("pack",), "vtk_merged": (), "vtk_tree": (), "wheel_merged": ()}


def command_of(method: Method, isovalue: float) -> list[str]:
    return [word.replace("{isovalue}", repr(isovalue)) for word in method.command]
