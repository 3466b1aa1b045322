// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Directions in 32 bits: two 16-bit coordinates on an octahedron folded into a square.
// Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors (2014).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace isotet::core {

constexpr std::uint32_t zero_normal_code = 0x80008000u; ///< no direction
constexpr int normal_code_steps = 32767;

/// The code of a direction of any length; zero or not finite gives zero_normal_code.
inline std::uint32_t encode_normal(const std::array<double, 3>& n) {
    const double length = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
    if (!(length > 0) || std::isinf(length)) return zero_normal_code;
    double u = n[0] / length, v = n[1] / length;
    if (n[2] < 0) {
        const double folded = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
        v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
        u = folded;
    }
    const auto step = [](double x) {
        return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::floor(x * normal_code_steps + 0.5)));
    };
    return step(u) | static_cast<std::uint32_t>(step(v)) << 16;
}

/// The direction of a code as whole numbers, not of unit length: the same on any device. Zero for zero_normal_code.
inline std::array<int, 3> decode_normal(std::uint32_t code) {
    if (code == zero_normal_code) return {0, 0, 0};
    const int u = static_cast<std::int16_t>(code & 0xffff), v = static_cast<std::int16_t>(code >> 16);
    const int z = normal_code_steps - std::abs(u) - std::abs(v);
    if (z >= 0) return {u, v, z};
    return {(normal_code_steps - std::abs(v)) * (u < 0 ? -1 : 1), (normal_code_steps - std::abs(u)) * (v < 0 ? -1 : 1),
            z};
}

} // namespace isotet::core
