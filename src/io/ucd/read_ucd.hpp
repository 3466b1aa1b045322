// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// AVS UCD, ascii and binary.
#pragma once

#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// True for the first bytes of such a file: a line of five whole numbers, behind empty lines and comments; or of a binary one.
bool looks_like_ucd(std::string_view head);

/// Tells the fields; looks through the whole file.
Result<FileInfo> inspect_ucd(std::string_view text, const Progress& progress);

/// Reads all cells, and their materials as a cell field; fields become float64, those of binary files
/// float32.
///
/// Errors   invalid_data: a rule of the format broken, with place, value and rule
Result<ReadResult> parse_ucd(std::string_view text, const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
