# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Cuts along implicit functions of VTK, from Python."""

from __future__ import annotations

import math
import weakref
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject, vtkPointSet

from . import _isotet
from ._call import call_options
from ._vtk_contour import Block, IsotetContour
from ._vtk_data import Scalars, points_of, unstructured_of

_ARRAY = "isotet cut"


class _Cut(NamedTuple):
    """How a function is evaluated: of a plane the products of its unit normal and the points, which are the same wherever it moves
    along its normal; of a sphere or cylinder distances from its middle; of others its values."""

    normal: tuple[float, ...] | None = None
    radius: float | None = None
    isovalue: float = 0.0  # where the function is 0
    time: int = 0

    @classmethod
    def of(cls, function) -> _Cut:
        if function.IsA("vtkPlane") and function.GetTransform() is None:
            normal = function.GetNormal()
            length = math.hypot(*normal)
            if length == 0:
                raise ValueError(f"the plane's normal is {normal}, but must have a length")
            # Subclasses shift planes: their origin alone does not tell where they are.
            return cls(tuple(x / length for x in normal), None, -function.FunctionValue((0.0, 0.0, 0.0)) / length)
        if function.IsA("vtkSphere") or function.IsA("vtkCylinder"):
            radius = abs(function.GetRadius())
            return cls(None, radius, radius, function.GetMTime())
        return cls(time=function.GetMTime())

    def values(self, points: np.ndarray, function, threads: int) -> np.ndarray:
        if self.normal is not None:
            return _isotet.plane_field(points, (0.0, 0.0, 0.0), self.normal, 0.0, call_options(threads, None)).values
        out = vtkDoubleArray()
        function.FunctionValue(numpy_to_vtk(points.astype(np.float64), deep=True), out)
        values = vtk_to_numpy(out)
        return values.copy() if self.radius is None else np.sqrt(np.maximum(values + self.radius**2, 0.0))


class IsotetSlice(IsotetContour):
    """A vtkAlgorithm that cuts along a vtkImplicitFunction, its CutFunction: isosurfaces of a field of the points.

    The values, SetValue() and so on, are distances from the function: along the normal of a plane, outwards from a sphere or
    cylinder; of other functions they are its values. A plane that moves along its normal costs the time of its cut. All point
    and cell arrays are carried; there are no normals.

    >>> import pyvista, isotet.vtk
    >>> from vtkmodules.vtkCommonDataModel import vtkPlane
    >>> grid = pyvista.ImageData(dimensions=(9, 9, 9)).cast_to_unstructured_grid()
    >>> plane = vtkPlane()
    >>> plane.SetOrigin(0, 0, 2.5)
    >>> cut = isotet.vtk.IsotetSlice(cut_function=plane, input_data=grid)
    >>> done = cut.Update()
    >>> pyvista.wrap(cut.GetOutput()).area
    64.0
    """

    _name = "IsotetSlice"

    def __init__(self, **properties: Any) -> None:
        self._function = None
        self._observed = 0
        self._cut = _Cut()
        self._cuts: dict[int, tuple[tuple, Scalars]] = {}  # of the blocks of the last execution
        super().__init__(**properties)
        self.SetComputeNormals(0)
        self.SetComputeScalars(0)

    def SetCutFunction(self, function) -> None:
        """Along what is cut."""
        if function is self._function:
            return
        if self._function is not None:
            self._function.RemoveObserver(self._observed)
        self._function = function
        if function is not None:
            mine = weakref.ref(self)
            self._observed = function.AddObserver("ModifiedEvent", lambda *_: mine() and mine().Modified())
        self.Modified()

    def GetCutFunction(self):
        return self._function

    cut_function = property(GetCutFunction, SetCutFunction, doc="GetCutFunction(), SetCutFunction().")

    def _isovalues(self) -> list[float]:
        return [value + self._cut.isovalue for value in self.GetValues()]

    def _scalars_of(self, data, number: int) -> tuple[Scalars | None, bool]:
        if self._function is None:
            raise ValueError("there is no CutFunction to cut along")
        self._cut = cut = _Cut.of(self._function)
        points = data.GetPoints().GetData() if isinstance(data, vtkPointSet) else data
        key = (points.GetMTime(), cut.normal, cut.radius, cut.time)
        before = self._cuts.get(number)
        if before is None or before[0] != key:
            values = cut.values(points_of(unstructured_of(data)), self._function, self._threads)
            before = key, Scalars(_ARRAY, numpy_to_vtk(values), values)
            self._cuts[number] = before
        return before[1], False

    def _how(self, block: Block, numbered: bool) -> dict[str, Any]:
        return {**super()._how(block, numbered), "refine_for_fields": True}

    def RequestData(self, request, inputs, outputs) -> int:
        done = super().RequestData(request, inputs, outputs)
        if set(self._cuts) - set(self._sessions) and self._sessions:
            self._cuts = {number: cut for number, cut in self._cuts.items() if number in self._sessions}
        _forget_cut(vtkDataObject.GetData(outputs, 0))
        return done


def _forget_cut(out) -> None:
    """VTK carries the field where it cuts."""
    if not isinstance(out, vtkCompositeDataSet):
        out.GetPointData().RemoveArray(_ARRAY)
        return
    at = out.NewIterator()
    at.InitTraversal()
    while not at.IsDoneWithTraversal():
        _forget_cut(at.GetCurrentDataObject())
        at.GoToNextItem()
