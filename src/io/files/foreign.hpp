// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of other programs that isotet does not read, but is often given.
#pragma once

#include <string_view>

namespace isotet::io {

/// What such a file is and what to do with it, to stand behind its name; empty for all others.
///
/// `head`        its first bytes; of a folder none
/// `extension`   in small letters, with its dot
std::string_view foreign_file(std::string_view head, std::string_view extension);

/// The same of files that tell it by their first bytes.
std::string_view foreign_content(std::string_view head, std::string_view extension);

} // namespace isotet::io
