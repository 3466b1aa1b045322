// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes whatever is forced upon the device, and at odd numbers of clusters, edges and isovalues.
#include <cstdlib>
#include <random>
#include <set>

#include "gpu_engine/engines.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"
#include "vulkan/engine/surface_buffers.hpp"

namespace isotet::test {
namespace {

class Forced : public Engines {
protected:
    void expect_same_on_a_nasty_grid(const DeviceGridOptions& grid_options = {}) {
        const NastyGrid g =
            nasty_grid(7, {.side = 12, .values = 3, .no_data = 0.02, .missing = 0.05, .inverted = 0.05});
        const PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
        ASSERT_LT(packed.report().tets, 20'000u);
        ExtractOptions options;
        options.normals = Normals::gradient;
        options.edge_ends = options.source_cells = true;
        DeviceGrid on_device = DeviceGrid::upload(device(), packed, grid_options).value();
        expect_same(on_device, packed, {0, 0.5}, options);
    }
};

TEST_F(Forced, StagingGivesTheSameBytes) {
    vulkan::Settings settings = watched();
    settings.force_staging = true;
    settings.staging_bytes = 4096;
    reopen(settings);
    expect_same_on_a_nasty_grid();
    expect_same_on_a_nasty_grid({.page_bytes = 20'000, .surface_bytes = {}});
}

TEST_F(Forced, Vulkan11WithItsExtensionsGivesTheSameBytes) {
    vulkan::Settings settings = watched();
    settings.vulkan_version = VK_API_VERSION_1_1;
    reopen(settings);
    expect_same_on_a_nasty_grid();
}

TEST_F(Forced, FoldingOfWorkgroupsGivesTheSameBytes) {
    vulkan::Settings settings = watched();
    settings.groups_per_axis = 7;
    reopen(settings);
    expect_same_on_a_nasty_grid();
}

TEST_F(Forced, ListsOfIsovaluesGiveTheSameBytes) {
    const Grid grid = made_grid("shuffled", 10, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    const std::vector<double> isovalues{0.4, -0.9, 7, 0.4, 0};
    for (int round = 0; round < 2; ++round) {
        const std::vector<DeviceSurface> surfaces = on_device.extract(isovalues).value();
        EXPECT_EQ(on_device.work().submissions, 2u) << "the second time with arrays that are large enough";
        ASSERT_EQ(surfaces.size(), isovalues.size());
        for (std::size_t i = 0; i < isovalues.size(); ++i)
            EXPECT_TRUE(bytes_of(on_device.download(surfaces[i]).value().surface) ==
                        bytes_of(isotet::extract(packed, isovalues[i]).value().surface))
                << isovalues[i];
    }
    EXPECT_TRUE(on_device.extract(std::vector<double>()).value().empty());
}

TEST_F(Forced, SurfacesAreUsedAgainAndGrow) {
    const Grid grid = made_grid("shuffled", 10, {"sphere"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    DeviceSurface surface;
    for (const double isovalue : {0.2, 0.9, 0.3, 0.85, 5.0}) {
        const std::uint64_t before = surface.device_bytes();
        on_device.extract(isovalue, surface).value();
        EXPECT_GE(surface.device_bytes(), before);
        EXPECT_EQ(on_device.work().submissions, surface.device_bytes() > before ? 2u : 1u) << isovalue;
        EXPECT_LT(on_device.work().uploaded_bytes + on_device.work().downloaded_bytes, 600u) << "heads only";
        const Extraction expected = isotet::extract(packed, isovalue).value();
        EXPECT_TRUE(bytes_of(on_device.download(surface).value().surface) == bytes_of(expected.surface)) << isovalue;
        const vulkan::layout::DrawArguments& draw = surface.buffers()->result.draw;
        EXPECT_EQ(draw.index_count, 3 * expected.surface.triangle_count());
        EXPECT_EQ(draw.instance_count, 1u);
    }
}

// 0, 1, 31, 32, 33 selected clusters and some around the 128 of a segment: islands of one tet, 32 a cluster.
TEST_F(Forced, AnyNumberOfSelectedClustersGivesTheSameBytes) {
    constexpr std::size_t islands = 32 * 140;
    std::vector<std::array<double, 3>> points;
    std::vector<Corners> tets;
    for (std::size_t i = 0; i < islands; ++i) {
        const double x = 2.0 * static_cast<double>(i);
        const auto first = static_cast<std::int64_t>(points.size());
        for (const auto& p : {std::array{x, 0.0, 0.0}, {x + 1, 0.0, 0.0}, {x, 1.0, 0.0}, {x, 0.0, 1.0}})
            points.push_back(p);
        tets.push_back({first, first + 1, first + 2, first + 3});
    }
    const PackedGrid packed = pack(tet_grid(points, tets), field_of(std::vector<float>(points.size()))).value();
    ASSERT_EQ(packed.report().clusters, islands / 32);
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    for (const std::size_t wanted : {0, 1, 31, 32, 33, 127, 128, 129, 140}) {
        std::vector<float> values(points.size(), -1.f);
        for (std::size_t c = 0; c < wanted; ++c) {
            std::uint64_t locals[core::max_cluster_points];
            const std::size_t count = core::local_points(packed.data(), c, locals);
            for (std::size_t k = 0; k < count; ++k) {
                const std::uint64_t point = packed.data().user_point(locals[k]);
                values[point] = static_cast<float>(point % 4) - 0.5f;
            }
        }
        on_device.set_field(field_of(std::move(values))).value();
        expect_same(on_device, on_device.packed(), {0}, {});
        const DeviceSurface surface = on_device.extract(0).value();
        EXPECT_EQ(surface.triangle_count(), 32 * wanted);
        EXPECT_EQ(surface.buffers()->result.selected_clusters, wanted);
    }
}

TEST_F(Forced, AGridWhereEveryTetIsCutGivesTheSameBytes) {
    const Grid grid = made_grid("kuhn", 12, {"plane"});
    std::vector<float> values; // every tet of a cube has a corner on even and one on odd layers
    for (std::size_t p = 0; p < grid.points.tuples(); ++p) values.push_back(p % 2 ? 1.f : -1.f);
    const PackedGrid packed = pack(grid, field_of(std::move(values))).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    expect_same(on_device, packed, {0, 0.25}, {});
    EXPECT_GE(on_device.extract(0).value().triangle_count(), packed.report().tets);
}

// Tets between any four of few points: clusters with more active edges than any mesh has.
TEST_F(Forced, ClustersWithManyCrossedEdgesGiveTheSameBytes) {
    std::mt19937 random(3);
    std::vector<std::array<double, 3>> points(300);
    for (auto& point : points)
        for (double& x : point) x = std::uniform_real_distribution<double>(-1, 1)(random);
    std::vector<Corners> tets;
    while (tets.size() < 4000) {
        Corners tet;
        const auto base = std::uniform_int_distribution<std::int64_t>(0, 2)(random) * 90;
        for (std::int64_t& corner : tet) corner = base + std::uniform_int_distribution<std::int64_t>(0, 119)(random);
        std::set<std::int64_t> distinct(tet.begin(), tet.end());
        if (distinct.size() == 4) tets.push_back(tet);
    }
    std::vector<float> values;
    for (std::size_t p = 0; p < points.size(); ++p)
        values.push_back(static_cast<float>(p % 2) + static_cast<float>(p % 7) / 16);
    const PackedGrid packed = pack(tet_grid(points, tets), field_of(std::move(values))).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    expect_same(on_device, packed, {0.75, 1, 0.1}, {});
    const DeviceSurface surface = on_device.extract(0.75).value();
    EXPECT_EQ(surface.buffers()->result.many_edges, 1u) << "no cluster had many";
    EXPECT_EQ(on_device.work().submissions, 2u) << "the kernel for many edges is known by now, room is made";
}

// Every address that a kernel uses is looked at. Compiling the kernels of an extraction so takes minutes on a software
// device: with ISOTET_WATCH_EXTRACTION in the environment they are watched, too.
TEST_F(Forced, WatchedAddressesStayInTheirBuffers) {
    vulkan::Settings settings = watched();
    settings.watch.validation = vulkan::Validation::gpu_assisted;
    reopen(settings);
    const NastyGrid g = nasty_grid(7, {.side = 6, .values = 3, .no_data = 0.02, .missing = 0.05});
    PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed, {.page_bytes = 10'000, .surface_bytes = {}}).value();
    on_device.set_field(g.field).value();
    if (!std::getenv("ISOTET_WATCH_EXTRACTION")) return;
    ExtractOptions options;
    options.edge_ends = options.source_cells = true;
    options.point_fields = {{"place", g.grid.points}};
    for (const Normals normals : {Normals::gradient, Normals::face}) {
        options.normals = normals;
        expect_same(on_device, packed, {0, 0.5}, options);
    }
}

TEST_F(Forced, MoreThanCanBeNumberedIsRefusedWithTheNumber) {
    const Grid grid = made_grid("kuhn", 6, {"sphere"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const Surface expected = isotet::extract(packed, 0.7).value().surface;
    vulkan::Settings settings = watched();
    settings.max_items = expected.triangle_count();
    reopen(settings);
    EXPECT_TRUE(DeviceGrid::upload(device(), packed).value().extract(0.7));
    --settings.max_items;
    reopen(settings);
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    const auto refused = on_device.extract(0.7);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(refused.error().message, "the surface has " + std::to_string(expected.vertex_count()) + " vertices and " +
                                           std::to_string(expected.triangle_count()) +
                                           " triangles, but the vulkan engine can number " +
                                           std::to_string(settings.max_items) + " of each");
    EXPECT_EQ(on_device.extract(5).value().triangle_count(), 0u) << "the grid can still be used";
}

TEST_F(Forced, WrongCallsAreErrors) {
    const Grid grid = made_grid("kuhn", 4, {"sphere"});
    PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    EXPECT_EQ(on_device.extract(NAN).error().message, "the isovalue is nan, but must be finite");
    ExtractOptions options;
    options.normals = Normals::gradient;
    EXPECT_EQ(on_device.extract(0.5, options).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(on_device.download(DeviceSurface()).error().code, ErrorCode::invalid_argument);
    const PackedGrid wide = pack(grid, point_field(grid), {.precision = Precision::float64}).value();
    const auto refused = DeviceGrid::upload(device(), wide);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(refused.error().message,
              "the grid was packed in double precision, but the vulkan engine takes single precision only");
}

} // namespace
} // namespace isotet::test
