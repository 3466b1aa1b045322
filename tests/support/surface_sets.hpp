// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A surface without its order: vertices by the grid edge they lie on, triangles up to the diagonals of quadrilaterals.
// Two surfaces with equal sets are the same surface, however their vertices and triangles are numbered.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <ostream>
#include <utility>
#include <vector>

#include <isotet/surface.hpp>

namespace isotet::test {

/// The user's points between which a vertex lies, the one below first; twice the same for a vertex at a tied point.
using Ends = std::pair<std::int64_t, std::int64_t>;

/// Bits of the position as doubles: float32 fits into double without loss, signs of zeros included.
using PositionBits = std::array<std::uint64_t, 3>;

inline PositionBits bits_of(double x, double y, double z) {
    return {std::bit_cast<std::uint64_t>(x), std::bit_cast<std::uint64_t>(y), std::bit_cast<std::uint64_t>(z)};
}

using DirectedEdge = std::pair<Ends, Ends>;

/// The triangles of one cell: how many, and the outline of their union, ascending. An inner diagonal, used once in each
/// direction, is not part of it.
struct CellTriangles {
    std::size_t count = 0;
    std::vector<DirectedEdge> outline;

    void add_edge(const Ends& from, const Ends& to) {
        const auto back = std::find(outline.begin(), outline.end(), DirectedEdge{to, from});
        if (back != outline.end()) outline.erase(back);
        else outline.insert(std::upper_bound(outline.begin(), outline.end(), DirectedEdge{from, to}), {from, to});
    }
    friend bool operator==(const CellTriangles&, const CellTriangles&) = default;
};

struct SurfaceSets {
    std::map<Ends, PositionBits> vertices;
    std::map<std::int64_t, CellTriangles> cells; ///< by the user's cell
    std::size_t repeated_vertices = 0;           ///< vertices with the ends of another one

    friend bool operator==(const SurfaceSets&, const SurfaceSets&) = default;

    /// The positions alone, ascending.
    std::vector<PositionBits> positions() const {
        std::vector<PositionBits> out;
        for (const auto& [ends, position] : vertices) out.push_back(position);
        std::sort(out.begin(), out.end());
        return out;
    }
    std::size_t triangle_count() const {
        std::size_t count = 0;
        for (const auto& [cell, triangles] : cells) count += triangles.count;
        return count;
    }
    friend void PrintTo(const SurfaceSets& sets, std::ostream* out) {
        *out << sets.vertices.size() << " vertices, " << sets.triangle_count() << " triangles in " << sets.cells.size()
             << " cells";
    }
};

/// The three vertices of a triangle.
inline std::array<std::size_t, 3> corners_of(const Surface& surface, std::size_t triangle) {
    std::array<std::size_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = surface.triangles.type() == ScalarType::uint32
                         ? surface.triangles.as<std::uint32_t>()[3 * triangle + k]
                         : surface.triangles.as<std::uint64_t>()[3 * triangle + k];
    return corners;
}

inline Ends ends_of(const Surface& surface, std::size_t vertex) {
    const auto ends = surface.edge_ends.as<std::int64_t>();
    return {ends[2 * vertex], ends[2 * vertex + 1]};
}

/// A position in the coordinates of the grid.
inline std::array<double, 3> position_of(const Surface& surface, std::size_t vertex) {
    return {surface.positions.at(vertex, 0), surface.positions.at(vertex, 1), surface.positions.at(vertex, 2)};
}

/// The sets of a surface that was extracted with edge ends and source cells.
inline SurfaceSets sets_of(const Surface& surface) {
    SurfaceSets sets;
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto p = position_of(surface, v);
        sets.repeated_vertices += !sets.vertices.emplace(ends_of(surface, v), bits_of(p[0], p[1], p[2])).second;
    }
    const auto source = surface.source_cells.as<std::int64_t>();
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        const auto corners = corners_of(surface, t);
        CellTriangles& cell = sets.cells[source[t]];
        ++cell.count;
        for (std::size_t k = 0; k < 3; ++k)
            cell.add_edge(ends_of(surface, corners[k]), ends_of(surface, corners[(k + 1) % 3]));
    }
    return sets;
}

} // namespace isotet::test
