// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// HDF5: the superblock states where the file ends. (The library checks this, too, but some readers ignore it.)
#include <algorithm>

#include <fmt/core.h>

#include "io/confined/length_check.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

Result<void> check_hdf5_length(const ByteSource& file, const std::string& path) {
    Scratch scratch;
    const auto head = file.view(0, std::min<std::size_t>(file.size(), 64), scratch);
    if (!head) return head.error();
    const std::string_view bytes = *head;
    if (!bytes.starts_with("\x89HDF\r\n\x1a\n")) return {};
    const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u; };
    // Versions 0 and 1 have the size of a place at byte 13, 2 and 3 at byte 9; base, another place, then the end.
    const unsigned version = byte(8);
    const unsigned size = byte(version < 2 ? 13 : 9);
    const std::size_t first = version == 0 ? 24 : version == 1 ? 28 : 12;
    if (version > 3 || (size != 4 && size != 8)) return broken(path, "its HDF5 superblock is broken");
    std::uint64_t end = 0;
    for (unsigned i = 0; i < size; ++i) end |= std::uint64_t(byte(first + 2 * size + i)) << (8 * i);
    if (end > file.size())
        return broken(path,
                      fmt::format("the file has {} bytes, but its header says {}: it is cut short", file.size(), end));
    return {};
}

} // namespace isotet::io::confined
