// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Reading a grid together with the field to contour, which may be left open.
#pragma once

#include <cstddef>
#include <string>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "console.hpp"
#include "grid_source.hpp"
#include "options.hpp"

namespace isotet::cli {

/// Reads a time step into `grid`: what the field needs, and `beside`; all fields where none is named, of which the one
/// that varies most is taken, with a note.
///
/// `beside`   the name of another field, or empty
/// Errors     as choose_field() and find_field(); invalid_data when none is named and none varies
Result<PointField> read_field(const GridSource& source, std::size_t step, const FieldChoice& choice,
                              const std::string& beside, int threads, Console& console, Grid& grid);

} // namespace isotet::cli
