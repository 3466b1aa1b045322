// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Linear cells of any kind as quadratic ones.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>

#include "grid/cells.hpp"
#include "linear/curved/curved_kinds.hpp"

namespace isotet::test {

enum class NodesOn : std::uint8_t { edges, faces };

/// The same cells with nodes in the middles of their edges, and with NodesOn::faces of quadrilaterals and hexahedra, too.
/// Nodes at the place of a point are that point. Fields are left out.
inline Grid quadratic_cells(const Grid& grid, NodesOn on = NodesOn::edges) {
    using Place = std::array<double, 3>;
    std::map<std::array<long, 3>, std::int64_t> known;
    std::vector<double> points;
    const auto node_at = [&](const Place& place) {
        std::array<long, 3> key;
        for (std::size_t axis = 0; axis < 3; ++axis) key[axis] = std::lround(place[axis] * 1e7);
        const auto [at, is_new] = known.emplace(key, static_cast<std::int64_t>(points.size() / 3));
        if (is_new) points.insert(points.end(), place.begin(), place.end());
        return at->second;
    };
    const core::CellReader reader = core::CellReader::open(grid).value();
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    for (std::size_t cell = 0; cell < reader.count(); ++cell) {
        const core::WholeCell whole = reader.whole(cell);
        std::vector<Place> corners;
        for (std::size_t i = 0; i < core::corner_count(whole.kind); ++i) {
            const auto point = static_cast<std::size_t>(whole.corners[i]);
            corners.push_back({grid.points.at(point, 0), grid.points.at(point, 1), grid.points.at(point, 2)});
            connectivity.push_back(node_at(corners.back()));
        }
        const auto add_middle = [&](std::span<const std::uint8_t> of) {
            Place middle{};
            for (const std::uint8_t corner : of)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    middle[axis] += corners[corner][axis] / static_cast<double>(of.size());
            connectivity.push_back(node_at(middle));
        };
        for (const linear::CornerPair& edge : linear::quadratic_edges(whole.kind)) add_middle(edge);
        const bool faces = on == NodesOn::faces && whole.kind != core::CellKind::pyramid;
        if (faces)
            for (const linear::CornerQuad& face : linear::quadratic_faces(whole.kind)) add_middle(face);
        if (faces && whole.kind == core::CellKind::hexahedron)
            add_middle(std::array<std::uint8_t, 8>{0, 1, 2, 3, 4, 5, 6, 7});
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        constexpr std::array<std::uint8_t, 4> on_edges{24, 27, 26, 25}, on_faces{24, 27, 32, 29}; // by CellKind
        types.push_back((faces ? on_faces : on_edges)[static_cast<std::size_t>(whole.kind)]);
    }
    Grid out;
    out.points = Array::own(std::move(points), 3);
    out.cells.connectivity = Array::own(std::move(connectivity));
    out.cells.offsets = Array::own(std::move(offsets));
    out.cells.types = Array::own(std::move(types));
    return out;
}

} // namespace isotet::test
