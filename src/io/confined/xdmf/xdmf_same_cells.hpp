// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids whose cells are those of another one on the same points, as mesh tags of dolfinx are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/confined/xdmf/xdmf_quadratic.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

/// A piece, and what it is.
struct NamedPiece {
    Piece piece;
    std::string name;
    std::string points; ///< equal where pieces have the same points
    std::shared_ptr<const TetEdges> edges = nullptr; ///< those of XdmfMesh
};

/// Gives a piece the fields of a later one all of whose cells it has, too, and drops that one. A cell that the later one
/// lacks has NaN.
void take_fields_of_same_cells(std::vector<NamedPiece>& pieces, std::vector<std::string>& notes);

} // namespace isotet::io::confined
