// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The boundary of a packed grid: closed, as large as it must be, facing outwards, the same for any number of threads.
// No device.
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

#include "linear/curved_grid.hpp"

namespace isotet::test {
namespace {

Surface boundary_of_made(const std::string& shape, std::size_t side, Precision precision = Precision::float32) {
    const Grid grid = make_grid({.shape = shape, .side = side, .fields = {"sphere"}}).value();
    return boundary_of(pack(grid, find_field(grid, "sphere").value(), {.precision = precision}).value()).value();
}

TEST(Boundary, OfACubeIsTheCube) {
    for (const char* shape : {"kuhn", "shuffled", "mixed", "hex"}) {
        const Surface surface = boundary_of_made(shape, 9);
        const SurfaceReport report = check(surface, {.closed = true}).value();
        EXPECT_TRUE(report.closed) << shape;
        EXPECT_EQ(report.triangles, 6u * 9 * 9 * 2) << shape;
        EXPECT_EQ(report.euler, 2) << shape;
        EXPECT_NEAR(report.area, 24, 1e-4) << shape;
        EXPECT_NEAR(report.volume, 8, 1e-4) << shape << ": faces look outwards";
    }
}

TEST(Boundary, OfADoublePackingIsDouble) {
    const Surface surface = boundary_of_made("kuhn", 4, Precision::float64);
    EXPECT_EQ(surface.positions.type(), ScalarType::float64);
    EXPECT_EQ(surface.triangle_count(), 6u * 4 * 4 * 2);
}

/// Every kind of flat cell with a field of the place: area and centre are those of the shapes.
TEST(Boundary, OfFlatCellsIsTheCells) {
    struct Shape {
        std::uint8_t type;
        std::vector<std::array<double, 2>> nodes;
        double area;
        std::size_t triangles;
    };
    const std::vector<std::array<double, 2>> triangle{{0, 0}, {2, 0}, {0, 2}}, square{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const auto with = [](std::vector<std::array<double, 2>> nodes, const std::vector<std::array<double, 2>>& more) {
        nodes.insert(nodes.end(), more.begin(), more.end());
        return nodes;
    };
    const std::vector<std::array<double, 2>> triangle_middles{{1, 0}, {1, 1}, {0, 1}},
        square_middles{{1, 0}, {2, 1}, {1, 2}, {0, 1}};
    const std::vector<Shape> shapes{
        {5, triangle, 2, 1},
        {6, {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0, 2}}, 1.5, 3},
        {7, {{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}, 5, 3},
        {8, {{0, 0}, {2, 0}, {0, 2}, {2, 2}}, 4, 2},
        {9, square, 4, 2},
        {22, with(triangle, triangle_middles), 2, 4},
        {34, with(with(triangle, triangle_middles), {{0.6, 0.6}}), 2, 6},
        {23, with(square, square_middles), 4, 6},
        {28, with(with(square, square_middles), {{1, 1}}), 4, 8},
        {30, with(square, {{1, 0}, {1, 2}}), 4, 4},
        {36, with(square, square_middles), 4, 6},
        {69, with(triangle, triangle_middles), 2, 1},
        {70, with(with(square, square_middles), {{1, 1}}), 4, 2},
        {76, with(triangle, triangle_middles), 2, 1},
        {77, square, 4, 2},
    };
    for (const Shape& shape : shapes) {
        std::vector<double> points{9, 9, 9}; // that no cell uses
        std::vector<std::int64_t> corners;
        for (const auto& [x, y] : shape.nodes) {
            corners.push_back(static_cast<std::int64_t>(points.size() / 3));
            points.insert(points.end(), {x, y, 0});
        }
        Grid grid;
        grid.points = Array::own(std::move(points), 3);
        // A line and a vertex are passed over.
        corners.insert(corners.end(), {1, 2, 1});
        const auto nodes = static_cast<std::int64_t>(shape.nodes.size());
        grid.cells.connectivity = Array::own(std::move(corners));
        grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, nodes, nodes + 2, nodes + 3});
        grid.cells.types = Array::own(std::vector<std::uint8_t>{shape.type, 3, 1});
        const Result<Surface> surface = boundary_of(grid);
        ASSERT_TRUE(surface) << int{shape.type} << ": " << surface.error().message;
        EXPECT_EQ(surface->triangle_count(), shape.triangles) << int{shape.type};
        EXPECT_NEAR(area(*surface), shape.area, 1e-12) << int{shape.type};
        const Array normals = face_normals(*surface).value();
        for (std::size_t i = 0; i < surface->triangle_count(); ++i) {
            EXPECT_EQ(normals.at(i, 2), 1) << int{shape.type} << ", triangle " << i;
            EXPECT_EQ(surface->source_cells.at(i), 0);
        }
        for (std::size_t v = 0; v < surface->vertex_count(); ++v) {
            const auto point = static_cast<std::size_t>(surface->edge_ends.at(v, 0));
            EXPECT_GT(point, 0u);
            for (std::size_t axis = 0; axis < 3; ++axis)
                EXPECT_EQ(surface->positions.at(v, axis), grid.points.at(point, axis));
        }
    }
}

/// Faces of quadratic cells have points that the grid does not have.
TEST(Boundary, OfQuadraticCellsHasColoursAtAllItsPoints) {
    std::size_t made = 0;
    for (const unsigned seed : {1u, 2u, 3u}) {
        const CurvedGrid curved =
            curved_grid({.side = 3, .seed = seed, .field = [](const At& p) { return p[0] + 2 * p[1] - p[2]; }});
        Surface boundary = boundary_of(curved.grid).value();
        const ColorField field{"p", curved.field.values, Association::point, {}};
        ASSERT_TRUE(color_boundary(boundary, curved.grid, field));
        const Array& values = boundary.point_fields.at(0).values;
        for (std::size_t i = 0; i < boundary.vertex_count(); ++i) {
            made += static_cast<std::size_t>(boundary.edge_ends.at(i, 0)) >= curved.grid.points.tuples();
            const Array& at = boundary.positions;
            ASSERT_NEAR(values.at(i), at.at(i, 0) + 2 * at.at(i, 1) - at.at(i, 2), 1e-5);
        }
    }
    EXPECT_GT(made, 10u);
}

TEST(Boundary, RefusesBrokenFlatCells) {
    Grid grid;
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 3});
    for (const auto& [type, last] : {std::pair<std::uint8_t, std::int64_t>{5, 3}, {5, -1}, {9, 2}, {22, 2}}) {
        grid.cells.types = Array::own(std::vector<std::uint8_t>{type});
        grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, last});
        const Result<Surface> surface = boundary_of(grid);
        ASSERT_FALSE(surface) << int{type} << ' ' << last;
        EXPECT_EQ(surface.error().code, ErrorCode::invalid_data);
        EXPECT_NE(surface.error().message.find("cells[0]"), std::string::npos) << surface.error().message;
    }
    grid.cells.types = Array::own(std::vector<std::uint8_t>{7, 5});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 2, 5});
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 0, 1, 2});
    EXPECT_EQ(boundary_of(grid).value().triangle_count(), 1u) << "a polygon of two corners has no area";
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, NAN, 0, 1, 0}, 3);
    EXPECT_EQ(boundary_of(grid).error().message.substr(0, 37), "points[1] has z coordinate nan, but c");
}

TEST(Boundary, CanBeCancelled) {
    const Grid grid = make_grid({.shape = "kuhn", .side = 4, .fields = {"sphere"}}).value();
    const PackedGrid packed = pack(grid, find_field(grid, "sphere").value()).value();
    const std::atomic<bool> cancel = true;
    const Result<Surface> surface = boundary_of(packed, {.progress = {.report = {}, .cancel = &cancel}});
    ASSERT_FALSE(surface);
    EXPECT_EQ(surface.error().code, ErrorCode::cancelled);
}

std::vector<std::byte> bytes_of(const Surface& surface) {
    std::vector<std::byte> all;
    for (const Array* array : {&surface.positions, &surface.triangles, &surface.edge_ends}) {
        const auto* const data = static_cast<const std::byte*>(array->data());
        all.insert(all.end(), data, data + array->bytes());
    }
    return all;
}

/// Each cell has points of its own, some of them moved by a rounding.
Grid taken_apart(const Grid& grid) {
    const Array& corners = grid.cells.connectivity;
    const auto from = grid.points.as<float>();
    std::vector<float> points;
    std::vector<std::int64_t> connectivity;
    for (std::size_t i = 0; i < corners.tuples(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float x = from[3 * static_cast<std::size_t>(corners.at(i)) + axis];
            points.push_back(i % 16 == axis ? std::nextafter(x, 2.0F) : x);
        }
        connectivity.push_back(static_cast<std::int64_t>(i));
    }
    Grid apart = grid;
    apart.points = Array::own(std::move(points), 3);
    apart.cells.connectivity = Array::own(std::move(connectivity));
    apart.point_fields.clear();
    return apart;
}

TEST(DrawnGrid, JoinsPointsWhereCellsHaveTheirOwn) {
    for (const char* shape : {"kuhn", "hex"}) {
        const Grid grid = make_grid({.shape = shape, .side = 4, .fields = {}}).value();
        const Grid apart = taken_apart(grid);
        EXPECT_GT(boundary_of(apart).value().triangle_count(), 6u * 4 * 4 * 2) << shape;
        const DrawnGrid drawn = grid_with_joined_points(apart).value();
        EXPECT_TRUE(drawn.joined) << shape;
        EXPECT_EQ(drawn.grid.points.tuples(), apart.points.tuples()) << shape;
        EXPECT_EQ(drawn.grid.cells.count(), grid.cells.count()) << shape;
        EXPECT_EQ(boundary_of(drawn.grid).value().triangle_count(), 6u * 4 * 4 * 2) << shape;
        const DrawnGrid whole = grid_with_joined_points(grid).value();
        EXPECT_FALSE(whole.joined) << shape;
        EXPECT_EQ(whole.grid.cells.connectivity.data(), grid.cells.connectivity.data()) << shape;
    }
}

TEST(KnownBoundary, IsFoundAgainWhereCellsOrPointsAreOthers) {
    const auto made = [](const char* shape) {
        return make_grid({.shape = shape, .side = 5, .fields = {"sphere"}}).value();
    };
    Grid moved = made("hex");
    std::vector<float> places(moved.points.as<float>().begin(), moved.points.as<float>().end());
    places[0] -= 1;
    moved.points = Array::own(std::move(places), 3);
    KnownBoundary known;
    const void* memory = nullptr;
    for (const auto& [grid, is_known] : {std::pair{made("hex"), false},
                                         {made("hex"), true},
                                         {moved, false},
                                         {moved, true},
                                         {made("kuhn"), false},
                                         {made("hex"), false}}) {
        const Surface surface = known.of(grid).value();
        EXPECT_EQ(bytes_of(surface), bytes_of(boundary_of(grid).value()));
        if (is_known) {
            EXPECT_EQ(surface.positions.data(), memory);
        }
        memory = surface.positions.data();
    }
}

TEST(KnownBoundary, IsFoundAgainWhereOnlyFacesAreOthers) {
    Grid grid = make_grid({.shape = "kelvin", .side = 2, .fields = {"sphere"}}).value();
    KnownBoundary known;
    const std::size_t all = known.of(grid, {.threads = 1}).value().triangle_count();
    std::vector<std::int64_t> offsets(grid.cells.count() + 1, 0); // no cell has faces
    grid.cells.face_offsets = Array::own(std::move(offsets));
    const Result<Surface> others = known.of(grid, {.threads = 1}), expected = boundary_of(grid);
    EXPECT_EQ(static_cast<bool>(others), static_cast<bool>(expected));
    EXPECT_FALSE(others && others->triangle_count() == all);
}

TEST(KnownBoundary, ForgetsTheGridBeforeOneThatIsWrong) {
    const Grid grid = make_grid({.shape = "hex", .side = 3, .fields = {"sphere"}}).value();
    Grid wrong = grid;
    wrong.cells.connectivity = Array::own(std::vector<std::int32_t>(8, 99'999));
    KnownBoundary known;
    EXPECT_TRUE(known.of(grid));
    EXPECT_FALSE(known.of(wrong));
    EXPECT_TRUE(known.of(grid));
}

} // namespace
} // namespace isotet::test
