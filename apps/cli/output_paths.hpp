// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Looks at the files that a command shall write before it starts to work for them.
#pragma once

#include <string>
#include <vector>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::cli {

/// The format that the ending of `path` names. Errors: invalid_argument with the endings that there are.
enum class Writes { grid, surface };
Result<Format> format_for_writing(const std::string& path, Writes what);

/// Refuses an output that is one of the inputs (the same file, however it is spelled), two outputs that are one file,
/// and an output that cannot be written at all. Empty names and "-" are passed over.
Result<void> check_output_paths(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// True when both names lead to the same file, or would once it is there.
bool same_file(const std::string& a, const std::string& b);

} // namespace isotet::cli
