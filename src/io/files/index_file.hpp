// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that name other files: what they may name.
#pragma once

#include <string>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Refuses a name in an index file that is a URL, absolute, or climbs out of the folder with "..", unless
/// `allow_outside`.
ISOTET_API Result<void> check_name(const std::string& index, std::string_view name, bool allow_outside);

/// The path of a file that an index file names, relative to the folder of the index; where there is none of the name,
/// backslashes are slashes. Links are followed before it is judged whether it lies below that folder.
///
/// Errors   file when it is not there or no plain file; invalid_data when it may not be named, or is the index itself
ISOTET_API Result<std::string> named_file(const std::string& index, std::string_view name, bool allow_outside);

} // namespace isotet::io
