// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/mesh_pass.hpp"

#include <array>
#include <cstddef>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "render/check_drawing.hpp"
#include "render_shaders.hpp"
#include "vulkan/engine/surface_buffers.hpp"

namespace isotet::render {

namespace {

using vulkan::address_of;
using vulkan::Buffer;
using vulkan::draws_from;

bool by_corner(std::uint32_t coloring) { return coloring == layout::by_triangle || coloring == layout::by_grid_tet; }

void place(MeshDraw& draw, const Space& space, const std::array<double, 3>& origin) {
    draw.mesh.offset = layout::vector(space.place(origin));
    draw.mesh.scale = static_cast<float>(space.scale());
}

void use(MeshDraw& draw, vulkan::layout::Address& address, const Buffer& buffer) {
    address = address_of(buffer);
    if (buffer) draw.uses.push_back(draws_from(buffer));
}

Result<void> take_mesh(MeshDraw& draw, const MeshBuffers& mesh, const FieldBuffer* colors) {
    use(draw, draw.mesh.positions, mesh.positions);
    use(draw, draw.mesh.triangles, mesh.triangles);
    use(draw, draw.mesh.normals, mesh.normals);
    draw.indices = mesh.triangles.handle();
    draw.corners = 3 * mesh.triangle_count;
    if (!colors) return {};
    const bool of_triangles = colors->coloring == layout::by_triangle;
    if (colors->coloring != layout::by_vertex && !of_triangles)
        return invalid_argument("colours of a grid were given to a mesh that was uploaded");
    return check_count(colors->count, mesh.vertices, mesh.triangle_count,
                       of_triangles ? Association::cell : Association::point);
}

Result<void> take_surface(MeshDraw& draw, const vulkan::SurfaceBuffers& surface, const FieldBuffer* colors) {
    if (surface.triangle_count() > std::numeric_limits<std::uint32_t>::max() / 3)
        return invalid_argument(fmt::format("a surface of {} triangles, but their corners must have 32-bit numbers",
                                            surface.triangle_count()));
    use(draw, draw.mesh.positions, surface.positions);
    use(draw, draw.mesh.triangles, surface.triangles);
    if (surface.parts().normals == Normals::gradient) use(draw, draw.mesh.normals, surface.normals);
    draw.indices = surface.triangles.handle();
    draw.arguments = surface.head.handle();
    draw.offset = offsetof(vulkan::layout::Output, draw);
    draw.uses.push_back(draws_from(surface.head));
    draw.corners = static_cast<std::uint32_t>(3 * surface.triangle_count());
    if (!colors) return {};
    if (colors->coloring == layout::by_grid_point) {
        if (!surface.parts().ends)
            return invalid_argument(
                "a surface that is coloured by points of the grid must be extracted with edge_ends");
        use(draw, draw.mesh.ends, surface.ends);
        use(draw, draw.mesh.weights, surface.weights);
        return {};
    }
    if (colors->coloring != layout::by_grid_tet)
        return invalid_argument("colours of a mesh were given to a surface that was extracted on the device");
    if (!surface.parts().sources)
        return invalid_argument("a surface that is coloured by cells of the grid must be extracted with source_cells");
    use(draw, draw.mesh.sources, surface.sources);
    return {};
}

void take_colors(MeshDraw& draw, const FieldBuffer& colors) {
    use(draw, draw.mesh.values, colors.values);
    use(draw, draw.mesh.table, colors.table);
    draw.mesh.no_data = light_of(colors.scale.no_data);
    draw.mesh.log_factor = log_factor_of(colors.scale);
    if (by_corner(colors.coloring)) draw.indices = VK_NULL_HANDLE;
}

} // namespace

Result<MeshDraw> make_mesh_draw(vulkan::DrawPipelines& pipelines, const Space& space, const DrawnSurface& drawn,
                                const MeshBuffers* mesh, const FieldBuffer* colors) {
    if (Result<void> right = check_opacity(drawn.opacity); !right) return right.error();
    MeshDraw draw;
    place(draw, space, mesh ? mesh->origin : drawn.surface->origin());
    const Result<void> taken =
        mesh ? take_mesh(draw, *mesh, colors) : take_surface(draw, *drawn.surface->buffers(), colors);
    if (!taken) return taken.error();
    draw.mesh.color = light_of(drawn.color);
    draw.mesh.opacity = static_cast<float>(drawn.opacity);
    if (colors) take_colors(draw, *colors);
    draw.translucent = drawn.opacity < 1;
    const bool has_normals = draw.mesh.normals.low || draw.mesh.normals.high;
    const std::uint32_t constants[] = {colors ? colors->coloring : layout::one_color, has_normals};
    namespace shaders = vulkan::drawing;
    const auto pipeline =
        draw.translucent
            ? pipelines.get(shaders::mesh_corners, shaders::mesh_translucent, vulkan::Surfaces::translucent, constants)
            : pipelines.get(shaders::mesh_corners, shaders::mesh_opaque, vulkan::Surfaces::opaque, constants);
    if (!pipeline) return pipeline.error();
    draw.pipeline = *pipeline;
    return draw;
}

void record(const MeshDraw& draw, const layout::DrawPush& push, const vulkan::DeviceFunctions& call,
            VkCommandBuffer commands) {
    call.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, draw.pipeline->pipeline);
    call.vkCmdPushConstants(commands, draw.pipeline->layout, draw.pipeline->stages, 0, sizeof push, &push);
    if (draw.indices) call.vkCmdBindIndexBuffer(commands, draw.indices, 0, VK_INDEX_TYPE_UINT32);
    // The arguments of an indexed draw begin with those of one that is not, as its vertex_offset is 0.
    static_assert(sizeof(VkDrawIndexedIndirectCommand) == sizeof(vulkan::layout::DrawArguments));
    if (draw.arguments && draw.indices) call.vkCmdDrawIndexedIndirect(commands, draw.arguments, draw.offset, 1, 0);
    else if (draw.arguments) call.vkCmdDrawIndirect(commands, draw.arguments, draw.offset, 1, 0);
    else if (draw.indices) call.vkCmdDrawIndexed(commands, draw.corners, 1, 0, 0, 0);
    else call.vkCmdDraw(commands, draw.corners, 1, 0, 0);
}

} // namespace isotet::render
