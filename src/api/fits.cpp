// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/fits.hpp"

#include <fmt/core.h>

#include "base/errors.hpp"

namespace isotet::api {

Result<void> check_fit(const ExtractOptions& options, const core::Packed& packed) {
    if (options.normals == Normals::gradient && packed.gradients.empty() && packed.points() != 0)
        return invalid_argument("gradient normals need a grid that was packed with gradients, but this one was not");
    if ((options.source_cells || !options.cell_fields.empty()) && !packed.has_cell_ids() && packed.clusters() != 0)
        return invalid_argument(
            "source cells and cell fields need a grid that was packed with source cells, but this one was not");
    for (const Field& field : options.point_fields)
        if (field.values.tuples() != packed.user_points)
            return invalid_argument(fmt::format("point field '{}' has {} tuples, but the packed grid has {} points", field.name,
                                     field.values.tuples(), packed.user_points));
    for (const PackedGrid& grid : options.packed_fields) {
        const core::Packed& other = grid.data();
        if (other.headers.data() != packed.headers.data() || other.reals.index() != packed.reals.index())
            return invalid_argument(fmt::format("the packed field '{}' is of other cells than the contoured field, but "
                                                "must be of the same packed grid",
                                                other.field_report.name));
    }
    for (const Field& field : options.cell_fields)
        if (field.values.tuples() != packed.user_cells)
            return invalid_argument(fmt::format("cell field '{}' has {} tuples, but the packed grid has {} cells",
                                                field.name, field.values.tuples(), packed.user_cells));
    return {};
}

} // namespace isotet::api
