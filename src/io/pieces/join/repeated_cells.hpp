// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that several pieces have.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"
#include "io/pieces/join/point_numbers.hpp"

namespace isotet::io {

struct RepeatedCells {
    std::uint64_t left_out = 0;
    std::vector<std::size_t> pieces; ///< that have them, ascending
};

/// Solids are told apart by their points alone: a voxel may be a hexahedron. Of others the type tells, too.
std::uint64_t kind_for_repetition(std::uint8_t type);

/// Marks cells whose points are those of a cell of an earlier piece as left out (Piece::left_out).
///
/// `numbers`   of points in the joined grid
/// Errors      out_of_memory; cancelled
/// Cost        a pass over the cells of pieces that share points; 32 bytes for each cell all of whose points are shared
Result<RepeatedCells> leave_out_repeated(std::vector<Piece>& pieces, const PointNumbers& numbers,
                                         const Progress& progress);

} // namespace isotet::io
