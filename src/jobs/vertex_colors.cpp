// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/vertex_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/parallel.hpp"
#include "jobs/refuse.hpp"

namespace isotet::jobs {
namespace {

using Bytes = std::array<std::uint8_t, 3>;

Bytes bytes_of(const Color& color) {
    const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0F, 1.0F))); };
    return {byte(color.red), byte(color.green), byte(color.blue)};
}

/// The colour of a value on a scale.
Bytes color_of(double value, const ColorScale& scale) {
    const double place = scale.place_of(value);
    if (std::isnan(place)) return bytes_of(scale.no_data);
    if (scale.classes.empty()) return bytes_of(scale.color_at(place));
    const auto classes = static_cast<double>(scale.classes.size());
    const double number = std::clamp(std::floor(place * classes), 0.0, classes - 1);
    return bytes_of(scale.classes[static_cast<std::size_t>(number)]);
}

} // namespace

Result<ColorOptions> color_options(const ColorScale& scale, const std::vector<double>& range) {
    ColorOptions options{scale, {}};
    if (range.empty()) return options;
    if (range.size() != 2 || !(range[0] < range[1]))
        return refusal("`range` takes two numbers, the smaller one first, such as 0,100");
    options.range = ValueRange{range[0], range[1]};
    return options;
}

Result<void> add_vertex_colors(Surface& surface, const ColorChoice& colors, Caller& caller) {
    const Result<ColorOptions> options = color_options(colors.scale, colors.range);
    if (!options) return options.error();
    Result<FoundColors> found = find_colors(surface, colors.by, *options, caller.run());
    if (!found) return found.error();
    const ColorField& field = found->field;
    if (field.association != Association::point)
        return refusal("`color_by` is '{}', a field of cells, but files hold colours of vertices: name a point field",
                       colors.by);
    caller.notes(found->notes);
    std::vector<std::uint8_t> rgb(3 * surface.vertex_count());
    core::parallel_each(surface.vertex_count(), 1 << 12, [&](std::size_t vertex) {
        const Bytes color = color_of(field.values.at(vertex), field.scale);
        std::copy(color.begin(), color.end(), rgb.begin() + static_cast<std::ptrdiff_t>(3 * vertex));
    });
    std::erase_if(surface.point_fields, [](const Field& other) { return other.name == "rgb"; });
    surface.point_fields.push_back({"rgb", Array::own(std::move(rgb), 3)});
    return {};
}

} // namespace isotet::jobs
