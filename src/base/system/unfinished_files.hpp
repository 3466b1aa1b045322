// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The files that are being written under temporary names, for a program that ends at once.
#pragma once

#include <string>

#include <isotet/export.hpp>

namespace isotet::core {

/// Of names longer than 63 bytes, and of more files than 64 at a time, nothing is noted.
ISOTET_API void note_unfinished_file(int folder, const std::string& name) noexcept;
ISOTET_API void forget_unfinished_file(int folder, const std::string& name) noexcept;
/// Removes all that are noted; a signal handler may call it.
ISOTET_API void remove_noted_files() noexcept;

} // namespace isotet::core
