// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the parts of each chunk are, in arrays and in the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/packed/format.hpp"

namespace isotet::io {

/// Numbers of the first point, word, link word and group of each chunk.
struct ChunkPlaces {
    std::vector<std::uint64_t> first_cluster;                 ///< one more than there are chunks
    std::array<std::vector<std::uint64_t>, unit_count> first; ///< by Unit; one more than there are chunks

    std::uint64_t of(Unit unit, std::size_t chunk) const { return first[static_cast<std::size_t>(unit)][chunk]; }
    std::uint64_t size(Unit unit) const { return first[static_cast<std::size_t>(unit)].back(); }
    std::size_t chunk_of(std::uint32_t cluster) const;

    /// One chunk right behind the other, as packing has them.
    static ChunkPlaces compact(const PackedDirectory& directory);

    /// Each chunk begins on a page of its own in every array, so that it comes and goes by itself.
    static ChunkPlaces on_pages(const PackedDirectory& directory, std::size_t page);
};

/// Where pieces begin in the file, by chunk.
struct PieceOffsets {
    std::vector<std::uint64_t> points, topology;

    explicit PieceOffsets(const PackedDirectory& directory);
};
std::vector<std::uint64_t> positions_offsets(const PackedDirectory& directory, const PointsEntry& points);
std::vector<std::uint64_t> values_offsets(const PackedDirectory& directory, const FieldEntry& field);

} // namespace isotet::io
