// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Derivatives of point values by the coordinates.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// At each point the mean over the cells around it of the derivative at that corner of the cell's linear interpolation:
/// of the three edges there; at the tip of a pyramid the mean over its four threes of edges side by side. Component
/// 3 c + j is the derivative of component c by coordinate j. NaN at points without a cell. A corner does not count where
/// a value is NaN or its edges lie in a plane.
///
/// `values`   float64, one tuple a point
/// Cost       O(n); 24 bytes a component and point, and a list of cells around points
/// Errors     as survey() and linearize(); cancelled
Result<Array> point_gradients(const Grid& grid, const Array& values, const Progress& progress);

} // namespace isotet::core
