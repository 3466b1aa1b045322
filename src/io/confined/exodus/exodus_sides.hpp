// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sides of Exodus's elements by their numbers, and side sets as patches.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/confined/exodus/exodus_file.hpp"

namespace isotet::io::confined {

/// The side sets, with their own numbers. Sides of elements without a volume, and of those that are not read, are passed over.
///
/// `grid`     points and cells as they were read of the file
/// Errors     invalid_data: elements or sides that are not there
Result<BoundaryPatches> exodus_side_sets(const ExodusFile& file, const Grid& grid);

} // namespace isotet::io::confined
