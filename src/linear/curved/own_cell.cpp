// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/own_cell.hpp"

#include <algorithm>
#include <span>

#include "linear/place.hpp"

namespace isotet::linear {

void OwnCell::values(const NodeValues& of, std::vector<double>& out) const {
    out.resize(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] != mean_node) {
            out[i] = of[nodes[i]];
            continue;
        }
        const auto [a, b] = ends(i);
        out[i] = (of[a] + of[b]) / 2;
    }
}

std::array<Node, 2> OwnCell::ends(std::size_t i) const {
    const CornerPair& pair = quadratic_edges(kind)[i - core::corner_count(kind)];
    return {nodes[pair[0]], nodes[pair[1]]};
}

OwnCells::OwnCells(const Grid& user, const LinearGrid& before, const QuadraticTets& tets)
    : tets_(tets),
      users_(core::CellReader::open({user.points, user.cells, {}, {}}).value()),
      source_cells_(before.source_cells) {}

void OwnCells::find(std::uint64_t cell, OwnCell& out) {
    out.functions = nullptr;
    out.nodes.clear();
    std::uint64_t source = cell, part = 0;
    if (!source_cells_.empty()) {
        const auto sources = source_cells_.as<std::uint64_t>();
        source = sources[cell];
        part = static_cast<std::uint64_t>(std::ranges::lower_bound(sources.first(cell), source) - sources.begin());
        part = cell - part;
    }
    if (const auto what = high_degree_of(users_.type(source), users_.corners(source)); what && what->degree > 1) {
        auto found = plans_.find(*what);
        if (found == plans_.end()) found = plans_.emplace(*what, plan_of(*what)).first;
        out.kind = what->kind;
        out.functions =
            &own_functions({what->kind, what->degree, what->bezier ? OwnKind::Of::bezier : OwnKind::Of::lagrange});
        const std::uint64_t first = users_.first(source);
        for (std::uint64_t i = 0; i < users_.corners(source); ++i)
            out.nodes.push_back(static_cast<Node>(users_.corner(first + i)));
        const std::int64_t fine = 2 * ((what->degree + 1) / 2);
        const auto& places = found->second.cells[part].places;
        for (std::size_t i = 0; i < std::min<std::size_t>(8, places.size()); ++i) {
            const std::int64_t at = places[i], side = fine + 1;
            out.corners[i] = {{at % side, at / side % side, at / side / side}, fine};
        }
        return;
    }
    if (tets_.first_node.empty() || tets_.first_node[cell] == tets_.first_node[cell + 1]) return;
    const std::span<const Node> nodes(tets_.cell_nodes.data() + tets_.first_node[cell],
                                      tets_.first_node[cell + 1] - tets_.first_node[cell]);
    out.nodes.assign(nodes.begin(), nodes.end());
    out.kind = nodes.size() == 27   ? core::CellKind::hexahedron
               : nodes.size() == 18 ? core::CellKind::wedge
                                    : core::CellKind::pyramid;
    out.functions = &own_functions({out.kind, 2, OwnKind::Of::lagrange});
    const auto corners = core::nodes_of_degree(out.kind, 1, core::NodeOrder::vtk);
    for (std::size_t i = 0; i < corners.size(); ++i)
        out.corners[i] = {{corners[i][0], corners[i][1], corners[i][2]}, 1};
}

CellPlace place_in_cell(const std::array<std::uint32_t, 4>& steps, const std::array<CellPlace, 4>& corners) {
    CellPlace out{{}, corners[0].steps * std::int64_t{whole_weight}};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 3; ++k) out.at[k] += steps[i] * corners[i].at[k];
    return out;
}

} // namespace isotet::linear
