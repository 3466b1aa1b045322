# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Isotet Contour against ParaView's Contour, in ParaView: a moving isovalue.

    ISOTET_PLUGIN=.../Isotet.so pvbatch bench/vtk/in_paraview.py [MILLION_TETS] [REPEATS]
    ISOTET_PLUGIN=.../Isotet.so mpirun -np 2 --bind-to core pvbatch bench/vtk/in_paraview.py
"""

import os
import sys
import time

import numpy as np
from paraview import simple

simple.LoadPlugin(os.environ["ISOTET_PLUGIN"], remote=True, ns=vars(simple))
million_tets = float(sys.argv[1]) if len(sys.argv) > 1 else 2.0
repeats = int(sys.argv[2]) if len(sys.argv) > 2 else 7
half = round((million_tets * 1e6 / 5) ** (1 / 3) / 2)  # 5 tets a voxel
image = simple.Wavelet(WholeExtent=[-half, half] * 3, Maximum=255)
grid = simple.Tetrahedralize(Input=image)
grid.UpdatePipeline()
print(f"{grid.GetDataInformation().GetNumberOfCells() / 1e6:.2f} million tets")
for name, options in (("Contour", {}), ("IsotetContour", {"ExpectedSurfaces": 1000})):
    filter = getattr(simple, name)(Input=grid, ContourBy=["POINTS", "RTData"], Isosurfaces=[100.0], ComputeNormals=0, **options)
    filter.UpdatePipeline()
    times = []
    for value in np.linspace(130, 180, repeats):
        filter.Isosurfaces = [value]
        start = time.perf_counter()
        filter.UpdatePipeline()
        times.append(1e3 * (time.perf_counter() - start))
    triangles = filter.GetDataInformation().GetNumberOfCells()
    print(f"{name:14s} {np.median(times):8.1f} ms ({min(times):.1f} to {max(times):.1f}), {triangles} triangles in the last", flush=True)
