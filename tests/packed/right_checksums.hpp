// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed files with other numbers, under checksums that are right for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "io/files/crc32c.hpp"
#include "io/packed/chunk_places.hpp"
#include "io/packed/directory.hpp"

namespace isotet::test {

/// The file with another directory in place of its last.
inline std::string with_directory(std::string file, io::DirectorySlot slot, const io::PackedDirectory& d) {
    const auto directory = io::encode_directory(d);
    file.resize(slot.offset);
    file.append(reinterpret_cast<const char*>(directory.data()), directory.size());
    slot.bytes = directory.size();
    slot.file_bytes = file.size();
    slot.checksum = io::crc32c(directory);
    const auto slot_bytes = io::encode_slot(slot);
    std::memcpy(file.data() + io::packed_slots[0], slot_bytes.data(), slot_bytes.size());
    return file;
}

/// Writes the checksums of whatever is in the file.
inline std::string with_right_checksums(std::string file) {
    const auto bytes = [&](std::uint64_t at, std::uint64_t size) {
        return std::as_bytes(std::span(file)).subspan(at, size);
    };
    io::DirectorySlot slot = io::decode_packed_header(bytes(0, file.size()), file.size()).value();
    io::PackedDirectory d = io::decode_directory(bytes(slot.offset, slot.bytes), file.size()).value();
    const io::PieceOffsets offsets(d);
    std::uint64_t clusters_at = d.clusters_offset;
    for (std::size_t k = 0; k < d.chunks.size(); ++k) {
        io::ChunkEntry& chunk = d.chunks[k];
        chunk.points_checksum = io::crc32c(bytes(offsets.points[k], d.points_bytes(chunk)));
        chunk.topology_checksum = io::crc32c(bytes(offsets.topology[k], d.topology_bytes(chunk)));
        chunk.clusters_checksum = io::crc32c(bytes(clusters_at, io::cluster_record_bytes * chunk.clusters));
        clusters_at += io::cluster_record_bytes * chunk.clusters;
    }
    for (io::PointsEntry& points : d.moved_points) {
        const std::vector<std::uint64_t> positions = io::positions_offsets(d, points);
        for (std::size_t k = 0; k < d.chunks.size(); ++k)
            points.checksums[k] = io::crc32c(bytes(positions[k], d.positions_bytes(d.chunks[k])));
        points.boundary_checksum =
            io::crc32c(bytes(points.boundary_offset, 3 * d.boundary->points * d.real_bytes()));
    }
    for (io::FieldEntry& field : d.fields) {
        std::uint64_t ranges_at = field.ranges_offset;
        for (std::size_t k = 0; k < d.chunks.size(); ++k) {
            field.ranges_checksums[k] = io::crc32c(bytes(ranges_at, d.ranges_bytes(d.chunks[k])));
            ranges_at += d.ranges_bytes(d.chunks[k]);
            field.values_checksums[k] = io::crc32c(
                bytes(io::values_offsets(d, field)[k], d.values_bytes(d.chunks[k], field)));
        }
    }
    d.boundary->checksum = io::crc32c(bytes(d.boundary->offset, d.boundary_bytes()));
    for (io::FieldEntry& field : d.fields)
        field.boundary_checksum = io::crc32c(bytes(field.boundary_offset, d.boundary->points * d.real_bytes()));
    return with_directory(std::move(file), slot, d);
}

/// As version 1.0 had files.
inline std::string without_boundary(std::string file) {
    const auto all = std::as_bytes(std::span(file));
    const io::DirectorySlot slot = io::decode_packed_header(all, file.size()).value();
    io::PackedDirectory d = io::decode_directory(all.subspan(slot.offset, slot.bytes), file.size()).value();
    d.boundary.reset();
    return with_directory(std::move(file), slot, d);
}

/// Only that of the directory, whatever is in it.
inline std::string with_right_directory_checksum(std::string file) {
    const auto all = std::as_bytes(std::span(file));
    io::DirectorySlot slot = io::decode_packed_header(all, file.size()).value();
    slot.checksum = io::crc32c(all.subspan(slot.offset, slot.bytes));
    const auto bytes = io::encode_slot(slot);
    std::memcpy(file.data() + io::packed_slots[0], bytes.data(), bytes.size());
    return file;
}

} // namespace isotet::test
