# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""How a call runs: on how many threads, and whom it tells of its progress."""

from __future__ import annotations

from collections.abc import Callable

from . import _isotet
from ._arrays import number_in

Progress = Callable[[str, float], object]


def call_options(threads: int, progress: Progress | None) -> _isotet.CallOptions:
    count = number_in("threads", threads)
    if not 0 <= count < 2**31:
        raise ValueError(f"threads is {threads}, but must be 0, for all, or a number of threads")
    return _isotet.CallOptions(count, progress)
