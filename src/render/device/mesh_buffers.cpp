// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/mesh_buffers.hpp"

#include "render/device/send.hpp"
#include "render/mesh_arrays.hpp"

namespace isotet::render {

Result<std::unique_ptr<MeshBuffers>> MeshBuffers::upload(std::shared_ptr<vulkan::Context> context,
                                                         const Surface& surface) {
    const Result<MeshArrays> arrays = MeshArrays::of(surface);
    if (!arrays) return arrays.error();
    auto mesh = std::make_unique<MeshBuffers>();
    mesh->origin = arrays->origin;
    mesh->vertices = arrays->vertices;
    mesh->triangle_count = arrays->triangle_count;
    Result<vulkan::Buffer> positions = send(*context, arrays->positions, "positions");
    if (!positions) return positions.error();
    mesh->positions = *std::move(positions);
    Result<vulkan::Buffer> triangles = send(*context, arrays->triangles, "triangles");
    if (!triangles) return triangles.error();
    mesh->triangles = *std::move(triangles);
    if (!arrays->normals.empty()) {
        Result<vulkan::Buffer> normals = send(*context, arrays->normals, "normals");
        if (!normals) return normals.error();
        mesh->normals = *std::move(normals);
    }
    mesh->context = std::move(context);
    return mesh;
}

} // namespace isotet::render
