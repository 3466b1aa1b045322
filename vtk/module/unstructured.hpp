// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids of isotet as vtkUnstructuredGrid, and other data sets of VTK as that.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include <vtkSmartPointer.h>

class vtkDataSet;
class vtkUnstructuredGrid;

namespace isotet_vtk {

/// Points and cells of `grid`, without fields. Arrays are shared where VTK has such.
void write_cells(const isotet::Grid& grid, vtkUnstructuredGrid* out);

/// The data set itself, or what it is converted to.
vtkSmartPointer<vtkUnstructuredGrid> unstructured_of(vtkDataSet* data);

} // namespace isotet_vtk
