# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""``plotter.isotet`` of a pyvista.Plotter, found by an entry point. Apart from the accessors, which do not need PyVista's plotting."""

from __future__ import annotations

import numpy as np
import pyvista
from pyvista.plotting.utilities.algorithms import algorithm_to_mesh_handler

from ._vtk_data import MAGNITUDE
from .pyvista import MANY, find_scalars
from ._vtk_contour import IsotetContour


class PlotterComponent:
    """``plotter.isotet`` of a pyvista.Plotter."""

    def __init__(self, plotter: pyvista.Plotter):
        self._plotter = plotter

    def add_isovalue(self, mesh, scalars: str | None = None, compute_normals: bool = False, compute_gradients: bool = False,
                     compute_scalars: bool = True, preference: str = "point", title: str | None = None, pointa=(0.4, 0.9),
                     pointb=(0.9, 0.9), widget_color=None, *, value: float | None = None, rng=None, color_by: str | None = None,
                     **kwargs):  # fmt: skip
        """An isosurface and a slider for its isovalue, which it follows while the slider is dragged.

        As `pyvista.Plotter.add_mesh_isovalue`; the grid is packed before the plot opens.

        mesh
            A grid, or several in a pyvista.MultiBlock or a list, which are contoured as one; a pyvista.PolyData; or a vtkAlgorithm
            that gives one of them.
        scalars
            A name, also of a component ("v:x", "v:mag"); else the active scalars.
        value
            The isovalue at first; else the middle of the range.
        rng
            Both ends of the slider; else the range of the data.
        preference
            "cell": a cell array of that name is averaged to the points.
        color_by
            Point data that colours the surface, over its range in the grid; else the scalars do.
        compute_gradients
            Accepted, without effect.
        kwargs
            For `pyvista.Plotter.add_mesh`.

        Returns the actor of the surface, which is in ``plotter.widgets.isovalue_meshes``, too. Raises TypeError for points without
        cells, for cell data without ``preference="cell"`` and for arrays that are not there.
        """
        shown, algorithm = algorithm_to_mesh_handler(pyvista.MultiBlock(mesh) if isinstance(mesh, (list, tuple)) else mesh)
        if isinstance(shown, pyvista.PointSet):
            raise TypeError("PointSets are 0-dimensional and thus cannot produce contours.")
        if not isinstance(shown, (pyvista.DataSet, pyvista.MultiBlock)):
            raise TypeError(f"the mesh is a {type(mesh).__name__}, but must be a data set of PyVista's, several, or an algorithm")
        blocks = _leaves(shown)
        name, of_cells = find_scalars(_first_with(blocks, scalars, preference), scalars, preference)
        array, component = _component_of(name, blocks)
        ends = [_range_of(block, array, component, of_cells) for block in blocks if array in block.array_names]
        lower, upper = (min(end[0] for end in ends), max(end[1] for end in ends)) if rng is None else rng
        contour = IsotetContour(expected_surfaces=MANY, compute_normals=compute_normals, compute_scalars=compute_scalars,
                                array_component=component)  # fmt: skip
        contour._keeps_active = False  # what is contoured colours the surface
        if algorithm is None:
            contour.SetInputData(_as_cells(shown))
        else:
            contour.SetInputConnection(algorithm.GetOutputPort())
        contour.SetInputArrayToProcess(0, 0, 0, int(of_cells), array)
        contour.SetValue(0, (lower + upper) / 2 if value is None else value)
        contour.Update()
        surface = pyvista.wrap(contour.GetOutput())
        self._plotter.widgets.isovalue_meshes.append(surface)

        def moved(value: float) -> None:
            contour.SetValue(0, value)
            contour.Update()
            surface.shallow_copy(contour.GetOutput())

        self._plotter.add_slider_widget(moved, [lower, upper], value=contour.GetValue(0), title=title or name,
                                        pointa=pointa, pointb=pointb, color=widget_color, interaction_event="always")  # fmt: skip
        if color_by is None:
            kwargs.setdefault("clim", [lower, upper])
        else:
            kwargs.setdefault("clim", _first_with(blocks, color_by, "point").get_data_range(color_by, preference="point"))
            kwargs["scalars"] = color_by
        if isinstance(surface, pyvista.MultiBlock):
            return self._plotter.add_composite(surface, **kwargs)[0]
        return self._plotter.add_mesh(contour, **kwargs)


def _component_of(name: str, blocks: list[pyvista.DataSet]) -> tuple[str, int]:
    """The array and the component of a name as "v:x", "v:2" or "v:mag"; the first one without."""
    array, _, part = name.rpartition(":")
    if not array or any(name in block.array_names for block in blocks):
        return name, 0
    known = {"x": 0, "y": 1, "z": 2, "mag": MAGNITUDE}
    if part not in known and not part.isdigit():
        raise ValueError(f"the scalars are '{name}', but a component is x, y, z, mag or a number")
    return array, known[part] if part in known else int(part)


def _range_of(block: pyvista.DataSet, array: str, component: int, of_cells: bool) -> tuple[float, float]:
    values = np.asarray((block.cell_data if of_cells else block.point_data)[array], float)
    if values.ndim == 2:
        values = np.linalg.norm(values, axis=1) if component == MAGNITUDE else values[:, component]
    return float(np.nanmin(values)), float(np.nanmax(values))


def _leaves(mesh) -> list[pyvista.DataSet]:
    if not isinstance(mesh, pyvista.MultiBlock):
        return [mesh]
    return [leaf for block in mesh if block is not None for leaf in _leaves(block)]


def _first_with(blocks: list[pyvista.DataSet], scalars, preference: str) -> pyvista.DataSet:
    """The first block with the array; the first one where none has it, or the active scalars are meant."""
    return next((block for block in blocks if isinstance(scalars, str) and scalars in block.array_names), blocks[0])


def _as_cells(mesh):
    """Structured grids as hexahedra, once."""
    if isinstance(mesh, pyvista.MultiBlock):
        return pyvista.MultiBlock({key: block if block is None else _as_cells(block) for key, block in zip(mesh.keys(), mesh, strict=True)})
    keeps = isinstance(mesh, (pyvista.UnstructuredGrid, pyvista.PolyData))
    return mesh if keeps else mesh.cast_to_unstructured_grid()


pyvista.register_plotter_component("isotet")(PlotterComponent)
