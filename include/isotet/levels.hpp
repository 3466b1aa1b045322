// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isovalues within a range, for whoever has a field but no isovalue in mind.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/export.hpp>

namespace isotet {

/// Whether levels are computed exactly or moved to short decimals.
enum class LevelRounding : std::uint8_t {
    none,  ///< lower + k (upper - lower) / (count + 1)
    short_decimals, ///< the same, rounded to a tenth of the distance between two levels or better: 0.3, not 0.29873
};

/// `count` isovalues that divide a range into equal parts; neither end is one of them, unless both are the same value.
///
/// `lower`, `upper`   in the unit of the field; finite. Nothing is returned where lower > upper or one is not finite
/// Returns            the levels, ascending; with `short_decimals` without repetitions, so perhaps fewer
/// Guarantees         finite, also where upper - lower is too large for a double
ISOTET_API std::vector<double> evenly_spaced_levels(double lower, double upper, std::uint64_t count,
                                         LevelRounding rounding = LevelRounding::none);

} // namespace isotet
