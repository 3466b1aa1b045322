// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>

#include "numbers/exact.hpp"

namespace isotet::core {

/// Both halves of the product: every bit of the factors tells on all bits of the result (as in wyhash).
constexpr std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) noexcept {
    __extension__ using Wide = unsigned __int128;
    const Wide product = Wide{a} * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

/// MurmurHash3's last step (Appleby 2011).
constexpr std::uint64_t mixed(std::uint64_t x) noexcept {
    x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
    return x ^ x >> 33;
}

/// The same for equal coordinates, -0 and +0 being equal.
inline std::uint64_t hash_of(const Point& point) noexcept {
    const auto bits = [](double coordinate) {
        return std::bit_cast<std::uint64_t>(coordinate + 0.0); // -0 becomes +0
    };
    const std::uint64_t x_and_y =
        folded_product(bits(point[0]) ^ 0xA0761D6478BD642FU, bits(point[1]) ^ 0xE7037ED1A0B428DBU);
    const std::uint64_t all = folded_product(x_and_y ^ 0x8EBC6AF09C88C6E3U, bits(point[2]) ^ 0x589965CC75374CC3U);
    return folded_product(all ^ 0x1D8E4E27C47D124FU, 0x9E3779B97F4A7C15U);
}

} // namespace isotet::core
