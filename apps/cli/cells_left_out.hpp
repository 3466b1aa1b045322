// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The one notice of cells that isotet does not contour, counted by type.
#pragma once

#include <string>

#include <isotet/grid.hpp>

namespace isotet::cli {

/// "cells left out, their types are not contoured: 12 triangle, 40 polyhedron"; empty when there are none.
std::string cells_left_out_note(const Grid& grid);

} // namespace isotet::cli
