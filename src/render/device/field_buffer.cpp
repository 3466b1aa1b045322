// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/field_buffer.hpp"

#include "render/color/color_places.hpp"
#include "render/device/send.hpp"

namespace isotet::render {

Result<std::unique_ptr<FieldBuffer>> FieldBuffer::upload(std::shared_ptr<vulkan::Context> context, const Array& values,
                                                         std::uint32_t coloring, std::uint64_t count,
                                                         const std::function<std::uint64_t(std::uint64_t)>& number,
                                                         const ColorScale& scale) {
    const Result<core::Buffer<float>> stored = color_places(values, count, number, scale);
    if (!stored) return stored.error();
    auto field = std::make_unique<FieldBuffer>();
    field->scale = scale;
    field->coloring = coloring;
    field->count = count;
    Result<vulkan::Buffer> sent = send(*context, *stored, "values that colour");
    if (!sent) return sent.error();
    field->values = *std::move(sent);
    Result<vulkan::Buffer> table = send(*context, color_table(scale), "colour map");
    if (!table) return table.error();
    field->table = *std::move(table);
    field->context = std::move(context);
    return field;
}

} // namespace isotet::render
