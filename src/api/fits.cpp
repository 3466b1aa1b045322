// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/fits.hpp"

#include <fmt/core.h>

#include "core/errors.hpp"

namespace isotet::api {

Error no_gradients() {
    return {ErrorCode::invalid_argument,
            "gradient normals need a grid that was packed with gradients, but this one was not"};
}

Result<void> check_length(const Field& point_field, std::uint64_t user_points) {
    if (point_field.values.tuples() == user_points) return {};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("point field '{}' has {} tuples, but the packed grid has {} points", point_field.name,
                             point_field.values.tuples(), user_points)};
}

Result<void> check_fit(const ExtractOptions& options, const core::Packed& packed) {
    if (options.normals == Normals::gradient && packed.gradients.empty() && packed.points() != 0) return no_gradients();
    if ((options.source_cells || !options.cell_fields.empty()) && !packed.has_cell_ids() && packed.clusters() != 0)
        return invalid_argument(
            "source cells and cell fields need a grid that was packed with source cells, but this one was not");
    for (const Field& field : options.point_fields)
        if (auto ok = check_length(field, packed.user_points); !ok) return ok;
    for (const Field& field : options.cell_fields)
        if (field.values.tuples() != packed.user_cells)
            return invalid_argument(fmt::format("cell field '{}' has {} tuples, but the packed grid has {} cells",
                                                field.name, field.values.tuples(), packed.user_cells));
    return {};
}

} // namespace isotet::api
