// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// find_field(): which field a name means, and its values as one scalar a point.
#include <algorithm>

#include <fmt/core.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "fields/expression/find_expression.hpp"
#include "fields/fill_values.hpp"
#include "fields/one_field.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet {

namespace {

/// Names of point and cell fields, each once, in the order of the grid.
std::vector<std::string> names_of(const Grid& grid) {
    std::vector<std::string> names;
    for (const auto* fields : {&grid.point_fields, &grid.cell_fields})
        for (const Field& field : *fields)
            if (std::ranges::find(names, field.name) == names.end()) names.push_back(field.name);
    return names;
}

std::string in_quotes(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += fmt::format("{}'{}'", list.empty() ? "" : ", ", name);
    return list;
}

Result<core::Scalar> choose_scalar(const Field& field, const std::optional<std::string>& component) {
    const std::size_t components = field.values.components();
    if (!component && components != 1)
        return invalid_argument(fmt::format(
            "the field '{}' has {} components, but one is needed: ask for '{}:{}', '{}:0' or '{}:mag'", field.name,
            components, field.name, components == 6 || components == 9 ? "xx" : "x", field.name, field.name));
    if (!component) return core::Scalar{};
    const auto scalar = core::parse_scalar(*component);
    const auto place = scalar ? scalar->place_in(components) : std::nullopt;
    if (!place)
        return invalid_argument(
            fmt::format("component '{}' of the field '{}' is asked for, but it has {} (counted from 0)", *component,
                        field.name, components));
    return core::Scalar{*place, scalar->magnitude};
}

Result<PointField> coordinate(const Grid& grid, std::string_view name) {
    if (!is_floating(grid.points.type()) || grid.points.components() != 3)
        return Error{ErrorCode::invalid_data,
                     fmt::format("points are {} with {} components, but must be float32 or float64 with 3",
                                 name_of(grid.points.type()), grid.points.components())};
    return PointField{std::string(name), core::scalar_of(grid.points, *core::parse_scalar(name)), false, {}};
}

Result<PointField> find_by_name(const Grid& grid, std::string_view name, const FindFieldOptions& options,
                                const Progress& progress) {
    const std::vector<std::string> names = names_of(grid);
    if (name.empty()) {
        if (names.size() != 1)
            return invalid_argument(names.empty() ? "no field is named, and the grid has none"
                                                  : fmt::format("no field is named, but the grid has {}: {}",
                                                                names.size(), in_quotes(names)));
        name = names[0];
    }
    const auto match = match_field_name(name, names);
    if (!match && (name == "x" || name == "y" || name == "z")) return coordinate(grid, name);
    if (!match && looks_like_expression(name)) return core::find_expression(grid, name, names, options, progress);
    if (!match)
        return invalid_argument(
            names.empty()
                ? fmt::format("the field is '{}', but the grid has none, only the coordinates x, y, z", name)
                : fmt::format("the field is '{}', but the grid has {}", name, in_quotes(nearest_first(name, names))));
    const auto of_points = core::find_or_gather(grid.point_fields, *match);
    if (!of_points) return of_points.error();
    const auto of_cells = core::find_or_gather(grid.cell_fields, *match);
    if (!of_cells) return of_cells.error();
    if (!*of_points && !*of_cells)
        return invalid_argument(fmt::format("the components of '{}' are of points and of cells", match->field));
    const bool take_cells = *of_cells && (!*of_points || options.prefer == Association::cell);
    const Field& field = take_cells ? **of_cells : **of_points;
    const auto scalar = choose_scalar(field, match->component);
    if (!scalar) return scalar.error();

    PointField found{std::string(name), {}, take_cells, {}};
    if (take_cells) {
        auto values = core::average_field(grid, field, *scalar, options.for_pieces, progress);
        if (!values) return values.error();
        found.values = std::move(*values);
        auto fill = core::find_fill_values(core::scalar_of(field.values, *scalar), {.progress = progress});
        if (!fill) return fill.error();
        found.cell_fill = *std::move(fill);
        if (options.keep_cell_values) found.cell_values = core::scalar_of(field.values, *scalar);
    } else {
        if (auto fits = core::check_length(field, "point", grid.points.tuples()); !fits) return fits.error();
        found.values = core::scalar_of(field.values, *scalar);
        if (*of_cells)
            found.note =
                fmt::format("'{}' is both a point field and a cell field; the point field is taken", field.name);
    }
    return found;
}

} // namespace

Result<PointField> find_field(const Grid& grid, std::string_view name, const FindFieldOptions& options,
                              const Run& run) {
    return core::carry_out("finding the field", run,
                           [&](const Progress& progress) { return find_by_name(grid, name, options, progress); });
}

} // namespace isotet
