// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What VTK's formats call the arrays that mean something, for our readers and VTK's.
#pragma once

#include <string_view>

namespace isotet::io {

/// Marks of vtkGhostType that take a cell out: it is another piece's (1), refined (8), outside (16), hidden (32).
inline constexpr int cell_is_out = 1 | 8 | 16 | 32;

inline constexpr std::string_view point_id_names[] = {"GlobalNodeId", "GlobalNodeIds", "GlobalPointIds",
                                                      "GLOBAL_IDS_POINTS"};
inline constexpr std::string_view cell_id_names[] = {"GlobalElementId", "GlobalElementIds", "GlobalCellIds",
                                                     "GLOBAL_IDS_CELLS"};

} // namespace isotet::io
