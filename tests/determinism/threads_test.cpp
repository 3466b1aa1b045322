// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes for 1, 2, 7 and 64 threads, again and again: packed grids, surfaces, reports; and from many threads at
// once.
#include <thread>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "determinism/packed_bytes.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

constexpr int thread_counts[] = {1, 2, 7, 64, 7, 2};

PackOptions with_everything(Precision precision) {
    PackOptions options;
    options.precision = precision;
    options.gradients = options.source_cells = true;
    return options;
}

ExtractOptions with_everything(const Grid& grid, Ties ties, Normals normals) {
    ExtractOptions options;
    options.ties = ties;
    options.normals = normals;
    options.edge_ends = options.source_cells = true;
    options.point_fields = grid.point_fields;
    return options;
}

void expect_same_bytes(const Grid& grid, const PointField& field, Precision precision,
                       const std::vector<double>& isovalues) {
    std::string packed_bytes;
    std::vector<std::string> surface_bytes;
    for (const int threads : thread_counts) {
        const PackedGrid packed = pack(grid, field, with_everything(precision), {.threads = threads}).value();
        if (packed_bytes.empty()) packed_bytes = bytes_of(packed);
        ASSERT_TRUE(bytes_of(packed) == packed_bytes) << threads << " threads";
        std::size_t place = 0;
        for (const double isovalue : isovalues)
            for (const Ties ties : {Ties::merge, Ties::keep})
                for (const Normals normals : {Normals::gradient, Normals::face, Normals::vertex}) {
                    const auto out =
                        extract(packed, isovalue, with_everything(grid, ties, normals), {.threads = threads}).value();
                    std::string bytes = bytes_of(out.surface);
                    bytes += std::to_string(area(out.surface)) + " " + std::to_string(out.report.tied_points);
                    if (surface_bytes.size() == place) surface_bytes.push_back(bytes);
                    ASSERT_TRUE(bytes == surface_bytes[place++]) << threads << " threads, isovalue " << isovalue;
                }
    }
}

TEST(Threads, DoNotMatterOnAGridOfSeveralBlocks) {
    const Grid grid = made_grid("shuffled", 24, {"gyroid"}); // 82,944 tets: more than one block of growth
    expect_same_bytes(grid, point_field(grid), Precision::float32, {0.3});
}

TEST(Threads, DoNotMatterOnMixedCells) {
    const Grid grid = made_grid("mixed", 16, {"wavelet", "integer"});
    expect_same_bytes(grid, point_field(grid, 1), Precision::float32, {2});
}

TEST(Threads, DoNotMatterInDoublePrecision) {
    const Grid grid = made_grid("perturbed", 14, {"gyroid"});
    expect_same_bytes(grid, point_field(grid), Precision::float64, {-0.2});
}

TEST(Threads, DoNotMatterWithTiesNaNAndTangledTets) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const NastyGrid g = nasty_grid(seed, {.side = 13,
                                              .values = 4,
                                              .no_data = 0.05,
                                              .missing = 0.1,
                                              .inverted = 0.1,
                                              .mirrored = 0.3,
                                              .repeated = 0.1,
                                              .wide = seed == 2});
        expect_same_bytes(g.grid, g.field, Precision::float32, {0, 1});
    }
}

TEST(Threads, DoNotMatterForNewFieldsAndPoints) {
    const Grid grid = made_grid("shuffled", 14, {"gyroid", "sphere"});
    std::vector<float> doubled;
    for (const float x : grid.points.as<float>()) doubled.push_back(2 * x);
    const Array points = Array::own(std::move(doubled), 3);
    std::string expected;
    for (const int threads : thread_counts) {
        PackedGrid packed =
            pack(grid, point_field(grid), with_everything(Precision::float32), {.threads = threads}).value();
        packed = packed.with_field(point_field(grid, 1), {.threads = threads}).value();
        packed = packed.with_points(points, {.threads = threads}).value();
        if (expected.empty()) expected = bytes_of(packed);
        EXPECT_TRUE(bytes_of(packed) == expected) << threads << " threads";
    }
}

TEST(Threads, DoNotMatterForReportsAndErrors) {
    Grid grid = made_grid("shuffled", 12, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    ExtractOptions options;
    options.edge_ends = true;
    const Surface surface = extract(packed, 0.1, options).value().surface;
    const SurfaceReport expected = check(surface, {.grid = &grid}).value();
    // Two broken cells: the error names the first, whichever thread finds it.
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    corners[4 * 3000 + 1] = 99999999;
    corners[4 * 9000 + 2] = -5;
    Grid broken = grid;
    broken.cells.connectivity = Array::own(std::move(corners));
    for (int repeat = 0; repeat < 5; ++repeat)
        for (const int threads : thread_counts) {
            const SurfaceReport report = check(surface, {.grid = &grid}).value();
            EXPECT_EQ(report.area, expected.area);
            EXPECT_EQ(report.volume, expected.volume);
            EXPECT_EQ(report.genus, expected.genus);
            const auto refused = pack(broken, point_field(grid), {}, {.threads = threads});
            ASSERT_FALSE(refused);
            EXPECT_EQ(refused.error().message, "tets[3000] has point 99999999, but the grid has 2197 points");
        }
}

TEST(ManyThreads, MayExtractFromOnePackedGridAtOnce) {
    const Grid grid = made_grid("shuffled", 14, {"gyroid", "integer"});
    const PackedGrid packed =
        pack(grid, point_field(grid), with_everything(Precision::float32), {.threads = 2}).value();
    const std::vector<double> isovalues{-0.9, -0.5, -0.1, 0, 0.1, 0.4, 0.8, 1.1};
    const auto surface_at = [&](double isovalue, int threads) {
        return bytes_of(
            extract(packed, isovalue, with_everything(grid, Ties::merge, Normals::gradient), {.threads = threads})
                .value()
                .surface);
    };
    std::vector<std::string> expected, found(isovalues.size());
    for (const double isovalue : isovalues) expected.push_back(surface_at(isovalue, 1));
    testing::internal::CaptureStderr(); // the library never prints, nor does oneTBB because of it
    for (int repeat = 0; repeat < 3; ++repeat) {
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < isovalues.size(); ++i)
            threads.emplace_back([&, i] { found[i] = surface_at(isovalues[i], 1 + static_cast<int>(i) % 3); });
        for (std::thread& thread : threads) thread.join();
        EXPECT_TRUE(found == expected);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ManyThreads, MayPackOneGridAtOnce) {
    const Grid grid = made_grid("shuffled", 10, {"gyroid"});
    const std::string expected =
        bytes_of(pack(grid, point_field(grid), with_everything(Precision::float32), {.threads = 1}).value());
    std::vector<std::string> found(4);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < found.size(); ++i)
        threads.emplace_back([&, i] {
            found[i] = bytes_of(
                pack(grid, point_field(grid), with_everything(Precision::float32), {.threads = 1 + static_cast<int>(i)})
                    .value());
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(std::count(found.begin(), found.end(), expected), 4);
}

} // namespace
} // namespace isotet::test
