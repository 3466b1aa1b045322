// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where a point lies in a quadratic tet: barycentric weights in steps of 2^-20, three of them in 64 bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "linear/derived.hpp"
#include "linear/node_values.hpp"
#include "linear/quadratic.hpp"

namespace isotet::linear {

/// The weights of corners 0, 1 and 2, 21 bits each, corner 0 highest; the fourth makes the sum 2^20. Of points on a face
/// that two tets share, both tets order these numbers alike, since corners stand in the order of point numbers.
using Place = std::uint64_t;

inline constexpr std::uint32_t whole_weight = 1u << 20;
inline constexpr std::array<Place, 4> corner_places{Place{whole_weight} << 42, Place{whole_weight} << 21, whole_weight,
                                                    0};

constexpr std::array<std::uint32_t, 4> steps_of(Place place) {
    constexpr Place mask = (1u << 21) - 1;
    const auto a = static_cast<std::uint32_t>(place >> 42), b = static_cast<std::uint32_t>(place >> 21 & mask),
               c = static_cast<std::uint32_t>(place & mask);
    return {a, b, c, whole_weight - a - b - c};
}

/// Halfway between two different places; nothing where the steps are too coarse for it.
constexpr std::optional<Place> halfway(Place a, Place b) {
    constexpr Place odd = Place{1} << 42 | Place{1} << 21 | 1;
    const Place sum = a + b;
    if (sum & odd) return std::nullopt;
    return sum >> 1;
}

/// What the ten nodes weigh there, exactly.
constexpr std::array<double, 10> node_weights(Place place) {
    const auto steps = steps_of(place);
    std::array<double, 4> at{};
    for (std::size_t i = 0; i < 4; ++i) at[i] = static_cast<double>(steps[i]) / whole_weight;
    std::array<double, 10> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = at[i] * (2 * at[i] - 1);
    for (std::size_t e = 0; e < 6; ++e) out[4 + e] = 4 * at[tet_edges[e][0]] * at[tet_edges[e][1]];
    return out;
}

/// The quadratic field there; nodes that weigh nothing are not looked at.
inline double value_at(const NodeValues& values, const QuadraticTet& tet, Place place) {
    std::array<double, 10> weights = node_weights(place);
    for (std::size_t e = 0; e < 6; ++e)
        if (tet[4 + e] == mean_node) {
            for (const std::uint8_t end : tet_edges[e]) weights[end] += weights[4 + e] / 2;
            weights[4 + e] = 0;
        }
    std::array<double, 10> used{};
    std::array<Node, 10> nodes{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 10; ++i)
        if (weights[i] != 0) {
            used[count] = weights[i];
            nodes[count++] = tet[i];
        }
    return weighted_sum(count, [&](std::size_t i) { return used[i]; }, [&](std::size_t i) { return values[nodes[i]]; });
}

} // namespace isotet::linear
