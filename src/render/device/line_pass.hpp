// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lines, as two triangles each.
#pragma once

#include <isotet/render.hpp>

#include "render/layout.hpp"
#include "render/space.hpp"
#include "vulkan/draw_pipelines.hpp"

namespace isotet::render {

/// Lines of one colour, ready to be drawn.
struct LineDraw {
    vulkan::Buffer ends;
    layout::Lines lines{};
    const vulkan::DrawPipeline* pipeline = nullptr;
    std::uint32_t corners = 0;
};

/// `samples`   an axis and pixel
/// Errors      invalid_argument when an end is not finite or the width not positive; out_of_memory; machine
Result<LineDraw> make_line_draw(vulkan::Context& context, vulkan::DrawPipelines& pipelines, const Space& space,
                                const DrawnLines& drawn, std::uint32_t samples);

void record(const LineDraw& draw, const layout::DrawPush& push, const vulkan::DeviceFunctions& call,
            VkCommandBuffer commands);

} // namespace isotet::render
