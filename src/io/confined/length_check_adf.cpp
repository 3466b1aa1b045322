// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ADF (CGNS): the header states the last byte of the file as a block of 4,096 bytes and a place in it: in hexadecimal, from
// version B on (CGNS 3) as binary numbers.
#include <charconv>

#include <fmt/core.h>

#include "io/confined/length_check.hpp"
#include "base/system/plain_file.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

namespace {

std::uint64_t adf_number(const char* bytes, std::size_t count, bool little) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[little ? count - 1 - i : i]);
    return value;
}

} // namespace

Result<void> check_adf_length(const std::string& path) {
    const auto file = core::open_plain_file(path);
    if (!file) return file.error();
    char header[186] = {};
    if (::pread(file->descriptor.number(), header, sizeof header, 0) != static_cast<ssize_t>(sizeof header)) return {};
    const std::string_view text(header, sizeof header);
    if (text.substr(4, 20) != "ADF Database Version" || text.substr(130, 4) != "AdF4") return {};
    std::uint64_t block = 0, offset = 0;
    const char* const end = header + 146; // behind the root node's place, which begins at 134
    if (text[25] == 'A') {
        const bool read = std::from_chars(end, end + 8, block, 16).ptr == end + 8 &&
                          std::from_chars(end + 8, end + 12, offset, 16).ptr == end + 12;
        if (!read) return broken(path, "the header of this ADF file does not say where the file ends");
    } else {
        const bool little = text[100] == 'L';
        block = adf_number(end, 8, little);
        offset = adf_number(end + 8, 4, little);
    }
    const std::uint64_t needed = block * 4096 + offset + 1;
    if (block > file->size / 4096 || needed > file->size)
        return broken(
            path, fmt::format("the file has {} bytes, but its header says {}: it is cut short", file->size, needed));
    return {};
}

} // namespace isotet::io::confined
