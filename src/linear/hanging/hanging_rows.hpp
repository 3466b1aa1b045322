// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hanging points by what larger cells have there.
#pragma once

#include <isotet/linear_cells.hpp>

#include "linear/hanging/covers.hpp"

namespace isotet::linear {

/// Sets points, parents, and what the report says of points, faces and distances.
void describe_hanging(const OpenFaces& open, const Covers& covers, const core::PointReader& points, bool single,
                      ClosedGrid& out);

} // namespace isotet::linear
