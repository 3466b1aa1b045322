// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From edges as they were found, some of them several times, to vertices in their order: by lower end, then higher end.
#pragma once

#include <cstdint>
#include <vector>

#include "base/buffer.hpp"
#include "cpu/direct/cells.hpp"

namespace isotet::cpu::direct {

/// An edge and the number under which it was found.
template <class Point>
struct FoundEdge {
    ActiveEdge<Point> edge;
    Point number;
};

/// All edges found, sorted: range by range, by their ends within.
template <class Point>
struct Welded {
    core::Buffer<FoundEdge<Point>> edges;
    std::vector<std::uint64_t> first_edge, first_vertex; ///< of each range, and the totals

    std::uint64_t vertex_count() const { return first_vertex.back(); }
};

/// Bytes that welding takes for so many edges.
template <class Point>
std::uint64_t welding_memory(std::uint64_t edges) {
    return edges * sizeof(FoundEdge<Point>);
}

/// Counts the chunks up, so that their numbers count from the beginning of the grid, and welds. The order in which
/// equal edges stand depends on the threads; nothing else does.
/// Cost   two moves of each edge
template <class Point>
Welded<Point> weld(CutCells<Point>& cut, const Ranges& ranges);

} // namespace isotet::cpu::direct
