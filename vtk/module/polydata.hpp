// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <isotet/surface.hpp>

#include "wishes.hpp"

class vtkDataArray;
class vtkDataSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace isotet_vtk {

/// The surfaces of the wished isovalues as one vtkPolyData, with arrays named as vtkContourFilter names them: the contoured
/// scalars (an isovalue a point), carried arrays, "Normals". Memory of a single surface is shared, not copied.
///
/// `scalars`, `grid`   what was contoured: type and name of the scalars, which arrays are active vectors and so on
void write_polydata(const std::vector<isotet::Surface>& surfaces, const Wishes& wishes, vtkDataArray* scalars,
                    vtkUnstructuredGrid* grid, vtkPolyData* out);

/// Fields of points and cells as VTK had them: interpolated integers are rounded, active arrays stay active.
void write_fields(const std::vector<isotet::Field>& of_points, const std::vector<isotet::Field>& of_cells,
                  vtkDataSet* from, vtkDataSet* to);

/// Positions in the type that the wishes name.
isotet::Array in_precision(const isotet::Array& positions, const Wishes& wishes);

} // namespace isotet_vtk
