// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Kelvin's foam: space filled with truncated octahedra, polyhedra of 6 squares and 8 hexagons.
#pragma once

#include <isotet/make.hpp>

namespace isotet::make {

/// Sides up to this: point numbers then fit 32 bits.
constexpr std::uint64_t largest_foam_side = 512;

/// Two polyhedra a cube, one around its centre and one around its upper corner: what make_grid() gives for "kelvin".
/// Errors   as make_grid()
Result<Grid> make_foam(const MakeOptions& options, const Progress& progress);

} // namespace isotet::make
