// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that are not linear; VTK's curved cell types that have one number of nodes.
#pragma once

#include <array>
#include <cstdint>

#include <isotet/grid.hpp>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

struct CurvedType {
    std::uint8_t type; ///< vtkCellType.h
    CellKind kind;     ///< of its corners
    std::uint8_t nodes;
};

inline constexpr std::array<CurvedType, 9> curved_types{{{24, CellKind::tetrahedron, 10},
                                                         {25, CellKind::hexahedron, 20},
                                                         {26, CellKind::wedge, 15},
                                                         {27, CellKind::pyramid, 13},
                                                         {29, CellKind::hexahedron, 27},
                                                         {31, CellKind::wedge, 12},
                                                         {32, CellKind::wedge, 18},
                                                         {33, CellKind::hexahedron, 24},
                                                         {37, CellKind::pyramid, 19}}};

} // namespace isotet::core

namespace isotet {

/// True when some cells are polyhedra with faces, or prisms of five or six sides.
bool has_polyhedra(const Cells& cells);

} // namespace isotet
