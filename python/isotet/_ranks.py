# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What the ranks of a vtkMultiProcessController tell each other about one grid in pieces. Collective: every rank calls the same."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

_TEXT = 512  # bytes of an error that are sent


class Ranks:
    """The ranks of a controller; None: this process alone, which sends nothing."""

    def __init__(self, controller):
        self._controller = controller
        self.count = 1 if controller is None else controller.GetNumberOfProcesses()

    def gather(self, mine: bytes) -> list[bytes]:
        """The bytes of each rank, equally many from all."""
        if self.count < 2:
            return [mine]
        own, every = numpy_to_vtk(np.frombuffer(mine, np.uint8), deep=True), vtkUnsignedCharArray()
        every.SetNumberOfTuples(len(mine) * self.count)
        if not self._controller.AllGather(own, every):
            raise RuntimeError("ranks could not gather: the controller refused")
        joined = vtk_to_numpy(every).tobytes()
        return [joined[i * len(mine) : (i + 1) * len(mine)] for i in range(self.count)]

    def gather_objects(self, mine: Any) -> list[Any]:
        """What each rank gives."""
        packed = pickle.dumps(mine)
        width = max(int(length) for length in self.gather(b"%20d" % len(packed)))
        return [pickle.loads(sent) for sent in self.gather(packed.ljust(width, b"\0"))]

    def any(self, mine: list[bool]) -> list[bool]:
        """Which of the flags a rank has set."""
        return np.any([np.frombuffer(flags, bool) for flags in self.gather(np.array(mine, bool).tobytes())], axis=0).tolist()

    def agree(self, failure: BaseException | None) -> None:
        """Raises on every rank when one has failed: its own exception there, and on the others what the first of them says."""
        text = "" if failure is None else str(failure) or type(failure).__name__
        texts = [sent.rstrip(b"\0").decode(errors="ignore") for sent in self.gather(text.encode()[:_TEXT].ljust(_TEXT, b"\0"))]
        if self.count < 2:
            if failure is not None:
                raise failure
            return
        for rank, said in enumerate(texts):
            if said:
                raise ValueError(f"rank {rank}: {said}") from failure
