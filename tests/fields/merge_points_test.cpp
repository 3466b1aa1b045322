// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points at one place, or nearly, become one.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>

#include "core/close_points.hpp"
#include "core/parallel.hpp"
#include "core/same_place.hpp"

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
    const MergedPoints merged = merge_points(torn(0), 0).value();
    EXPECT_EQ(merged.merged, 3u); // 4, 5, 6; the unused point 7 does not count
    EXPECT_EQ(corners(merged.grid), (std::vector<std::int64_t>{0, 1, 2, 3, 2, 1, 0, 8}));
    EXPECT_EQ(merged.grid.cells.connectivity.type(), ScalarType::uint32);
    EXPECT_EQ(survey(merged.grid).value().boundary_faces, 6u);
    EXPECT_EQ(merged.grid.points.tuples(), 9u);
}

TEST(MergePoints, LeavesPointsApartThatDifferInTheLastBit) {
    const Grid grid = torn(0x1p-60);
    const MergedPoints merged = merge_points(grid, 0).value();
    EXPECT_EQ(merged.merged, 1u); // 1 + 2^-60 is 1
    EXPECT_EQ(merge_points(grid, 1e-9).value().merged, 3u);
}

TEST(MergePoints, SharesTheConnectivityWhenNothingIsMerged) {
    const Grid grid = torn(0.25);
    const MergedPoints merged = merge_points(grid, 0.125).value();
    EXPECT_EQ(merged.merged, 0u);
    EXPECT_EQ(merged.grid.cells.connectivity.data(), grid.cells.connectivity.data());
}

TEST(MergePoints, JoinsWithinTheToleranceAndNotBeyond) {
    EXPECT_EQ(merge_points(torn(0.25), 0.25).value().merged, 3u);
    EXPECT_EQ(merge_points(torn(0.25), std::nextafter(0.25, 0)).value().merged, 0u);
}

TEST(MergePoints, PutsAGridTogetherAgainThatWasTakenApart) {
    MakeOptions options;
    options.shape = "perturbed";
    options.side = 12;
    const Grid whole = make_grid(options).value();
    for (const double tolerance : {0.0, 1e-6}) {
        const MergedPoints merged = merge_points(exploded(whole), tolerance).value();
        EXPECT_EQ(merged.merged, 4 * whole.cells.count() - whole.points.tuples());
        EXPECT_EQ(survey(merged.grid).value().boundary_faces, 12 * 12 * 12u);
    }
}

TEST(MergePoints, RefusesAToleranceThatMeansNothing) {
    for (const double tolerance : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity(), 1e-15, 1e-300}) {
        const auto merged = merge_points(torn(0), tolerance);
        ASSERT_FALSE(merged) << tolerance;
        EXPECT_EQ(merged.error().code, ErrorCode::invalid_argument);
    }
}

TEST(MergePoints, RefusesABrokenGrid) {
    Grid grid = torn(0);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, -1});
    const auto merged = merge_points(grid, 0);
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

} // namespace
