// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tetrahedra of 10 nodes, which functions of degree 2 need, where the file has those of 4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>

namespace isotet::io::confined {

/// A number of an array of whole numbers.
inline std::uint64_t number_at(const Array& numbers, std::size_t at) {
    return numbers.visit([&](auto values) { return static_cast<std::uint64_t>(values[at]); });
}

/// The edges of tetrahedra, each once, by the numbers of their ends.
class TetEdges {
public:
    explicit TetEdges(const Array& corners);

    std::size_t count() const { return edges_.size(); }
    const std::array<std::uint64_t, 2>& ends(std::size_t edge) const { return edges_[edge]; }
    /// `place`   VTK's number of the edge in the cell, that of the node on it less 4
    std::size_t number(std::size_t cell, std::size_t place) const;

private:
    std::array<std::uint64_t, 2> ends_in(std::size_t cell, std::size_t place) const;

    Array corners_;
    std::vector<std::array<std::uint64_t, 2>> edges_;
};

/// Gives the tetrahedra a point in the middle of each edge, numbered behind all others. Point fields that have values there
/// already keep them, others are linear along edges (integers become float64).
void make_quadratic(Grid& grid, const TetEdges& edges);

} // namespace isotet::io::confined
