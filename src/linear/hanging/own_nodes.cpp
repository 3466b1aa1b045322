// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/own_nodes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

#include "grid/cell/node_order.hpp"
#include "linear/curved/curved_kinds.hpp"

namespace isotet::linear {

namespace {

/// Which nodes of a cell are on its edges.
struct EdgeNodes {
    std::array<std::uint8_t, 2> ends;
    std::vector<std::uint16_t> nodes;
};

/// Of a quadratic cell, or one of degree 3 and above.
class NodesOnEdges {
public:
    /// Empty where the cell is not curved, or has none.
    const std::vector<EdgeNodes>& of(std::uint8_t type, std::uint64_t count) {
        static const std::vector<EdgeNodes> none;
        if (!is_curved(type)) return none;
        const auto [found, is_new] = known_.try_emplace({type, count});
        if (!is_new) return found->second;
        if (const auto layout = layout_of(type, count)) found->second = of_layout(*layout);
        else if (const auto what = high_degree_of(type, count)) found->second = of_degree(*what);
        return found->second;
    }

private:
    static std::vector<EdgeNodes> of_layout(const NodeLayout& layout) {
        std::vector<EdgeNodes> out;
        const auto corners = static_cast<std::uint16_t>(core::corner_count(layout.kind));
        for (std::uint16_t edge = 0; edge < layout.edges; ++edge)
            out.push_back({quadratic_edges(layout.kind)[edge], {static_cast<std::uint16_t>(corners + edge)}});
        return out;
    }

    static std::vector<EdgeNodes> of_degree(const HighDegree& what) {
        std::vector<EdgeNodes> out;
        const int degree = static_cast<int>(what.degree);
        const auto nodes = core::nodes_of_degree(what.kind, what.degree, core::NodeOrder::vtk);
        for (const auto& [a, b] : core::edges_of(what.kind)) {
            EdgeNodes& edge = out.emplace_back(EdgeNodes{{a, b}, {}});
            for (int step = 1; step < degree; ++step) {
                core::LatticePlace at{};
                for (std::size_t k = 0; k < 3; ++k)
                    at[k] = static_cast<std::uint16_t>((nodes[a][k] * (degree - step) + nodes[b][k] * step) / degree);
                edge.nodes.push_back(static_cast<std::uint16_t>(std::ranges::find(nodes, at) - nodes.begin()));
            }
        }
        return degree > 1 ? out : std::vector<EdgeNodes>();
    }

    std::map<std::pair<std::uint8_t, std::uint64_t>, std::vector<EdgeNodes>> known_;
};

/// `along`   the nodes of the cell on the edge
struct OwnNode {
    PointOnEdge at;
    std::size_t along;
};

bool comes_before(const OwnNode& a, const OwnNode& b) {
    return std::tie(a.at.low, a.at.high, a.at.point, a.along) < std::tie(b.at.low, b.at.high, b.at.point, b.along);
}
bool is_same_edge(const PointOnEdge& a, const PointOnEdge& b) { return a.low == b.low && a.high == b.high; }

} // namespace

std::vector<PointOnEdge> own_nodes(const core::CellReader& cells, const std::vector<std::uint64_t>& listed,
                                   const SplitEdges& split) {
    NodesOnEdges on_edges;
    const auto each_edge = [&](std::size_t cell, const auto& use) {
        const std::uint64_t first = cells.first(cell);
        for (const auto& [ends, nodes] : on_edges.of(cells.type(cell), cells.corners(cell))) {
            const auto [low, high] = std::minmax({cells.corner(first + ends[0]), cells.corner(first + ends[1])});
            use(low, high, nodes);
        }
    };
    std::vector<OwnNode> all;
    std::vector<std::uint8_t> is_low(cells.points());
    for (const std::uint64_t cell : listed) {
        if (cells.type(cell) >= core::first_bezier) continue;
        const std::uint64_t first = cells.first(cell);
        each_edge(cell, [&](std::uint64_t low, std::uint64_t high, const std::vector<std::uint16_t>& nodes) {
            if (low == high || split.is_split(low, high)) return;
            for (const std::uint16_t node : nodes)
                all.push_back({{low, high, cells.corner(first + node)}, nodes.size()});
            is_low[low] = 1;
        });
    }
    if (all.empty()) return {};
    std::ranges::sort(all, comes_before);
    all.erase(std::unique(all.begin(), all.end(),
                          [](const OwnNode& a, const OwnNode& b) {
                              return is_same_edge(a.at, b.at) && a.at.point == b.at.point && a.along == b.along;
                          }),
              all.end());
    std::vector<std::uint8_t> is_other(all.size());
    auto next = listed.begin();
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (next != listed.end() && *next == cell) {
            ++next;
            continue;
        }
        each_edge(cell, [&](std::uint64_t low, std::uint64_t high, const std::vector<std::uint16_t>&) {
            if (is_low[low] == 0) return;
            auto at = std::ranges::lower_bound(all, OwnNode{{low, high, 0}, 0}, comes_before);
            for (; at != all.end() && at->at.low == low && at->at.high == high; ++at)
                is_other[static_cast<std::size_t>(at - all.begin())] = 1;
        });
    }
    std::vector<PointOnEdge> out;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        while (end < all.size() && is_same_edge(all[begin].at, all[end].at)) ++end;
        const bool agree = end - begin == all[begin].along && // as many as each cell has
                           std::all_of(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                       all.begin() + static_cast<std::ptrdiff_t>(end),
                                       [&](const OwnNode& node) { return node.along == all[begin].along; });
        for (std::size_t i = begin; agree && is_other[begin] == 0 && i < end; ++i) out.push_back(all[i].at);
    }
    return out;
}

} // namespace isotet::linear
