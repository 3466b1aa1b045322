// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::cli {

/// Writes a text as a file: whole, or not at all.
Result<void> write_text_file(const std::string& path, std::string_view text, const Progress& progress);

} // namespace isotet::cli
