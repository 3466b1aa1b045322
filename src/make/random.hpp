// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Random numbers by counter: a hash of (seed, stream, index), so that any thread can draw any of them in any order.
#pragma once

#include <cstdint>

namespace isotet::make {

/// What a number is drawn for; different streams are independent.
enum class Stream : std::uint64_t { position = 1, integer, point_order, tet_order, corner_order, refinement };

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): a bijection of 64-bit numbers.
constexpr std::uint64_t mix(std::uint64_t x) noexcept {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

constexpr std::uint64_t draw(std::uint64_t seed, Stream stream, std::uint64_t index) noexcept {
    return mix(mix(mix(seed) ^ static_cast<std::uint64_t>(stream)) ^ index);
}

/// The upper 53 bits as a number in [-1, 1).
constexpr double to_symmetric(std::uint64_t bits) noexcept {
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

} // namespace isotet::make
