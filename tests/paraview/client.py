# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvpython, with the port of a pvserver: surfaces of its ranks, by the plugins that ISOTET_PLUGINS names, loaded on both sides."""

from pieces import VALUES, filter_of, read_pieces, whole_of
from support import *

simple.Connect("localhost", int(sys.argv[1]))
for kind in os.environ["ISOTET_PLUGINS"].split():
    filter = filter_of(kind, read_pieces())
    for value in VALUES:
        filter.Isosurfaces = [value]
        surface = servermanager.Fetch(filter)
        assert corners_of(surface) == whole_of(value), (kind, len(corners_of(surface)), len(whole_of(value)))
        assert open_edges(surface) == 0
print("ok", servermanager.ActiveConnection.GetNumberOfDataPartitions())
