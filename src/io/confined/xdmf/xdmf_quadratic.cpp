// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_quadratic.hpp"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

namespace isotet::io::confined {
namespace {

constexpr std::size_t corners_of_tet = 4, edges_of_tet = 6;
constexpr std::array<std::array<std::uint8_t, 2>, edges_of_tet> vtk_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::uint8_t quadratic_tetrahedron = 24;

template <class Real, class Value>
Array with_middles(std::span<const Value> values, std::size_t components, const TetEdges& edges) {
    std::vector<Real> all(values.begin(), values.end());
    all.reserve(all.size() + edges.count() * components);
    for (std::size_t edge = 0; edge < edges.count(); ++edge)
        for (std::size_t c = 0; c < components; ++c) {
            const auto [a, b] = edges.ends(edge);
            const auto at = [&](std::uint64_t point) { return static_cast<Real>(values[point * components + c]); };
            all.push_back(at(a) + (at(b) - at(a)) / 2);
        }
    return Array::own(std::move(all), components);
}

Array with_middles(const Array& values, const TetEdges& edges) {
    return values.visit([&](auto typed) {
        using Value = typename decltype(typed)::value_type;
        using Real = std::conditional_t<std::is_same_v<Value, float>, float, double>;
        return with_middles<Real, Value>(typed, values.components(), edges);
    });
}

Cells cells_with_middles(const Cells& cells, std::size_t points, const TetEdges& edges) {
    const std::size_t count = cells.connectivity.size() / corners_of_tet;
    std::vector<std::int64_t> nodes, offsets{0};
    nodes.reserve(count * (corners_of_tet + edges_of_tet));
    offsets.reserve(count + 1);
    for (std::size_t cell = 0; cell < count; ++cell) {
        for (std::size_t corner = 0; corner < corners_of_tet; ++corner)
            nodes.push_back(static_cast<std::int64_t>(number_at(cells.connectivity, cell * corners_of_tet + corner)));
        for (std::size_t place = 0; place < edges_of_tet; ++place)
            nodes.push_back(static_cast<std::int64_t>(points + edges.number(cell, place)));
        offsets.push_back(static_cast<std::int64_t>(nodes.size()));
    }
    Cells made;
    made.connectivity = Array::own(std::move(nodes));
    made.offsets = Array::own(std::move(offsets));
    made.types = Array::own(std::vector<std::uint8_t>(count, quadratic_tetrahedron));
    return made;
}

} // namespace

TetEdges::TetEdges(const Array& corners) : corners_(corners) {
    const std::size_t count = corners.size() / corners_of_tet;
    edges_.reserve(count * edges_of_tet);
    for (std::size_t cell = 0; cell < count; ++cell)
        for (std::size_t place = 0; place < edges_of_tet; ++place) edges_.push_back(ends_in(cell, place));
    std::ranges::sort(edges_);
    const auto repeated = std::ranges::unique(edges_);
    edges_.erase(repeated.begin(), repeated.end());
}

std::size_t TetEdges::number(std::size_t cell, std::size_t place) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(edges_, ends_in(cell, place)) - edges_.begin());
}

std::array<std::uint64_t, 2> TetEdges::ends_in(std::size_t cell, std::size_t place) const {
    const auto corner = [&](std::size_t end) {
        return number_at(corners_, cell * corners_of_tet + vtk_edges[place][end]);
    };
    return {std::min(corner(0), corner(1)), std::max(corner(0), corner(1))};
}

void make_quadratic(Grid& grid, const TetEdges& edges) {
    const std::size_t points = grid.points.tuples();
    grid.cells = cells_with_middles(grid.cells, points, edges);
    for (Field& field : grid.point_fields)
        if (field.values.tuples() == points) field.values = with_middles(field.values, edges);
    grid.points = with_middles(grid.points, edges);
}

} // namespace isotet::io::confined
