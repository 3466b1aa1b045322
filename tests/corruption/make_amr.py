#!/usr/bin/env python3
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Writes the AMR files of data/: the distance from a point in the cells of overlapping boxes on three levels, refined by
2 and by 4. VTH by VTK (vtkXMLUniformGridAMRWriter), VTKHDF by its specification, with two steps."""
import pathlib
import sys

import h5py
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

ORIGIN = np.array([-1.0, -1.0, -1.0])
# Spacing and boxes (first and last cell along each axis) of each level.
LEVELS = [(0.25, [((0, 0, 0), (7, 7, 3)), ((0, 0, 4), (7, 7, 7))]),
          (0.125, [((4, 4, 4), (15, 11, 11)), ((4, 12, 4), (11, 15, 11))]),
          (0.03125, [((24, 28, 24), (39, 39, 39))])]


def distance(level: int, box: tuple, centre: float = 0.0) -> np.ndarray:
    """From the sphere's centre, in the middles of the cells, z slowest."""
    spacing = LEVELS[level][0]
    x, y, z = (ORIGIN[a] + spacing * (np.arange(box[0][a], box[1][a] + 1) + 0.5) for a in range(3))
    return np.sqrt((x[None, None, :] - centre) ** 2 + y[None, :, None] ** 2 + z[:, None, None] ** 2)


def write_vth(path: pathlib.Path) -> None:
    amr = vtk.vtkOverlappingAMR()
    amr.Initialize([len(boxes) for _, boxes in LEVELS])
    amr.SetOrigin(ORIGIN)
    amr.SetGridDescription(vtk.vtkStructuredData.VTK_STRUCTURED_XYZ_GRID
                           if hasattr(vtk.vtkStructuredData, "VTK_STRUCTURED_XYZ_GRID") else 8)
    for level, (spacing, boxes) in enumerate(LEVELS):
        amr.SetSpacing(level, [spacing] * 3)
        for number, (first, last) in enumerate(boxes):
            amr.SetAMRBox(level, number, vtk.vtkAMRBox(first, last))
            image = vtk.vtkUniformGrid()
            image.SetOrigin(ORIGIN + spacing * np.array(first))
            image.SetSpacing(spacing, spacing, spacing)
            image.SetDimensions([last[a] - first[a] + 2 for a in range(3)])
            values = numpy_to_vtk(distance(level, (first, last)).ravel(), deep=True)
            values.SetName("distance")
            image.GetCellData().AddArray(values)
            amr.SetDataSet(level, number, image)
    vtk.vtkAMRUtilities.BlankCells(amr)
    writer = vtk.vtkXMLUniformGridAMRWriter()
    writer.SetInputData(amr)
    writer.SetFileName(str(path))
    if not writer.Write():
        raise RuntimeError(f"{path} was not written")


def write_vtkhdf(path: pathlib.Path) -> None:
    """The second step has no third level, and its sphere is moved."""
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 3])
        root.attrs.create("Type", np.bytes_("OverlappingAMR"))
        root.attrs.create("GridDescription", np.bytes_("XYZ"))
        root.attrs["Origin"] = ORIGIN
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = 2
        steps["Values"] = np.array([0.0, 0.5])
        for level, (spacing, boxes) in enumerate(LEVELS):
            group = root.create_group(f"Level{level}")
            group.attrs["Spacing"] = np.array([spacing] * 3)
            there = 2 if level < 2 else 1
            rows = [[v for a in range(3) for v in (first[a], last[a])] for first, last in boxes]
            group.create_dataset("AMRBox", data=np.array(rows * there, dtype=np.int32))
            parts = [np.concatenate([distance(level, box, 0.125 * step).ravel() for box in boxes])
                     for step in range(there)]
            group.create_group("PointData"), group.create_group("FieldData")
            group.create_group("CellData").create_dataset("distance", data=np.concatenate(parts).astype(np.float32),
                                                          compression="gzip")
            of_level = steps.create_group(f"Level{level}")
            of_level["NumberOfAMRBoxes"] = np.array([len(boxes), len(boxes) * (there - 1)])
            of_level["AMRBoxOffsets"] = np.array([0, len(boxes)])
            of_level.create_group("PointDataOffsets")
            of_level.create_group("CellDataOffsets")["distance"] = np.array([0, len(parts[0])])


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    write_vth(folder / "sphere_amr.vth")
    write_vtkhdf(folder / "sphere_amr.vtkhdf")
