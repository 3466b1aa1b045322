// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/field_buffer.hpp"

#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "render/layout.hpp"
#include "render/send.hpp"

namespace isotet::render {

namespace {

Result<void> check_scale(const ColorScale& scale) {
    if (std::isfinite(scale.lower) && std::isfinite(scale.upper) && scale.lower < scale.upper &&
        (!scale.logarithmic || scale.lower > 0))
        return {};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("a colour scale from {} to {}, but it must run from a smaller{} to a larger finite value",
                             scale.lower, scale.upper, scale.logarithmic ? " positive" : "")};
}

core::Buffer<float> table_of(ColorMap map) {
    core::Buffer<float> table(std::size_t{3} * layout::table_entries);
    for (std::uint32_t i = 0; i < layout::table_entries; ++i) {
        const layout::vec3 color = linear_light(color_at(map, static_cast<double>(i) / (layout::table_entries - 1)));
        table[3 * i] = color.x;
        table[3 * i + 1] = color.y;
        table[3 * i + 2] = color.z;
    }
    return table;
}

} // namespace

Result<std::unique_ptr<FieldBuffer>> FieldBuffer::upload(std::shared_ptr<vulkan::Context> context, const Array& values,
                                                         std::uint32_t coloring, std::uint64_t count,
                                                         const std::function<std::uint64_t(std::uint64_t)>& number,
                                                         const ColorScale& scale) {
    if (Result<void> right = check_scale(scale); !right) return right.error();
    if (values.components() != 1 && values.tuples() > 0)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("values that colour have {} components, but need 1", values.components())};
    auto field = std::make_unique<FieldBuffer>();
    field->scale = scale;
    field->coloring = coloring;
    field->count = count;
    core::Buffer<float> stored(count);
    values.visit([&](auto scalars) {
        core::parallel_each(count, std::size_t{1} << 16, [&](std::size_t i) {
            const auto value = static_cast<double>(scalars[number(i)]);
            stored[i] = static_cast<float>(scale.logarithmic ? value / scale.lower : scale.place_of(value));
        });
    });
    Result<vulkan::Buffer> sent = send(*context, stored, "values that colour");
    if (!sent) return sent.error();
    field->values = *std::move(sent);
    Result<vulkan::Buffer> table = send(*context, table_of(scale.map), "colour map");
    if (!table) return table.error();
    field->table = *std::move(table);
    field->context = std::move(context);
    return field;
}

} // namespace isotet::render
