// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces: their triangles, pulled from where they lie in the device's memory.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/render.hpp>

#include "render/device/field_buffer.hpp"
#include "render/device/mesh_buffers.hpp"
#include "render/layout.hpp"
#include "render/space.hpp"
#include "vulkan/draw_pipelines.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::render {

/// A surface, ready to be drawn.
struct MeshDraw {
    layout::Mesh mesh{};
    bool translucent = false;
    const vulkan::DrawPipeline* pipeline = nullptr;
    VkBuffer indices = VK_NULL_HANDLE;   ///< null: a draw of corners that is not indexed
    VkBuffer arguments = VK_NULL_HANDLE; ///< of an indirect draw; null: `corners` count
    std::uint64_t offset = 0;            ///< of the arguments
    std::uint32_t corners = 0;
    std::vector<vulkan::Use> uses;
};

/// Exactly one of `mesh` and `surface` is not null; `colors` may be.
///
/// Errors   invalid_argument when the colours do not fit the surface, or the opacity is out of range
Result<MeshDraw> make_mesh_draw(vulkan::DrawPipelines& pipelines, const Space& space, const DrawnSurface& drawn,
                                const MeshBuffers* mesh, const FieldBuffer* colors);

void record(const MeshDraw& draw, const layout::DrawPush& push, const vulkan::DeviceFunctions& call,
            VkCommandBuffer commands);

} // namespace isotet::render
