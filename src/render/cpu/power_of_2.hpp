// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace isotet::render {

/// 2^x for x from -126 to 0, to 2^-22; no library's, which differ in their last bits.
inline float power_of_2(float x) {
    const float whole = std::floor(x), part = x - whole;
    float power = 1.8937541e-03F;
    for (const float term : {8.9495904e-03F, 5.5860337e-02F, 2.4014182e-01F, 6.9315449e-01F, 9.9999990e-01F})
        power = power * part + term;
    return power * std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
}

} // namespace isotet::render
