# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvbatch, on one process or several: the plugin in Python. ISOTET_PLUGIN_PYTHON is its file."""

from support import *

simple.LoadPlugin(os.environ["ISOTET_PLUGIN_PYTHON"], remote=True, ns=vars(simple))
reader = simple.XMLPartitionedUnstructuredGridReader(FileName=[os.path.join(scratch, "pieces.pvtu")])
filter = simple.IsotetContour(Input=reader, ContourBy=["POINTS", "r"], Isosurfaces=[0.3], ComputeNormals=0)
out = os.path.join(scratch, f"python-{ranks}.pvtp")
simple.servermanager.writers.XMLPPolyDataWriter(Input=filter, FileName=out, DataMode="Binary").UpdatePipeline()

from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader  # noqa: E402

whole = vtkXMLPPolyDataReader()
whole.SetFileName(out)
whole.Update()
surface = whole.GetOutput()
# The grid is closed around the surface, so that an open edge is a seam.
assert surface.GetNumberOfPolys() > 0 and open_edges(surface) == 0, open_edges(surface)
assert "r" in names(surface.GetPointData())

filter.UpdatePropertyInformation()
assert filter.GetProperty("LastUpdate")[0] == 3
filter.OutputPointsPrecision = "Double"
filter.NumberOfThreads = 1
filter.Isosurfaces = [0.31, 0.33]
filter.UpdatePipeline()
assert filter.GetDataInformation().GetNumberOfCells() > surface.GetNumberOfPolys()
print("ok", ranks)
