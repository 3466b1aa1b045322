// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Reading parts of a file: which of its blocks are asked for, and what they leave of a grid.
#pragma once

#include <vector>

#include <isotet/export.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io {

/// One flag a block: whether the options ask for it. All of them when they ask for none.
///
/// A block is asked for by its name, by the last part of it ("Zone" of "Base/Zone"), by what stands before one of its
/// slashes ("Base"), or by its number where no name fits.
///
/// Errors   invalid_argument, with a list of the blocks, when what is asked for is not there
ISOTET_API Result<std::vector<bool>> chosen_blocks(const std::vector<BlockInfo>& blocks, const ReadOptions& options);

/// Adds a block to the description; one with the same number and name only counts more cells.
ISOTET_API void announce_block(FileInfo& info, const BlockInfo& block);

/// Keeps the points that a cell uses, in their order, and what belongs to them.
ISOTET_API void drop_unused_points(Piece& piece);

/// Keeps the cells that are not marked as left out, the points that they use, and what belongs to both.
///
/// Errors   as join(): arrays that do not fit
ISOTET_API Result<void> drop_left_out_cells(Piece& piece);

} // namespace isotet::io
