// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "linear/hanging/checked_cells.hpp"

namespace isotet::linear {

/// Whether a point that none of these cells has lies on a face or an edge of one of them, to 1/1000 of a face's extent: where
/// they are some of a grid's cells, one that hangs there. Flat cells beside them may seem so; true, too, where many cells are so
/// long that it would take too long to find out.
///
/// Cost   two passes over the cells, one over the points; a byte a point, 60 a cell, 8 MB
bool has_points_between(const CheckedCells& all, const Array& points, const Progress& progress);

} // namespace isotet::linear
