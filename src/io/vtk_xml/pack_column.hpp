// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A column as compressed arrays of VTK's XML files have it: blocks that are packed one by one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/write/write_stream.hpp"

namespace isotet::io {

struct PackedColumn {
    std::uint64_t block_bytes = 0, last_bytes = 0; ///< unpacked: of each block, and of the last one where that is less
    std::vector<std::string> blocks;

    /// In the file: how many blocks, their sizes, the blocks.
    std::uint64_t bytes() const;
    void write(WriteStream& stream) const;
};

/// Packs in parallel. Whether all was packed before a cancel, `progress` tells.
PackedColumn pack_column(const Column& column, Compression compression, const Progress& progress);

} // namespace isotet::io
