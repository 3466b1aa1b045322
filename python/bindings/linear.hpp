// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed grids whose polyhedra and quadratic cells became linear cells: arrays of the user's grid as arrays of these.
#pragma once

#include <optional>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pack.hpp>
#include <isotet/surface.hpp>

namespace isotet::python {

/// `linear`   what connects the packed cells with those of the user, without the grid; none: they are the same
struct PackedCells {
    PackedGrid packed;
    std::optional<LinearGrid> linear;
};

/// pack(), with linear cells in place of those that are not linear.
Result<PackedCells> pack_linear(const Grid& grid, const PointField& field, const PackOptions& options, const Run& run);

// `linear`   null: arrays stay as they are

Result<Array> of_points(const LinearGrid* linear, const Array& values, const Run& run);
Result<std::vector<Field>> of_points(const LinearGrid* linear, const std::vector<Field>& fields, const Run& run);
Result<std::vector<Field>> of_cells(const LinearGrid* linear, const std::vector<Field>& fields, const Run& run);

/// Writes the user's cell numbers over those of packed cells.
void number_by_user(const LinearGrid* linear, std::vector<Extraction>& surfaces);

} // namespace isotet::python
