// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which reader takes a file: by the name of the format, else by the content of the file, else by its name.
#pragma once

#include <string>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/reader.hpp"

namespace isotet::io {

/// Picks the reader for a file. `options.format` overrules; else of the readers that know the content the one that also
/// knows the extension comes first, then those that know the extension only.
///
/// Errors   file: not there, not readable, empty, or of no known format: what was seen, and the formats that there are;
///          invalid_argument: options.format is not one of them
Result<const GridReader*> choose_reader(const std::string& path, const ReadOptions& options);

} // namespace isotet::io
