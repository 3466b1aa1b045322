// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which values lie in ranges, and point values without those that no cell uses.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet::core {

/// Clears `chosen` where a value lies in none of the ranges, or in one if `others`. A range of one number is of the value
/// that float32 has of it where the values are float32.
///
/// `values`   one scalar for each of `chosen`
/// `skipped`  empty, or not zero where a value is not looked at
/// Returns    by range, whether a value lies in it
ISOTET_API std::vector<bool> restrict_to_ranges(const Array& values, std::span<const std::array<double, 2>> ranges,
                                                bool others, std::span<const std::uint8_t> skipped,
                                                std::span<std::uint8_t> chosen);

/// The same values, but NaN at points whose byte in `used` is 0; integers stay.
ISOTET_API Array without_unused(const Array& values, std::span<const std::uint8_t> used);

} // namespace isotet::core
