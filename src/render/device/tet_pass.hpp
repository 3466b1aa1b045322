// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets that are cut while they are drawn: a quad a tet, page by page.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/render.hpp>

#include "render/device/chosen_tets.hpp"
#include "render/space.hpp"
#include "vulkan/draw_pipelines.hpp"

namespace isotet::render {

/// The corners of the quads of one page, two triangles each: 0, 1, 2, 0, 2, 3, then 4 more each. The same for every
/// page, so that each vertex of a tet need be worked out once, as in the paper.
Result<vulkan::Buffer> make_quad_corners(vulkan::Context& context);

/// A page of tets, ready to be drawn.
struct TetDraw {
    layout::TetPage page{};
    std::uint32_t tets = 0;
    bool translucent = false;
    const vulkan::DrawPipeline* pipeline = nullptr;
    VkBuffer quad_corners = VK_NULL_HANDLE; ///< null: drawn by mesh shaders
    const vulkan::Buffer *from = nullptr, *to = nullptr; ///< what has to be copied before; null: it is there
    std::vector<vulkan::Use> uses;
};

/// Adds a draw for each page.
///
/// Errors   invalid_argument when there are colours, or the opacity is out of range
Result<void> add_tet_draws(vulkan::DrawPipelines& pipelines, const Space& space, const DrawnSurface& drawn,
                           const ChosenTets& tets, const vulkan::Buffer& quad_corners, std::vector<TetDraw>& draws);

void record(const TetDraw& draw, const layout::DrawPush& push, const vulkan::DeviceFunctions& call,
            VkCommandBuffer commands);

} // namespace isotet::render
