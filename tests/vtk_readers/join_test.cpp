// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pieces joined to one grid.
#include <cmath>

#include <gtest/gtest.h>

#include "io/pieces/join/join.hpp"

namespace isotet::io::confined {
namespace {

/// One tetrahedron on the unit square's corners, moved by x; its first three points have the numbers 0, 1, 2 if x is 0.
Piece tetrahedron(double x, double apex) {
    Piece piece;
    piece.name = "piece";
    piece.grid.points = Array::own(std::vector<double>{x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, apex}, 3);
    piece.grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3});
    return piece;
}

Array numbers(std::vector<std::int64_t> values) { return Array::own(std::move(values)); }

bool has_note(const ReadResult& result, std::string_view words) {
    for (const std::string& note : result.notes)
        if (note.find(words) != std::string::npos) return true;
    return false;
}

TEST(Join, PassesASinglePieceOnWithoutACopy) {
    Loaded loaded;
    loaded.pieces.push_back(tetrahedron(0, 1));
    const void* data = loaded.pieces[0].grid.points.data();
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->grid.points.data(), data);
    EXPECT_TRUE(result->notes.empty());
}

TEST(Join, ByGlobalNumbersSharesPointsAndDropsRepeatedCells) {
    Loaded loaded;
    for (const double apex : {1.0, -1.0, 1.0}) loaded.pieces.push_back(tetrahedron(0, apex));
    loaded.pieces[0].point_ids = numbers({7, 8, 9, 100});
    loaded.pieces[1].point_ids = numbers({7, 8, 9, 200});
    loaded.pieces[2].point_ids = numbers({7, 8, 9, 100});
    loaded.pieces[0].cell_ids = numbers({1});
    loaded.pieces[1].cell_ids = numbers({2});
    loaded.pieces[2].cell_ids = numbers({1});
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 5u);
    EXPECT_EQ(result->grid.cells.count(), 2u);
    EXPECT_TRUE(has_note(*result, "1 cells that an earlier piece has, too, were left out"));
}

TEST(Join, DoesNotTrustGlobalNumbersThatMeanDifferentPlaces) {
    Loaded loaded;
    for (const double x : {0.0, 5.0}) {
        loaded.pieces.push_back(tetrahedron(x, 1));
        loaded.pieces.back().point_ids = numbers({0, 1, 2, 3});
    }
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->grid.points.tuples(), 8u);
    EXPECT_TRUE(has_note(*result, "mean different places"));
}

TEST(Join, LeavesPointsApartWhereAPieceHasSeveral) {
    Loaded loaded;
    loaded.pieces.push_back(tetrahedron(0, 0)); // two points of its own at one place
    loaded.pieces.push_back(tetrahedron(-0.0, -1));
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->grid.points.tuples(), 6u);
    EXPECT_TRUE(has_note(*result, "3 points lie at the place of another piece's which has several there"));
    EXPECT_TRUE(has_note(*result, "--merge-points 0 joins them"));
}

TEST(Join, KeepsTheValueOfOnePieceAndSaysWhereTheyDiffer) {
    for (const float add : {0.0f, 1e-7f, 10.0f}) {
        Loaded loaded;
        for (const float more : {0.0f, add}) {
            loaded.pieces.push_back(tetrahedron(0, loaded.pieces.empty() ? 1 : -1));
            loaded.pieces.back().grid.point_fields = {{"same", Array::own(std::vector<float>{1, 2, 3, 4})},
                                                      {"jump", Array::own(std::vector<float>{1, 2, 3 + more, 4})}};
        }
        const auto result = join(std::move(loaded), {});
        ASSERT_TRUE(result);
        EXPECT_EQ(result->grid.points.tuples(), 5u);
        EXPECT_EQ(has_note(*result, "\"jump\" differs in 1 points"), add > 1) << "rounding is no jump";
        EXPECT_FALSE(has_note(*result, "\"same\" differs"));
    }
}

TEST(Join, PutsPiecesSideBySideWhereAskedAndSaysSo) {
    Loaded loaded;
    for (const double apex : {1.0, -1.0}) loaded.pieces.push_back(tetrahedron(0, apex));
    ReadOptions apart;
    apart.merge_pieces_by_coordinates = false;
    const auto result = join(std::move(loaded), apart);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->grid.points.tuples(), 8u);
    EXPECT_TRUE(has_note(*result, "side by side"));
}

TEST(Join, FillsFieldsThatAPieceLacksWithNaN) {
    Loaded loaded;
    for (const double x : {0.0, 5.0}) loaded.pieces.push_back(tetrahedron(x, 1));
    loaded.pieces[1].grid.point_fields = {{"n", Array::own(std::vector<std::int32_t>{1, 2, 3, 4})}};
    loaded.pieces[0].grid.cell_fields = {{"c", Array::own(std::vector<float>{6, 7}, 2)}};
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    const Array& n = result->grid.point_fields.at(0).values;
    EXPECT_EQ(n.type(), ScalarType::float64);
    EXPECT_TRUE(std::isnan(n.at(0)));
    EXPECT_EQ(n.at(5), 2);
    const Array& c = result->grid.cell_fields.at(0).values;
    EXPECT_EQ(c.type(), ScalarType::float32);
    EXPECT_EQ(c.at(0, 1), 7);
    EXPECT_TRUE(std::isnan(c.at(1, 1)));
    EXPECT_TRUE(has_note(*result, "\"n\" is in 1 of 2 pieces only"));
}

TEST(Join, TakesDataBeforeNoDataWherePiecesMeet) {
    Loaded loaded;
    for (const double apex : {1.0, -1.0}) loaded.pieces.push_back(tetrahedron(0, apex));
    const double none = std::nan("");
    loaded.pieces[0].grid.point_fields = {{"t", Array::own(std::vector<double>{none, 1, none, none})}};
    loaded.pieces[1].grid.point_fields = {{"t", Array::own(std::vector<double>{5, 1, 7, none})}};
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    const Array& t = result->grid.point_fields.at(0).values;
    ASSERT_EQ(t.tuples(), 5u);
    EXPECT_EQ(t.at(0), 5);
    EXPECT_EQ(t.at(1), 1);
    EXPECT_EQ(t.at(2), 7);
    EXPECT_FALSE(has_note(*result, "differs in"));
}

TEST(Join, TellsOfAllFieldsThatAPieceLacksAtOnce) {
    Loaded loaded;
    for (const double x : {0.0, 5.0}) loaded.pieces.push_back(tetrahedron(x, 1));
    for (const char* name : {"a", "b"})
        loaded.pieces[1].grid.point_fields.push_back({name, Array::own(std::vector<float>{1, 2, 3, 4})});
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(has_note(*result, "point fields \"a\", \"b\" are in 1 of 2 pieces only"));
}

TEST(Join, KeepsTheTypeThatAllPiecesHave) {
    Loaded loaded;
    for (const double x : {0.0, 5.0}) {
        loaded.pieces.push_back(tetrahedron(x, 1));
        loaded.pieces.back().grid.point_fields = {{"n", Array::own(std::vector<std::uint8_t>{1, 2, 3, 4})}};
    }
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->grid.point_fields.at(0).values.type(), ScalarType::uint8);
}

TEST(Join, IsAnErrorWhenACellHasAPointOutOfRange) {
    Loaded loaded;
    for (const double x : {0.0, 5.0}) loaded.pieces.push_back(tetrahedron(x, 1));
    loaded.pieces[1].grid.cells.connectivity = numbers({0, 1, 2, 4});
    const auto result = join(std::move(loaded), {});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("cell 0 has point 4, but there are 4 points"), std::string::npos)
        << result.error().message;
}

TEST(Join, IsAnErrorWhenAFieldHasTheWrongLength) {
    Loaded loaded;
    loaded.pieces.push_back(tetrahedron(0, 1));
    loaded.pieces[0].grid.point_fields = {{"short", Array::own(std::vector<float>{1, 2, 3})}};
    const auto result = join(std::move(loaded), {});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("3 values for 4 points"), std::string::npos) << result.error().message;
}

TEST(Join, OfGhostsOnlyIsAGridWithoutCells) {
    Loaded loaded;
    loaded.pieces.push_back(tetrahedron(0, 1));
    loaded.pieces[0].left_out = {1};
    const auto result = join(std::move(loaded), {});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->grid.cells.count(), 0u);
}

} // namespace
} // namespace isotet::io::confined
