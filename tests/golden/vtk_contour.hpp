// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The rival: what VTK's vtkContour3DLinearGrid, merging points, makes of the valid cells of a grid.
#pragma once

#include <cstdint>

#include <isotet/grid.hpp>
#include <isotet/slice.hpp>

namespace isotet::test {

struct VtkSurface {
    std::uint64_t vertices = 0, triangles = 0;
    double area = 0;
};

/// Gives VTK the cells that isotet contours, or the tets into which it splits them, and only they: repeated ones once,
/// none with a corner of NaN.
VtkSurface vtk_contour(const Grid& grid, const Array& field, double isovalue, bool split_cells);

/// What VTK's vtkCutter makes of the tets of a grid, as triangles.
VtkSurface vtk_cut(const Grid& grid, const Array& field, const Plane& plane);

} // namespace isotet::test
