// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Divisions that are the hardest to round: their quotients lie as near to the middle between two floats as quotients
// can.
#pragma once

#include <cstdint>

namespace isotet::vulkan {

/// The dividend below `divisor` whose 2^24-fold leaves `remainder`, by halving the remainder 24 times modulo the
/// divisor. Of 24-bit significands, with a remainder of about half the divisor, the quotient is a hardest case if the
/// dividend has 24 bits.
///
/// `divisor`   odd, below 2^24
constexpr std::uint32_t hard_dividend(std::uint32_t divisor, std::uint32_t remainder) {
    std::uint32_t dividend = remainder;
    for (int i = 0; i < 24; ++i) dividend = (dividend % 2 ? dividend + divisor : dividend) / 2;
    return dividend;
}

} // namespace isotet::vulkan
