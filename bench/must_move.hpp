// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The bytes that a step cannot avoid moving between memory and processor: each array it depends on once, each result
// once. What a method moves beyond that is its own affair.
#pragma once

#include <cstdint>

#include <isotet/pack.hpp>
#include <isotet/surface.hpp>

namespace isotet::bench {

/// The ranges of all clusters; of the selected ones the header, links, values, positions and group ranges, and the tets
/// of groups whose range holds the isovalue; the surface.
std::uint64_t extraction_must_move(const PackedGrid& packed, double isovalue, const Surface& surface);

/// Read: the user's values, the point map, headers, links and tets. Written: stored values and all ranges.
std::uint64_t new_field_must_move(const PackedGrid& packed, std::uint64_t field_bytes);

/// Positions, triangles, and every other array of the surface.
std::uint64_t bytes_of(const Surface& surface);

} // namespace isotet::bench
