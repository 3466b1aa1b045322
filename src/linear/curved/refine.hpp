// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Curved cells as linear tets: split at their nodes, or refined for a field.
#pragma once

#include <isotet/linear_cells.hpp>

namespace isotet::linear {

/// The polyhedra as linear cells; all other cells as they are, curved ones too.
Result<LinearGrid> split_polyhedra(const Grid& grid, const LinearizeOptions& options, const Progress& progress);

/// All cells of what split_polyhedra() gave, as tets. Without a field each edge with a node is bisected once.
///
/// `user`    the grid before that
/// `field`   one scalar a user's point; may be null
Result<LinearGrid> refined(const Grid& user, LinearGrid before, const Array* field, const RefineOptions& options,
                           const Progress& progress);

} // namespace isotet::linear
