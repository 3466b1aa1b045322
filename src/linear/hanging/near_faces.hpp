// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether faces lie near larger ones, by their places alone: for grids of which some cells are missing.
#pragma once

#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "linear/hanging/open_faces.hpp"

namespace isotet::linear {

/// Cost   O(n log n)
bool has_smaller_faces(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points);

} // namespace isotet::linear
