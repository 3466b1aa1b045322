// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids of pieces of a grid: together they are those of the whole, triangle for triangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <isotet/pieces.hpp>
#include <isotet/solid.hpp>

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
