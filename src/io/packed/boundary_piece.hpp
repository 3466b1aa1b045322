// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The grid's boundary in a packed file: packed points, their places, triangles; and the values of each field there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "io/packed/piece_reader.hpp"
#include "numbers/storage.hpp"
#include "packed/boundary_points.hpp"

namespace isotet::io {

/// The piece of a grid in memory.
std::vector<std::byte> encode_boundary(const core::Packed& packed, const core::PackedBoundary& boundary);

/// Stored positions of points, and values of a field.
std::vector<std::byte> encode_boundary_positions(const core::Packed& packed, const std::vector<std::uint64_t>& points);
std::vector<std::byte> encode_boundary_values(const core::Packed& packed, const std::vector<std::uint64_t>& points);

/// The boundary at a step, as it is stored.
struct StoredBoundary {
    std::vector<std::uint64_t> points; ///< packed ones, numbered as packing has them
    Array triangles;
    std::variant<std::vector<float>, std::vector<double>> positions; ///< three a point, relative to the origin
    std::array<double, 3> origin{};
};
/// Of a file that has it.
/// `step`   whose points it has
/// Errors   file; invalid_data: the checksum differs, or numbers break a rule
Result<StoredBoundary> read_boundary(const PackedSource& source, std::uint32_t step);

/// As boundary_of() gives it.
/// `type`   of the user's points
Surface surface_of(StoredBoundary boundary, ScalarType type);

/// The stored values of a field at the points of the boundary. Errors   as above
template <class Real>
Result<std::vector<Real>> read_boundary_values(const PackedSource& source, const FieldEntry& field);

/// Stored values as the user has them.
template <class Real>
Array user_values(const std::vector<Real>& stored, ScalarType type, const core::Storage& storage);

} // namespace isotet::io
