// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>

#include "core/exact.hpp"

namespace isotet::core {

/// The finalizer of splitmix64 (Steele, Lea, Flood 2014).
constexpr std::uint64_t mixed(std::uint64_t value) noexcept {
    value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31);
}

/// The same for equal coordinates, -0 and +0 being equal.
inline std::uint64_t hash_of(const Point& point) noexcept {
    std::uint64_t hash = 0;
    for (const double coordinate : point) {
        const double value = coordinate + 0.0; // -0 becomes +0
        hash = mixed(hash + 0x9E3779B97F4A7C15U + std::bit_cast<std::uint64_t>(value));
    }
    return hash;
}

} // namespace isotet::core
