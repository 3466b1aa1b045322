// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/line_pass.hpp"

#include "render/check_drawing.hpp"
#include "render/device/send.hpp"
#include "render_shaders.hpp"

namespace isotet::render {

namespace {

constexpr std::uint32_t corners_per_line = 6;

} // namespace

Result<LineDraw> make_line_draw(vulkan::Context& context, vulkan::DrawPipelines& pipelines, const Space& space,
                                const DrawnLines& drawn, std::uint32_t samples) {
    if (Result<void> right = check_lines(drawn); !right) return right.error();
    core::Buffer<float> ends(drawn.lines.size() * 6);
    for (std::size_t i = 0; i < drawn.lines.size(); ++i) {
        for (std::size_t end = 0; end < 2; ++end) {
            const std::array<double, 3> place = space.place(drawn.lines[i][end]);
            for (std::size_t axis = 0; axis < 3; ++axis) ends[6 * i + 3 * end + axis] = static_cast<float>(place[axis]);
        }
    }
    LineDraw draw;
    Result<vulkan::Buffer> sent = send(context, ends, "lines");
    if (!sent) return sent.error();
    draw.ends = *std::move(sent);
    draw.lines.ends = vulkan::address_of(draw.ends);
    draw.lines.color = light_of(drawn.color);
    draw.lines.half_width = static_cast<float>(drawn.width / 2 * samples);
    draw.lines.lift = static_cast<float>(drawn.lift);
    draw.corners = corners_per_line * static_cast<std::uint32_t>(drawn.lines.size());
    const auto pipeline = pipelines.get(vulkan::drawing::line_corners, vulkan::drawing::line, vulkan::Surfaces::opaque);
    if (!pipeline) return pipeline.error();
    draw.pipeline = *pipeline;
    return draw;
}

void record(const LineDraw& draw, const layout::DrawPush& push, const vulkan::DeviceFunctions& call,
            VkCommandBuffer commands) {
    call.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw.pipeline->pipeline);
    call.vkCmdPushConstants(commands, draw.pipeline->layout, draw.pipeline->stages, 0, sizeof push, &push);
    call.vkCmdDraw(commands, draw.corners, 1, 0, 0);
}

} // namespace isotet::render
