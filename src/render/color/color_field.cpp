// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"

namespace isotet {

namespace {

/// What there is to colour: values with a place on the scale, and others.
struct ColoredValues {
    ValueRange range{INFINITY, -INFINITY};
    bool no_data = false, not_positive = false; ///< some values

    void add(const ColoredValues& other) {
        range.lower = std::min(range.lower, other.range.lower);
        range.upper = std::max(range.upper, other.range.upper);
        no_data |= other.no_data;
        not_positive |= other.not_positive;
    }
};

template <class Scalar>
ColoredValues look_at_part(std::span<const Scalar> scalars, bool logarithmic) {
    ColoredValues part;
    for (const Scalar scalar : scalars) {
        const auto value = static_cast<double>(scalar);
        part.no_data |= std::isnan(value);
        part.not_positive |= value <= 0;
        if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
        part.range.lower = std::min(part.range.lower, value);
        part.range.upper = std::max(part.range.upper, value);
    }
    return part;
}

Result<ColoredValues> look_at(const Array& values, bool logarithmic, const Run& run) {
    return core::carry_out("finding a range of colours", run, [&](const Progress& progress) -> Result<ColoredValues> {
        constexpr std::size_t grain = std::size_t{1} << 16;
        ColoredValues all;
        std::mutex mutex;
        values.visit([&](auto scalars) {
            core::parallel_pieces(scalars.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
                const ColoredValues part = look_at_part(scalars.subspan(begin, end - begin), logarithmic);
                const std::lock_guard lock(mutex);
                all.add(part);
            });
        });
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding a range of colours was cancelled"};
        return all;
    });
}

/// The ends of a scale for values that are all the same, or none, lie around them.
ValueRange widened(const ValueRange& range, bool logarithmic) {
    if (range.lower < range.upper) return range;
    const double value = std::isfinite(range.lower) ? range.lower : logarithmic ? 1 : 0;
    const double half = value == 0 ? 1 : std::abs(value) / 2;
    return {value - half, value + half};
}

Result<ColorScale> scale_between(const ColoredValues& found, const ColorOptions& options) {
    ColorScale scale = options.scale;
    scale.classes.clear();
    if (options.range) {
        const auto [lower, upper] = *options.range;
        if (!(lower < upper) || !std::isfinite(lower) || !std::isfinite(upper))
            return invalid_argument(fmt::format(
                "the range of colours is {} to {}, but its ends must be numbers, the smaller one first", lower, upper));
        if (scale.logarithmic && lower <= 0)
            return invalid_argument(fmt::format(
                "the range of colours begins with {}, but a logarithmic scale takes positive numbers only", lower));
    }
    const ValueRange ends = options.range ? *options.range : widened(found.range, scale.logarithmic);
    scale.lower = ends.lower;
    scale.upper = ends.upper;
    return scale;
}

// Paul Tol's "bright" and "light" schemes, which colour-blind people tell apart.
constexpr std::array<std::string_view, 12> class_colors{"#4477aa", "#ee6677", "#228833", "#ccbb44",
                                                        "#66ccee", "#aa3377", "#ee8866", "#44bb99",
                                                        "#99ddff", "#ffaabb", "#aaaa00", "#777777"};

/// The whole numbers of the cells that are contoured, where they are few and all there is. Empty cells count, too: cells that
/// were not chosen leave others their colours.
std::set<double> few_whole_numbers(const Array& values, const Cells& cells) {
    const std::span<const std::uint8_t> types =
        cells.types.empty() ? std::span<const std::uint8_t>() : cells.types.as<std::uint8_t>();
    if (!types.empty() && std::ranges::none_of(types, [](std::uint8_t type) { return is_contoured(type); })) return {};
    const auto counts = [&](std::size_t cell) {
        return types.empty() || types[cell] == 0 || is_contoured(types[cell]);
    };
    std::set<double> numbers;
    const bool few = values.visit([&](auto scalars) {
        for (std::size_t i = 0; i < scalars.size(); ++i) {
            const auto value = static_cast<double>(scalars[i]);
            if (std::isnan(value) || !counts(i)) continue;
            if (value != std::floor(value)) return false;
            if (numbers.insert(value).second && numbers.size() > class_colors.size()) return false;
        }
        return true;
    });
    return few ? numbers : std::set<double>();
}

/// Numbers of classes instead of the whole numbers themselves.
ColorField classified(ColorField field, const Array& all, const std::set<double>& numbers,
                      const ColorOptions& options) {
    std::vector<float> classes(field.values.size());
    all.visit([&](auto scalars) {
        field.has_no_data =
            std::ranges::any_of(scalars, [](auto scalar) { return std::isnan(static_cast<double>(scalar)); });
    });
    field.values.visit([&](auto scalars) {
        for (std::size_t i = 0; i < scalars.size(); ++i) {
            const auto value = static_cast<double>(scalars[i]);
            const auto place = std::distance(numbers.begin(), numbers.lower_bound(value));
            classes[i] = std::isnan(value) ? NAN : static_cast<float>(place);
        }
    });
    field.values = Array::own(std::move(classes));
    field.scale = options.scale;
    field.scale.lower = -0.5;
    field.scale.upper = static_cast<double>(numbers.size()) - 0.5;
    field.scale.classes.clear();
    for (const double number : numbers) {
        field.scale.classes.push_back(*parse_color(class_colors[field.scale.classes.size()]));
        const auto name = options.names.find(number);
        field.classes.push_back(name != options.names.end() ? name->second : fmt::format("{}", number));
    }
    return field;
}

/// `all`   values that the scale is of
Result<FoundColors> with_scale(ColorField field, const Array& all, const ColorOptions& options, const Run& run) {
    if (field.values.components() != 1)
        return invalid_argument(fmt::format("the field to colour by, '{}', has {} components: name one, such as {}:mag",
                                            field.name, field.values.components(), field.name));
    const bool logarithmic = options.scale.logarithmic;
    const auto values = look_at(all, logarithmic, run);
    if (!values) return values.error();
    const auto scale = scale_between(*values, options);
    if (!scale) return scale.error();
    FoundColors found{std::move(field), {}};
    if (logarithmic && values->not_positive)
        found.notes.push_back(
            fmt::format("'{}' has values that are not positive: on the logarithmic scale they have the colour of its "
                        "lower end",
                        found.field.name));
    if (!options.range && !(values->range.lower <= values->range.upper))
        found.notes.push_back(fmt::format("'{}' has no value that could have a colour", found.field.name));
    found.field.scale = *scale;
    found.field.has_no_data = values->no_data;
    return found;
}

Result<FoundColors> with_scale(ColorField field, const ColorOptions& options, const Run& run) {
    const Array all = field.values;
    return with_scale(std::move(field), all, options, run);
}

const Field* find_named(const std::vector<Field>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &Field::name);
    return found == fields.end() ? nullptr : &*found;
}

} // namespace

Result<ValueRange> colored_range(const Array& values, bool logarithmic, const Run& run) {
    const auto found = look_at(values, logarithmic, run);
    if (!found) return found.error();
    return found->range;
}

Result<ColorScale> color_scale(std::span<const Array> values, const ColorOptions& options, const Run& run) {
    ColoredValues all;
    for (const Array& array : values) {
        if (options.range) break;
        const auto found = look_at(array, options.scale.logarithmic, run);
        if (!found) return found.error();
        all.add(*found);
    }
    return scale_between(all, options);
}

const Field* cell_colors(const Grid& grid, const std::string& name) {
    const Field* cells = find_named(grid.cell_fields, name);
    return cells && cells->values.components() == 1 && !find_named(grid.point_fields, name) ? cells : nullptr;
}

Result<FoundColors> find_colors(const Grid& grid, const std::string& name, const ColorOptions& options,
                                const Run& run) {
    if (const Field* cells = cell_colors(grid, name)) {
        ColorField field{name, cells->values, Association::cell, {}};
        const bool has_some = !options.all_values.empty();
        const Array& all = has_some ? options.all_values : cells->values;
        if (!options.range && !options.scale.logarithmic)
            if (const auto numbers = few_whole_numbers(all, has_some ? Cells() : grid.cells); !numbers.empty())
                return FoundColors{classified(std::move(field), all, numbers, options), {}};
        return with_scale(std::move(field), all, options, run);
    }
    const Result<PointField> found = find_field(grid, name, {}, run);
    if (!found) return found.error();
    return with_scale({name, found->values, Association::point, {}}, options, run);
}

Result<FoundColors> find_colors(const Surface& surface, const std::string& name, const ColorOptions& options,
                                const Run& run) {
    std::vector<std::string> names;
    for (const Field& field : surface.point_fields) names.push_back(field.name);
    if (match_field_name(name, names)) {
        Grid vertices;
        vertices.points = surface.positions;
        vertices.point_fields = surface.point_fields;
        const Result<PointField> found = find_field(vertices, name, {}, run);
        if (!found) return found.error();
        return with_scale({name, found->values, Association::point, {}}, options, run);
    }
    if (const Field* triangles = find_named(surface.cell_fields, name))
        return with_scale({name, triangles->values, Association::cell, {}}, options, run);
    for (const Field& field : surface.cell_fields) names.push_back(field.name);
    for (std::string& known : names = nearest_first(name, std::move(names))) known = "'" + known + "'";
    return invalid_argument(fmt::format("there is no field '{}' to colour by: the surface has {}", name,
                                        names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

} // namespace isotet
