// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Names come from files and may hold anything: here they are made fit for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace isotet::cli {

/// For people: bytes that are not UTF-8 and control characters become \xNN, characters that reorder or break lines
/// (U+0080 to U+009F, U+2028 to U+202E, U+2066 to U+2069) become \u{NNNN}, tab and newline \t and \n.
std::string printable(std::string_view text);

/// Options as the command line has them: "`merge_points` 0" becomes "--merge-points 0". Backquotes around anything but
/// small letters and underscores stay, and so does what stands in quotes, as names of fields: "no field 'a + `b`'".
std::string with_options(std::string_view sentence);

/// Characters of printable text, for aligning columns.
std::size_t width_of(std::string_view printable_text) noexcept;

/// Breaks a paragraph at spaces into lines of at most `columns`, each but the first indented by `indent` spaces.
std::string wrapped(std::string_view paragraph, std::size_t columns, std::size_t indent = 0);

} // namespace isotet::cli
