// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of an Exodus file: those of its blocks, one after another.
#pragma once

#include <memory>
#include <string>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/confined/exodus/exodus_file.hpp"
#include "io/pieces/cell_source.hpp"

namespace isotet::io::confined {

/// `path`     for errors
/// Errors   invalid_data: what is missing or does not fit; nodes that are not there
Result<Cells> read_exodus_cells(ExodusFile& file, const std::string& path);

/// Cells that stay in the file; null where they are not linear, or not all of their nodes are read.
std::shared_ptr<const CellSource> unread_exodus_cells(const std::shared_ptr<ExodusFile>& file, const std::string& path);

} // namespace isotet::io::confined
