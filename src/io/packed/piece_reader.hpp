// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pieces of a packed file, read straight into the arrays that they are parts of.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "base/system/plain_file.hpp"
#include "io/packed/chunk_places.hpp"
#include "io/packed/format.hpp"

namespace isotet::io {

/// An open packed file.
struct PackedSource {
    std::string path;
    core::PlainFile file;
    PackedDirectory directory;
    DirectorySlot slot;         ///< that holds
    std::size_t slot_place = 0; ///< the first or the second
    std::uint16_t minor = 0;    ///< version of the writer that began the file
    mutable std::atomic<std::uint64_t> bytes_read{0}, reads{0};

    /// Reads header and directory.
    /// Errors   as PackedFile::open()
    static Result<std::shared_ptr<const PackedSource>> open(const std::string& path);

    /// Errors   file: cut short, cannot be read
    Result<void> read(std::uint64_t at, std::span<std::byte> to) const;

    /// With the file's name before the message of an error about data.
    Error in_file(Error error) const;
};

/// An array of which each chunk has a part.
struct ChunkedArray {
    std::byte* data = nullptr;
    std::size_t bytes_each = 0; ///< of a point, word, link word or group
    Unit unit = Unit::points;
};

/// Pieces of one kind, one a chunk: parts of arrays one after another.
struct PieceKind {
    std::vector<ChunkedArray> arrays;
    std::vector<std::uint64_t> offsets; ///< in the file, a chunk
    std::function<std::uint32_t(std::size_t chunk)> checksum;
    std::function<Result<void>(std::size_t chunk)> check = {}; ///< of the numbers, once they are there
    std::function<void(std::size_t chunk)> fill =
        {}; ///< instead of all these where pieces are not read, but made of others

    std::uint64_t bytes(const PackedDirectory& directory, std::size_t chunk) const;
    std::span<std::byte> part(const PackedDirectory& directory, const ChunkPlaces& places, std::size_t array,
                              std::size_t chunk) const;
};

struct PieceWish {
    const PieceKind* kind;
    std::size_t chunk;
};

/// Reads pieces, several side by side at once, on all threads, and checks them.
/// Errors   file; invalid_data: a checksum differs, or numbers break a rule; cancelled
Result<void> read_pieces(const PackedSource& source, const ChunkPlaces& places, std::vector<PieceWish> wishes,
                         const Progress& progress);

/// The table of clusters with numbers by `places`.
/// Errors   as read_pieces()
Result<core::SharedBuffer<core::ClusterHeader>> read_headers(const PackedSource& source, const ChunkPlaces& places,
                                                             const Progress& progress);

/// Ranges and has_no_data of a field into a packed grid.
/// Errors   as read_pieces()
Result<void> read_ranges(const PackedSource& source, const FieldEntry& field, core::Packed& packed,
                         const Progress& progress);

} // namespace isotet::io
