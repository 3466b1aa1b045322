// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The grid's boundary in a packed file: packed points, their places, triangles; and the values of each field there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "io/packed/piece_reader.hpp"
#include "packed/boundary_points.hpp"

namespace isotet::io {

/// The piece of a grid in memory.
std::vector<std::byte> encode_boundary(const core::Packed& packed, const core::PackedBoundary& boundary);

/// Stored positions of points, and values of a field.
std::vector<std::byte> encode_boundary_positions(const core::Packed& packed, const std::vector<std::uint64_t>& points);
std::vector<std::byte> encode_boundary_values(const core::Packed& packed, const std::vector<std::uint64_t>& points);

/// As boundary_of() gives it, and the packed points, numbered as packing has them. The file has it.
/// Errors   file; invalid_data: the checksum differs, or numbers break a rule
struct StoredBoundary {
    Surface surface;
    std::vector<std::uint64_t> points;
};
/// `step`   whose points it has
Result<StoredBoundary> read_boundary(const PackedSource& source, std::uint32_t step);

/// The values of a field at the points of the boundary, in the user's type. Errors as above
Result<Array> read_boundary_values(const PackedSource& source, const FieldEntry& field);

} // namespace isotet::io
