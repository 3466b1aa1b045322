// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "base/system/descriptor.hpp"

namespace isotet::core {

/// A plain file that is open for reading.
struct PlainFile {
    Descriptor descriptor;
    std::size_t size = 0; ///< bytes, at least one
};

/// Opens a file that is one: nothing that waits, or does something when it is opened.
///
/// Errors   file: not there, not readable, a folder, a pipe or a device, empty; machine; out_of_memory when it is larger
///          than what can be addressed
ISOTET_API Result<PlainFile> open_plain_file(const std::string& path);

/// Fills `to` with the bytes of the file from `at` on.
///
/// Errors   file: the file ends before, so it was cut short meanwhile; machine
ISOTET_API Result<void> read_at(const PlainFile& file, const std::string& path, std::size_t at, std::span<std::byte> to);

/// "PATH: cannot be read: REASON" for an errno.
ISOTET_API Error system_error(const std::string& path, std::string_view what, int number);

} // namespace isotet::core
