// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What packed arrays from a file must hold to, so that nothing reads out of bounds, whatever is in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/result.hpp>

#include "io/packed/chunk_places.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::io {

/// The headers of a chunk's clusters.
/// Errors   invalid_data: counts beyond what a cluster may have, or that do not add up to the chunk's
Result<void> decode_headers(std::span<const std::byte> records, const ChunkEntry& chunk, const ChunkPlaces& places,
                            std::size_t chunk_number, core::ClusterHeader* out);

/// A chunk of clusters, whose first points, words and links are `points`, `words` and `links`.
struct ChunkRange {
    std::uint64_t first_cluster, clusters, first_point, points, first_word, words;
};
ChunkRange chunk_range(const PackedDirectory& directory, const ChunkPlaces& places, std::size_t chunk);

constexpr double largest_position = 2 * core::stored_infinity; ///< relative to the origin

/// Positions and the user's numbers.
Result<void> check_points(const core::Packed& packed, const ChunkRange& chunk);

/// Positions alone.
Result<void> check_positions(const core::Packed& packed, const ChunkRange& chunk);

/// Corners, neighbours, ghost points and seams. Needs all headers.
Result<void> check_topology(const core::Packed& packed, const ChunkRange& chunk);

/// Values of points: within the range of their cluster. Needs all headers and ranges.
Result<void> check_values(const core::Packed& packed, const ChunkRange& chunk);

/// The range of a cluster against the values of all its points, and owners of its seams, whose ranges hold the values at
/// both ends. Needs cells, links and the points of neighbours.
Result<void> check_ranges(const core::Packed& packed, std::uint32_t cluster);

} // namespace isotet::io
