// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/tet_pass.hpp"

#include <fmt/core.h>

#include "base/errors.hpp"
#include "render/device/send.hpp"
#include "render_shaders.hpp"

namespace isotet::render {

namespace {

constexpr std::uint32_t corners_per_quad = 6, vertices_per_quad = 4;

} // namespace

Result<vulkan::Buffer> make_quad_corners(vulkan::Context& context) {
    constexpr std::uint32_t corners[corners_per_quad] = {0, 1, 2, 0, 2, 3};
    core::Buffer<std::uint32_t> numbers(std::size_t{layout::page_tets} * corners_per_quad);
    for (std::uint32_t i = 0; i < numbers.size(); ++i)
        numbers[i] = i / corners_per_quad * vertices_per_quad + corners[i % corners_per_quad];
    return send(context, numbers, "corners of quads");
}

Result<void> add_tet_draws(vulkan::DrawPipelines& pipelines, const Space& space, const DrawnSurface& drawn,
                           const ChosenTets& tets, const vulkan::Buffer& quad_corners, std::vector<TetDraw>& draws) {
    if (!(drawn.opacity >= 0 && drawn.opacity <= 1))
        return invalid_argument(fmt::format("an opacity of {}, but it must be from 0 to 1", drawn.opacity));
    if (drawn.colors)
        return invalid_argument("tets that are cut while they are drawn have one colour: a field cannot colour them");
    TetDraw draw;
    draw.translucent = drawn.opacity < 1;
    const bool by_groups = tets.store().method == DrawMethod::mesh;
    if (!by_groups) draw.quad_corners = quad_corners.handle();
    const auto constants = tets.store().constants(tets.has_list());
    namespace shaders = vulkan::drawing;
    const auto pipeline = pipelines.get(by_groups ? shaders::tet_groups : shaders::tet_corners,
                                        draw.translucent ? shaders::mesh_translucent : shaders::mesh_opaque,
                                        draw.translucent ? vulkan::Surfaces::translucent : vulkan::Surfaces::opaque,
                                        constants, by_groups ? vulkan::FirstStage::mesh : vulkan::FirstStage::vertex);
    if (!pipeline) return pipeline.error();
    draw.pipeline = *pipeline;
    for (const ChosenTets::Part& part : tets.parts()) {
        TetDraw& one = draws.emplace_back(draw);
        one.page = tets.describe(part);
        one.page.mesh.offset = layout::vector(space.place(tets.store().origin));
        one.page.mesh.scale = static_cast<float>(space.scale());
        one.page.mesh.color = light_of(drawn.color);
        one.page.mesh.opacity = static_cast<float>(drawn.opacity);
        one.tets = part.tets;
        tets.add_uses(part, by_groups ? vulkan::Access::mesh_read : vulkan::Access::draw_read, one.uses);
        if (!by_groups) one.uses.push_back(vulkan::draws_from(quad_corners));
        if (part.page->on_device) continue;
        one.from = &part.page->records;
        one.to = &tets.store().guest;
    }
    return {};
}

void record(const TetDraw& draw, const layout::DrawPush& push, const vulkan::DeviceFunctions& call,
            VkCommandBuffer commands) {
    call.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw.pipeline->pipeline);
    call.vkCmdPushConstants(commands, draw.pipeline->layout, draw.pipeline->stages, 0, sizeof push, &push);
    if (!draw.quad_corners) return call.vkCmdDrawMeshTasksEXT(commands, (draw.tets - 1) / layout::tet_group + 1, 1, 1);
    call.vkCmdBindIndexBuffer(commands, draw.quad_corners, 0, VK_INDEX_TYPE_UINT32);
    call.vkCmdDrawIndexed(commands, corners_per_quad * draw.tets, 1, 0, 0, 0);
}

} // namespace isotet::render
