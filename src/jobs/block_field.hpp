// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers of blocks as a cell field, of files that have blocks but no such field.
#pragma once

#include <string_view>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

inline constexpr std::string_view block_field_name = "block";

/// Whether the file has two blocks or more with different numbers, which its reader gives one after another and which have
/// all cells, and no cell field of this name. Not of regions, groups, sets and zones of cells, which may overlap, nor of the
/// parts of a split Exodus file, each of which has cells of all blocks.
bool has_block_field(const FileInfo& info);

/// Of blocks that have one.
std::vector<RegionName> names_of_blocks(const FileInfo& info);

/// Adds the field to a grid of such a file.
///
/// Errors   invalid_data: the grid does not have as many cells as the blocks, as where ghost cells were dropped
Result<void> add_block_field(Grid& grid, const std::vector<BlockInfo>& blocks);

} // namespace isotet::jobs
