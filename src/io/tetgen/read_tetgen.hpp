// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// TetGen's .node and .ele files.
#pragma once

#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Tells what the two files hold: point fields `attribute_0`, `attribute_1` ..., `boundary_marker` (int32), and cell
/// fields `region_0`, `region_1` ..., the attributes of the tets.
Result<FileInfo> inspect_tetgen(std::string_view nodes, std::string_view elements, const Progress& progress);

/// Reads the points of a .node file and the tets of the .ele file that goes with it.
///
/// Points are numbered as the .node file says, from 0, from 1 or otherwise. Tets of 10 nodes come as quadratic ones.
/// What a line holds beyond what the header announces is passed over.
///
/// Errors   invalid_data: a rule of the format broken, with file, value and rule
Result<ReadResult> parse_tetgen(std::string_view nodes, std::string_view elements, const ReadOptions& options,
                                const Progress& progress);

} // namespace isotet::io
