// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cell values averaged to points.
#pragma once

#include <span>

#include <isotet/grid.hpp>

#include "grid/cells.hpp"
#include "grid/values/scalar_of.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

/// At each point the mean of the values of the contoured cells around it, weighted by their volumes (the sum over the
/// cell's tets, each taken as positive; where all are zero, all cells weigh the same). Cells whose value is NaN are
/// left out; a point without a cell left is NaN. In a grid of flat cells alone these are averaged, and weigh the same.
///
/// `grid`, `cells`   checked (check_cells); a tuple of `values` for each cell
/// `volumes`         empty, or of each cell, negative where it is left out: then cells need not be contoured ones
///
/// Guarantees   the same bytes for any thread count: cells are added in ascending order; where all cells agree, the
///              mean is their value exactly
/// Cost         two passes over the cells and one over the points; 8 bytes a cell, 8 a point and 4 a corner (8 above
///              2^32 cells) beside the result, which is float32 for float32 and float64 for all other types
/// `by_value`        cells around a point are added in the order of their values and volumes, not of their numbers, and
///                   volumes follow from Grid::point_numbers: pieces with ghost cells get the values of the whole
/// Cancelled, the values are of no use.
Array average_to_points(const Grid& grid, const CellReader& cells, const Array& values, Scalar scalar, bool by_value,
                        std::span<const double> volumes, const Progress& progress);

/// Six times the volume of a cell: the sum over its tets, each taken as positive; -1 for one that is not contoured.
double six_volumes_of(const CellReader& cells, const PointReader& points, std::size_t cell);

} // namespace isotet::core
