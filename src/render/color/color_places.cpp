// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/color/color_places.hpp"

#include <cmath>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "render/check_drawing.hpp"
#include "render/color/linear_light.hpp"

namespace isotet::render {

core::Buffer<float> color_table(const ColorScale& scale) {
    core::Buffer<float> table(std::size_t{3} * entries_per_map);
    for (std::uint32_t i = 0; i < entries_per_map; ++i) {
        const std::size_t which = i * scale.classes.size() / entries_per_map;
        const Light color =
            linear_light(scale.classes.empty() ? scale.color_at(static_cast<double>(i) / (entries_per_map - 1))
                                               : scale.classes[which]);
        for (std::size_t part = 0; part < 3; ++part) table[3 * i + part] = color[part];
    }
    return table;
}

Result<core::Buffer<float>> color_places(const Array& values, std::uint64_t count,
                                         const std::function<std::uint64_t(std::uint64_t)>& number,
                                         const ColorScale& scale) {
    if (Result<void> right = check_scale(scale); !right) return right.error();
    if (values.components() != 1 && values.tuples() > 0)
        return invalid_argument(fmt::format("values that colour have {} components, but need 1", values.components()));
    core::Buffer<float> places(count);
    values.visit([&](auto scalars) {
        core::parallel_each(count, std::size_t{1} << 16, [&](std::size_t i) {
            const auto value = static_cast<double>(scalars[number(i)]);
            places[i] = static_cast<float>(scale.logarithmic ? value / scale.lower : scale.place_of(value));
        });
    });
    return places;
}

float log_factor_of(const ColorScale& scale) {
    return scale.logarithmic ? static_cast<float>(1 / std::log(scale.upper / scale.lower)) : 0;
}

} // namespace isotet::render
