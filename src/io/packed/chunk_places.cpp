// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/chunk_places.hpp"

#include <algorithm>

namespace isotet::io {

namespace {

/// `unit_steps`  by Unit: chunks begin at multiples, `slack` behind the end of the one before
ChunkPlaces chunk_places(const PackedDirectory& directory, const std::array<std::uint64_t, unit_count>& unit_steps,
                         std::uint64_t slack) {
    ChunkPlaces places;
    std::array<std::uint64_t, unit_count> next{};
    std::uint64_t cluster = 0;
    for (const ChunkEntry& chunk : directory.chunks) {
        places.first_cluster.push_back(cluster);
        cluster += chunk.clusters;
        for (std::size_t u = 0; u < unit_count; ++u) {
            places.first[u].push_back(next[u]);
            const std::uint64_t end = next[u] + chunk.counts[u] + slack;
            next[u] = (end + unit_steps[u] - 1) / unit_steps[u] * unit_steps[u];
        }
    }
    places.first_cluster.push_back(cluster);
    for (std::size_t u = 0; u < unit_count; ++u) places.first[u].push_back(next[u]);
    return places;
}

} // namespace

std::size_t ChunkPlaces::chunk_of(std::uint32_t cluster) const {
    const auto after = std::upper_bound(first_cluster.begin(), first_cluster.end(), cluster);
    return static_cast<std::size_t>(after - first_cluster.begin()) - 1;
}

ChunkPlaces ChunkPlaces::compact(const PackedDirectory& directory) { return chunk_places(directory, {1, 1, 1, 1}, 0); }

ChunkPlaces ChunkPlaces::on_pages(const PackedDirectory& directory, std::size_t page) {
    // The smallest number of an array has 4 bytes, a group 2.
    return chunk_places(directory, {page / 4, page / 4, page / 4, page / 2}, core::slack_words);
}

PieceOffsets::PieceOffsets(const PackedDirectory& directory) {
    std::uint64_t next = directory.chunks_offset;
    for (const ChunkEntry& chunk : directory.chunks) {
        points.push_back(next);
        next += align_piece(directory.points_bytes(chunk));
        topology.push_back(next);
        next += align_piece(directory.topology_bytes(chunk));
    }
}

std::vector<std::uint64_t> positions_offsets(const PackedDirectory& directory, const PointsEntry& points) {
    std::vector<std::uint64_t> offsets;
    std::uint64_t next = points.offset;
    for (const ChunkEntry& chunk : directory.chunks) {
        offsets.push_back(next);
        next += align_piece(directory.positions_bytes(chunk));
    }
    return offsets;
}

std::vector<std::uint64_t> values_offsets(const PackedDirectory& directory, const FieldEntry& field) {
    std::vector<std::uint64_t> offsets;
    std::uint64_t next = field.values_offset;
    for (const ChunkEntry& chunk : directory.chunks) {
        offsets.push_back(next);
        next += align_piece(directory.values_bytes(chunk, field));
    }
    return offsets;
}

} // namespace isotet::io
