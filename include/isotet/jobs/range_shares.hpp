// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ranges of values whose ends may be shares of the grid's volume or of its points.
#pragma once

#include <optional>
#include <vector>

#include <isotet/isovalues.hpp>
#include <isotet/solid.hpp>

namespace isotet::jobs {

/// Ends of a range that are found in the grid, in place of its own.
struct RangeShares {
    std::optional<IsovalueShare> lower, upper;
};

/// The range with these ends, of one time step.
///
/// Errors   as isovalues_at(); invalid_data where its ends do not ascend
Result<SolidRange> with_shares(SolidRange range, const RangeShares& shares, const Grid& grid, const PointField& field,
                               const Run& run = {});
} // namespace isotet::jobs
