// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids that lie on the device in many pages, all of them or a few at a time: the same bytes, with the traffic told.
#include "gpu_engine/engines.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

constexpr DeviceGridOptions small_pages{.page_bytes = 8 << 10, .surface_bytes = 0};

class Pages : public Engines {
protected:
    static ExtractOptions everything(const NastyGrid& g) {
        ExtractOptions options;
        options.normals = Normals::gradient;
        options.edge_ends = options.source_cells = true;
        options.point_fields = {{"value", g.field.values}};
        return options;
    }
};

TEST_F(Pages, OfAnySizeGiveTheSameBytes) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 9, .values = seed == 1 ? 0 : 4, .no_data = 0.02, .missing = 0.05});
        const PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
        for (const std::uint64_t bytes : {1, 5'000, 20'000, 1 << 20}) {
            const DeviceGridOptions options{.page_bytes = bytes, .surface_bytes = {}};
            EXPECT_EQ(DeviceGrid::needs(packed, options).pages == 1, bytes == 1 << 20);
            DeviceGrid on_device = DeviceGrid::upload(device(), packed, options).value();
            EXPECT_TRUE(on_device.complete());
            expect_same(on_device, packed, {0, 0.5}, everything(g));
        }
    }
}

TEST_F(Pages, ThatDoNotFitComeAndGo) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 13, .values = seed == 1 ? 0 : 3, .no_data = seed == 1 ? 0 : 0.02});
        const PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
        const DeviceGridNeeds needs = DeviceGrid::needs(packed, small_pages);
        // Room for the largest of the surfaces, and for three pages beside it.
        reopen(watched());
        ExtractOptions without_fields = everything(g); // of a grid in parts they are not on the device
        without_fields.point_fields.clear();
        const std::uint64_t surface =
            DeviceGrid::upload(device(), packed).value().extract(0.5, without_fields).value().device_bytes();
        const std::uint64_t limit = needs.resident_bytes + 3 * needs.largest_page_bytes + surface;
        ASSERT_LT(needs.resident_bytes + surface, limit);
        reopen(watched(), limit);
        DeviceGrid on_device = DeviceGrid::upload(device(), packed, small_pages).value();
        expect_same(on_device, packed, {0.5, 0, 0.5}, everything(g));
        EXPECT_FALSE(on_device.complete());
        EXPECT_LE(context().memory().peak(), limit);
    }
}

TEST_F(Pages, OfAGridOfFourTimesTheMemoryGiveTheSameBytes) {
    const Grid grid = made_grid("shuffled", 26, {"plane"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const DeviceGridOptions options{.page_bytes = 32 << 10, .surface_bytes = 0};
    const DeviceGridNeeds needs = DeviceGrid::needs(packed, options);
    const std::uint64_t limit = needs.all() / 4;
    reopen(watched(), limit);
    DeviceGrid on_device = DeviceGrid::upload(device(), packed, options).value();
    std::uint64_t loads = 0, uploaded = 0;
    for (const double isovalue : {-0.6, 0.1, 0.55}) {
        const Extraction expected = isotet::extract(packed, isovalue).value();
        ASSERT_GT(expected.surface.triangle_count(), 3000u);
        const DeviceSurface surface = on_device.extract(isovalue).value();
        loads += on_device.work().page_loads;
        uploaded += on_device.work().uploaded_bytes;
        EXPECT_TRUE(bytes_of(on_device.download(surface).value().surface) == bytes_of(expected.surface)) << isovalue;
    }
    EXPECT_LE(context().memory().peak(), limit);
    EXPECT_GT(loads, 0u);
    EXPECT_GE(uploaded, loads * needs.page_bytes / needs.pages / 2) << "pages are part of the traffic";
}

TEST_F(Pages, AreLoadedByTheirRangeOnly) {
    const Grid grid = made_grid("kuhn", 20, {"plane"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const DeviceGridOptions options{.page_bytes = 16 << 10, .surface_bytes = 0};
    const DeviceGridNeeds needs = DeviceGrid::needs(packed, options);
    reopen(watched(), needs.resident_bytes + needs.page_bytes * 3 / 4);
    DeviceGrid on_device = DeviceGrid::upload(device(), packed, options).value();
    EXPECT_FALSE(on_device.complete());
    DeviceSurface surface;
    on_device.extract(0.93, surface).value();
    EXPECT_LT(on_device.work().page_loads, needs.pages / 3);
    on_device.extract(0.93, surface).value();
    EXPECT_EQ(on_device.work().page_loads, 0u) << "what was needed last stays";
    EXPECT_EQ(on_device.work().submissions, 1u);
    on_device.extract(5, surface).value();
    EXPECT_EQ(on_device.work().page_loads, 0u) << "a value outside the range needs no page";
    EXPECT_EQ(surface.triangle_count(), 0u);
}

TEST_F(Pages, OfWhichNoneFitsAreRefusedBeforehand) {
    const Grid grid = made_grid("kuhn", 12, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const DeviceGridNeeds needs = DeviceGrid::needs(packed);
    reopen(watched(), needs.least() - 1);
    const auto refused = DeviceGrid::upload(device(), packed);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    EXPECT_EQ(context().memory().peak(), 0u) << "nothing was taken";
    reopen(watched(), needs.least());
    EXPECT_TRUE(DeviceGrid::upload(device(), packed));
}

TEST_F(Pages, LeaveNothingForASurfaceThatIsTooLarge) {
    const Grid grid = made_grid("kuhn", 12, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    reopen(watched(), DeviceGrid::needs(packed, small_pages).least() + 4096);
    DeviceGrid on_device = DeviceGrid::upload(device(), packed, small_pages).value();
    DeviceSurface surface;
    const auto refused = on_device.extract(0.1, surface);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    on_device.extract(2, surface).value();
    EXPECT_EQ(surface.triangle_count(), 0u) << "the grid can still be used";
}

} // namespace
} // namespace isotet::test
