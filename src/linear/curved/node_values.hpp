// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values at the nodes of quadratic tets.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/linear_cells.hpp>

#include "base/parallel.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/derived.hpp"

namespace isotet::linear {

/// A component of an array of one tuple a point, at points and hidden nodes, as doubles. Borrows the array.
class NodeValues {
public:
    NodeValues() = default;
    NodeValues(const Array& values, const DerivedPoints& hidden, std::size_t component = 0)
        : data_(values.data()), stride_(values.components()), component_(component), points_(values.tuples()) {
        values.visit([&]<class T>(std::span<const T>) {
            read_ = [](const void* data, std::size_t i) { return static_cast<double>(static_cast<const T*>(data)[i]); };
        });
        const auto first = hidden.first.as<std::uint64_t>(), terms = hidden.points.as<std::uint64_t>();
        const auto weights = hidden.weights.as<double>();
        hidden_.resize(hidden.count());
        core::parallel_each(hidden_.size(), 1 << 14, [&](std::size_t row) {
            hidden_[row] = weighted_sum(
                first[row + 1] - first[row], [&](std::size_t i) { return weights[first[row] + i]; },
                [&](std::size_t i) { return at_point(terms[first[row] + i]); });
        });
    }

    double at_point(std::uint64_t point) const { return read_(data_, point * stride_ + component_); }
    /// Of a point or a hidden node.
    double operator[](Node node) const { return node < points_ ? at_point(node) : hidden_[node - points_]; }

    /// Of all ten nodes.
    std::array<double, 10> of(const QuadraticTet& tet) const {
        std::array<double, 10> out{};
        for (std::size_t i = 0; i < 4; ++i) out[i] = (*this)[tet[i]];
        for (std::size_t e = 0; e < 6; ++e)
            out[4 + e] =
                tet[4 + e] == mean_node ? (out[tet_edges[e][0]] + out[tet_edges[e][1]]) / 2 : (*this)[tet[4 + e]];
        return out;
    }

private:
    const void* data_ = nullptr;
    double (*read_)(const void*, std::size_t) = nullptr;
    std::size_t stride_ = 1, component_ = 0;
    std::uint64_t points_ = 0;
    std::vector<double> hidden_;
};

/// Bezier values from those at the nodes: corners stay, edges become 2 m - (a + b) / 2.
inline std::array<double, 10> to_bezier(std::array<double, 10> values) {
    for (std::size_t e = 0; e < 6; ++e)
        values[4 + e] = 2 * values[4 + e] - (values[tet_edges[e][0]] + values[tet_edges[e][1]]) / 2;
    return values;
}

} // namespace isotet::linear
