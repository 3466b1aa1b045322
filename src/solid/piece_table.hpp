// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The pieces of cells that one isovalue crosses, by which of their corners are inside: made once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solid/cell_pieces.hpp"

namespace isotet::solid {

/// No corner is tied.
struct PieceCase {
    CellPieces exact; ///< the isosurface as triangles
    CellPieces flat;  ///< loops of four vertices as quadrilaterals
    std::vector<std::array<std::uint8_t, 2>> edges; ///< that are crossed: lower corner first
};

/// `inside`     the sum over corners k inside of 2^k
/// `of_upper`   the others are above, not below
const PieceCase& piece_case(core::CellKind kind, unsigned inside, bool of_upper);

} // namespace isotet::solid
