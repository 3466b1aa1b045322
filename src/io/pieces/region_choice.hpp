// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Parts of files that number the regions of their cells: physical groups of Gmsh, references of Medit, regions of TetGen.
#pragma once

#include <string_view>

#include <isotet/export.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Whether files of a format may number regions.
bool may_have_regions(std::string_view format);

/// The cell field that numbers the regions of a file; empty where its format has none.
std::string_view region_field(const FileInfo& info);

/// Keeps the cells of the regions that `options.blocks` name, the points that they use and what belongs to them, and
/// lists all regions in the file's blocks: of volumes, then of surfaces, whose names are those of the grid's patches. The
/// region field must have been read.
///
/// Errors   invalid_argument, with a list of the regions, when what is asked for is not there
/// Cost     one pass over the cells and a copy of what stays
ISOTET_API Result<void> choose_regions(ReadResult& result, const ReadOptions& options);

} // namespace isotet::io
