// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What solids and the cells between isovalues are made of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/solid.hpp>

namespace isotet::solid {

struct SolidInput {
    ContourInput input;                       ///< with linear cells
    Grid user_grid;                           ///< before: without point fields
    std::shared_ptr<const LinearGrid> linear; ///< null where all were linear
    Array cell_numbers;                       ///< GridPart::cell_numbers of the user's cells
    std::vector<std::string> notes;           ///< on making cells linear
};

/// The input with all its cells, linear ones; curved ones refined for all isovalues.
///
/// `is_piece`   it must have a frame, which else it must not
/// Errors       invalid_argument for options that make no sense here; as linearize() and refine()
Result<SolidInput> take_input(ContourInput given, const ContourOptions& options, const Run& run, bool is_piece = false);

/// A session for the isosurfaces of an input, with edge ends.
Result<Contour> contour_of(ContourInput input, const ContourOptions& options, const Run& run);

Result<void> check_range(const SolidRange& range);

/// The finite ends of a range, ascending.
std::vector<double> ends_of_range(const SolidRange& range);

} // namespace isotet::solid
