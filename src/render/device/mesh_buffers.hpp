// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Triangles that were uploaded: what isotet::DeviceMesh stands for inside.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <isotet/surface.hpp>

#include "vulkan/context.hpp"

namespace isotet::render {

class MeshBuffers {
public:
    static Result<std::unique_ptr<MeshBuffers>> upload(std::shared_ptr<vulkan::Context> context,
                                                       const Surface& surface);

    std::shared_ptr<vulkan::Context> context; ///< before the buffers, so that it goes after them
    vulkan::Buffer positions, triangles, normals; ///< as layout::Mesh has them; normals may be empty
    std::array<double, 3> origin{};           ///< positions are relative to it
    std::uint32_t vertices = 0, triangle_count = 0;
};

} // namespace isotet::render
