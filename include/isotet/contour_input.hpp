// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is contoured, and what surfaces carry, by the names of fields.
#pragma once

#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/export.hpp>

namespace isotet {

/// The grid with the field of a name that find_field() takes, and what surfaces are to carry: fields of points, then of
/// cells, then what else find_field() takes.
///
/// Errors   as find_field()
ISOTET_API Result<ContourInput> contour_input(const Grid& grid, const std::string& field,
                                              const std::vector<std::string>& carried = {}, const Run& run = {});

} // namespace isotet
