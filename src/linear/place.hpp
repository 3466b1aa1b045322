// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where a point lies in a quadratic tet: barycentric weights in steps of 2^-30.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "linear/curved/node_values.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/derived.hpp"

namespace isotet::linear {

/// The weights of corners 0, 1 and 2; the fourth makes the sum 2^30. Compared in this order. Of points on a face that two
/// tets share, both tets order these numbers alike, since corners stand in the order of point numbers.
using Place = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t whole_weight = 1u << 30;
inline constexpr std::array<Place, 4> corner_places{
    {{whole_weight, 0, 0}, {0, whole_weight, 0}, {0, 0, whole_weight}, {0, 0, 0}}};

constexpr std::array<std::uint32_t, 4> steps_of(const Place& place) {
    return {place[0], place[1], place[2], whole_weight - place[0] - place[1] - place[2]};
}

/// Halfway between two different places; nothing where the steps are too coarse for it.
constexpr std::optional<Place> halfway(const Place& a, const Place& b) {
    const Place sum{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    if ((sum[0] | sum[1] | sum[2]) & 1) return std::nullopt;
    return Place{sum[0] / 2, sum[1] / 2, sum[2] / 2};
}

/// How far a field's middle between two places is from the mean of both: a quarter of its second difference. On a face that
/// tets share the same bits in both: values that weigh nothing there are not looked at.
inline double deviation_between(const std::array<double, 10>& bezier, const Place& a, const Place& b) {
    const auto from = steps_of(a), to = steps_of(b);
    std::array<double, 4> step{};
    for (std::size_t i = 0; i < 4; ++i) step[i] = (static_cast<double>(to[i]) - from[i]) / whole_weight;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (step[i] != 0) sum += bezier[i] * step[i] * step[i];
    for (std::size_t e = 0; e < 6; ++e)
        if (const double product = step[tet_edges[e][0]] * step[tet_edges[e][1]]; product != 0)
            sum += 2 * bezier[4 + e] * product;
    return std::abs(sum) / 4;
}

/// Of RefinedPoints::places.
inline Place place_at(const Array& places, std::size_t row) {
    const std::uint32_t* const steps = places.as<std::uint32_t>().data() + 3 * row;
    return {steps[0], steps[1], steps[2]};
}

/// What the ten nodes weigh there.
constexpr std::array<double, 10> node_weights(const Place& place) {
    const auto steps = steps_of(place);
    std::array<double, 4> at{};
    for (std::size_t i = 0; i < 4; ++i) at[i] = static_cast<double>(steps[i]) / whole_weight;
    std::array<double, 10> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = at[i] * (2 * at[i] - 1);
    for (std::size_t e = 0; e < 6; ++e) out[4 + e] = 4 * at[tet_edges[e][0]] * at[tet_edges[e][1]];
    return out;
}

/// The nodes that weigh something at a place of a quadratic tet.
class WeightedNodes {
public:
    WeightedNodes(const QuadraticTet& tet, const Place& place) {
        std::array<double, 10> weights = node_weights(place);
        for (std::size_t e = 0; e < 6; ++e)
            if (tet[4 + e] == mean_node) {
                for (const std::uint8_t end : tet_edges[e]) weights[end] += weights[4 + e] / 2;
                weights[4 + e] = 0;
            }
        for (std::size_t i = 0; i < 10; ++i)
            if (weights[i] != 0) {
                weights_[count_] = weights[i];
                nodes_[count_++] = tet[i];
            }
    }

    /// The quadratic field there.
    double value(const NodeValues& values) const {
        return weighted_sum(
            count_, [&](std::size_t i) { return weights_[i]; }, [&](std::size_t i) { return values[nodes_[i]]; });
    }

private:
    std::array<double, 10> weights_{};
    std::array<Node, 10> nodes_{};
    std::size_t count_ = 0;
};

/// The quadratic field there; nodes that weigh nothing are not looked at.
inline double value_at(const NodeValues& values, const QuadraticTet& tet, const Place& place) {
    return WeightedNodes(tet, place).value(values);
}

} // namespace isotet::linear
