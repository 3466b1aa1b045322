// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Wrong calls and broken grids are errors that name the value seen and the rule; nothing crashes, nothing is guessed.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class T>
void expect_error(const Result<T>& result, ErrorCode code, const std::string& message) {
    ASSERT_FALSE(result) << "expected: " << message;
    EXPECT_EQ(result.error().code, code) << result.error().message;
    EXPECT_EQ(result.error().message, message);
}

const std::vector<std::array<double, 3>> unit{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}};

Grid one_tet() { return tet_grid(unit, {{0, 1, 2, 3}}); }
PointField some_field() { return field_of<float>({0, 1, 2, 3, 4}); }

/// The same error from everything that takes a grid.
void expect_bad_grid(const Grid& grid, const std::string& message) {
    const PointField field = field_of(std::vector<float>(grid.points.tuples(), 0));
    expect_error(pack(grid, field), ErrorCode::invalid_data, message);
    expect_error(survey(grid), ErrorCode::invalid_data, message);
    expect_error(split(grid), ErrorCode::invalid_data, message);
}

void expect_nothing_to_contour(const Grid& grid, const std::string& message) {
    expect_error(pack(grid, field_of(std::vector<float>(grid.points.tuples(), 0))), ErrorCode::invalid_data, message);
    expect_error(split(grid), ErrorCode::invalid_data, message);
    const Result<GridReport> report = survey(grid);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->tets, 0u);
    EXPECT_EQ(report->cells, grid.cells.count());
}

TEST(TinyGrids, AreRefusedAndNeverPutAtTheOrigin) {
    const auto is_taken = [](const Grid& grid, Precision precision) {
        PackOptions packing;
        packing.precision = precision;
        DirectOptions direct;
        direct.precision = precision;
        const double isovalue = 0.5;
        const PointField field = some_field();
        const auto packed = pack(grid, field, packing);
        const auto found = extract_direct(grid, field, {&isovalue, 1}, direct);
        EXPECT_EQ(static_cast<bool>(packed), static_cast<bool>(found));
        if (!packed) {
            EXPECT_EQ(packed.error().code, ErrorCode::invalid_data);
            EXPECT_EQ(packed.error().message, found.error().message);
            EXPECT_NE(packed.error().message.find("give them in a smaller unit"), std::string::npos);
        }
        return static_cast<bool>(packed);
    };
    for (const Precision precision : {Precision::float32, Precision::float64})
        for (const double size : {1e-300, 1e-38, 1e-30, 1e-22, 1e-21, 1e-17, 1e-14, 1e-6, 1.0}) {
            SCOPED_TRACE(size);
            std::vector<double> points;
            for (const auto& point : unit)
                for (const double x : point) points.push_back(x * size);
            std::vector<float> single;
            for (const double x : points) single.push_back(static_cast<float>(x));
            Grid grid = one_tet();
            grid.points = Array::own(std::move(points), 3);
            EXPECT_EQ(is_taken(grid, precision), size > 1e-15);
            grid.points = Array::own(std::move(single), 3);
            EXPECT_EQ(is_taken(grid, precision), size > 1e-15 || size < 1e-100) << "as float32, where 1e-300 is 0";
        }
    const Grid thin = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-30}, {5, 5, 5}}, {{0, 1, 2, 3}});
    EXPECT_TRUE(is_taken(thin, Precision::float32));
}

TEST(Pack, RefusesAFieldThatDoesNotFit) {
    expect_error(pack(one_tet(), field_of<float>({0, 1, 2}, "short")), ErrorCode::invalid_argument,
                 "field 'short' has 3 values, but the grid has 5 points");
    expect_error(pack(one_tet(), {"none", {}, false, {}}), ErrorCode::invalid_argument,
                 "field 'none' has 0 values, but the grid has 5 points");
    PointField vector = field_of(std::vector<float>(15, 0), "velocity");
    vector.values = Array(ScalarType::float32, vector.values.data(), 5, 3, nullptr);
    expect_error(pack(one_tet(), vector), ErrorCode::invalid_argument,
                 "field 'velocity' has 3 components, but the contoured field must have 1");
}

TEST(Pack, RefusesPointNumbersOutOfRange) {
    expect_bad_grid(tet_grid(unit, {{0, 1, 2, 3}, {0, 1, 2, 5}}), "tets[1] has point 5, but the grid has 5 points");
    expect_bad_grid(tet_grid(unit, {{0, -1, 2, 3}}), "tets[0] has point -1, but the grid has 5 points");
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, std::numeric_limits<std::int32_t>::min()});
    expect_bad_grid(grid, "tets[0] has point -2147483648, but the grid has 5 points");
    grid.cells.connectivity = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0xffffffffu});
    expect_bad_grid(grid, "tets[0] has point 4294967295, but the grid has 5 points");
    grid.cells.connectivity = Array::own(std::vector<std::uint64_t>{0, 1, 2, 6});
    expect_bad_grid(grid, "tets[0] has point 6, but the grid has 5 points");
}

TEST(Pack, RefusesOffsetsThatFallOrLeadOutside) {
    Grid grid = tet_grid(unit, {{0, 1, 2, 3}, {1, 2, 3, 4}});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 4, 2});
    expect_bad_grid(grid, "tets[1] starts at 4 and ends at 2, but offsets must not fall");
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 4, 9});
    expect_bad_grid(grid, "tets[1] has corners 4 to 9, but the connectivity has 8 entries");
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 3, 8});
    expect_bad_grid(grid, "tets[0] has 3 corners, but must have 4");
    for (const std::int64_t first : {std::int64_t{-4}, std::int64_t{9}, std::numeric_limits<std::int64_t>::min()}) {
        grid.cells.offsets = Array::own(std::vector<std::int64_t>{first, 4, 8});
        EXPECT_FALSE(pack(grid, some_field())) << first;
        EXPECT_FALSE(split(grid)) << first;
    }
}

TEST(Pack, RefusesCellsWithTheWrongNumberOfCorners) {
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 0, 1});
    grid.cells.offsets = Array::own(std::vector<std::int32_t>{0, 7});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{12});
    expect_bad_grid(grid, "cells[0] (hexahedron) has 7 corners, but must have 8");
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>(20, 0));
    grid.cells.offsets = Array::own(std::vector<std::int32_t>{0, 20});
    expect_bad_grid(
        grid, "cells[0] (hexahedron) has 20 corners, but must have 8; a quadratic hexahedron has 20: its cell type "
              "is 25, not 12");
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 0, 1});
    grid.cells.offsets = {};
    grid.cells.types = {};
    expect_bad_grid(grid, "the connectivity has 7 entries, but must be a multiple of 4 for tetrahedron cells");
}

TEST(Pack, RefusesArraysOfTheWrongTypeOrShape) {
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::vector<float>{0, 1, 2, 3});
    expect_bad_grid(grid, "the connectivity is float32 with 1 components, but must be 32- or 64-bit integers with 1");
    grid = one_tet();
    grid.points = Array::own(std::vector<std::int32_t>(15, 0), 3);
    expect_bad_grid(grid, "points are int32 with 3 components, but must be float32 or float64 with 3");
    grid.points = Array::own(std::vector<float>(10, 0), 2);
    expect_bad_grid(grid, "points are float32 with 2 components, but must be float32 or float64 with 3");
    grid = one_tet();
    grid.cells.types = Array::own(std::vector<std::uint8_t>{10});
    expect_bad_grid(grid, "there are cell types but no offsets, and cells of several types need offsets");
    grid.cells.offsets = Array::own(std::vector<std::int32_t>{0, 4, 4});
    expect_bad_grid(grid, "there are 3 offsets for 1 cells, but there must be one more than cells");
    grid = one_tet();
    grid.point_fields.push_back({"p", Array::own(std::vector<float>{1, 2})});
    expect_bad_grid(grid, "point field 'p' has 2 tuples, but the grid has 5 points");
    grid = one_tet();
    grid.cell_fields.push_back({"c", Array::own(std::vector<float>{1, 2})});
    expect_bad_grid(grid, "cell field 'c' has 2 tuples, but the grid has 1 cells");
}

TEST(Pack, RefusesCoordinatesThatAreNotFiniteWhereACellUsesThePoint) {
    for (const double wrong : {std::nan(""), infinity, -infinity, 0x1p91, -0x1p91}) {
        auto points = unit;
        points[2][1] = wrong;
        EXPECT_FALSE(pack(tet_grid<double>(points, {{0, 1, 2, 3}}), some_field())) << wrong;
        EXPECT_FALSE(pack(tet_grid<float>(points, {{0, 1, 2, 3}}), some_field())) << wrong;
        points = unit;
        points[4] = {wrong, wrong, wrong}; // no cell uses it
        EXPECT_TRUE(pack(tet_grid<double>(points, {{0, 1, 2, 3}}), some_field())) << wrong;
    }
    auto points = unit;
    points[1][2] = infinity;
    expect_bad_grid(
        tet_grid(points, {{0, 1, 2, 3}}),
        "points[1] has z coordinate inf, but cells use the point, and coordinates must be finite and below 2^91");
}

TEST(Pack, RefusesGridsWithNothingToContour) {
    expect_nothing_to_contour(tet_grid({}, {}),
                              "the grid with 0 points has no cell that can be contoured (no cells at all); tetrahedra, "
                              "hexahedra, voxels, wedges and pyramids can");
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 0, 1, 2, 3, 1, 2, 3});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 3, 7, 10});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{5, 9, 5});
    expect_nothing_to_contour(grid,
                              "the grid with 5 points has no cell that can be contoured (2 x triangle, 1 x quad); "
                              "tetrahedra, hexahedra, voxels, wedges and pyramids can");
    EXPECT_FALSE(pack(tet_grid(unit, {{0, 1, 2, 2}}), some_field())) << "only a collapsed tet";
}

TEST(Extract, RefusesIsovaluesThatAreNotFinite) {
    const PackedGrid packed = pack(one_tet(), some_field()).value();
    expect_error(extract(packed, std::nan("")), ErrorCode::invalid_argument, "the isovalue is nan, but must be finite");
    expect_error(extract(packed, infinity), ErrorCode::invalid_argument, "the isovalue is inf, but must be finite");
    expect_error(extract(packed, -infinity), ErrorCode::invalid_argument, "the isovalue is -inf, but must be finite");
}

TEST(Extract, RefusesWhatWasNotPacked) {
    const PackedGrid packed = pack(one_tet(), some_field()).value();
    ExtractOptions options;
    options.normals = Normals::gradient;
    expect_error(extract(packed, 1, options), ErrorCode::invalid_argument,
                 "gradient normals need a grid that was packed with gradients, but this one was not");
    options = {};
    options.source_cells = true;
    expect_error(extract(packed, 1, options), ErrorCode::invalid_argument,
                 "source cells and cell fields need a grid that was packed with source cells, but this one was not");
    options = {};
    options.cell_fields = {{"c", Array::own(std::vector<float>{1})}};
    EXPECT_FALSE(extract(packed, 1, options));
}

TEST(Extract, RefusesFieldsThatDoNotFit) {
    PackOptions pack_options;
    pack_options.source_cells = true;
    const PackedGrid packed = pack(one_tet(), some_field(), pack_options).value();
    ExtractOptions options;
    options.point_fields = {{"p", Array::own(std::vector<float>{1, 2})}};
    expect_error(extract(packed, 1, options), ErrorCode::invalid_argument,
                 "point field 'p' has 2 tuples, but the packed grid has 5 points");
    options = {};
    options.cell_fields = {{"c", Array::own(std::vector<float>{1, 2})}};
    expect_error(extract(packed, 1, options), ErrorCode::invalid_argument,
                 "cell field 'c' has 2 tuples, but the packed grid has 1 cells");
}

TEST(SetField, RefusesAFieldThatDoesNotFitAndKeepsTheOldOne) {
    PackedGrid packed = pack(one_tet(), some_field()).value();
    expect_error(packed.with_field(field_of<float>({1, 2}, "new")), ErrorCode::invalid_argument,
                 "field 'new' has 2 values, but the grid has 5 points");
    EXPECT_EQ(packed.field().name, "value");
    EXPECT_EQ(extract(packed, 0.5).value().surface.triangle_count(), 1u);
}

TEST(SetPoints, RefusesPointsOfTheWrongShapeOrType) {
    PackedGrid packed = pack(one_tet(), some_field()).value();
    expect_error(packed.with_points(Array::own(std::vector<float>(12, 0), 3)), ErrorCode::invalid_argument,
                 "the new points are 4 x 3 float32, but must be 5 x 3 of float32 or float64");
    EXPECT_FALSE(packed.with_points(Array::own(std::vector<std::int32_t>(15, 0), 3)));
    EXPECT_FALSE(packed.with_points(Array::own(std::vector<float>(15, 0), 1)));
    EXPECT_FALSE(packed.with_points({}));
}

TEST(NumberOfThreads, MayBeAnything) {
    for (const int threads : {std::numeric_limits<int>::min(), -1, 0, 1, 5000, std::numeric_limits<int>::max()}) {
        const isotet::Run run{.threads = threads};
        const PackedGrid packed = pack(one_tet(), some_field(), {}, run).value();
        EXPECT_EQ(extract(packed, 0.5, {}, run).value().surface.triangle_count(), 1u) << threads;
    }
}

TEST(EmptyPackedGrid, HasNoSurface) {
    const PackedGrid empty;
    ExtractOptions options;
    options.normals = Normals::gradient;
    options.source_cells = true;
    EXPECT_EQ(extract(empty, 1, options).value().surface.vertex_count(), 0u);
}

TEST(ResultValue, ThrowsTheErrorAndNothingElse) {
    try {
        (void)pack(one_tet(), field_of<float>({1}, "short")).value();
        FAIL() << "value() of an error must throw";
    } catch (const Exception& e) {
        EXPECT_EQ(e.error().code, ErrorCode::invalid_argument);
        EXPECT_STREQ(e.what(), "field 'short' has 1 values, but the grid has 5 points");
    }
}

} // namespace
} // namespace isotet::test
