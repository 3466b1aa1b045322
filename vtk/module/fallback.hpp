// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What isotet does not contour goes to vtkContourFilter.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vtkSmartPointer.h>

#include "wishes.hpp"

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace isotet_vtk {

/// Why isotet does not contour `data` at all: a sentence; empty when it does.
std::string reason_against(vtkDataObject* data, vtkDataArray* scalars);

/// "triangle, quadratic tetrahedron": of VTK's numbers.
std::string names_of(const std::vector<std::uint8_t>& types);

/// The sentence for cells of these types, VTK's numbers, in a grid that isotet contours but for them.
///
/// `why_not`   why curved ones among them are not refined
std::string reason_against(const std::vector<std::uint8_t>& types, const std::string& why_not);

/// Contours a data set with vtkContourFilter.
void contour_by_vtk(vtkDataSet* data, vtkDataArray* scalars, const Wishes& wishes, vtkPolyData* out);

/// The cells of `grid` that have one of these types, without ghost cells, with all points and fields.
vtkSmartPointer<vtkUnstructuredGrid> cells_of_types(vtkUnstructuredGrid* grid, const std::vector<std::uint8_t>& types);

/// Appends `more` to `out`.
void append(vtkPolyData* more, vtkPolyData* out);

} // namespace isotet_vtk
