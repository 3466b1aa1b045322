// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/weld.hpp"

#include <algorithm>
#include <compare>

#include <tbb/parallel_sort.h>

#include "base/parallel.hpp"
#include "grid/points/same_place.hpp"

namespace isotet::checking {

namespace {

/// The tuples of an array whose `lowest` is themselves, in their order.
Array keep_leaders(const Array& array, const std::vector<std::uint64_t>& lowest) {
    return array.visit([&](auto values) {
        using Value = std::remove_const_t<typename decltype(values)::element_type>;
        const std::size_t components = array.components();
        std::vector<Value> kept;
        for (std::size_t i = 0; i < lowest.size(); ++i)
            if (lowest[i] == i)
                kept.insert(kept.end(), values.begin() + static_cast<std::ptrdiff_t>(i * components),
                            values.begin() + static_cast<std::ptrdiff_t>((i + 1) * components));
        return Array::own(std::move(kept), components);
    });
}

/// For each vertex the lowest one that lies on the same edge of the grid.
std::vector<std::uint64_t> lowest_on_same_edge(const Array& edge_ends) {
    struct OnEdge {
        double ends[2]; // exact below 2^53, and in one order for all
        std::uint64_t vertex;
        auto operator<=>(const OnEdge&) const = default;
    };
    std::vector<OnEdge> vertices(edge_ends.tuples());
    core::parallel_each(vertices.size(), 1 << 14, [&](std::size_t v) {
        const auto [low, high] = std::minmax({edge_ends.at(v, 0), edge_ends.at(v, 1)});
        vertices[v] = {{low, high}, v};
    });
    tbb::parallel_sort(vertices.begin(), vertices.end(), [](const OnEdge& a, const OnEdge& b) { return a < b; });
    std::vector<std::uint64_t> lowest(vertices.size());
    std::uint64_t first = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const bool same = i > 0 && std::ranges::equal(vertices[i].ends, vertices[i - 1].ends);
        if (!same) first = vertices[i].vertex;
        lowest[vertices[i].vertex] = first;
    }
    return lowest;
}

} // namespace

Welded weld(const Surface& surface, const Mesh& mesh) {
    const bool has_ends = !surface.edge_ends.empty() && surface.edge_ends.tuples() == surface.positions.tuples();
    const std::vector<std::uint64_t> lowest =
        has_ends ? lowest_on_same_edge(surface.edge_ends) : core::lowest_at_same_place(surface.positions);
    std::vector<std::uint64_t> numbers(lowest.size());
    std::uint64_t count = 0;
    for (std::size_t v = 0; v < lowest.size(); ++v) numbers[v] = lowest[v] == v ? count++ : numbers[lowest[v]];

    Welded welded;
    std::vector<std::uint64_t> triangles;
    triangles.reserve(3 * mesh.triangles());
    for (std::uint64_t triangle = 0; triangle < mesh.triangles(); ++triangle) {
        const Corners before = mesh.corners(triangle);
        const Corners after{numbers[before[0]], numbers[before[1]], numbers[before[2]]};
        if (has_equal_corners(after) && !has_equal_corners(before)) ++welded.collapsed;
        else triangles.insert(triangles.end(), after.begin(), after.end());
    }
    welded.surface.positions = keep_leaders(surface.positions, lowest);
    welded.surface.triangles = Array::own(std::move(triangles), 3);
    if (surface.edge_ends.tuples() == lowest.size()) welded.surface.edge_ends = keep_leaders(surface.edge_ends, lowest);
    return welded;
}

} // namespace isotet::checking
