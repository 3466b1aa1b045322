# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What is raced: each method by a contestant, the command that runs it, and how often."""

from dataclasses import dataclass

SERIAL_LIMIT = 5_100_000  # cells; vtkContourGrid takes a second for each 3 to 6 million


@dataclass(frozen=True)
class Method:
    key: str
    contestant: str
    label: str
    command: tuple[str, ...]  # "{isovalue}" is replaced
    per_isovalue: bool = True  # else once a round, at the middle isovalue
    max_cells: int | None = None
    levels: tuple[str, ...] | None = None  # what isotet's processor must be able to do; None: anything


def _surface(key: str, contestant: str, label: str, *command: str, **limits) -> Method:
    return Method(key, contestant, label, command, **limits)


def _once_a_round(key: str, contestant: str, label: str, *command: str) -> Method:
    return Method(key, contestant, label, command, per_isovalue=False)


METHODS = [
    _surface("clusters", "isotet", "isotet, packed before", "extract", "main", "{isovalue}"),
    _surface("clusters_avx2", "isotet", "isotet, packed before, with AVX2 only",
             "extract", "main", "{isovalue}", "avx2", levels=("AVX-512",)),
    _surface("clusters_portable", "isotet", "isotet, packed before, portable code only",
             "extract", "main", "{isovalue}", "portable", levels=("AVX-512", "AVX2")),
    _surface("once", "isotet", "isotet, from arrays, nothing kept", "once", "{isovalue}"),
    _surface("face_normals", "isotet", "isotet, face normals", "extract", "main", "{isovalue}", "face_normals"),
    _surface("gradient_normals", "isotet", "isotet, gradient normals",
             "extract", "full", "{isovalue}", "gradient_normals"),
    _surface("point_field", "isotet", "isotet, one point field", "extract", "main", "{isovalue}", "point_field"),
    _surface("source_cells", "isotet", "isotet, source cells", "extract", "full", "{isovalue}", "source_cells"),
    _surface("vtk_unmerged", "vtk", "VTK linear grid, points not merged", "contour", "unmerged", "{isovalue}"),
    _surface("vtk_merged", "vtk", "VTK linear grid, merged", "contour", "merged", "{isovalue}"),
    _surface("vtk_span_space", "vtk", "VTK linear grid, merged, span space built before",
             "contour", "span_space", "{isovalue}"),
    _surface("vtk_normals", "vtk", "VTK linear grid, merged, normals", "contour", "merged_normals", "{isovalue}"),
    _surface("vtk_attributes", "vtk", "VTK linear grid, merged, one point field",
             "contour", "merged_attributes", "{isovalue}"),
    _surface("vtk_contour_grid", "vtk", "VTK contour grid (serial)", "contour", "contour_grid", "{isovalue}",
             max_cells=SERIAL_LIMIT),
    _surface("wheel_merged", "wheel", "VTK wheel, merged", "contour", "merged", "{isovalue}"),
    _surface("wheel_span_space", "wheel", "VTK wheel, merged, span space built before",
             "contour", "span_space", "{isovalue}"),
    _once_a_round("pack", "isotet", "isotet, pack", "pack", "main"),
    _once_a_round("pack_full", "isotet", "isotet, pack with gradients and source cells",
                  "pack", "full", "gradients", "source_cells"),
    _once_a_round("new_field", "isotet", "isotet, new field on a packed grid", "set_field", "main"),
    _once_a_round("vtk_tree", "vtk", "VTK span space and one surface", "tree", "{isovalue}"),
    _once_a_round("wheel_tree", "wheel", "VTK wheel, span space and one surface", "tree", "{isovalue}"),
]

BY_KEY = {method.key: method for method in METHODS}

# The work is the same, a welded surface without normals: the faster of them is what isotet is measured against.
MERGED_RIVALS = ("vtk_merged", "wheel_merged")

# What goes before the first round: packed grids and trees that methods above rest on.
PREPARATIONS = ("pack", "pack_full", "vtk_tree", "wheel_tree")

# Peak memory is measured in processes of their own, of these methods; some need another one first.
MEASURED_FOR_MEMORY = {"pack": (), "once": (), "clusters": ("pack",), "vtk_merged": (), "vtk_tree": (),
                       "wheel_merged": ()}


def command_of(method: Method, isovalue: float) -> list[str]:
    return [word.replace("{isovalue}", repr(isovalue)) for word in method.command]
