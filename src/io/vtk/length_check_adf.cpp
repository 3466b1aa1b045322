// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ADF (CGNS): the header states the last byte of the file as a block of 4,096 bytes and a place in it, in hexadecimal.
#include <charconv>

#include <fmt/core.h>

#include "io/own/loaded.hpp"
#include "io/own/plain_file.hpp"
#include "io/vtk/length_check.hpp"

namespace isotet::io::vtk {

Result<void> check_adf_length(const std::string& path) {
    const auto file = open_plain_file(path);
    if (!file) return file.error();
    char header[186] = {};
    if (::pread(file->descriptor.number(), header, sizeof header, 0) != static_cast<ssize_t>(sizeof header)) return {};
    const std::string_view text(header, sizeof header);
    if (text.substr(4, 20) != "ADF Database Version" || text.substr(130, 4) != "AdF4") return {};
    std::uint64_t block = 0, offset = 0;
    const char* const end = header + 146; // behind the root node's place, which begins at 134
    const bool read = std::from_chars(end, end + 8, block, 16).ptr == end + 8 &&
                      std::from_chars(end + 8, end + 12, offset, 16).ptr == end + 12;
    if (!read) return broken(path, "the header of this ADF file does not say where the file ends");
    const std::uint64_t needed = block * 4096 + offset + 1;
    if (needed > file->size)
        return broken(
            path, fmt::format("the file has {} bytes, but its header says {}: it is cut short", file->size, needed));
    return {};
}

} // namespace isotet::io::vtk
