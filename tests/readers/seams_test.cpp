// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pieces joined to one grid: the same in any order, far from the origin, with cracks, with numbers of every kind.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/make.hpp>
#include <isotet/pieces.hpp>

#include "io/pieces/join/join.hpp"

namespace isotet::test {
namespace {

using io::Loaded;
using io::Piece;
using Places = std::vector<std::array<double, 3>>;

/// Tetrahedra on points, as float64 or float32.
template <class Real>
Piece piece_of(const Places& places, std::vector<std::int64_t> corners) {
    Piece piece;
    piece.name = "piece";
    std::vector<Real> points;
    for (const auto& place : places)
        for (const double x : place) points.push_back(static_cast<Real>(x));
    piece.grid.points = Array::own(std::move(points), 3);
    piece.grid.cells.connectivity = Array::own(std::move(corners));
    return piece;
}

ReadResult joined(const std::vector<Piece>& pieces) {
    Loaded loaded;
    loaded.pieces = pieces;
    auto result = join(std::move(loaded), {});
    EXPECT_TRUE(result) << result.error().message;
    return result ? *std::move(result) : ReadResult{};
}

bool says(const ReadResult& result, std::string_view words) {
    return std::ranges::any_of(result.notes,
                               [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// Each cell by the places and values of its corners.
std::multiset<std::vector<double>> cells_of(const Grid& grid) {
    std::multiset<std::vector<double>> cells;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        std::vector<std::vector<double>> corners;
        for (std::size_t i = 4 * cell; i < 4 * cell + 4; ++i) {
            const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(i));
            auto& corner = corners.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis) corner.push_back(grid.points.at(point, axis));
            for (const Field& field : grid.point_fields) corner.push_back(field.values.at(point));
        }
        std::ranges::sort(corners);
        std::vector<double> all;
        for (const auto& corner : corners) all.insert(all.end(), corner.begin(), corner.end());
        cells.insert(std::move(all));
    }
    return cells;
}

/// Joins the pieces in every order, and expects the same grid of each.
ReadResult joined_in_any_order(const std::vector<Piece>& pieces) {
    std::vector<std::size_t> order(pieces.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    ReadResult first = joined(pieces);
    const auto cells = cells_of(first.grid);
    while (std::ranges::next_permutation(order).found) {
        std::vector<Piece> permuted;
        for (const std::size_t i : order) permuted.push_back(pieces[i]);
        const ReadResult other = joined(permuted);
        EXPECT_EQ(other.grid.points.tuples(), first.grid.points.tuples());
        EXPECT_EQ(cells_of(other.grid), cells);
    }
    return first;
}

std::size_t boundary_triangles(const Grid& grid) {
    const auto surface = boundary_of(grid);
    EXPECT_TRUE(surface);
    return surface ? surface->triangles.tuples() : 0;
}

Array ids(std::vector<std::int64_t> values) { return Array::own(std::move(values)); }

/// A made grid, cut; each coordinate moved by some thousandths of the tolerance that its type allows.
std::vector<Piece> cut(const Grid& grid, std::size_t count, std::array<double, 3> origin, double noise) {
    std::vector<Piece> pieces;
    for (std::size_t k = 0; k < count; ++k) {
        Grid part = take_piece(grid, {k, count}).value();
        std::vector<double> points;
        for (std::size_t i = 0; i < part.points.size(); ++i)
            points.push_back(part.points.at(i / 3, i % 3) + origin[i % 3] +
                             noise * std::sin(static_cast<double>(i + 7 * k)));
        Piece piece;
        piece.name = "piece";
        piece.grid = part;
        piece.grid.points = Array::own(std::move(points), 3);
        piece.grid.point_numbers = {};
        piece.point_ids = part.point_numbers;
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

TEST(Seams, OfACutGridCloseWhereverItLies) {
    const Grid grid = make_grid({"kuhn", 6, {"plane"}}).value();
    const std::size_t boundary = boundary_triangles(grid);
    for (const std::array<double, 3> origin : {std::array{0.0, 0.0, 0.0}, std::array{5e5, 4.6e6, 10.0}})
        for (const bool numbered : {false, true})
            for (const double noise : {0.0, 3e-13, 1e-7}) {
                std::vector<Piece> pieces = cut(grid, 5, origin, noise);
                for (Piece& piece : pieces)
                    if (!numbered) piece.point_ids = {};
                const ReadResult whole = joined(pieces);
                const bool closes = noise < 1e-8 || numbered;
                EXPECT_EQ(boundary_triangles(whole.grid) == boundary, closes) << origin[0] << ' ' << noise;
                EXPECT_EQ(whole.grid.points.tuples() == grid.points.tuples(), closes);
                EXPECT_EQ(whole.grid.cells.connectivity.type(), ScalarType::int32);
                EXPECT_EQ(says(whole, "beside another piece's"), !closes);
            }
}

TEST(Seams, OfAPieceOfFloat32CloseAcrossOneRounding) {
    for (const double at : {0.0, 1e-8}) {
        std::vector<Piece> pieces{piece_of<float>({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}}, {0, 1, 2, 3})};
        pieces.push_back(piece_of<float>({{at, 0, 0}, {at, 1, 0}, {at, 0, 1}, {1, 0, 0}}, {0, 1, 2, 3}));
        EXPECT_EQ(joined_in_any_order(pieces).grid.points.tuples(), 5u);
    }
    const float third = 1.0F / 3;
    std::vector<Piece> pieces{piece_of<float>({{third, 0, 0}, {third, 1, 0}, {third, 0, 1}, {0, 0, 0}}, {0, 1, 2, 3})};
    const float next = std::nextafter(third, 1.0F);
    pieces.push_back(piece_of<float>({{next, 0, 0}, {next, 1, 0}, {next, 0, 1}, {1, 0, 0}}, {0, 1, 2, 3}));
    EXPECT_EQ(joined_in_any_order(pieces).grid.points.tuples(), 5u);
}

TEST(Seams, AdviseAToleranceThatClosesThem) {
    const Grid grid = make_grid({"kuhn", 4, {"plane"}}).value();
    const ReadResult whole = joined(cut(grid, 3, {0, 0, 0}, 0));
    ASSERT_EQ(whole.grid.points.tuples(), grid.points.tuples());
    std::vector<Piece> pieces = cut(grid, 3, {0, 0, 0}, 4e-8);
    for (Piece& piece : pieces) piece.point_ids = {};
    const ReadResult open = joined(pieces);
    const auto note = std::ranges::find_if(
        open.notes, [](const std::string& text) { return text.find("--merge-points") != std::string::npos; });
    ASSERT_NE(note, open.notes.end());
    const double tolerance = std::stod(note->substr(note->find("--merge-points") + 14));
    EXPECT_LT(tolerance, 1e-6);
    const auto merged = merge_points(open.grid, {tolerance, {}});
    ASSERT_TRUE(merged) << merged.error().message;
    EXPECT_EQ(boundary_triangles(merged->grid), boundary_triangles(grid));
}

/// One tet on an edge of which another piece has two copies: a crack that ends at the seam.
std::vector<Piece> crack_on_one_side() {
    std::vector<Piece> pieces;
    pieces.push_back(piece_of<double>({{0, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}, {0, 1, 2, 3}));
    pieces.push_back(piece_of<double>({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}, {1, 1, 0}},
                                      {0, 1, 2, 3, 4, 5, 6, 2}));
    pieces[0].grid.point_fields = {{"v", Array::own(std::vector<double>{0, 0, 1, 1})}};
    pieces[1].grid.point_fields = {{"v", Array::own(std::vector<double>{0, 0, 1, 1, -5, -5, 1})}};
    return pieces;
}

/// Of 2,000 places of two pieces a third is the same, a third is near, and a third is not.
TEST(Seams, TellEqualPlacesFromNearOnesWhereverTheyLie) {
    constexpr std::size_t places = 2000;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(0, 1);
    Places first, second;
    std::vector<std::int64_t> corners, other_corners;
    for (std::size_t i = 0; i < places; ++i) {
        std::array<double, 3> place{anywhere(random), anywhere(random), anywhere(random)};
        if (i < 2) place.fill(static_cast<double>(i)); // so that the grid's length is 1
        first.push_back(place);
        place[i / 3 % 3] += (i % 3 == 0 ? 0 : i % 3 == 1 ? 0.4e-6 : 3e-6) * (i == 1 ? -1 : 1);
        second.push_back(place);
        corners.push_back(static_cast<std::int64_t>(i));
        other_corners.push_back(static_cast<std::int64_t>((i + 2) % places)); // of other cells
    }
    const ReadResult grid =
        joined_in_any_order({piece_of<double>(first, corners), piece_of<double>(second, other_corners)});
    EXPECT_EQ(grid.grid.points.tuples(), 2 * places - 667);
    EXPECT_TRUE(says(grid, "coordinates: 667 points were merged"));
    EXPECT_TRUE(says(grid, "1334 points lie up to 4e-07 beside another piece's"));
}

TEST(Seams, LeaveACrackOfOnePieceAsItIsInAnyOrder) {
    const ReadResult whole = joined_in_any_order(crack_on_one_side());
    EXPECT_EQ(whole.grid.points.tuples(), 11u);
    EXPECT_TRUE(says(whole, "points lie at the place of another piece's"));
}

TEST(Seams, AtACrackAreDecidedByGlobalNumbers) {
    std::vector<Piece> pieces = crack_on_one_side();
    pieces[0].point_ids = ids({0, 1, 2, 3});
    pieces[1].point_ids = ids({10, 11, 12, 13, 0, 1, 14}); // the second copies are those of the other piece
    const ReadResult whole = joined_in_any_order(pieces);
    EXPECT_EQ(whole.grid.points.tuples(), 9u);
    EXPECT_TRUE(says(whole, "joined by global point numbers: 2 points were merged"));
}

TEST(Seams, OfBlocksThatEachCountFromOneStayApart) {
    const auto block = [](double x, double y) {
        Piece piece = piece_of<double>({{x, y, 10}, {x + 1, y, 10}, {x, y + 1, 10}, {x, y, 11}}, {0, 1, 2, 3});
        piece.point_ids = ids({1, 2, 3, 4});
        piece.cell_ids = ids({1});
        return piece;
    };
    const ReadResult whole = joined_in_any_order({block(500000, 4600000), block(500000, 4600020)});
    EXPECT_EQ(whole.grid.points.tuples(), 8u);
    EXPECT_EQ(whole.grid.cells.count(), 2u) << "one cell number does not mean one cell either";
    EXPECT_TRUE(says(whole, "mean different places"));
}

TEST(Seams, DoNotTrustNumbersThatAreWrong) {
    const auto with = [](std::vector<std::int64_t> a, std::vector<std::int64_t> b) {
        std::vector<Piece> pieces;
        pieces.push_back(piece_of<double>({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}}, {0, 1, 2, 3}));
        pieces.push_back(piece_of<double>({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {0, 1, 2, 3}));
        pieces[0].point_ids = ids(std::move(a));
        pieces[1].point_ids = ids(std::move(b));
        return joined_in_any_order(pieces);
    };
    EXPECT_EQ(with({1, 2, 3, 4}, {1, 2, 3, 4}).grid.points.tuples(), 5u) << "each piece counts from one";
    EXPECT_EQ(with({1, 2, 3, 4}, {4, 3, 2, 1}).grid.points.tuples(), 5u);
    EXPECT_EQ(with({0, 0, 0, 0}, {0, 0, 0, 0}).grid.points.tuples(), 5u);
    EXPECT_EQ(with({-1, -1, -1, 0}, {-1, -1, -1, 1}).grid.points.tuples(), 5u);
    EXPECT_EQ(with({1, 2, 3, 4}, {}).grid.points.tuples(), 5u) << "only one has numbers";
    const ReadResult own = with({1, 2, 3, 4}, {5, 6, 7, 8});
    EXPECT_EQ(own.grid.points.tuples(), 5u);
    EXPECT_TRUE(says(own, "no two pieces have a global point number in common"));
    const ReadResult right = with({1, 2, 3, 4}, {1, 2, 3, 5});
    EXPECT_EQ(right.grid.points.tuples(), 5u);
    EXPECT_TRUE(says(right, "joined by global point numbers: 3 points"));
    EXPECT_EQ(with({1, 2, 3, 4}, {1, 2, 6, 5}).grid.points.tuples(), 6u) << "a fault where numbers differ";
}

TEST(Seams, CountCellsOfOverlappingPiecesOnce) {
    const Grid grid = make_grid({"kuhn", 4, {"gyroid"}}).value();
    const auto all = cells_of(grid);
    std::vector<Piece> pieces = cut(grid, 3, {0, 0, 0}, 0);
    for (Piece& piece : cut(grid, 2, {0, 0, 0}, 0)) pieces.push_back(std::move(piece));
    for (Piece& piece : pieces) piece.point_ids = {};
    const ReadResult whole = joined(pieces);
    EXPECT_EQ(whole.grid.cells.count(), grid.cells.count());
    EXPECT_EQ(boundary_triangles(whole.grid), boundary_triangles(grid));
    EXPECT_TRUE(
        says(whole, std::to_string(grid.cells.count()) + " cells that an earlier piece has, too, were left out"));
    std::ranges::reverse(pieces);
    EXPECT_EQ(cells_of(joined(pieces).grid), cells_of(whole.grid));
}

TEST(Seams, TakeNoPointsThatOnlyGhostCellsHave) {
    std::vector<Piece> pieces;
    pieces.push_back(
        piece_of<double>({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {1, 0, 0}}, {0, 1, 2, 3, 0, 1, 2, 4}));
    pieces.push_back(piece_of<double>({{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {0, 1, 2, 3}));
    pieces[0].left_out = {0, 1};
    pieces[0].grid.point_fields = {{"v", Array::own(std::vector<double>{1, 2, 3, 4, -99})}};
    pieces[1].grid.point_fields = {{"v", Array::own(std::vector<double>{1, 2, 3, 5})}};
    const ReadResult whole = joined_in_any_order(pieces);
    EXPECT_EQ(whole.grid.points.tuples(), 5u);
    EXPECT_EQ(whole.grid.cells.count(), 2u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_GT(whole.grid.point_fields.at(0).values.at(i), 0);
}

TEST(Seams, OfHexahedraDoNotDependOnTheOrderOfPieces) {
    const Grid grid = make_grid({"hex", 4, {"gyroid"}}).value();
    std::vector<Piece> pieces = cut(grid, 4, {0, 0, 0}, 0);
    for (Piece& piece : pieces) piece.point_ids = {};
    const ReadResult whole = joined(pieces);
    EXPECT_EQ(whole.grid.cells.uniform_type, CellType::hexahedron);
    EXPECT_TRUE(whole.grid.cells.types.empty());
    std::ranges::reverse(pieces);
    const ReadResult other = joined(pieces);
    const auto same = [](const Array& a, const Array& b) {
        return a.bytes() == b.bytes() &&
               std::equal(static_cast<const std::byte*>(a.data()), static_cast<const std::byte*>(a.data()) + a.bytes(),
                          static_cast<const std::byte*>(b.data()));
    };
    EXPECT_TRUE(same(whole.grid.points, other.grid.points)) << "points are numbered alike";
    EXPECT_TRUE(same(whole.grid.point_fields[0].values, other.grid.point_fields[0].values));
}

} // namespace
} // namespace isotet::test
