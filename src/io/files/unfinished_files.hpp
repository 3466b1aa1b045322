// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The files that are being written under temporary names, for a program that ends at once.
#pragma once

#include <string>

namespace isotet::io {

/// Of names longer than 63 bytes, and of more files than 64 at a time, nothing is noted.
void note_unfinished_file(int folder, const std::string& name) noexcept;
void forget_unfinished_file(int folder, const std::string& name) noexcept;

} // namespace isotet::io
