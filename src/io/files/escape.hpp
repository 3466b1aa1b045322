// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <isotet/export.hpp>

namespace isotet::io {

/// Bytes of the UTF-8 character at the start of `text`; 0 where there is none, or a control character.
std::size_t printable_length(std::string_view text);

/// Control characters, line ends too, and bytes that are not ASCII or UTF-8 as \x.., so that the content of a file
/// cannot write to the user's terminal. Runs of line ends become one space.
ISOTET_API std::string escaped(std::string_view text);

} // namespace isotet::io
