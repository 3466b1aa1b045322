// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether coordinates can be stored at all: those below 2^-70 are 0 for every engine.
#pragma once

#include <isotet/array.hpp>
#include <isotet/frame.hpp>
#include <isotet/pack.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// Whether the grid is so small that coordinates lose digits, or vanish: nothing in any direction reaches 2^-50. Points that
/// are all at one place pass, as do grids that are thin in some directions only.
///
/// `frame`   of the whole grid, where `points` are those of a piece; or null
/// Cost      a look at the first points, but for grids that fail
/// Errors    invalid_data
Result<void> check_grid_size(const Array& points, Precision precision, const Frame* frame);

} // namespace isotet::core
