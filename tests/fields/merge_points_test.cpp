// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points at one place, or nearly, become one.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>

#include "base/parallel.hpp"
#include "grid/points/close_points.hpp"
#include "grid/points/same_place.hpp"

namespace {

using namespace isotet;

std::vector<std::int64_t> corners(const Grid& grid) {
    std::vector<std::int64_t> all;
    for (std::size_t i = 0; i < grid.cells.connectivity.tuples(); ++i)
        all.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    return all;
}

/// Two tets whose common face is there twice, the second time `off` along x; point 7 is a copy of point 0 without a
/// cell.
Grid torn(double off) {
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0,       0, 1, 0,   0, 0, 1, 0, 0, 0, 1, -0.0 + off, 0,
                                                 0, 1 + off, 0, 0, off, 1, 0, 0, 0, 0, 0, 0, -1},
                             3);
    grid.cells.connectivity = Array::own(std::vector<std::uint32_t>{0, 1, 2, 3, 6, 5, 4, 8});
    return grid;
}

/// `grid` with every tet's corners as points of its own.
Grid exploded(const Grid& grid) {
    std::vector<float> points;
    std::vector<std::int32_t> connectivity;
    const auto old = grid.cells.connectivity.as<std::int32_t>();
    for (std::size_t i = 0; i < old.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            points.push_back(static_cast<float>(grid.points.at(static_cast<std::size_t>(old[i]), axis)));
        connectivity.push_back(static_cast<std::int32_t>(i));
    }
    Grid result;
    result.points = Array::own(std::move(points), 3);
    result.cells.connectivity = Array::own(std::move(connectivity));
    return result;
}

TEST(MergePoints, JoinsExactlyEqualPointsThatCellsUse) {
    const MergedPoints merged = merge_points(torn(0), {.tolerance = 0}).value();
    EXPECT_EQ(merged.merged, 3u); // 4, 5, 6; the unused point 7 does not count
    EXPECT_EQ(corners(merged.grid), (std::vector<std::int64_t>{0, 1, 2, 3, 2, 1, 0, 8}));
    EXPECT_EQ(merged.grid.cells.connectivity.type(), ScalarType::uint32);
    EXPECT_EQ(survey(merged.grid).value().boundary_faces, 6u);
    EXPECT_EQ(merged.grid.points.tuples(), 9u);
}

TEST(MergePoints, LeavesPointsApartThatDifferInTheLastBit) {
    const Grid grid = torn(0x1p-60);
    const MergedPoints merged = merge_points(grid, {.tolerance = 0}).value();
    EXPECT_EQ(merged.merged, 1u); // 1 + 2^-60 is 1
    EXPECT_EQ(merge_points(grid, {.tolerance = 1e-9}).value().merged, 3u);
}

TEST(MergePoints, SharesTheConnectivityWhenNothingIsMerged) {
    const Grid grid = torn(0.25);
    const MergedPoints merged = merge_points(grid, {.tolerance = 0.125}).value();
    EXPECT_EQ(merged.merged, 0u);
    EXPECT_EQ(merged.grid.cells.connectivity.data(), grid.cells.connectivity.data());
}

TEST(MergePoints, JoinsWithinTheToleranceAndNotBeyond) {
    EXPECT_EQ(merge_points(torn(0.25), {.tolerance = 0.25}).value().merged, 3u);
    EXPECT_EQ(merge_points(torn(0.25), {.tolerance = std::nextafter(0.25, 0)}).value().merged, 0u);
}

TEST(MergePoints, PutsAGridTogetherAgainThatWasTakenApart) {
    MakeOptions options;
    options.shape = "perturbed";
    options.side = 12;
    const Grid whole = make_grid(options).value();
    for (const double tolerance : {0.0, 1e-6}) {
        const MergedPoints merged = merge_points(exploded(whole), {.tolerance = tolerance}).value();
        EXPECT_EQ(merged.merged, 4 * whole.cells.count() - whole.points.tuples());
        EXPECT_EQ(survey(merged.grid).value().boundary_faces, 12 * 12 * 12u);
    }
}

TEST(MergePoints, RefusesAToleranceThatMeansNothing) {
    for (const double tolerance : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity(), 1e-15, 1e-300}) {
        const auto merged = merge_points(torn(0), {.tolerance = tolerance});
        ASSERT_FALSE(merged) << tolerance;
        EXPECT_EQ(merged.error().code, ErrorCode::invalid_argument);
    }
}

TEST(MergePoints, RefusesABrokenGrid) {
    Grid grid = torn(0);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, -1});
    const auto merged = merge_points(grid, {.tolerance = 0});
    ASSERT_FALSE(merged);
    EXPECT_EQ(merged.error().code, ErrorCode::invalid_data);
}

// All pairs, joined until nothing changes.
std::vector<std::uint64_t> chains_by_force(const std::vector<float>& points, double tolerance) {
    const std::size_t count = points.size() / 3;
    std::vector<std::uint64_t> lowest(count);
    for (std::size_t i = 0; i < count; ++i) lowest[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j) {
                double sum = 0;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    sum += std::pow(double(points[3 * i + axis]) - points[3 * j + axis], 2);
                if (std::sqrt(sum) > tolerance || lowest[j] <= lowest[i]) continue;
                lowest[j] = lowest[i];
                changed = true;
            }
    }
    return lowest;
}

TEST(LowestOfChain, AgreesWithComparingAllPairsAtAnyTolerance) {
    std::uint64_t state = 1;
    const auto random = [&] {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<float>(state >> 40) * 0x1p-24f;
    };
    std::vector<float> points(3 * 400);
    for (float& x : points) x = random();
    const Array array = Array::borrow<float>(points, 3);
    const std::vector<std::uint8_t> wanted(400, 1);
    for (const double tolerance : {1e-6, 0.01, 0.03, 0.06, 0.09, 0.12, 0.2, 0.7, 3.0, 1e6}) {
        const auto expected = chains_by_force(points, tolerance);
        for (const int threads : {1, 7})
            core::with_threads(threads, [&] {
                EXPECT_EQ(core::lowest_of_chain(array, wanted, {}, tolerance), expected) << tolerance;
            });
    }
}

TEST(LowestAtSamePlace, EqualsZerosAndNothingEqualsNaN) {
    const float nan = std::nanf("");
    const Array points = Array::own(std::vector<float>{0, 1, nan, 0, 1, nan, -0.0f, 1, 2, 0, 1, 2, 5, 5, 5}, 3);
    EXPECT_EQ(core::lowest_at_same_place(points), (std::vector<std::uint64_t>{0, 1, 2, 2, 4}));
    const std::vector<std::uint8_t> wanted{1, 1, 0, 1, 1};
    EXPECT_EQ(core::lowest_at_same_place(points, wanted.data()), (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
}

/// torn(0) with a field: 1 on one side of the common face, 2 on the other.
Grid jumping() {
    Grid grid = torn(0);
    grid.point_fields.push_back({"jumps", Array::own(std::vector<float>{1, 1, 1, 0, 2, 2, 2, 9, 0})});
    grid.point_fields.push_back({"steady", Array::own(std::vector<float>{1, 1, 1, 0, 1, 1, 1, 9, 0})});
    grid.point_fields.push_back({"count", Array::own(std::vector<std::int32_t>{1, 1, 1, 0, 2, 2, 2, 9, 0})});
    return grid;
}

TEST(MergePoints, TakesMeansWhereAFieldJumps) {
    const MergedPoints lowest = merge_points(jumping()).value();
    ASSERT_EQ(lowest.jumps.size(), 3u);
    EXPECT_EQ(lowest.jumps[0].field, "jumps");
    EXPECT_EQ(lowest.jumps[0].largest, 1);
    EXPECT_EQ(lowest.jumps[1].largest, 0);
    EXPECT_EQ(lowest.grid.point_fields[0].values.at(0), 1);

    const MergedPoints mean = merge_points(jumping(), {.values = MergedValues::mean}).value();
    const Array &jumps = mean.grid.point_fields[0].values, &count = mean.grid.point_fields[2].values;
    EXPECT_EQ(jumps.type(), ScalarType::float32);
    EXPECT_EQ(count.type(), ScalarType::float64) << "means are not rounded to integers";
    for (const std::size_t merged : {0u, 1u, 2u, 4u, 5u, 6u}) {
        EXPECT_EQ(jumps.at(merged), 1.5) << merged;
        EXPECT_EQ(count.at(merged), 1.5) << merged;
        EXPECT_EQ(mean.grid.point_fields[1].values.at(merged), 1) << merged;
    }
    EXPECT_EQ(jumps.at(3), 0);
    EXPECT_EQ(jumps.at(7), 9) << "no cell uses it, so it is not merged with its like";
}

TEST(MergePoints, LeavesNaNOutOfMeans) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Grid grid = torn(0);
    grid.point_fields.push_back({"f", Array::own(std::vector<double>{nan, nan, 1, 0, nan, 2, nan, 9, 0})});
    const Array values = merge_points(grid, {.values = MergedValues::mean}).value().grid.point_fields[0].values;
    EXPECT_TRUE(std::isnan(values.at(0))) << "points 0 and 6";
    EXPECT_EQ(values.at(1), 2) << "points 1 and 5";
    EXPECT_EQ(values.at(2), 1) << "points 2 and 4";
}

TEST(MergePoints, JoinsCurvedCellsAndPolyhedra) {
    // Two quadratic tets with nodes of their own, on a common face; and two polyhedra likewise.
    const std::vector<double> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    Grid curved;
    std::vector<double> points;
    std::vector<std::int32_t> nodes;
    constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (const auto& tet : {std::array{0, 1, 2, 3}, std::array{1, 2, 3, 4}}) {
        const auto add = [&](int a, int b) {
            nodes.push_back(static_cast<std::int32_t>(points.size() / 3));
            for (int k = 0; k < 3; ++k)
                points.push_back(
                    (corners[static_cast<std::size_t>(3 * a + k)] + corners[static_cast<std::size_t>(3 * b + k)]) / 2);
        };
        for (const int corner : tet) add(corner, corner);
        for (const auto& [a, b] : edges) add(tet[static_cast<std::size_t>(a)], tet[static_cast<std::size_t>(b)]);
    }
    curved.points = Array::own(std::move(points), 3);
    curved.cells.connectivity = Array::own(std::move(nodes));
    curved.cells.offsets = Array::own(std::vector<std::int64_t>{0, 10, 20});
    curved.cells.types = Array::own(std::vector<std::uint8_t>{24, 24});
    EXPECT_EQ(merge_points(curved).value().merged, 6u) << "three corners and three nodes";

    Grid faced;
    faced.points = torn(0).points;
    faced.cells.connectivity = torn(0).cells.connectivity;
    faced.cells.offsets = Array::own(std::vector<std::int64_t>{0, 4, 8});
    faced.cells.types = Array::own(std::vector<std::uint8_t>{42, 42});
    faced.cells.faces = Array::own(std::vector<std::int32_t>{4, 3, 0, 1, 2, 3, 0, 1, 3, 3, 1, 2, 3, 3, 2, 0, 3,
                                                             4, 3, 6, 5, 4, 3, 6, 5, 8, 3, 5, 4, 8, 3, 4, 6, 8});
    faced.cells.face_offsets = Array::own(std::vector<std::int64_t>{0, 17, 34});
    const MergedPoints merged = merge_points(faced).value();
    EXPECT_EQ(merged.merged, 3u);
    EXPECT_EQ(survey(merged.grid).value().boundary_faces, 6u);
    EXPECT_EQ(survey(faced).value().boundary_faces, 8u);
}

TEST(MergePoints, RefusesBrokenCurvedCellsAndFields) {
    Grid grid = torn(0);
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 8});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{24});
    grid.cells.connectivity = Array::own(std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 99});
    EXPECT_EQ(merge_points(grid).error().message, "cell 0 has point 99, but the grid has 9 points");
    grid = torn(0);
    grid.point_fields.push_back({"short", Array::own(std::vector<float>{1, 2})});
    EXPECT_EQ(merge_points(grid).error().message, "point field 'short' has 2 tuples, but the grid has 9 points");
}

} // namespace
