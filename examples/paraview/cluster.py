# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Isosurfaces of a grid that several ranks share, into one PVTP:

    mpirun -np 4 pvbatch cluster.py make grid.pvtu             a grid to try it with, in four pieces
    mpirun -np 4 pvbatch cluster.py contour grid.pvtu RTData 150 surface.pvtp
    pvbatch cluster.py contour grid.pvtu RTData 150 alone.pvtp on one rank
    pvbatch cluster.py compare surface.pvtp alone.pvtp         the same surface, bit for bit?

ISOTET_PLUGIN is the plugin, Isotet.so; leave it empty where ParaView loads it by itself. Files that are cut into pieces
already (.pvtu) are read in pieces; a single file is read by one rank and dealt out.
"""

import os
import sys

from paraview import simple


def load_plugin():
    if os.environ.get("ISOTET_PLUGIN"):
        simple.LoadPlugin(os.environ["ISOTET_PLUGIN"], remote=True, ns=vars(simple))


def make(grid):
    image = simple.Wavelet(WholeExtent=[-20, 20, -20, 20, -20, 20])
    tets = simple.Tetrahedralize(Input=image)
    simple.SaveData(grid, tets, DataMode="Binary")


def contour(grid, array, isovalue, surface):
    load_plugin()
    source = simple.OpenDataFile(grid)
    if not grid.endswith(".pvtu"):  # each cell to one rank, as is the default
        source = simple.RedistributeDataSet(Input=source)
    filter = simple.IsotetContour(Input=source, ContourBy=["POINTS", array], Isosurfaces=[float(isovalue)], ComputeNormals=0)
    pieces = simple.MergeBlocks(Input=filter, OutputDataSetType="Polygonal Mesh", MergePoints=0)
    simple.SaveData(surface, pieces, DataMode="Binary")
    print(surface, pieces.GetDataInformation().GetNumberOfCells(), "triangles")


def compare(*surfaces):
    vertices, triangles = [], []
    for name in surfaces:
        reader = simple.OpenDataFile(name)
        reader.UpdatePipeline()
        surface = reader.GetClientSideObject().GetOutputDataObject(0)
        vertices.append({surface.GetPoint(i) for i in range(surface.GetNumberOfPoints())})
        triangles.append(surface.GetNumberOfPolys())
    same = vertices[0] == vertices[1] and triangles[0] == triangles[1]
    print(f"{triangles[0]} triangles on {len(vertices[0])} vertices:", "the same surface" if same else "another surface")
    sys.exit(0 if same else 1)


{"make": make, "contour": contour, "compare": compare}[sys.argv[1]](*sys.argv[2:])
