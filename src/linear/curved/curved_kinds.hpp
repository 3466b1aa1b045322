// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where quadratic cells have their nodes: corners, then edges, then quadrilateral faces, then the centre, in VTK's order.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "grid/cell/cell_kind.hpp"
#include "grid/cell/curved_types.hpp"
#include "grid/cell/linear_names.hpp"
#include "grid/cell/node_order.hpp"
#include "grid/cells.hpp"

namespace isotet::linear {

using CornerPair = std::array<std::uint8_t, 2>;
using CornerQuad = std::array<std::uint8_t, 4>;

/// A cell of degree 2 or 1: the nodes that it has.
struct NodeLayout {
    core::CellKind kind;
    std::uint8_t nodes; ///< in all; those behind the centre are not used
    std::uint8_t edges; ///< the first so many of quadratic_edges() have nodes
    std::uint8_t faces; ///< the first so many of quadratic_faces() have nodes
    bool centre;
};

namespace node_tables {

inline constexpr std::array<CornerPair, 6> tet_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
inline constexpr std::array<CornerPair, 8> pyramid_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
inline constexpr std::array<CornerPair, 9> wedge_edges{
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
inline constexpr std::array<CornerPair, 12> hexahedron_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
inline constexpr std::array<CornerQuad, 1> pyramid_faces{{{0, 1, 2, 3}}};
inline constexpr std::array<CornerQuad, 3> wedge_faces{{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
inline constexpr std::array<CornerQuad, 6> hexahedron_faces{
    {{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

} // namespace node_tables

/// In the order of their nodes.
constexpr std::span<const CornerPair> quadratic_edges(core::CellKind kind) {
    switch (kind) {
    case core::CellKind::tetrahedron: return node_tables::tet_edges;
    case core::CellKind::pyramid: return node_tables::pyramid_edges;
    case core::CellKind::wedge: return node_tables::wedge_edges;
    case core::CellKind::hexahedron: break;
    }
    return node_tables::hexahedron_edges;
}

/// Quadrilaterals only, in the order of their nodes.
constexpr std::span<const CornerQuad> quadratic_faces(core::CellKind kind) {
    switch (kind) {
    case core::CellKind::tetrahedron: return {};
    case core::CellKind::pyramid: return node_tables::pyramid_faces;
    case core::CellKind::wedge: return node_tables::wedge_faces;
    case core::CellKind::hexahedron: break;
    }
    return node_tables::hexahedron_faces;
}

using core::first_lagrange;

/// Of a curved type with so many nodes; nothing: not handled, or a wrong number for its type (expected_nodes()).
constexpr std::optional<NodeLayout> layout_of(std::uint8_t type, std::uint64_t nodes) {
    using enum core::CellKind;
    const auto with = [&](NodeLayout layout) -> std::optional<NodeLayout> {
        return layout.nodes == nodes ? std::optional(layout) : std::nullopt;
    };
    switch (type) {
    case 24: return with({tetrahedron, 10, 6, 0, false});
    case 25: return with({hexahedron, 20, 12, 0, false});
    case 26: return with({wedge, 15, 9, 0, false});
    case 27: return with({pyramid, 13, 8, 0, false});
    case 29: return with({hexahedron, 27, 12, 6, true});
    case 31: return with({wedge, 12, 6, 0, false});
    case 32: return with({wedge, 18, 9, 3, false});
    case 33: return with({hexahedron, 24, 12, 4, false});
    case 37: return with({pyramid, 19, 8, 1, false});
    case 71: return nodes == 4 ? with({tetrahedron, 4, 0, 0, false}) : with({tetrahedron, 10, 6, 0, false});
    case 72: return nodes == 8 ? with({hexahedron, 8, 0, 0, false}) : with({hexahedron, 27, 12, 6, true});
    case 73: return nodes == 6 ? with({wedge, 6, 0, 0, false}) : with({wedge, 18, 9, 3, false});
    case 74: return nodes == 5 ? with({pyramid, 5, 0, 0, false}) : with({pyramid, 14, 8, 1, false});
    default: return std::nullopt;
    }
}

/// A cell that is split into cells of degree 2 first.
struct HighDegree {
    core::CellKind kind;
    unsigned degree;
    bool bezier; ///< its nodes are control points

    auto operator<=>(const HighDegree&) const = default;
};

/// Lagrange cells of degree 3 to core::max_degree, Bezier cells from degree 1 on. No program defines Bezier pyramids.
constexpr std::optional<HighDegree> high_degree_of(std::uint8_t type, std::uint64_t nodes) {
    constexpr std::array<core::CellKind, 4> kinds{core::CellKind::tetrahedron, core::CellKind::hexahedron,
                                                  core::CellKind::wedge, core::CellKind::pyramid};
    const bool bezier = type >= core::first_bezier;
    const std::uint8_t first = bezier ? core::first_bezier : first_lagrange;
    if (type < first || type - first > (bezier ? 2 : 3)) return std::nullopt;
    const core::CellKind kind = kinds[static_cast<std::size_t>(type - first)];
    const unsigned degree = core::degree_of(kind, nodes);
    if (degree < (bezier ? 1U : 3U)) return std::nullopt;
    return HighDegree{kind, degree, bezier};
}

/// The number of nodes of a type that has only one; 0 for others.
constexpr std::uint64_t expected_nodes(std::uint8_t type) {
    for (const core::CurvedType& curved : core::curved_types)
        if (curved.type == type) return curved.nodes;
    return 0;
}

} // namespace isotet::linear
