// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <isotet/export.hpp>

namespace isotet::io {

/// Control characters, line ends too, and bytes that are not ASCII or UTF-8 as \x.., so that the content of a file
/// cannot write to the user's terminal. Runs of line ends become one space.
ISOTET_API std::string escaped(std::string_view text);

} // namespace isotet::io
