// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The kinds of cells that are stored as they are, and their faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace isotet::core {

/// In the order in which a cluster stores its cells.
enum class CellKind : std::uint8_t { tetrahedron, pyramid, wedge, hexahedron };

inline constexpr std::size_t cell_kind_count = 4;
inline constexpr std::array<CellKind, cell_kind_count> cell_kinds{CellKind::tetrahedron, CellKind::pyramid,
                                                                  CellKind::wedge, CellKind::hexahedron};
inline constexpr std::array<std::size_t, cell_kind_count> corner_counts{4, 5, 6, 8};

constexpr std::size_t corner_count(CellKind kind) { return corner_counts[static_cast<std::size_t>(kind)]; }

/// A face by its corners, counter-clockwise seen from outside of an upright cell.
struct CellFace {
    std::uint8_t count = 0; ///< 3 or 4
    std::array<std::uint8_t, 4> corners{};

    constexpr std::span<const std::uint8_t> all() const { return {corners.data(), count}; }
    /// A bit for each of its corners.
    constexpr std::uint32_t bits() const {
        std::uint32_t all_bits = 0;
        for (const std::uint8_t corner : all()) all_bits |= 1U << corner;
        return all_bits;
    }
};

struct CellShape {
    std::uint8_t face_count = 0;
    std::array<CellFace, 6> all_faces{};

    constexpr std::span<const CellFace> faces() const { return {all_faces.data(), face_count}; }
};

/// Corners as VTK numbers them. Its wedges have their first triangle outward.
inline constexpr std::array<CellShape, cell_kind_count> cell_shapes{
    CellShape{4, {{{3, {1, 2, 3}}, {3, {0, 3, 2}}, {3, {0, 1, 3}}, {3, {0, 2, 1}}}}},
    CellShape{5, {{{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}}},
    CellShape{5, {{{3, {0, 1, 2}}, {3, {5, 4, 3}}, {4, {0, 3, 4, 1}}, {4, {1, 4, 5, 2}}, {4, {2, 5, 3, 0}}}}},
    CellShape{6,
              {{{4, {0, 3, 2, 1}},
                {4, {4, 5, 6, 7}},
                {4, {0, 1, 5, 4}},
                {4, {1, 2, 6, 5}},
                {4, {2, 3, 7, 6}},
                {4, {3, 0, 4, 7}}}}}};

constexpr const CellShape& shape_of(CellKind kind) { return cell_shapes[static_cast<std::size_t>(kind)]; }

/// The edges of a kind: each once, its lower corner first, ascending.
struct CellEdges {
    std::uint8_t count = 0;
    std::array<std::array<std::uint8_t, 2>, 12> all_edges{};

    constexpr std::span<const std::array<std::uint8_t, 2>> all() const { return {all_edges.data(), count}; }
};

inline constexpr std::array<CellEdges, cell_kind_count> cell_edges = [] {
    std::array<CellEdges, cell_kind_count> out{};
    for (std::size_t kind = 0; kind < cell_kind_count; ++kind) {
        std::array<bool, 64> is_edge{};
        for (const CellFace& face : cell_shapes[kind].faces())
            for (std::size_t k = 0; k < face.count; ++k) {
                const std::size_t a = face.corners[k], b = face.corners[(k + 1) % face.count];
                is_edge[a < b ? 8 * a + b : 8 * b + a] = true;
            }
        for (std::size_t code = 0; code < is_edge.size(); ++code)
            if (is_edge[code])
                out[kind].all_edges[out[kind].count++] = {static_cast<std::uint8_t>(code / 8),
                                                          static_cast<std::uint8_t>(code % 8)};
    }
    return out;
}();

constexpr std::span<const std::array<std::uint8_t, 2>> edges_of(CellKind kind) {
    return cell_edges[static_cast<std::size_t>(kind)].all();
}

/// The order of corners that turns a cell inside out: position k of the mirrored cell has corner mirrored[k].
inline constexpr std::array<std::array<std::uint8_t, 8>, cell_kind_count> mirrored_corners{
    {{0, 1, 3, 2}, {0, 3, 2, 1, 4}, {3, 4, 5, 0, 1, 2}, {4, 5, 6, 7, 0, 1, 2, 3}}};

} // namespace isotet::core
