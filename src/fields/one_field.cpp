// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/one_field.hpp"

#include <algorithm>
#include <span>

#include <fmt/core.h>

#include <isotet/fields.hpp>
#include <isotet/linear_cells.hpp>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "grid/values/average_to_points.hpp"
#include "grid/renumber.hpp"

namespace isotet::core {

Result<std::optional<Field>> find_or_gather(const std::vector<Field>& fields, const FieldName& wanted) {
    const auto is_there = [&](const std::string& name) {
        return std::ranges::find(fields, name, &Field::name) != fields.end();
    };
    if (wanted.parts.empty()) {
        const auto found = std::ranges::find(fields, wanted.field, &Field::name);
        return found == fields.end() ? std::optional<Field>() : std::optional(*found);
    }
    if (!std::ranges::all_of(wanted.parts, is_there)) return std::optional<Field>();
    Result<Field> gathered = gather_components(fields, wanted.field, wanted.parts);
    if (!gathered) return gathered.error();
    return std::optional(*std::move(gathered));
}

Result<void> check_length(const Field& field, std::string_view what, std::size_t expected) {
    if (field.values.tuples() == expected && field.values.components() > 0) return {};
    return invalid_argument(fmt::format("the {} field '{}' has {} tuples of {} components, but the grid has {} {}s",
                                        what, field.name, field.values.tuples(), field.values.components(), expected,
                                        what));
}

Result<Array> average_field(const Grid& grid, const Field& field, Scalar scalar, bool by_value,
                            const Progress& progress) {
    const Grid bare{grid.points, grid.cells, {}, {}, grid.point_numbers};
    const auto cells = CellReader::open(bare);
    if (!cells) return cells.error();
    if (auto fits = check_length(field, "cell", cells->count()); !fits) return fits.error();
    const auto averaged = [&](std::span<const double> volumes) -> Result<Array> {
        Array values = average_to_points(bare, *cells, field.values, scalar, by_value, volumes, progress);
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "averaging a cell field was cancelled"};
        return values;
    };
    if (has_cells_to_linearize(grid.cells)) { // which checks the cells, too
        const auto volumes = relative_volumes(bare, {.progress = progress});
        if (!volumes) return volumes.error();
        return averaged(*volumes);
    }
    if (auto sound = check_cells(bare, *cells, progress); !sound) return sound.error();
    if (by_value && !grid.point_numbers.empty())
        if (auto numbers = check_point_numbers(bare); !numbers) return numbers.error();
    return averaged({});
}

} // namespace isotet::core
