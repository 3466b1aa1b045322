# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""ParaView's picture of a file with its defaults: Contour of the field, outline, scale. FILE FIELD TIME PICTURE; - is no field, no time"""

import sys

from paraview.simple import (
    Calculator, CellDatatoPointData, ColorBy, Contour, GetActiveViewOrCreate, OpenDataFile, Outline, Render, ResetCamera,
    SaveScreenshot, Show, UpdatePipeline)

file, field, time, picture = sys.argv[1:]
source = OpenDataFile(file)
if time != "-":
    UpdatePipeline(float(time), source)
else:
    UpdatePipeline(proxy=source)
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [800, 600]
Show(Outline(source), view)

base, _, part = field.partition(":")
if base in source.CellData.keys() and base not in source.PointData.keys():
    source = CellDatatoPointData(source)
    UpdatePipeline(proxy=source)
if base in source.PointData.keys():
    if part:
        source = Calculator(source, Function=f"mag({base})" if part == "mag" else base, ResultArrayName=base + "_" + part)
        UpdatePipeline(proxy=source)
        base = base + "_" + part
    low, high = source.PointData[base].GetRange(0)
    contour = Contour(source, ContourBy=["POINTS", base], Isosurfaces=[low + (high - low) * k / 4 for k in range(5)])
    shown = Show(contour, view)
    ColorBy(shown, ("POINTS", base))
    shown.RescaleTransferFunctionToDataRange(True)
    shown.SetScalarBarVisibility(view, True)
else:
    Show(source, view)
ResetCamera(view)
Render(view)
SaveScreenshot(picture, view)
