// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// File descriptors 0, 1 and 2, which a hostile or careless parent may have closed, and checked writing to the last two.
#pragma once

#include <string_view>

#include <isotet/result.hpp>

namespace isotet::cli {

/// Opens /dev/null in place of each standard stream that is closed, so that no file opened later gets its number and is
/// written into by a message.
void open_missing_streams();

/// True when standard output was closed when the program started: what is written there goes nowhere.
bool stdout_was_closed() noexcept;

/// Writes all of `text`. Errors: machine, when it cannot be written (a full disk, a reader that went away).
Result<void> write_to_stdout(std::string_view text);

/// Writes what it can of `text`: there is nowhere left to complain.
void write_to_stderr(std::string_view text) noexcept;

bool stderr_is_terminal() noexcept;

} // namespace isotet::cli
