# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The methods and properties of vtkContourFilter, without what it computes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

from ._arrays import isovalues_in
from ._vtk_session import levels

_POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
# Properties, in VTK's two spellings. Those of the second row are kept, and have no effect.
_SETTINGS = {
    "ComputeNormals": -1, "ComputeScalars": 1, "GenerateTriangles": 1, "ArrayComponent": 0, "OutputPointsPrecision": 2,
    "ComputeGradients": 0, "UseScalarTree": 0, "ScalarTree": None, "Locator": None, "FastMode": False,
}  # fmt: skip
_SWITCHES = ("ComputeNormals", "ComputeScalars", "GenerateTriangles", "ComputeGradients", "UseScalarTree", "FastMode")
_OWN = ("NumberOfContours", "ContourValues", "ExpectedSurfaces", "NumberOfThreads", "Precision", "Tolerance", "Controller")


def _snake(name: str) -> str:
    return "".join("_" + letter.lower() if letter.isupper() else letter for letter in name).lstrip("_")


def _like_vtk(cls: type) -> type:
    """Adds Set, Get, On, Off and the property of each setting."""

    def add(name: str, method: Callable[..., Any]) -> None:
        method.__name__, method.__qualname__ = name, f"{cls.__name__}.{name}"
        setattr(cls, name, method)

    for name in _SETTINGS:
        kind = type(_SETTINGS[name])
        add("Set" + name, lambda self, value, name=name, kind=kind: self._set(name, value if kind is type(None) else kind(value)))
        add("Get" + name, lambda self, name=name: self._settings[name])
    for name in _SWITCHES:
        add(name + "On", lambda self, name=name: getattr(self, "Set" + name)(1))
        add(name + "Off", lambda self, name=name: getattr(self, "Set" + name)(0))
    for name in (*_SETTINGS, *_OWN):
        setattr(cls, _snake(name), _property("Get" + name, "Set" + name))
    return cls


def _property(getter: str, setter: str) -> property:
    return property(lambda self: getattr(self, getter)(), lambda self, value: getattr(self, setter)(value), doc=f"{getter}(), {setter}().")


@_like_vtk
class ContourProperties(VTKPythonAlgorithmBase):
    """A vtkAlgorithm with the properties of vtkContourFilter."""

    def __init__(self, **properties):
        super().__init__(nInputPorts=1, inputType="vtkDataSet", nOutputPorts=1, outputType="vtkPolyData")
        self._settings: dict[str, Any] = dict(_SETTINGS, Values=[0.0])
        self.SetInputArrayToProcess(0, 0, 0, _POINTS, 0)
        for name, value in properties.items():
            if not name.islower() or not hasattr(type(self), name):
                raise TypeError(f"Unexpected keyword argument '{name}' for '{type(self).__name__}' constructor")
            setattr(self, name, value)

    def _set(self, name: str, value: Any) -> None:
        if self._settings[name] != value:
            self._settings[name] = value
            self.Modified()

    @property
    def _values(self) -> list[float]:
        return self._settings["Values"]

    def SetValue(self, i: int, value: float) -> None:
        """The isovalue `i`, from 0; there are then at least so many."""
        i = max(i, 0)
        values = self._values + [0.0] * (i + 1 - len(self._values))
        values[i] = float(value)
        self._set("Values", values)

    def GetValue(self, i: int) -> float:
        """The isovalue `i`; beyond the end the last one, 0 where there is none."""
        return self._values[min(max(i, 0), len(self._values) - 1)] if self._values else 0.0

    def GetValues(self, values: list[float] | None = None) -> list[float]:
        """All isovalues; also written into `values`."""
        if values is not None:
            values[: len(self._values)] = self._values
        return list(self._values)

    def SetContourValues(self, values: Sequence[float]) -> None:
        """All isovalues at once."""
        self._set("Values", isovalues_in(values))

    def GetContourValues(self) -> tuple[float, ...]:
        return tuple(self._values)

    def SetNumberOfContours(self, count: int) -> None:
        """So many isovalues: the first ones stay, others are 0."""
        self._set("Values", (self._values + [0.0] * count)[: max(count, 0)])

    def GetNumberOfContours(self) -> int:
        return len(self._values)

    def GenerateValues(self, count: int, *lower_upper) -> None:
        """`count` values from the first to the last, both included."""
        lower, upper = lower_upper[0] if len(lower_upper) == 1 else lower_upper
        self._set("Values", levels(lower, upper, count))

    def SetInputArray(self, name: str) -> None:
        """The point array to contour."""
        self.SetInputArrayToProcess(0, 0, 0, _POINTS, name)

    def SetInputData(self, *port_and_data) -> None:
        """The data set to contour; a port may stand before it."""
        *port, data = port_and_data
        self.SetInputDataObject(*(port or [0]), data)

    def AddInputData(self, *port_and_data) -> None:
        """As SetInputData() where there is no input."""
        *port, data = port_and_data
        self.AddInputDataObject(*(port or [0]), data)

    def GetInput(self, port: int = 0):
        """The data set that is contoured, or None."""
        return self.GetInputDataObject(port, 0) if self.GetNumberOfInputConnections(port) else None

    def GetPolyDataInput(self, port: int):
        """The input where it is vtkPolyData, else None."""
        return vtkPolyData.SafeDownCast(self.GetInput(port))

    def GetOutput(self, port: int = 0):
        """The surface of the last execution: a vtkPolyData, or composite data."""
        return self.GetOutputDataObject(port)

    def SetOutput(self, data) -> None:
        self.GetExecutive().SetOutputData(0, data)

    def CreateDefaultLocator(self) -> None:
        """Without effect: vertices are known by the edges they lie on."""

    input = property(GetInput, doc="GetInput().")
    output = property(GetOutput, doc="GetOutput().")
    input_data = property(None, SetInputData, doc="SetInputData().")
    input_array = property(None, SetInputArray, doc="SetInputArray().")
    values = property(GetValues, SetContourValues, doc="GetValues(), SetContourValues().")
