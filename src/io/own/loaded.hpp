// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What readers of files in pieces give, before the pieces are joined to one grid.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// One part of a grid: a block, a zone, a file of a parallel run.
struct Piece {
    std::string name; ///< for messages
    Grid grid;
    Array point_ids;                                 ///< empty, or a global number for each point
    Array cell_ids;                                  ///< empty, or a global number for each cell
    std::vector<std::uint8_t> left_out;              ///< empty, or nonzero for each ghost or blanked cell
    std::optional<std::uint64_t> cells_in_file = {}; ///< where the grid has only active cells
};

struct Loaded {
    FileInfo info;
    std::size_t step = 0;
    std::vector<Piece> pieces;
    std::vector<std::string> notes;
};

/// How far to read: what the file holds, or its grid too.
enum class Depth { description, arrays };

/// Adds a field to the description unless it is there.
ISOTET_API void announce(FileInfo& info, FieldInfo field);

ISOTET_API Error broken(const std::string& path, std::string_view what);

} // namespace isotet::io
