// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The part of one cell that lies between two isovalues, as cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/cell/cell_kind.hpp"

namespace isotet::solid {

/// A corner's value against the two isovalues.
enum class CornerState : std::uint8_t {
    below,
    at_lower, ///< inside
    inside,
    at_upper, ///< not inside
    above
};

/// A vertex of a piece, as a code: 9 k is corner k; 8 a + b with a < b is where the lower isovalue crosses the edge between
/// two corners, 64 more where the upper one does; 128 + 8 f + i is the vertex inside part i of face f.
using PieceVertex = std::uint8_t;
inline constexpr PieceVertex upper_cut = 64, inside_face = 128;

constexpr bool is_corner(PieceVertex vertex) { return vertex < upper_cut && vertex % 9 == 0; }

/// Counter-clockwise seen from outside.
struct PieceFace {
    std::array<PieceVertex, 12> vertices{};
    std::uint8_t count = 0;

    std::span<const PieceVertex> all() const { return {vertices.data(), count}; }
    std::span<PieceVertex> all() { return {vertices.data(), count}; }
};

/// A tetrahedron, pyramid, wedge, hexahedron, or a polyhedron.
struct CellPiece {
    std::uint8_t type = 0;             ///< VTK's
    std::vector<PieceVertex> vertices; ///< in VTK's order, of a wedge the first triangle inward; of a polyhedron each once
    std::vector<PieceFace> faces;      ///< of a polyhedron only
};

struct CellToCut {
    core::CellKind kind = core::CellKind::tetrahedron;
    std::array<CornerState, 8> states{};
    std::array<std::uint8_t, 8> same{0, 1, 2, 3, 4, 5, 6, 7}; ///< the lowest corner at the same point
    std::array<bool, 6> has_fans{};       ///< faces whose parts are fans around a vertex inside each
    std::array<std::uint8_t, 6> start{};  ///< corners by which their parts are numbered (for_parts())
};

/// Faces on the isosurface.
enum class IsosurfaceFaces : std::uint8_t {
    triangles, ///< those of the isosurface
    flat       ///< loops of four vertices as one quadrilateral
};

struct CellPieces {
    std::vector<CellPiece> pieces;
    std::vector<std::array<PieceVertex, 4>> quadrilaterals; ///< on the isosurface, with IsosurfaceFaces::flat
    std::uint32_t flat = 0;                                 ///< pieces without a volume, left out
};

/// The pieces of an upright cell. The polygons of its faces are those of for_parts(), and the isosurface's triangles those of
/// its case tables. What hangs together along edges is one piece.
///
/// At ties edges end in their corner: so faces may vanish, and a piece whose vertices are all corners of one face has no
/// volume. Where triangles would then meet in an edge that is in four faces, whole loops are the faces.
CellPieces pieces_of(const CellToCut& cell, IsosurfaceFaces faces);

} // namespace isotet::solid
