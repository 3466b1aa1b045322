// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cutting grids, numbering points, leaving out cells and triangles.
#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/pieces.hpp>

#include "pieces/partition.hpp"
#include "support/mixed_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

std::vector<std::int64_t> integers(const Array& array) {
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < array.size(); ++i) out.push_back(static_cast<std::int64_t>(array.at(i)));
    return out;
}

TEST(TakingCells, KeepsWhatTheyUse) {
    Grid grid = made_grid("mixed", 3, {"gyroid"});
    std::vector<float> weights(grid.cells.count());
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<float>(i);
    grid.cell_fields.push_back({"weight", Array::own(std::move(weights))});
    const std::uint64_t first = 5, last = 17;
    const Grid piece = take_cells(grid, first, last).value();
    const core::CellReader of_grid = core::CellReader::open(grid).value(),
                           of_piece = core::CellReader::open(piece).value();
    ASSERT_EQ(of_piece.count(), last - first);
    const auto numbers = integers(piece.point_numbers);
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
    for (std::size_t cell = 0; cell < of_piece.count(); ++cell) {
        ASSERT_EQ(of_piece.type(cell), of_grid.type(first + cell));
        ASSERT_EQ(of_piece.corners(cell), of_grid.corners(first + cell));
        EXPECT_EQ(piece.cell_fields[0].values.at(cell), static_cast<double>(first + cell));
        for (std::uint64_t k = 0; k < of_piece.corners(cell); ++k) {
            const auto point = of_piece.corner(of_piece.first(cell) + k);
            const auto whole = of_grid.corner(of_grid.first(first + cell) + k);
            EXPECT_EQ(numbers[point], static_cast<std::int64_t>(whole));
            EXPECT_EQ(piece.points.at(point, 1), grid.points.at(whole, 1));
            EXPECT_EQ(piece.point_fields[0].values.at(point), grid.point_fields[0].values.at(whole));
        }
    }
    const Grid again = take_cells(piece, 2, 4).value();
    for (const std::int64_t number : integers(again.point_numbers))
        EXPECT_TRUE(std::binary_search(numbers.begin(), numbers.end(), number));
}

TEST(TakingCells, GivesEveryCellToOnePiece) {
    const Grid grid = made_grid("kuhn", 2, {});
    for (const std::uint64_t pieces : {1, 2, 5, 48, 60}) {
        std::uint64_t cells = 0, most = 0, least = grid.cells.count();
        for (std::uint64_t i = 0; i < pieces; ++i) {
            const std::uint64_t count = take_piece(grid, {i, pieces}).value().cells.count();
            cells += count;
            most = std::max(most, count);
            least = std::min(least, count);
        }
        EXPECT_EQ(cells, grid.cells.count());
        EXPECT_LE(most - least, 1u);
    }
}

TEST(TakingCells, RefusesWhatIsNotThere) {
    Grid grid = made_grid("kuhn", 2, {});
    EXPECT_EQ(take_piece(grid, {2, 2}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(take_piece(grid, {0, 0}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(take_cells(grid, 3, 2).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(take_cells(grid, 0, 49).error().code, ErrorCode::invalid_argument);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, -3});
    EXPECT_EQ(take_cells(grid, 0, 1).error().code, ErrorCode::invalid_data);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3});
    grid.cells.offsets = Array::own(std::vector<std::int32_t>{0, 9});
    EXPECT_EQ(take_cells(grid, 0, 1).error().code, ErrorCode::invalid_data);
}

TEST(NumberingPoints, RanksByCoordinates) {
    const Grid grid = tet_grid({{1, 0, 0}, {-0.0, 2, 0}, {0, 1, 5}, {-3, 9, 9}, {0, 1, -5}, {0, 1, 5}}, {});
    EXPECT_EQ(integers(number_points_by_coordinates(grid.points).value()),
              (std::vector<std::int64_t>{5, 4, 2, 0, 1, 3}));
    EXPECT_EQ(number_points_by_coordinates(Array::own(std::vector<float>{1, 2})).error().code, ErrorCode::invalid_data);
}

TEST(PointNumbers, MustBeIntegersOneAPoint) {
    Grid grid = made_grid("kuhn", 2, {"gyroid"});
    const PointField field = point_field(grid);
    grid.point_numbers = Array::own(std::vector<std::int32_t>{1, 2, 3});
    EXPECT_EQ(pack(grid, field).error().code, ErrorCode::invalid_data);
    grid.point_numbers = Array::own(std::vector<float>(27));
    EXPECT_EQ(pack(grid, field).error().code, ErrorCode::invalid_data);
}

TEST(PointNumbers, MayAllBeTheSame) {
    Grid grid = made_grid("hex", 3, {"gyroid"});
    const PointField field = point_field(grid);
    const auto without = triangle_set(extract(pack(grid, field, {.split_cells = true}).value(), 0.1).value().surface);
    grid.point_numbers = Array::own(std::vector<std::int32_t>(grid.points.tuples(), -7));
    EXPECT_EQ(triangle_set(extract(pack(grid, field, {.split_cells = true}).value(), 0.1).value().surface), without);
}

TEST(LeavingOutCells, GivesNoTriangleOfThem) {
    const NastyGrid g = mixed_grid(4, {.side = 4, .moved = 0.1});
    std::vector<std::uint8_t> marks(g.grid.cells.count());
    for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = i % 3 == 0 ? 1 : i % 5 == 0 ? 2 : 0;
    const Array ghosts = Array::own(marks);
    ExtractOptions options;
    options.source_cells = options.edge_ends = true;
    const Surface whole = extract(pack(g.grid, g.field, {.source_cells = true}).value(), 1.5, options).value().surface;
    const Grid fewer = leave_out_cells(g.grid, ghosts).value();
    const PackedGrid packed = pack(fewer, g.field, {.source_cells = true}).value();
    EXPECT_EQ(packed.report().cells_left_out, (marks.size() + 2) / 3);
    const Surface less = extract(packed, 1.5, options).value().surface;
    const Surface cut = leave_out_triangles(whole, ghosts).value();
    ASSERT_GT(less.triangle_count(), 50u);
    EXPECT_LT(less.triangle_count(), whole.triangle_count());
    EXPECT_EQ(triangle_set(less), triangle_set(cut));
    EXPECT_EQ(less.vertex_count(), cut.vertex_count());
    EXPECT_EQ(cut.edge_ends.tuples(), cut.vertex_count());
    for (const std::int64_t cell : cut.source_cells.as<std::int64_t>()) EXPECT_NE(cell % 3, 0);
    EXPECT_EQ(leave_out_triangles(whole, ghosts, 0).value().triangle_count(), whole.triangle_count());
}

TEST(LeavingOutCells, NeedsAMarkForEach) {
    const Grid grid = made_grid("kuhn", 4, {"sphere"});
    const Array few = Array::own(std::vector<std::uint8_t>(3)), floats = Array::own(std::vector<float>(48));
    EXPECT_EQ(leave_out_cells(grid, few).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(leave_out_cells(grid, floats).error().code, ErrorCode::invalid_argument);
    ExtractOptions options;
    options.source_cells = true;
    const PackedGrid packed = pack(grid, point_field(grid), {.source_cells = true}).value();
    const Surface surface = extract(packed, 0.1, options).value().surface;
    ASSERT_GT(surface.triangle_count(), 3u);
    EXPECT_EQ(leave_out_triangles(surface, few).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(leave_out_triangles(extract(packed, 0.1).value().surface, few).error().code, ErrorCode::invalid_argument);
}

/// A piece that is split by its numbers is checked against the faces of the same tets.
TEST(PointNumbers, DecideForSplittingAndChecking) {
    const Grid whole = made_grid("hex", 5, {"gyroid"});
    Grid piece = take_piece(whole, {1, 3}).value();
    std::vector<std::int64_t> scattered;
    for (std::size_t i = 0; i < piece.points.tuples(); ++i)
        scattered.push_back(static_cast<std::int64_t>(i * 480'271 % 1'000'003) - 500'000);
    const auto by_index = split(take_piece(whole, {1, 3}).value()).value();
    piece.point_numbers = Array::own(std::move(scattered));
    EXPECT_NE(split(piece).value().tets, by_index.tets);

    const PointField field = point_field(piece);
    PackOptions options;
    options.split_cells = true;
    ExtractOptions with_ends;
    with_ends.edge_ends = true;
    const Surface surface = extract(pack(piece, field, options).value(), 0.1, with_ends).value().surface;
    CheckOptions check_options;
    check_options.grid = &piece;
    check_options.field = &field;
    check_options.split_cells = true;
    const SurfaceReport report = check(surface, check_options).value();
    EXPECT_GT(report.boundary_edges, 0u);
    EXPECT_EQ(report.blamed_edges, 0u);
    Grid by_other_numbers = piece;
    by_other_numbers.point_numbers = {};
    check_options.grid = &by_other_numbers;
    EXPECT_GT(check(surface, check_options).value().blamed_edges, 0u);
}

} // namespace
} // namespace isotet::test
