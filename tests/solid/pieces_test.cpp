// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids of pieces of a grid: together they are those of the whole, triangle for triangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <isotet/pieces.hpp>
#include <isotet/solid.hpp>

#include "support/random_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using Place = std::array<double, 3>;
using Triangle = std::array<Place, 3>;

/// By places, each from its least one on.
void append(const Surface& surface, std::vector<Triangle>& out) {
    for (std::size_t i = 0; i < surface.triangle_count(); ++i) {
        Triangle triangle;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                triangle[k][axis] = surface.positions.at(static_cast<std::size_t>(surface.triangles.at(i, k)), axis);
        std::ranges::rotate(triangle, std::ranges::min_element(triangle));
        out.push_back(triangle);
    }
}

/// The solids of all pieces of a whole, each with all the other cells as ghosts.
std::vector<Solids> solids_of_pieces(const ContourInput& whole, std::uint64_t count) {
    std::vector<Solids> out;
    for (std::uint64_t k = 0; k < count; ++k) {
        const FramedPiece piece = take_piece(whole, {k, count}).value();
        std::vector<std::uint8_t> ghosts(whole.grid.cells.count(), 1);
        std::fill_n(ghosts.begin() + static_cast<std::ptrdiff_t>(piece.first_cell), piece.input.grid.cells.count(),
                    std::uint8_t{0});
        ContourOptions options;
        options.frame = piece.frame;
        out.push_back(Solids::create_piece(whole, Array::own(std::move(ghosts)), options).value());
    }
    return out;
}

Array in_steps_of_a_half(const Array& values) {
    std::vector<double> out(values.tuples());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::round(values.at(i) * 2) / 2;
    return Array::own(std::move(out));
}

TEST(SolidPieces, AreTogetherTheSolidOfTheWhole) {
    for (const auto& [shape, full_of_ties] :
         {std::pair("kuhn", false), {"mixed", false}, {"kelvin", false}, {"kuhn", true}, {"hex", true}, {"mixed", true}}) {
        SCOPED_TRACE(testing::Message() << shape << (full_of_ties ? " full of ties" : ""));
        Grid grid = made_grid(shape, 3, {"gyroid"});
        if (full_of_ties) grid.point_fields[0].values = in_steps_of_a_half(grid.point_fields[0].values);
        const ContourInput whole{grid, point_field(grid), {{"gyroid", grid.point_fields[0].values}}, {}};
        Solids of_whole = Solids::create(whole).value();
        std::vector<Solids> pieces = solids_of_pieces(whole, 3);
        double grid_volume = 0;
        for (const Solids& piece : pieces) grid_volume += piece.grid_volume();
        EXPECT_NEAR(grid_volume, of_whole.grid_volume(), 1e-9 * of_whole.grid_volume());
        for (const SolidRange& range : {SolidRange::above(0.5), SolidRange::below(0.5), SolidRange{-0.5, 0.5}}) {
            const Solid all = of_whole.extract(range).value();
            EXPECT_EQ(all.contour.surfaces[0].report.tied_points > 0, full_of_ties);
            std::vector<Triangle> expected, found;
            append(all.surface, expected);
            double volume = 0;
            for (Solids& piece : pieces) {
                const Solid part = piece.extract(range).value();
                EXPECT_EQ(part.contour.cells_left_out, all.contour.cells_left_out);
                append(part.surface, found);
                volume += part.volume;
            }
            std::ranges::sort(expected);
            std::ranges::sort(found);
            EXPECT_TRUE(expected == found);
            EXPECT_NEAR(volume, all.volume, 1e-6 * of_whole.grid_volume());
        }
    }
}

/// All points between the layers of cells, and so between the pieces, have the isovalue.
TEST(SolidPieces, HaveNoDoubleSheetsWhereTheyMeet) {
    for (const char* shape : {"kuhn", "hex"}) {
        SCOPED_TRACE(shape);
        Grid grid = made_grid(shape, 2, {"gyroid"});
        std::vector<double> values(grid.points.tuples());
        const double middle = (grid.points.at(0, 2) + grid.points.at(values.size() - 1, 2)) / 2;
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::abs(grid.points.at(i, 2) - middle) < 0.1;
        grid.point_fields[0].values = Array::own(std::move(values));
        const ContourInput whole{grid, point_field(grid), {}, {}};
        for (Solids& piece : solids_of_pieces(whole, 2)) {
            EXPECT_EQ(piece.extract(SolidRange::above(1)).value().surface.triangle_count(), 0u);
            const Solid below = piece.extract(SolidRange::below(1)).value();
            EXPECT_EQ(below.isosurface_triangles, 0u);
            EXPECT_GT(below.surface.triangle_count(), 0u);
        }
    }
}

/// Three cells around a point above a plane of it, and three below; the field is the height.
NastyGrid cells_around_a_point(bool hexahedra) {
    std::vector<double> points, values;
    std::vector<std::int64_t> connectivity, offsets{0};
    for (const double z : {0.0, 1.0, -1.0}) {
        points.insert(points.end(), {0, 0, z});
        for (int k = 0; k < 6; ++k)
            points.insert(points.end(), {std::cos(std::numbers::pi / 3 * k), std::sin(std::numbers::pi / 3 * k), z});
    }
    for (std::size_t i = 2; i < points.size(); i += 3) values.push_back(points[i]);
    const auto add = [&](const std::vector<std::int64_t>& corners) {
        connectivity.insert(connectivity.end(), corners.begin(), corners.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    };
    for (const std::int64_t k : {0, 2, 4}) {
        const std::int64_t a = 1 + k, b = 1 + (k + 1) % 6, c = 1 + (k + 2) % 6;
        if (hexahedra) {
            add({a, b, c, 0, a + 7, b + 7, c + 7, 7});
            add({a + 14, b + 14, c + 14, 14, a, b, c, 0});
        } else {
            add({0, a, c, 7});
            add({0, c, a, 14});
        }
    }
    NastyGrid out;
    out.grid.points = Array::own(std::move(points), 3);
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    out.grid.cells.types = Array::own(std::vector<std::uint8_t>(offsets.size() - 1, hexahedra ? 12 : 10));
    out.grid.cells.offsets = Array::own(std::move(offsets));
    out.field = {"height", Array::own(std::move(values)), false, {}};
    return out;
}

/// Three triangles around a point of a plane are no double sheet, whichever pieces they are of.
TEST(SolidPieces, KeepWhatLiesBesideEachOther) {
    for (const bool hexahedra : {false, true}) {
        SCOPED_TRACE(hexahedra ? "hexahedra" : "tetrahedra");
        const NastyGrid g = cells_around_a_point(hexahedra);
        const ContourInput whole{g.grid, g.field, {}, {}};
        ContourOptions options{.precision = Precision::float64}; // points keep their places, whose vertices they are
        const Solid all = Solids::create(whole, options).value().extract(SolidRange::above(0)).value();
        const Extraction surface = Contour::create(whole).value().extract(0.0).value().surfaces[0];
        EXPECT_EQ(all.isosurface_triangles, surface.surface.triangle_count());
        EXPECT_EQ(all.open_edges, 0u);
        std::vector<Triangle> expected, found;
        append(all.surface, expected);
        for (std::size_t own = 0; own < g.grid.cells.count(); ++own) {
            std::vector<std::uint8_t> ghosts(g.grid.cells.count(), 1);
            ghosts[own] = 0;
            options.frame = take_piece(whole, {0, 1}).value().frame;
            Solids solids = Solids::create_piece(whole, Array::own(std::move(ghosts)), options).value();
            const Solid part = solids.extract(SolidRange::above(0)).value();
            for (const std::uint32_t vertex : part.surface.triangles.as<std::uint32_t>())
                ASSERT_LT(vertex, part.surface.vertex_count());
            append(part.surface, found);
        }
        std::ranges::sort(expected);
        std::ranges::sort(found);
        EXPECT_TRUE(expected == found);
    }
}

TEST(SolidPieces, NeedAFrameAndAMarkForEachCell) {
    const Grid grid = made_grid("kuhn", 2, {"gyroid"});
    const ContourInput whole{grid, point_field(grid), {}, {}};
    const Array none = Array::own(std::vector<std::uint8_t>(grid.cells.count(), 0));
    EXPECT_EQ(Solids::create_piece(whole, none, {}).error().code, ErrorCode::invalid_argument);
    ContourOptions options;
    options.frame = take_piece(whole, {0, 1}).value().frame;
    EXPECT_EQ(Solids::create(whole, options).error().code, ErrorCode::invalid_argument);
    const Array few = Array::own(std::vector<std::uint8_t>(1, 0));
    EXPECT_EQ(Solids::create_piece(whole, few, options).error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(Solids::create_piece(whole, none, options));
}

} // namespace
} // namespace isotet::test
