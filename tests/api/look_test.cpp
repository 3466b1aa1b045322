// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is found out about a grid and its fields before anything is contoured.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/text.hpp>

namespace isotet::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Statistics, AreOfEachComponentAndOfFiniteValues) {
    const Array values = Array::own(std::vector<double>{1, nan, -4, INFINITY, 2.5, nan}, 2);
    const auto all = statistics_of(values).value();
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].lower, -4);
    EXPECT_EQ(all[0].upper, 2.5);
    EXPECT_EQ(all[0].not_a_number, 0u);
    EXPECT_GT(all[1].lower, all[1].upper) << "no finite value";
    EXPECT_EQ(all[1].not_a_number, 2u);
    EXPECT_EQ(all[1].infinite, 1u);
}

TEST(Statistics, CanBeCancelled) {
    const std::atomic<bool> cancel = true;
    const auto all =
        statistics_of(Array::own(std::vector<double>(8, 1.0)), {.progress = {.report = {}, .cancel = &cancel}});
    ASSERT_FALSE(all);
    EXPECT_EQ(all.error().code, ErrorCode::cancelled);
}

TEST(TypicalRange, LeavesOutRareValues) {
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i) values.push_back(i);
    values.push_back(1e9);
    const ValueRange range = typical_range(Array::own(std::move(values)));
    EXPECT_EQ(range.lower, 20);
    EXPECT_EQ(range.upper, 980);
    const ValueRange two = typical_range(Array::own(std::vector<double>{3, 3, 3, 7}));
    EXPECT_EQ(two.lower, 3);
    EXPECT_EQ(two.upper, 7);
    const ValueRange none = typical_range(Array::own(std::vector<double>{nan}));
    EXPECT_GT(none.lower, none.upper);
}

TEST(CellCounts, AreByType) {
    const Grid tets = make_grid({.shape = "kuhn", .side = 2}).value();
    const auto uniform = count_cells_by_type(tets.cells);
    ASSERT_EQ(uniform.size(), 1u);
    EXPECT_EQ(uniform.begin()->second, 48u);
    EXPECT_TRUE(is_contoured(uniform.begin()->first));
    EXPECT_FALSE(is_contoured(5)) << "VTK's triangle";
    const Grid mixed = make_grid({.shape = "mixed", .side = 2}).value();
    std::uint64_t sum = 0;
    for (const auto& [type, count] : count_cells_by_type(mixed.cells)) sum += count;
    EXPECT_EQ(sum, mixed.cells.count());
}

/// `noise`   moves each of the doubled points by up to as much along each axis
Grid with_doubled_points(std::size_t side, double noise = 0) {
    Grid grid = make_grid({.shape = "kuhn", .side = side}).value();
    const auto old = grid.cells.connectivity;
    std::vector<std::uint64_t> numbers;
    std::vector<double> points;
    for (std::size_t i = 0; i < old.tuples(); ++i) {
        const auto point = static_cast<std::size_t>(old.at(i));
        numbers.push_back(i);
        for (std::size_t axis = 0; axis < 3; ++axis)
            points.push_back(grid.points.at(point, axis) + noise * std::sin(static_cast<double>(3 * i + axis)));
    }
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(numbers));
    grid.point_fields.clear();
    return grid;
}

TEST(CoincidentPoints, AreCountedOnSmallGridsAndEstimatedOnLargeOnes) {
    EXPECT_EQ(estimate_coincident_points(make_grid({.shape = "kuhn", .side = 6}).value()).points, 0u);
    const CoincidentPoints few = estimate_coincident_points(with_doubled_points(4));
    EXPECT_FALSE(few.estimated);
    EXPECT_EQ(few.points, 4u * 6 * 4 * 4 * 4 - 5 * 5 * 5);
    const CoincidentPoints many = estimate_coincident_points(with_doubled_points(24));
    const double expected = 4.0 * 6 * 24 * 24 * 24 - 25 * 25 * 25;
    EXPECT_TRUE(many.estimated);
    EXPECT_NEAR(static_cast<double>(many.points), expected, 0.05 * expected);
}

TEST(CoincidentPoints, AreThoseApartByRoundingToo) {
    for (const double noise : {1e-15, 1e-12, 1e-8}) {
        const Grid grid = with_doubled_points(4, noise);
        EXPECT_EQ(estimate_coincident_points(grid).points, 4u * 6 * 4 * 4 * 4 - 5 * 5 * 5) << noise;
        EXPECT_TRUE(may_have_coincident_points(grid.points)) << noise;
    }
    const CoincidentPoints many = estimate_coincident_points(with_doubled_points(24, 1e-13));
    const double expected = 4.0 * 6 * 24 * 24 * 24 - 25 * 25 * 25;
    EXPECT_NEAR(static_cast<double>(many.points), expected, 0.05 * expected);
}

TEST(CoincidentPoints, AreNotTheCornersOfThinCells) {
    Grid grid = make_grid({.shape = "kuhn", .side = 6}).value();
    std::vector<double> points;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            points.push_back(grid.points.at(i, axis) * (axis == 2 ? 1e-12 : 1));
    grid.points = Array::own(std::move(points), 3);
    EXPECT_EQ(estimate_coincident_points(grid).points, 0u);
}

TEST(Looks, BeginNoThreadWhereThereIsToBeOne) {
    const auto threads = [] {
        const std::filesystem::directory_iterator tasks("/proc/self/task");
        return std::distance(begin(tasks), end(tasks));
    };
    const isotet::Run one{.threads = 1};
    Grid grid = with_doubled_points(24);
    grid.cells.types = Array::own(std::vector<std::uint8_t>(std::size_t{3} << 20, 10));
    Surface surface;
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 2, 0}, 3);
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 0; i < 100000; ++i) triangles.insert(triangles.end(), {0, 1, 2});
    surface.triangles = Array::own(std::move(triangles), 3);
    const auto before = threads();
    EXPECT_EQ(area(surface, one), 100000);
    EXPECT_EQ(count_cells_by_type(grid.cells, one).at(10), std::size_t{3} << 20);
    EXPECT_GT(estimate_coincident_points(grid, one).points, 0u);
    EXPECT_TRUE(may_have_coincident_points(grid.points, one));
    const double rounding = rounding_of(grid.points, one);
    EXPECT_EQ(threads(), before);
    EXPECT_EQ(rounding, rounding_of(grid.points));
}

TEST(BoundaryOfAGrid, IsTheCubeAndTheSameForAnyThreadCount) {
    for (const char* shape : {"kuhn", "shuffled", "mixed", "hex"}) {
        const Grid grid = make_grid({.shape = shape, .side = 9}).value();
        const Surface surface = boundary_of(grid).value();
        const SurfaceReport report = check(surface, {.closed = true}).value();
        EXPECT_TRUE(report.closed) << shape;
        EXPECT_EQ(report.triangles, 6u * 9 * 9 * 2) << shape;
        EXPECT_NEAR(report.area, 24, 1e-4) << shape;
        EXPECT_NEAR(report.volume, 8, 1e-4) << shape << ": faces look outwards";
        const Surface single = boundary_of(grid, {.threads = 1}).value();
        ASSERT_EQ(single.triangle_count(), surface.triangle_count());
        EXPECT_TRUE(std::ranges::equal(single.triangles.as<std::uint32_t>(), surface.triangles.as<std::uint32_t>()));
    }
}

TEST(BoundaryOfAGrid, FacesOutwardsWhereAllTetsAreInverted) {
    Grid grid = make_grid({.shape = "kuhn", .side = 3}).value();
    std::vector<std::uint64_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.tuples(); ++i)
        corners.push_back(static_cast<std::uint64_t>(grid.cells.connectivity.at(i ^ 1)));
    grid.cells.connectivity = Array::own(std::move(corners));
    EXPECT_NEAR(check(boundary_of(grid).value(), {.closed = true}).value().volume, 8, 1e-4);
}

TEST(BoundaryOfAGrid, NeedsSomethingToContourAndCanBeCancelled) {
    EXPECT_FALSE(boundary_of(Grid{}));
    const std::atomic<bool> cancel = true;
    const Grid grid = make_grid({.shape = "kuhn", .side = 4}).value();
    const Result<Surface> surface = boundary_of(grid, {.progress = {.report = {}, .cancel = &cancel}});
    ASSERT_FALSE(surface);
    EXPECT_EQ(surface.error().code, ErrorCode::cancelled);
}

TEST(Utf8, BytesThatBeginNoCharacterAreNotValid) {
    EXPECT_EQ(first_utf8_character("\xC3\xA9x").code, U'\u00E9');
    EXPECT_EQ(first_utf8_character("\xC3\xA9x").bytes, 2u);
    for (const char* wrong : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\xA9"}) {
        EXPECT_FALSE(first_utf8_character(wrong).valid);
        EXPECT_EQ(first_utf8_character(wrong).bytes, 1u);
    }
}

} // namespace
} // namespace isotet::test
