// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The triangles of tets that are drawn, by the compute twin of their vertex shader.
#include <cmath>

#include "base/buffer.hpp"
#include "render/device/chosen_tets.hpp"
#include "render_shaders.hpp"

namespace isotet::render {

namespace {

using Place = std::array<float, 3>;
using Triangle = std::array<std::array<double, 3>, 3>;

/// Adds what a quad holds: none, one or two triangles.
void add_triangles(const Place* quad, const std::array<double, 3>& origin, std::vector<Triangle>& triangles) {
    if (std::isnan(quad[0][0])) return;
    constexpr std::size_t corners[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (const auto& [i, j, k] : corners) {
        if (quad[i] == quad[j] || quad[j] == quad[k] || quad[k] == quad[i]) continue;
        Triangle& triangle = triangles.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            triangle[0][axis] = origin[axis] + static_cast<double>(quad[i][axis]);
            triangle[1][axis] = origin[axis] + static_cast<double>(quad[j][axis]);
            triangle[2][axis] = origin[axis] + static_cast<double>(quad[k][axis]);
        }
    }
}

} // namespace

Result<std::vector<Triangle>> ChosenTets::triangles() const {
    std::vector<Triangle> triangles;
    if (parts_.empty()) return triangles;
    vulkan::Context& context = *store_->context;
    const auto constants = store_->constants(has_list_);
    const Result<const vulkan::Kernel*> twin = context.kernels().get(vulkan::drawing::tet_twin, constants);
    if (!twin) return twin.error();
    constexpr std::uint64_t vertices_per_tet = 4, most = std::uint64_t{layout::page_tets} * vertices_per_tet;
    const Result<vulkan::Buffer> item =
        context.memory().take(sizeof(layout::TetPage), vulkan::Where::device, "a page of tets");
    if (!item) return item.error();
    const Result<vulkan::Buffer> vertices =
        context.memory().take(most * sizeof(Place), vulkan::Where::device, "vertices of tets");
    if (!vertices) return vertices.error();
    core::Buffer<Place> places(most);
    for (const Part& part : parts_) {
        const layout::TetPage page = describe(part);
        vulkan::Recorder recorder(context);
        recorder.write(*item, 0, std::as_bytes(std::span(&page, 1)));
        if (!part.page->on_device) recorder.copy(part.page->records, 0, store_->guest, 0, part.page->records.size());
        std::vector<vulkan::Use> uses{vulkan::reads(*item), vulkan::writes(*vertices)};
        add_uses(part, vulkan::Access::kernel_read, uses);
        const std::uint64_t count = part.tets * vertices_per_tet;
        const layout::TwinPush push{vulkan::address_of(*item), vulkan::address_of(*vertices),
                                    static_cast<std::uint32_t>(count)};
        recorder.dispatch(**twin, push, (count + layout::twin_size - 1) / layout::twin_size, uses);
        if (const Result<vulkan::Timings> ran = recorder.run(); !ran) return ran.error();
        const auto found = std::as_writable_bytes(std::span(places.data(), count));
        if (Result<void> fetched = context.staging().download(*vertices, 0, found); !fetched) return fetched.error();
        for (std::uint64_t tet = 0; tet < part.tets; ++tet)
            add_triangles(places.data() + vertices_per_tet * tet, store_->origin, triangles);
    }
    return triangles;
}

} // namespace isotet::render
