// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/pyramid_weights.hpp"

#include <algorithm>
#include <numeric>

namespace isotet::linear {

namespace {

/// The function of `node` at `place` / `steps`.
long double layered_function(int degree, const core::LatticePlace& node, const std::array<long double, 3>& place,
                             long double steps) {
    const int layer = node[2], q = degree - layer; // the node's layer has q steps along x and y
    const long double height = place[2], width = steps - height;
    long double value = 1;
    for (int s = 0; s < layer; ++s)
        value *= (degree * height - s * steps) / (static_cast<long double>(layer - s) * steps);
    if (q == 0) return value;
    if (width == 0) return 0; // the apex
    for (int m = 0; m < q; ++m) value *= (width * degree) / (steps * q);
    for (std::size_t axis = 0; axis < 2; ++axis)
        for (int m = 0; m <= q; ++m)
            if (m != node[axis])
                value *= (q * place[axis] - m * width) / (static_cast<long double>(node[axis] - m) * width);
    return value;
}

std::array<long double, 3> widened_place(const core::LatticePlace& place) {
    return {static_cast<long double>(place[0]), static_cast<long double>(place[1]), static_cast<long double>(place[2])};
}

} // namespace

PyramidWeights::PyramidWeights(unsigned degree)
    : degree_(degree),
      nodes_(core::nodes_of_degree(core::CellKind::pyramid, degree, core::NodeOrder::vtk)),
      from_top_(nodes_.size()),
      of_(nodes_.size()) {
    std::iota(from_top_.begin(), from_top_.end(), std::size_t{0});
    std::ranges::stable_sort(from_top_, [&](std::size_t a, std::size_t b) { return nodes_[a][2] > nodes_[b][2]; });
    for (std::size_t at = 0; at < nodes_.size(); ++at)
        for (const auto& node : nodes_)
            of_[at].push_back(node[2] < nodes_[at][2] ? layered_function(static_cast<int>(degree), node,
                                                                         widened_place(nodes_[at]),
                                                                         static_cast<long double>(degree))
                                                      : 0);
}

std::vector<double> PyramidWeights::weights(const std::array<long double, 3>& place, long double steps) const {
    std::vector<long double> weights;
    for (const auto& node : nodes_)
        weights.push_back(layered_function(static_cast<int>(degree_), node, place, steps));
    for (const std::size_t above : from_top_)
        for (std::size_t node = 0; node < nodes_.size(); ++node) weights[node] -= weights[above] * of_[above][node];
    return {weights.begin(), weights.end()};
}

std::vector<double> PyramidWeights::at(const core::LatticePlace& place, unsigned steps) const {
    return weights(widened_place(place), static_cast<long double>(steps));
}

std::vector<double> PyramidWeights::at(const std::array<long double, 3>& place) const { return weights(place, 1); }

} // namespace isotet::linear
