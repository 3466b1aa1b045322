// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What colours of cell fields go by, of fields that stay in their files.
#pragma once

#include <optional>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/join/ordered_pieces.hpp"

namespace isotet::io {

/// ReadResult::digests of joined cell fields, of which some values are known, read part by part. Nothing where all cells are
/// needed: some have no volume, or a field cannot be read.
///
/// Errors   as FieldSource; cancelled
Result<std::optional<std::vector<Field>>> digests_of(const OrderedPieces& all, const std::vector<Field>& joined,
                                                     const Progress& progress);

} // namespace isotet::io
