// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/line_pass.hpp"

#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "render/send.hpp"
#include "render_shaders.hpp"

namespace isotet::render {

namespace {

constexpr std::uint32_t corners_per_line = 6;
constexpr std::size_t max_lines = std::numeric_limits<std::uint32_t>::max() / corners_per_line;

} // namespace

Result<LineDraw> make_line_draw(vulkan::Context& context, vulkan::DrawPipelines& pipelines, const Space& space,
                                const DrawnLines& drawn, std::uint32_t samples) {
    if (!(drawn.width > 0 && std::isfinite(drawn.width)))
        return invalid_argument(fmt::format("lines {} pixels wide, but the width must be positive", drawn.width));
    if (drawn.lines.size() > max_lines)
        return invalid_argument(fmt::format("{} lines, but {} can be drawn at most", drawn.lines.size(), max_lines));
    core::Buffer<float> ends(drawn.lines.size() * 6);
    for (std::size_t i = 0; i < drawn.lines.size(); ++i) {
        for (std::size_t end = 0; end < 2; ++end) {
            const std::array<double, 3> place = space.place(drawn.lines[i][end]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                ends[6 * i + 3 * end + axis] = static_cast<float>(place[axis]);
                if (!std::isfinite(place[axis]))
                    return invalid_argument(fmt::format("line {} has an end that is not finite", i));
            }
        }
    }
    LineDraw draw;
    Result<vulkan::Buffer> sent = send(context, ends, "lines");
    if (!sent) return sent.error();
    draw.ends = *std::move(sent);
    draw.lines.ends = vulkan::address_of(draw.ends);
    draw.lines.color = linear_light(drawn.color);
    draw.lines.half_width = static_cast<float>(drawn.width / 2 * samples);
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
