// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What readers of files in pieces give, before the pieces are joined to one grid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/pieces/cell_source.hpp"
#include "io/pieces/field_source.hpp"

namespace isotet::io {

/// One part of a grid: a block, a zone, a file of a parallel run.
struct Piece {
    std::string name; ///< for messages
    Grid grid;
    Array point_ids;                    ///< empty, or a global number for each point
    Array cell_ids;                     ///< empty, or a global number for each cell
    std::vector<std::uint8_t> left_out; ///< empty, or nonzero for each ghost or blanked cell
    /// Of a structured grid: first and last point along each axis, as the file numbers them.
    std::optional<std::array<std::int64_t, 6>> extent = {};
    std::string flat = {}; ///< of a structured grid without cells that have a volume: "a plane of 3 x 4 points"
    std::shared_ptr<const CellSource> unread = {}; ///< the cells, where `grid` does not have them yet
    std::vector<UnreadField> unread_fields = {};   ///< then, in place of its cell fields

    std::uint64_t cell_count() const { return unread ? unread->count() : grid.cells.count(); }
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

/// Adds to FileInfo::left_out unless it is there with the same reason; read() makes notes of it.
ISOTET_API void leave_out(FileInfo& info, LeftOut item);

/// Adds the counts of another part of the grid. Of different coordinates the narrower ones count.
ISOTET_API void add(LeastCounts& all, const LeastCounts& part);

/// Makes the pieces of `part` further ones of `whole`, with its fields, files and notes.
void append(Loaded& whole, Loaded part);

ISOTET_API Error broken(const std::string& path, std::string_view what);

/// An error about content, with the path of its file in front; others as they are.
ISOTET_API Error in_file(const std::string& path, const Error& error);

} // namespace isotet::io
