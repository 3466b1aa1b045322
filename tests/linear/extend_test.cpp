// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays continued for derived points and cells.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>

#include "linear/polyhedral_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

TEST(Extend, KeepsConstantsExactly) {
    const LinearGrid linear = linearize(octree_grid({.seed = 2})).value();
    ASSERT_GT(linear.derived.count(), 0u);
    for (const double value : {0.1, 1e300, -3.3e-17}) {
        const Array out = linear.extend(Array::own(std::vector<double>(linear.user_points, value))).value();
        ASSERT_EQ(out.tuples(), linear.grid.points.tuples());
        for (const double extended : out.as<double>()) ASSERT_EQ(extended, value);
    }
}

TEST(Extend, KeepsTypesOfFloatsAndMakesDoublesOfIntegers) {
    const LinearGrid linear = linearize(octree_grid({.seed = 2})).value();
    const std::size_t points = linear.user_points;
    EXPECT_EQ(linear.extend(Array::own(std::vector<float>(points, 1))).value().type(), ScalarType::float32);
    EXPECT_EQ(linear.extend(Array::own(std::vector<double>(points, 1))).value().type(), ScalarType::float64);
    std::vector<std::uint8_t> alternating(points);
    for (std::size_t i = 0; i < points; ++i) alternating[i] = i % 2;
    const Array doubles = linear.extend(Array::own(std::move(alternating))).value();
    ASSERT_EQ(doubles.type(), ScalarType::float64);
    const auto values = doubles.as<double>();
    EXPECT_TRUE(std::any_of(values.begin(), values.end(), [](double v) { return v > 0 && v < 1; }))
        << "means of integers are not rounded";
}

TEST(Extend, HasNoDataWhereAPointHasNone) {
    const LinearGrid linear = linearize(octree_grid({.seed = 2})).value();
    const auto first = linear.derived.first.as<std::uint64_t>(), of = linear.derived.points.as<std::uint64_t>();
    std::vector<double> values(linear.user_points, 1);
    const std::uint64_t hole = of[first[1] - 1]; // the last point of the first derived one
    values[hole] = std::numeric_limits<double>::quiet_NaN();
    const Array out = linear.extend(Array::own(std::move(values))).value();
    for (std::size_t row = 0; row < linear.derived.count(); ++row) {
        const bool has = std::find(of.begin() + static_cast<std::ptrdiff_t>(first[row]),
                                   of.begin() + static_cast<std::ptrdiff_t>(first[row + 1]),
                                   hole) != of.begin() + static_cast<std::ptrdiff_t>(first[row + 1]);
        EXPECT_EQ(std::isnan(out.at(linear.user_points + row)), has);
    }
}

TEST(Extend, NeedsNoWeightsForMeans) {
    const Grid foam = make_grid({.shape = "kelvin", .side = 3, .fields = {}}).value();
    const LinearGrid linear = linearize(foam).value();
    ASSERT_EQ(linear.report.moved_centres, 0u);
    ASSERT_GT(linear.derived.count(), 0u);
    EXPECT_TRUE(linear.derived.weights.empty());
    std::vector<double> values(linear.user_points);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * i % 101);
    const auto first = linear.derived.first.as<std::uint64_t>(), of = linear.derived.points.as<std::uint64_t>();
    const Array out = linear.extend(Array::borrow(values)).value();
    LinearGrid weighted = linear; // with the same weights written out
    std::vector<double> weights;
    for (std::size_t row = 0; row < linear.derived.count(); ++row) {
        const std::size_t count = first[row + 1] - first[row];
        double sum = 0;
        for (std::uint64_t i = first[row]; i < first[row + 1]; ++i) sum += values[of[i]];
        EXPECT_NEAR(out.at(values.size() + row), sum / static_cast<double>(count), 1e-12);
        weights.insert(weights.end(), count, 1 / static_cast<double>(count));
    }
    weighted.derived.weights = Array::own(std::move(weights));
    const Array same = weighted.extend(Array::borrow(values)).value();
    EXPECT_TRUE(std::ranges::equal(out.as<double>(), same.as<double>()));
}

TEST(Extend, GivesCentresTheValuesOfTheirCells) {
    const LinearGrid linear = linearize(octree_grid({.seed = 2})).value();
    const auto sources = linear.source_cells.as<std::uint64_t>();
    std::vector<float> points(linear.user_points), numbers(linear.user_cells);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = -static_cast<float>(i);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
    for (const bool wide : {false, true}) {
        const Array given = wide ? Array::own(std::vector<double>(points.begin(), points.end())) : Array::own(points);
        const Array out = linear.extend(given, Array::own(numbers)).value();
        ASSERT_EQ(out.type(), given.type());
        ASSERT_EQ(out.tuples(), linear.grid.points.tuples());
        for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(out.at(i), points[i]);
        std::size_t centres = 0;
        const Cells& cells = linear.grid.cells;
        for (std::size_t cell = 0; cell < cells.count(); ++cell)
            for (auto i = static_cast<std::size_t>(cells.offsets.at(cell)); i < cells.offsets.at(cell + 1); ++i)
                if (const auto point = static_cast<std::size_t>(cells.connectivity.at(i)); point >= points.size()) {
                    ASSERT_EQ(out.at(point), static_cast<double>(sources[cell]));
                    ++centres;
                }
        EXPECT_GT(centres, linear.derived.count());
    }
    EXPECT_EQ(linear.extend(Array::own(points), Array::own(points)).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(linear.extend(linear.grid.points, Array::own(numbers)).error().code, ErrorCode::invalid_argument);
}

TEST(Extend, TakesVectorsAndCells) {
    const LinearGrid linear = linearize(octree_grid({.seed = 2})).value();
    const Array points = linear.extend(octree_grid({.seed = 2}).points).value();
    ASSERT_EQ(points.components(), 3u);
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_EQ(points.as<double>()[i], linear.grid.points.as<double>()[i]);
    std::vector<std::int16_t> numbers(2 * linear.user_cells);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int16_t>(i);
    const Array cells = linear.of_cells(Array::own(std::move(numbers), 2)).value();
    ASSERT_EQ(cells.tuples(), linear.grid.cells.count());
    for (std::size_t cell = 0; cell < cells.tuples(); ++cell)
        ASSERT_EQ(cells.at(cell, 1), static_cast<double>(2 * linear.source_cells.as<std::uint64_t>()[cell] + 1));
}

TEST(Extend, RefusesArraysOfAnotherLength) {
    const LinearGrid linear = linearize(octree_grid({.seed = 2})).value();
    const Array wrong = Array::own(std::vector<double>(5));
    EXPECT_EQ(linear.extend(wrong).error().message, "the array has 5 tuples, but the user's grid has 343 points");
    EXPECT_EQ(linear.of_cells(wrong).error().code, ErrorCode::invalid_argument);
}

TEST(Extend, LeavesLinearGridsAlone) {
    const Grid grid = made_grid("mixed", 3, {"gyroid"}, 1);
    const LinearGrid linear = linearize(grid).value();
    EXPECT_EQ(linear.grid.points.data(), grid.points.data());
    EXPECT_EQ(linear.grid.cells.connectivity.data(), grid.cells.connectivity.data());
    EXPECT_EQ(linear.extend(grid.point_fields[0].values).value().data(), grid.point_fields[0].values.data());
    EXPECT_EQ(linear.derived.count(), 0u);
}

} // namespace
} // namespace isotet::test
