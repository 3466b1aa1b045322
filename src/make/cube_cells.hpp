// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells that one cube of the lattice is divided into, as tables of corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <isotet/grid.hpp>

namespace isotet::make {

/// Cells of one cube. Corners are numbered x + 2 y + 4 z; 8 is the centre. In VTK's order all cells are upright.
struct CubeCells {
    std::span<const std::uint8_t> corners; ///< of all cells, one after another
    std::span<const CellType> types;       ///< one a cell
};

namespace tables {

/// Kuhn 1960: a tet for each order in which a path from corner 0 to corner 7 can take the three axes. All six share the
/// diagonal, and each face of the cube is cut from its lowest corner to its highest, so neighbours agree.
inline constexpr std::array<std::uint8_t, 24> kuhn{0, 1, 3, 7, 0, 2, 6, 7, 0, 4, 5, 7,
                                                   0, 3, 2, 7, 0, 5, 1, 7, 0, 6, 4, 7};
inline constexpr std::array<std::uint8_t, 8> hex{0, 1, 3, 2, 4, 5, 7, 6};
/// Cut along the planes x = y; the triangles, below and above, are cut as `kuhn` cuts them.
inline constexpr std::array<std::uint8_t, 12> wedge{0, 1, 3, 4, 5, 7, 0, 3, 2, 4, 7, 6};
/// Each face of the cube with the centre: -z, +z, -y, +y, -x, +x.
inline constexpr std::array<std::uint8_t, 30> pyramid{0, 1, 3, 2, 8, 4, 6, 7, 5, 8, 0, 4, 5, 1, 8,
                                                      2, 3, 7, 6, 8, 0, 2, 6, 4, 8, 1, 5, 7, 3, 8};
/// As `pyramid`, the face +z cut as `wedge` cuts it.
inline constexpr std::array<std::uint8_t, 33> cut_above{0, 1, 3, 2, 8, 4, 6, 7, 8, 4, 7, 5, 8, 0, 4, 5, 1,
                                                        8, 2, 3, 7, 6, 8, 0, 2, 6, 4, 8, 1, 5, 7, 3, 8};
/// As `pyramid`, the face -z cut as `wedge` cuts it.
inline constexpr std::array<std::uint8_t, 33> cut_below{0, 1, 3, 8, 0, 3, 2, 8, 4, 6, 7, 5, 8, 0, 4, 5, 1,
                                                        8, 2, 3, 7, 6, 8, 0, 2, 6, 4, 8, 1, 5, 7, 3, 8};

/// The nodes of VTK's quadratic tetrahedron, each in the middle of two corners (of the same for a corner).
inline constexpr std::array<std::array<std::uint8_t, 2>, 10> quadratic_tet{
    {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
/// The nodes of VTK's triquadratic hexahedron, in half edges.
inline constexpr std::array<std::array<std::uint8_t, 3>, 27> triquadratic{
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0},
     {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1},
     {2, 2, 1}, {0, 2, 1}, {0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}, {1, 1, 1}}};

inline constexpr auto t = CellType::tetrahedron, h = CellType::hexahedron, w = CellType::wedge, p = CellType::pyramid;
inline constexpr std::array<CellType, 6> kuhn_types{t, t, t, t, t, t};
inline constexpr std::array<CellType, 1> hex_types{h};
inline constexpr std::array<CellType, 2> wedge_types{w, w};
inline constexpr std::array<CellType, 6> pyramid_types{p, p, p, p, p, p};
inline constexpr std::array<CellType, 7> cut_above_types{p, t, t, p, p, p, p};
inline constexpr std::array<CellType, 7> cut_below_types{t, t, p, p, p, p, p};

} // namespace tables

inline constexpr CubeCells kuhn_cube{tables::kuhn, tables::kuhn_types};
inline constexpr CubeCells hex_cube{tables::hex, tables::hex_types};
inline constexpr CubeCells wedge_cube{tables::wedge, tables::wedge_types};
inline constexpr CubeCells pyramid_cube{tables::pyramid, tables::pyramid_types};

/// The layers of a mixed grid from below, over and over: hexahedra; pyramids with their upper face cut into tets;
/// wedges; pyramids with their lower face cut. So quads meet quads and triangles meet triangles, whatever the number of
/// layers.
inline constexpr std::array<CubeCells, 4> mixed_layers{hex_cube, CubeCells{tables::cut_above, tables::cut_above_types},
                                                       wedge_cube,
                                                       CubeCells{tables::cut_below, tables::cut_below_types}};

/// True when a cell of the cube uses its centre point.
constexpr bool uses_centre(const CubeCells& cube) noexcept {
    for (const std::uint8_t corner : cube.corners)
        if (corner == 8) return true;
    return false;
}

} // namespace isotet::make
