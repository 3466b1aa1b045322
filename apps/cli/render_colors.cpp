// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "grid_source.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

/// The range of what has a colour: finite values, on a logarithmic scale positive ones.
struct Seen {
    double lower = INFINITY, upper = -INFINITY;
    bool no_data = false, not_positive = false; ///< some values
};
Seen look_at(const Array& values, bool positive) {
    Seen seen;
    values.visit([&](auto scalars) {
        for (const auto scalar : scalars) {
            const auto value = static_cast<double>(scalar);
            seen.no_data = seen.no_data || std::isnan(value);
            seen.not_positive = seen.not_positive || value <= 0;
            if (!std::isfinite(value) || (positive && value <= 0)) continue;
            seen.lower = std::min(seen.lower, value);
            seen.upper = std::max(seen.upper, value);
        }
    });
    return seen;
}

/// A field with one value, or none, still has a scale: around that value.
void widen(ColorScale& scale) {
    if (scale.lower < scale.upper) return;
    const double value = std::isfinite(scale.lower) ? scale.lower : scale.logarithmic ? 1 : 0;
    const double half = value == 0 ? 1 : std::abs(value) / 2;
    scale.lower = value - half;
    scale.upper = value + half;
}

/// Whether the cell is of a type that is contoured, and so drawn.
bool is_contoured(const Cells& cells, std::size_t cell) {
    if (cells.types.empty()) return true;
    const std::uint8_t type = cells.types.as<std::uint8_t>()[cell];
    return type >= static_cast<std::uint8_t>(CellType::tetrahedron) &&
           type <= static_cast<std::uint8_t>(CellType::pyramid);
}

/// A colour for each whole number, where they are few; false where the field has others.
bool make_classes(ColorField& field, const Cells& cells) {
    // Paul Tol's "bright" and "light" schemes, which colour-blind people tell apart.
    constexpr std::array<std::string_view, 12> colors{"#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377",
                                                      "#ee8866", "#44bb99", "#99ddff", "#ffaabb", "#aaaa00", "#777777"};
    std::set<double> numbers;
    const bool few = field.values.components() == 1 && field.values.visit([&](auto scalars) {
        for (std::size_t i = 0; i < scalars.size(); ++i) {
            const auto value = static_cast<double>(scalars[i]);
            if (!is_contoured(cells, i)) continue;
            if (std::isnan(value)) {
                field.has_no_data = true;
                continue;
            }
            if (value != std::floor(value)) return false;
            if (numbers.insert(value).second && numbers.size() > colors.size()) return false;
        }
        return !numbers.empty();
    });
    if (!few) return false;
    const std::vector<double> ascending(numbers.begin(), numbers.end());
    std::vector<float> classes(field.values.size());
    field.values.visit([&](auto scalars) {
        for (std::size_t i = 0; i < scalars.size(); ++i) {
            const auto value = static_cast<double>(scalars[i]);
            const auto place = std::ranges::lower_bound(ascending, value) - ascending.begin();
            classes[i] = std::isnan(value) ? NAN : static_cast<float>(place);
        }
    });
    field.values = Array::own(std::move(classes));
    field.scale.lower = -0.5;
    field.scale.upper = static_cast<double>(ascending.size()) - 0.5;
    for (std::size_t i = 0; i < ascending.size(); ++i) {
        field.scale.classes.push_back(*parse_color(colors[i]));
        field.classes.push_back(shortest(ascending[i]));
    }
    return true;
}

Result<ColorField> with_scale(ColorField field, const RenderCommand& command, Console& console) {
    if (field.values.components() != 1) {
        return usage_error("the field to colour by, '{}', has {} components: name one, such as {}:mag", field.name,
                           field.values.components(), field.name);
    }
    field.scale = command.scale;
    const Seen seen = look_at(field.values, command.scale.logarithmic);
    field.has_no_data = seen.no_data;
    if (command.scale.logarithmic && seen.not_positive)
        console.note(
            fmt::format("'{}' has values that are not positive: on the logarithmic scale they have the colour of its "
                        "lower end",
                        field.name));
    if (command.range.empty()) {
        if (!(seen.lower <= seen.upper))
            console.note(fmt::format("'{}' has no value that could have a colour", field.name));
        field.scale.lower = seen.lower;
        field.scale.upper = seen.upper;
        widen(field.scale);
        return field;
    }
    if (command.range.size() != 2 || !(command.range[0] < command.range[1]))
        return usage_error("--range takes two numbers, the smaller one first, such as 0,100");
    if (command.scale.logarithmic && command.range[0] <= 0)
        return usage_error("--range begins with {}, but --log takes positive numbers only", shortest(command.range[0]));
    field.scale.lower = command.range[0];
    field.scale.upper = command.range[1];
    return field;
}

const Array* find(const std::vector<Field>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &Field::name);
    return found == fields.end() ? nullptr : &found->values;
}

} // namespace

ValueRange range_of(const Array& values, const RenderCommand& command) {
    const Seen seen = look_at(values, command.scale.logarithmic);
    return {seen.lower, seen.upper};
}

Result<ColorField> colors_of(const Grid& grid, const std::string& name, const RenderCommand& command,
                             Console& console) {
    const Array* cells = find(grid.cell_fields, name);
    if (cells && !find(grid.point_fields, name)) {
        ColorField field{name, *cells, Association::cell, {}, false};
        if (command.range.empty() && !command.scale.logarithmic && make_classes(field, grid.cells)) return field;
        return with_scale(std::move(field), command, console);
    }
    const Result<PointField> found = find_field(grid, name, {}, console.run());
    if (!found) return found.error();
    return with_scale({name, found->values, Association::point, {}, false}, command, console);
}

Result<ColorField> colors_of(const Surface& surface, const RenderCommand& command, Console& console) {
    Grid vertices;
    vertices.points = surface.positions;
    vertices.point_fields = surface.point_fields;
    std::vector<std::string> names;
    for (const Field& field : surface.point_fields) names.push_back(field.name);
    if (const auto match = match_field_name(command.color_by, names)) {
        const Result<PointField> found = find_field(vertices, command.color_by, {}, console.run());
        if (!found) return found.error();
        return with_scale({command.color_by, found->values, Association::point, {}, false}, command, console);
    }
    for (const Field& field : surface.cell_fields) {
        names.push_back(field.name);
        if (field.name == command.color_by)
            return with_scale({field.name, field.values, Association::cell, {}, false}, command, console);
    }
    return usage_error("--color-by names '{}', but the surface has {}", command.color_by,
                       names.empty() ? "no fields" : quoted_list(nearest_first(command.color_by, names)));
}

} // namespace isotet::cli
