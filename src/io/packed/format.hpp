// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed files, version 1: docs/inside/packed-file.md describes every byte.
//
//   header        4096 bytes: magic, version, two slots that tell where the directory is; the one with the higher count holds
//   chunks        each: points (positions, user's numbers, ranks), then topology (cells, links, user's cells); 64-byte aligned
//   clusters      20 bytes each: the counts of their headers
//   boundary      its points by packed number, their positions, triangles
//   moved points  of a step: positions a chunk; then of the boundary
//   field, step   ranges and has_no_data of all clusters; then a piece a chunk: values, group ranges, gradients; then values at
//                 the points of the boundary
//   cell fields   the user's arrays
//   directory     what is where, with checksums
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/frame.hpp>
#include <isotet/pack.hpp>

#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::io {

constexpr std::string_view packed_magic = "isotetP\n";
constexpr std::uint16_t packed_major = 1, packed_minor = 2;
constexpr std::uint32_t packed_byte_order = 0x01020304;
constexpr std::size_t packed_header_bytes = 4096, packed_minor_at = 10;
constexpr std::array<std::size_t, 2> packed_slots{512, 1024}; ///< a sector each: written at once
constexpr std::size_t packed_slot_bytes = 40;
constexpr std::uint64_t piece_alignment = 64;
constexpr std::size_t cluster_record_bytes = 20;

constexpr std::uint64_t align_piece(std::uint64_t at) {
    return (at + piece_alignment - 1) / piece_alignment * piece_alignment;
}

/// Where the newest directory is.
struct DirectorySlot {
    std::uint64_t count = 0; ///< directories written so far; 0: none
    std::uint64_t offset = 0, bytes = 0;
    std::uint64_t file_bytes = 0; ///< what is behind was left by a writer that did not finish
    std::uint32_t checksum = 0;   ///< of the directory
};

/// What chunks and arrays are counted in.
enum class Unit : std::uint8_t { points, words, links, groups };
constexpr std::size_t unit_count = 4;

struct ChunkEntry {
    std::uint32_t clusters = 0;
    std::array<std::uint32_t, unit_count> counts{}; ///< by Unit
    std::uint32_t clusters_checksum = 0, points_checksum = 0, topology_checksum = 0;

    std::uint64_t count(Unit unit) const { return counts[static_cast<std::size_t>(unit)]; }
};

/// The grid's boundary.
struct BoundaryEntry {
    std::uint64_t points = 0, triangles = 0, offset = 0;
    std::uint32_t checksum = 0;
};

/// Positions of the points from a step on, until there are others.
struct PointsEntry {
    std::uint32_t step = 0;
    std::array<double, 3> origin{}, lower{}, upper{}; ///< bounds of the points
    std::uint64_t flushed_coordinates = 0, coarse_clusters = 0;
    std::uint64_t offset = 0;
    std::vector<std::uint32_t> checksums; ///< a chunk
    std::uint64_t boundary_offset = 0;    ///< of those of the boundary, where the file has it
    std::uint32_t boundary_checksum = 0;
};

/// A field at a step.
struct FieldEntry {
    std::string name;
    std::uint32_t step = 0;
    double time = std::numeric_limits<double>::quiet_NaN(); ///< NaN: not known
    ScalarType type = ScalarType::float32;
    bool gradients = false;
    core::Storage storage;
    FieldReport report;
    std::uint64_t ranges_offset = 0, values_offset = 0;
    std::vector<std::uint32_t> ranges_checksums, values_checksums; ///< a chunk
    std::uint64_t boundary_offset = 0; ///< of the values at the points of the boundary, where the file has it
    std::uint32_t boundary_checksum = 0;
};

constexpr std::size_t cell_block_bytes = std::size_t{1} << 20; ///< that a checksum is of

/// A field of the user's cells, from a step on until there is another of this name.
struct CellFieldEntry {
    std::string name;
    std::uint32_t step = 0;
    ScalarType type = ScalarType::float32;
    std::uint8_t components = 1;
    std::uint64_t offset = 0;
    std::vector<std::uint32_t> checksums; ///< a block

    std::uint64_t bytes(std::uint64_t user_cells) const { return user_cells * components * size_of(type); }
    static std::uint64_t blocks(std::uint64_t bytes) { return (bytes + cell_block_bytes - 1) / cell_block_bytes; }
};

/// What a packed file holds.
struct PackedDirectory {
    Precision precision = Precision::float32;
    ScalarType point_type = ScalarType::float32;
    bool wide_point_ids = false, wide_cell_ids = false, cell_ids = false, ranks = false;
    std::uint64_t clusters = 0;
    std::array<std::uint64_t, unit_count> counts{}; ///< by Unit
    std::uint64_t user_points = 0, user_cells = 0;
    std::array<double, 3> origin{}, lower{}, upper{}; ///< bounds of the points
    PackReport report;
    std::uint64_t clusters_offset = 0, chunks_offset = 0;
    std::optional<Frame> frame;
    std::vector<ChunkEntry> chunks;
    std::optional<BoundaryEntry> boundary; ///< since version 1.1
    std::vector<PointsEntry> moved_points; ///< by step, from 1 on; since version 1.2
    std::vector<FieldEntry> fields;
    std::vector<CellFieldEntry> cell_fields; ///< by step; since version 1.1; source cells are there

    std::size_t real_bytes() const { return precision == Precision::float32 ? 4 : 8; }
    std::uint64_t count(Unit unit) const { return counts[static_cast<std::size_t>(unit)]; }

    /// Bytes of pieces of a chunk.
    std::uint64_t points_bytes(const ChunkEntry& chunk) const {
        return chunk.count(Unit::points) *
               (3 * real_bytes() + (wide_point_ids ? 8u : 4u) + (ranks ? std::size_t{8} : 0));
    }
    std::uint64_t topology_bytes(const ChunkEntry& chunk) const {
        const std::uint64_t cell_id = !cell_ids ? 0 : wide_cell_ids ? 8 : 4;
        return chunk.count(Unit::words) * (4 + cell_id) + chunk.count(Unit::links) * 4;
    }
    std::uint64_t positions_bytes(const ChunkEntry& chunk) const {
        return chunk.count(Unit::points) * 3 * real_bytes();
    }
    /// Null where the points of a step are those of the chunks.
    const PointsEntry* points_at(std::uint32_t step) const {
        const PointsEntry* found = nullptr;
        for (const PointsEntry& points : moved_points)
            if (points.step <= step) found = &points;
        return found;
    }
    /// Of the boundary's piece, which there is.
    std::uint64_t boundary_bytes() const {
        return boundary->points * ((wide_packed_points() ? 8u : 4u) + 3 * real_bytes()) + boundary->triangles * 12;
    }
    bool wide_packed_points() const { return count(Unit::points) > std::numeric_limits<std::uint32_t>::max(); }
    std::uint64_t ranges_bytes(const ChunkEntry& chunk) const {
        return std::uint64_t{chunk.clusters} * (2 * real_bytes() + 1);
    }
    std::uint64_t values_bytes(const ChunkEntry& chunk, const FieldEntry& field) const {
        return chunk.count(Unit::points) * (real_bytes() + (field.gradients ? std::size_t{4} : 0)) +
               chunk.count(Unit::groups) * 2;
    }
};

} // namespace isotet::io
