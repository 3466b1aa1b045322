// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Everything that a picture shows, put in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/device/line_pass.hpp"
#include "render/device/mesh_pass.hpp"
#include "render/device/tet_pass.hpp"

namespace isotet::render {

/// What is drawn, ready to be recorded.
struct Draws {
    std::vector<std::unique_ptr<MeshBuffers>> uploaded; ///< for this picture only
    std::vector<std::unique_ptr<FieldBuffer>> uploaded_colors;
    std::vector<LineDraw> lines;
    std::vector<MeshDraw> meshes;
    std::vector<TetDraw> tets;
};

/// One draw among the others. Borrows from Draws.
struct DrawStep {
    std::span<const std::byte> item; ///< its struct of parameters
    std::uint64_t at = 0;            ///< where that stands in the buffer of all
    bool translucent = false;
    std::vector<vulkan::Use> uses;
    const vulkan::Buffer *from = nullptr, *to = nullptr; ///< what must be copied before; null: nothing
    std::function<void(const layout::DrawPush&, const vulkan::DeviceFunctions&, VkCommandBuffer)> record;
};

/// What is opaque before what is translucent, and of both what is there before what has to be copied. Items stand from
/// `first_item` on.
std::vector<DrawStep> in_order(const Draws& draws, std::uint64_t first_item);

} // namespace isotet::render
