// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hexahedra as quadratic ones of 20 nodes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>

namespace isotet::test {

/// The same hexahedra with nodes in the middle of their edges, and the point field "square": of the distance from the
/// origin. Nodes at the place of a point are that point.
inline Grid quadratic_hexahedra(const Grid& grid) {
    constexpr std::array<std::array<std::size_t, 2>, 12> edges{
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    using Place = std::array<double, 3>;
    std::map<Place, std::int64_t> known;
    std::vector<double> points, values;
    std::vector<std::int64_t> connectivity;
    const auto node_at = [&](const Place& place) {
        const auto [at, is_new] = known.emplace(place, static_cast<std::int64_t>(values.size()));
        if (is_new) {
            points.insert(points.end(), place.begin(), place.end());
            values.push_back(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]);
        }
        return at->second;
    };
    for (std::size_t first = 0; first < grid.cells.connectivity.size(); first += 8) {
        std::array<Place, 8> corners;
        for (std::size_t i = 0; i < 8; ++i) {
            const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(first + i));
            for (std::size_t axis = 0; axis < 3; ++axis) corners[i][axis] = grid.points.at(point, axis);
            connectivity.push_back(node_at(corners[i]));
        }
        for (const auto& [a, b] : edges) {
            Place middle;
            for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = (corners[a][axis] + corners[b][axis]) / 2;
            connectivity.push_back(node_at(middle));
        }
    }
    Grid out;
    out.points = Array::own(std::move(points), 3);
    const std::size_t cells = connectivity.size() / 20;
    std::vector<std::int64_t> offsets;
    for (std::size_t cell = 0; cell <= cells; ++cell) offsets.push_back(static_cast<std::int64_t>(20 * cell));
    out.cells.connectivity = Array::own(std::move(connectivity));
    out.cells.offsets = Array::own(std::move(offsets));
    out.cells.types = Array::own(std::vector<std::uint8_t>(cells, 25));
    out.point_fields = {{"square", Array::own(std::move(values))}};
    return out;
}

} // namespace isotet::test
