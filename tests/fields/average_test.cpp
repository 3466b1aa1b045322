// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cell fields averaged to points.
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/make.hpp>

#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "grid/values/cell_means.hpp"

namespace {

using namespace isotet;

/// Two tets on the face 0 1 2: one of height 1 to point 3, one of height 3 to point 4; point 5 is unused.
Grid two_tets(Array values) {
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -3, 9, 9, 9}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2, 4});
    grid.cell_fields = {{"c", std::move(values)}};
    return grid;
}

/// Cells that go by in their order give the same.
void expect_same_of_cells_that_go_by(const Grid& grid, core::Scalar scalar, const Array& expected) {
    const core::CellReader cells = core::CellReader::open(grid).value();
    for (const int threads : {1, 3})
        core::with_threads(threads, [&] {
            core::CellMeans means(grid.points);
            means.add(cells, grid.cell_fields[0].values, scalar, 0);
            const Array found = std::move(means).finish(grid.cell_fields[0].values.type());
            EXPECT_EQ(found.type(), expected.type());
            ASSERT_EQ(found.bytes(), expected.bytes());
            EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.bytes()), 0);
        });
}

Array averaged(const Grid& grid, std::string_view name = "c") {
    const PointField found = find_field(grid, name).value();
    EXPECT_TRUE(found.averaged);
    const std::size_t colon = name.find(':');
    const auto scalar = colon == name.npos ? core::Scalar() : *core::CellMeans::scalar_called(name.substr(colon + 1));
    expect_same_of_cells_that_go_by(grid, scalar, found.values);
    return found.values;
}

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

TEST(AverageToPoints, WeighsCellsByTheirVolume) {
    const Array values = averaged(two_tets(Array::own(std::vector<float>{4, 8})));
    EXPECT_EQ(values.type(), ScalarType::float32);
    EXPECT_EQ(values.at(0), 7); // (1 * 4 + 3 * 8) / 4
    EXPECT_EQ(values.at(3), 4);
    EXPECT_EQ(values.at(4), 8);
    EXPECT_TRUE(std::isnan(values.at(5)));
}

TEST(AverageToPoints, LeavesCellsWithoutDataOut) {
    const Array values = averaged(two_tets(Array::own(std::vector<float>{4, nan_value})));
    EXPECT_EQ(values.at(0), 4);
    EXPECT_TRUE(std::isnan(values.at(4)));
}

TEST(AverageToPoints, MakesDoublesOfIntegersAndTakesComponents) {
    const Array values = averaged(two_tets(Array::own(std::vector<std::int32_t>{3, 4, 0, 1}, 2)), "c:mag");
    EXPECT_EQ(values.type(), ScalarType::float64);
    EXPECT_EQ(values.at(3), 5);
    EXPECT_EQ(averaged(two_tets(Array::own(std::vector<std::int32_t>{3, 4, 7, 8}, 2)), "c:y").at(0), 7);
}

TEST(AverageToPoints, KeepsInfinitiesAndFindsNoDataBetweenOppositeOnes) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(averaged(two_tets(Array::own(std::vector<double>{1, -infinity}))).at(0), -infinity);
    EXPECT_EQ(averaged(two_tets(Array::own(std::vector<double>{infinity, 1}))).at(0), infinity);
    EXPECT_TRUE(std::isnan(averaged(two_tets(Array::own(std::vector<double>{infinity, -infinity}))).at(0)));
}

TEST(AverageToPoints, DoesNotOverflow) {
    EXPECT_DOUBLE_EQ(averaged(two_tets(Array::own(std::vector<double>{1.5e308, 1.7e308}))).at(0), 1.65e308);
}

TEST(AverageToPoints, TreatsFlatCellsAlikeWhenThereAreNoOthers) {
    Grid grid = two_tets(Array::own(std::vector<float>{4, 8}));
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0, 9, 9, 9}, 3);
    EXPECT_EQ(averaged(grid).at(0), 6);
}

TEST(AverageToPoints, CountsACollapsedCellOnceAtItsRepeatedCorner) {
    Grid grid;
    // A pyramid whose base has the point 1 twice, and a tet.
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 1, 2, 3, 1, 2, 3, 4});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 5, 9});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{14, 10});
    grid.cell_fields = {{"c", Array::own(std::vector<double>{3, 9})}};
    // Volumes 1/6 and 2/6.
    EXPECT_DOUBLE_EQ(averaged(grid).at(1), 7);
}

TEST(AverageToPoints, LooksAtContouredCellsOnly) {
    Grid grid = two_tets(Array::own(std::vector<float>{4, 8, 100}));
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3, 0, 1, 2, 4, 0, 3, 5});
    grid.cells.offsets = Array::own(std::vector<std::int32_t>{0, 4, 8, 11});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{10, 10, 5});
    const Array values = averaged(grid);
    EXPECT_EQ(values.at(3), 4);
    EXPECT_TRUE(std::isnan(values.at(5)));
}

TEST(AverageToPoints, LeavesAConstantFieldExactlyConstant) {
    MakeOptions options;
    options.shape = "shuffled";
    options.side = 8;
    Grid grid = make_grid(options).value();
    grid.cell_fields = {{"c", Array::own(std::vector<double>(grid.cells.count(), 0.1))}};
    const Array averages = averaged(grid);
    for (const double value : averages.as<double>()) ASSERT_EQ(value, 0.1);
}

TEST(AverageToPoints, IsTheSameBytesForAnyNumberOfThreads) {
    MakeOptions options;
    options.shape = "mixed";
    options.side = 28; // several pieces of cells and points
    Grid grid = make_grid(options).value();
    std::vector<float> values(grid.cells.count());
    for (std::size_t cell = 0; cell < values.size(); ++cell)
        values[cell] = static_cast<float>(cell * 2654435761u % 1000) / 7;
    grid.cell_fields = {{"c", Array::own(std::move(values))}};
    const Array one = find_field(grid, "c", {}, {.threads = 1}).value().values;
    expect_same_of_cells_that_go_by(grid, {}, one);
    for (const int threads : {2, 7, 64}) {
        const Array many = find_field(grid, "c", {}, {.threads = threads}).value().values;
        ASSERT_EQ(one.bytes(), many.bytes());
        EXPECT_EQ(std::memcmp(one.data(), many.data(), one.bytes()), 0) << threads;
    }
}

} // namespace
