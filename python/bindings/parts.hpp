// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The parts of the module isotet._isotet.
#pragma once

#include <nanobind/nanobind.h>

namespace isotet::python {

void add_grids(nanobind::module_& module);    ///< Grid, read, inspect, make, formats
void add_contours(nanobind::module_& module); ///< Contour, PackedGrid, pack
void add_linear(nanobind::module_& module);   ///< LinearGrid
void add_packed_files(nanobind::module_& module); ///< PackedFile, save_packed
void add_pieces(nanobind::module_& module);   ///< Frame, make_frame, survey, take_piece, leave_out_cells, number_points
void add_pictures(nanobind::module_& module); ///< Camera, render
void add_surfaces(nanobind::module_& module); ///< Surface, check, write, read_surface

} // namespace isotet::python
