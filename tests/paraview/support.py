# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What the scripts for pvpython and pvbatch share. Environment: ISOTET_PLUGIN, the plugin; ISOTET_SCRATCH, a folder."""

import os
import sys

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "vtk"))
from grids import add, area_of, corners_of, grid_of, lattice, names, open_edges, points_of, triangles_of  # noqa: E402, F401

scratch = os.environ["ISOTET_SCRATCH"]
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()


def load(kind="plugin"):
    """The plugin in C++ ("plugin") or Python ("python"), loaded on all ranks without a word."""
    file = os.environ[{"plugin": "ISOTET_PLUGIN", "python": "ISOTET_PLUGIN_PYTHON"}[kind]]
    simple.LoadPlugin(file, remote=True, ns=vars(simple))


def fetch(proxy):
    """The output on this process, of all ranks where they are those of a server."""
    if servermanager.ActiveConnection.IsRemote():
        return servermanager.Fetch(proxy)
    proxy.UpdatePipeline()
    return proxy.GetClientSideObject().GetOutputDataObject(0)


def contour(source, value=0.3, by="r", **options):
    return simple.IsotetContour(Input=source, ContourBy=["POINTS", by], Isosurfaces=value if isinstance(value, list) else [value],
                                **options)  # fmt: skip


def made(grid, name="grid"):
    """A grid of a test as a source."""
    source = simple.TrivialProducer(registrationName=name)
    source.GetClientSideObject().SetOutput(grid)
    source.UpdatePipeline()
    return source


def pixels_of(picture):
    from vtkmodules.vtkIOImage import vtkPNGReader

    reader = vtkPNGReader()
    reader.SetFileName(picture)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)


def write(grid, name):
    """A file that ParaView 5.11.0 of Debian 12 reads: its libexpat does not let raw appended data pass."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(os.path.join(scratch, name))
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    assert writer.Write()
    return os.path.join(scratch, name)
