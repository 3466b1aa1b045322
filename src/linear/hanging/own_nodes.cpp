// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/own_nodes.hpp"

#include <algorithm>
#include <tuple>

#include "linear/curved/curved_kinds.hpp"

namespace isotet::linear {

namespace {

/// Calls use(low, high, node) for each edge with a node.
template <class Use>
void each_edge_node(const core::CellReader& cells, std::size_t cell, const Use& use) {
    if (!is_curved(cells.type(cell))) return;
    const auto layout = layout_of(cells.type(cell), cells.corners(cell));
    if (!layout) return;
    const std::uint64_t first = cells.first(cell), corners = core::corner_count(layout->kind);
    for (std::uint64_t edge = 0; edge < layout->edges; ++edge) {
        const CornerPair ends = quadratic_edges(layout->kind)[edge];
        const auto [low, high] = std::minmax({cells.corner(first + ends[0]), cells.corner(first + ends[1])});
        use(low, high, cells.corner(first + corners + edge));
    }
}

bool comes_before(const PointOnEdge& a, const PointOnEdge& b) {
    return std::tie(a.low, a.high, a.point) < std::tie(b.low, b.high, b.point);
}
bool is_same_edge(const PointOnEdge& a, const PointOnEdge& b) { return a.low == b.low && a.high == b.high; }

} // namespace

std::vector<PointOnEdge> own_nodes(const core::CellReader& cells, const std::vector<std::uint64_t>& listed,
                                   const SplitEdges& split) {
    std::vector<PointOnEdge> all;
    std::vector<std::uint8_t> is_low(cells.points());
    for (const std::uint64_t cell : listed)
        each_edge_node(cells, cell, [&](std::uint64_t low, std::uint64_t high, std::uint64_t node) {
            if (low == high || split.is_split(low, high)) return;
            all.push_back({low, high, node});
            is_low[low] = 1;
        });
    if (all.empty()) return all;
    std::ranges::sort(all, comes_before);
    all.erase(std::unique(
                  all.begin(), all.end(),
                  [](const PointOnEdge& a, const PointOnEdge& b) { return is_same_edge(a, b) && a.point == b.point; }),
              all.end());
    std::vector<std::uint8_t> is_other(all.size());
    auto next = listed.begin();
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (next != listed.end() && *next == cell) {
            ++next;
            continue;
        }
        each_edge_node(cells, cell, [&](std::uint64_t low, std::uint64_t high, std::uint64_t) {
            if (is_low[low] == 0) return;
            auto at = std::ranges::lower_bound(all, PointOnEdge{low, high, 0}, comes_before);
            for (; at != all.end() && at->low == low && at->high == high; ++at)
                is_other[static_cast<std::size_t>(at - all.begin())] = 1;
        });
    }
    std::vector<PointOnEdge> out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool twice =
            (i > 0 && is_same_edge(all[i], all[i - 1])) || (i + 1 < all.size() && is_same_edge(all[i], all[i + 1]));
        if (is_other[i] == 0 && !twice) out.push_back(all[i]);
    }
    return out;
}

} // namespace isotet::linear
