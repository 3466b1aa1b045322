# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Packed files in VTK's pipelines, from Python."""

from __future__ import annotations

import bisect
import os
import weakref
from typing import Any

from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkDataArraySelection
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm, vtkStreamingDemandDrivenPipeline

from . import _isotet
from ._call import call_options
from ._grid import Grid
from ._vtk_contour import tell_error
from ._vtk_data import fill_unstructured


class IsotetReader(VTKPythonAlgorithmBase):
    """A vtkAlgorithm that reads packed files (.isotet): points and fields by the numbers of the grid that was packed, cells in the
    order of the file, which keeps no cell fields for them.

    Steps are VTK's time steps: 0, 1, 2, ... where the file has no times. In parallel the first piece has all.

    >>> import isotet, isotet.vtk, os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "grid.isotet")
    >>> isotet.pack(isotet.make("kuhn", 8, ["sphere"])).save(path)
    >>> reader = isotet.vtk.IsotetReader(file_name=path)
    >>> done = reader.Update()
    >>> reader.GetOutput().GetNumberOfCells(), reader.GetOutput().GetPointData().GetArrayName(0)
    (3072, 'sphere')
    """

    def __init__(self, *, file_name: str | os.PathLike[str] | None = None) -> None:
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkUnstructuredGrid")
        self._name: str | None = None
        self._threads = 0
        self._opened: tuple[Any, ...] = ()
        self._file: _isotet.PackedFile | None = None
        self._times: list[float] = []
        self._cells: vtkUnstructuredGrid | None = None  # with points, without arrays: of steps from `_moved` on
        self._moved = 0
        self._arrays = vtkDataArraySelection()
        mine = weakref.ref(self)
        self._arrays.AddObserver("ModifiedEvent", lambda *_: mine() and mine().Modified())
        self.SetFileName(file_name)

    def SetFileName(self, name: str | os.PathLike[str] | None) -> None:
        """The file."""
        name = None if name is None else os.fspath(name)
        if name != self._name:
            self._name = name
            self.Modified()

    def GetFileName(self) -> str | None:
        return self._name

    file_name = property(GetFileName, SetFileName, doc="GetFileName(), SetFileName().")

    def SetNumberOfThreads(self, count: int) -> None:
        """At most so many; 0, the default: all that the process may use."""
        self._threads = int(count)

    def GetNumberOfThreads(self) -> int:
        return self._threads

    def GetPointDataArraySelection(self) -> vtkDataArraySelection:
        """Which fields are read; all by default. Known after UpdateInformation()."""
        return self._arrays

    def GetOutput(self) -> vtkUnstructuredGrid:
        return self.GetOutputDataObject(0)

    def _open(self) -> None:
        if not self._name:
            raise ValueError("no FileName was given")
        told = os.stat(self._name) if os.path.exists(self._name) else None
        stamp = (self._name, told and (told.st_mtime_ns, told.st_size))
        if self._file is not None and stamp == self._opened:
            return
        self._file, self._cells = None, None
        file = _isotet.PackedFile.open(self._name, 0, call_options(self._threads, None))
        info = file.info()
        before = {self._arrays.GetArrayName(i): self._arrays.GetArraySetting(i) for i in range(self._arrays.GetNumberOfArrays())}
        names = list(dict.fromkeys(field["name"] for field in info["fields"]))
        if list(before) != names:
            self._arrays.RemoveAllArrays()
            for name in names:
                self._arrays.AddArray(name, bool(before.get(name, True)))
        self._file, self._opened = file, stamp
        self._times = info["times"] or [float(step) for step in range(info["steps"])]

    def _tell(self, error: Exception) -> int:
        tell_error(self, "IsotetReader", error)
        return 0

    def RequestInformation(self, request, inputs, outputs) -> int:
        info, pipeline = outputs.GetInformationObject(0), vtkStreamingDemandDrivenPipeline
        info.Set(vtkAlgorithm.CAN_HANDLE_PIECE_REQUEST(), 1)
        try:
            self._open()
        except Exception as error:  # noqa: BLE001 - VTK would say that a method failed, and not why
            return self._tell(error)
        info.Remove(pipeline.TIME_STEPS())
        info.Remove(pipeline.TIME_RANGE())
        if len(self._times) > 1 or self._file.info()["times"]:
            for time in self._times:
                info.Append(pipeline.TIME_STEPS(), time)
            for time in (self._times[0], self._times[-1]):
                info.Append(pipeline.TIME_RANGE(), time)
        return 1

    def _read(self, step: int, out) -> None:
        call = call_options(self._threads, lambda _, fraction: self.UpdateProgress(fraction))
        info = self._file.info()
        fields = [field for field in info["fields"] if field["step"] == step]
        moved = max((points["step"] for points in info["moved_points"] if points["step"] <= step), default=0)
        if self._cells is None or moved != self._moved:
            packed, self._moved = self._file.grid(fields[0]["name"], step, 0, call), moved
            grid = Grid._of(packed.unpack(call))
            self._cells = fill_unstructured(vtkUnstructuredGrid(), grid)
            for name in grid.fields:
                self._cells.GetPointData().RemoveArray(name)
        out.ShallowCopy(self._cells)
        for field in fields:
            name = field["name"]
            if not self._arrays.ArrayIsEnabled(name):
                continue
            array = numpy_to_vtk(self._file.grid(name, step, 0, call).unpack_field(call), deep=True)
            array.SetName(name)
            out.GetPointData().AddArray(array)
            if out.GetPointData().GetScalars() is None:
                out.GetPointData().SetActiveScalars(name)

    def RequestData(self, request, inputs, outputs) -> int:
        info, pipeline = outputs.GetInformationObject(0), vtkStreamingDemandDrivenPipeline
        out = vtkUnstructuredGrid.GetData(outputs, 0)
        if self._file is None:
            return 0  # which was told
        time = info.Get(pipeline.UPDATE_TIME_STEP()) if info.Has(pipeline.UPDATE_TIME_STEP()) else self._times[0]
        step = max(bisect.bisect_right(self._times, time) - 1, 0)
        if (info.Get(pipeline.UPDATE_PIECE_NUMBER()) or 0) > 0:
            return 1
        try:
            self._read(step, out)
        except Exception as error:  # noqa: BLE001
            out.Initialize()
            return self._tell(error)
        if info.Has(pipeline.TIME_STEPS()):
            out.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), self._times[step])
        return 1
