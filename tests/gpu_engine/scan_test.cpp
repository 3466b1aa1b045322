// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sizes of surfaces that no test could extract: scan adds up counts that are put where count would have left them.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "gpu_engine/engines.hpp"
#include "packed/packed.hpp"
#include "vulkan/engine/grid_on_device.hpp"

namespace isotet::test {
namespace {

using vulkan::layout::Count;

class Scan : public Engines {
protected:
    static constexpr std::size_t clusters = 3 * 128 * 128; ///< three blocks

    /// Clusters of nothing, but for a point in the first.
    static core::Packed empty_clusters() {
        core::Packed packed;
        packed.headers = core::SharedBuffer<core::ClusterHeader>(clusters);
        std::fill(packed.headers.begin(), packed.headers.end(), core::ClusterHeader{});
        packed.headers[0].own_points = 1;
        packed.point_ids = core::SharedBuffer<std::uint32_t>(1);
        packed.point_ids[0] = 0;
        packed.has_no_data = core::SharedBuffer<std::uint8_t>(clusters);
        std::fill(packed.has_no_data.begin(), packed.has_no_data.end(), std::uint8_t{0});
        packed.as<float>().values = core::SharedBuffer<float>(1);
        packed.as<float>().positions = core::SharedBuffer<float>(3);
        std::fill_n(packed.as<float>().values.data(), 1, 0.f);
        std::fill_n(packed.as<float>().positions.data(), 3, 0.f);
        auto& ranges = packed.as<float>().ranges;
        ranges = core::SharedBuffer<core::Range<float>>(clusters);
        std::fill(ranges.begin(), ranges.end(), core::Range<float>{0, 1});
        return packed;
    }

    /// The head of a surface after blocks with these counts have been added up.
    vulkan::layout::Output scan(const std::array<Count, 3>& blocks) {
        const auto packed = std::make_shared<const core::Packed>(empty_clusters());
        const auto grid = vulkan::GridOnDevice::upload(shared_context(), packed, {}, {}).value();
        const vulkan::Resident& resident = grid->resident();
        std::vector<Count> sums(resident.sizes().segments, Count{0, 0});
        sums.insert(sums.end(), blocks.begin(), blocks.end());
        context().staging().upload(resident.sums, 0, std::as_bytes(std::span(sums))).value();

        vulkan::SurfaceBuffers surface;
        surface.prepare(context(), {}).value();
        const vulkan::Task task{{0.5f}, Ties::merge, surface, {}};
        const vulkan::Passes passes = vulkan::Passes::make(context(), resident, {}).value();
        vulkan::Recorder recorder(context());
        passes.begin(recorder, task);
        passes.scan(recorder, task);
        recorder.run().value();
        vulkan::layout::Output head{};
        context().staging().download(surface.head, 0, std::as_writable_bytes(std::span(&head, 1))).value();
        return head;
    }

    static std::uint64_t wide(std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; }
};

TEST_F(Scan, AddsUpInSixtyFourBits) {
    const std::array<std::array<Count, 3>, 4> all = {
        {{{{0, 0}, {0, 0}, {0, 0}}},
         {{{7, 0xfffffffe}, {0, 0}, {1, 1}}},
         {{{0xffffffff, 5}, {1, 0}, {0, 0}}},
         {{{0xffffffff, 0xfffffffa}, {0xffff0001, 0x12345678}, {0x0001ffff, 0xffffffff}}}}};
    for (const auto& blocks : all) {
        std::uint64_t vertices = 0, triangles = 0;
        for (const Count& block : blocks) {
            vertices += block.vertices;
            triangles += block.triangles;
        }
        const vulkan::layout::Output head = scan(blocks);
        EXPECT_EQ(wide(head.vertices_low, head.vertices_high), vertices);
        EXPECT_EQ(wide(head.triangles_low, head.triangles_high), triangles);
        EXPECT_EQ(head.overflow, vertices + triangles > 0 ? 1u : 0u) << "there is no room for any";
        EXPECT_EQ(head.draw.index_count, 0u);
        EXPECT_EQ(head.vertex_groups_x, 0u);
    }
}

} // namespace
} // namespace isotet::test
