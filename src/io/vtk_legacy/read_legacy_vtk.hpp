// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK files as a reader of isotet::read().
#pragma once

#include <string>

#include "io/files/byte_source.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io {

GridReader legacy_vtk_reader();

/// Reads a grid, as one piece, from a file or memory.
///
/// `path`   where the file can be opened again, for cells that are read later; empty: all are read now
/// Errors   invalid_data: polygon data; as read_legacy_vtk(); cancelled
Result<Loaded> load_legacy(const ByteSource& source, const ReadOptions& options, Depth depth, const Progress& progress,
                           const std::string& path = {});

/// The same of a file, whose path its errors and its piece name.
Result<Loaded> load_legacy_file(const std::string& path, const ReadOptions& options, Depth depth,
                                const Progress& progress);

} // namespace isotet::io
