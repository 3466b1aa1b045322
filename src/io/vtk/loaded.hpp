// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the readers in the reader process give, before pieces are joined to one grid. VTK is not seen here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io::vtk {

/// One part of a grid: a block, a zone, a file of a parallel run.
struct Piece {
    std::string name;  ///< for messages
    Grid grid;
    Array point_ids;   ///< empty, or a global number for each point
    Array cell_ids;    ///< empty, or a global number for each cell
    std::vector<std::uint8_t> left_out; ///< empty, or nonzero for each ghost or blanked cell
};

struct Loaded {
    FileInfo info;
    std::size_t step = 0;
    std::vector<Piece> pieces;
    std::vector<std::string> notes;
};

/// How far to read: what the file holds, or its grid too.
enum class Depth { description, arrays };

/// One format, in the reader process.
using Load = Result<Loaded> (*)(const std::string& path, const ReadOptions& options, Depth depth);

struct FileLoader {
    std::string_view format;
    Load load;
};

/// The loader of a format, or null.
Load loader_of(std::string_view format);

/// Adds a field to the description unless it is there.
void announce(FileInfo& info, FieldInfo field);

Error broken(const std::string& path, std::string_view what);

} // namespace isotet::io::vtk
