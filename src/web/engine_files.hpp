// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the two modules of the engine for other pages differ in: one has readers.
#pragma once

#include <string>

#include <isotet/read.hpp>

namespace isotet::web {

/// Errors   as isotet::read(); invalid_argument in the module without readers
Result<ReadResult> read_grid_file(const std::string& path, const ReadOptions& options, const Run& run);

} // namespace isotet::web
