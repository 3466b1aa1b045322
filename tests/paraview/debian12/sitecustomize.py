# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""ParaView 5.11.0 of Debian 12 imports inspect.getargspec for plugins in Python; Python 3.11 no longer has it."""

import collections
import inspect

if not hasattr(inspect, "getargspec"):
    _ArgSpec = collections.namedtuple("ArgSpec", "args varargs keywords defaults")
    inspect.getargspec = lambda function: _ArgSpec(*inspect.getfullargspec(function)[:4])
