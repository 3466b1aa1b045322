// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Rows of a data set at their places in an HDF5 file: read and inflated without HDF5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <hdf5.h>

#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io::confined {

/// Which rows of a data set.
struct RowRange {
    std::uint64_t first = 0, rows = 0;
    std::size_t columns = 1, scalar = 1; ///< scalar: bytes

    std::uint64_t row_bytes() const { return columns * scalar; }
    std::uint64_t end() const { return first + rows; }
};

struct StoredChunk {
    std::uint64_t row = 0, column = 0; ///< its first ones
    std::uint64_t address = 0, bytes = 0;
};

/// How a data set is cut, and what was done to each chunk.
struct ChunkShape {
    std::uint64_t rows = 1, columns = 1;
    bool deflated = false, shuffled = false;
};

/// Threads   safe from many threads, but for find(): that asks HDF5
class StoredRows {
public:
    /// Nothing where HDF5 has to read them: filled in, with another filter, stored elsewhere.
    ///
    /// `source`   the file, whose places are those that HDF5 gives
    static std::optional<StoredRows> find(hid_t data, hid_t creation, int rank, const ByteSource& source,
                                          const RowRange& range);

    /// Rows [begin, end) of the data set.
    ///
    /// Errors   invalid_data: they are not there, or cannot be inflated; as ByteSource::read()
    Result<void> read(std::uint64_t begin, std::uint64_t end, std::byte* to) const;

    /// Calls work(begin, end) for all rows, some `bytes` of them at a time, in parallel. Each chunk is in one call.
    ///
    /// Errors   the first that work() returns
    using Work = std::function<Result<void>(std::uint64_t begin, std::uint64_t end)>;
    Result<void> each_stretch(std::size_t bytes, const Work& work) const;

private:
    StoredRows(const ByteSource& source, const RowRange& range) : source_(source), range_(range) {}
    Result<void> read_chunk(const StoredChunk& chunk, std::uint64_t begin, std::uint64_t end, std::byte* to) const;
    Result<void> decode(const StoredChunk& chunk, std::span<std::byte> to) const;

    ByteSource source_;
    RowRange range_;
    std::uint64_t address_ = 0;         ///< of the first row of the data set, where there are no chunks
    std::optional<ChunkShape> shape_;
    std::vector<StoredChunk> chunks_; ///< by row, then by column
};

} // namespace isotet::io::confined
