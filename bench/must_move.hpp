// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The bytes that a step cannot avoid moving between memory and processor: each array it depends on once, each result once.
// What a method moves beyond that is its own affair, so the share of the copy bandwidth compares methods fairly.
#pragma once

#include <cstdint>

#include <isotet/pack.hpp>
#include <isotet/surface.hpp>

namespace isotet::bench {

/// The ranges of all clusters; of the selected ones the header, links, values, positions and group ranges, and the tets of
/// groups whose range holds the isovalue; the surface.
std::uint64_t extraction_must_move(const PackedGrid& packed, double isovalue, const Surface& surface);

/// The user's values and the point map read; stored values and ranges written, local values looked up by links and tets.
std::uint64_t new_field_must_move(const PackedGrid& packed, std::uint64_t field_bytes);

/// Positions, triangles, and every other array of the surface.
std::uint64_t bytes_of(const Surface& surface);

} // namespace isotet::bench
