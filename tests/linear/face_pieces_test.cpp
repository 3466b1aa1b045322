// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How faces are cut: as few pieces as can be, from the face alone.
#include "linear/polyhedra/face_pieces.hpp"

#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "grid/orientation.hpp"

namespace isotet::linear {
namespace {

/// "0123 034": the pieces of a face in the plane z = 0.
std::string cut(const std::vector<std::array<double, 2>>& corners) {
    std::vector<double> places;
    for (const auto& [x, y] : corners) places.insert(places.end(), {x, y, 0});
    const Array points = Array::own(std::move(places), 3);
    std::vector<std::uint64_t> loop(corners.size());
    std::iota(loop.begin(), loop.end(), std::uint64_t{0});
    std::vector<LoopPiece> pieces;
    cut_face(loop, core::PointReader(points), pieces);
    std::string text;
    for (const LoopPiece& piece : pieces) {
        if (!text.empty()) text += ' ';
        for (std::uint32_t i = 0; i < piece.count; ++i) text += static_cast<char>('0' + piece.corners[i]);
    }
    return text;
}

TEST(FacePieces, OfConvexFacesAreQuadrilateralsAsFarAsTheyGo) {
    EXPECT_EQ(cut({{0, 0}, {1, 0}, {0, 1}}), "012");
    EXPECT_EQ(cut({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), "0123");
    EXPECT_EQ(cut({{0, 0}, {2, 0}, {3, 2}, {1, 3}, {-1, 2}}), "0123 034");
    EXPECT_EQ(cut({{0, 0}, {1, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 1}}), "0123 0345");
    EXPECT_EQ(cut({{0, 0}, {2, -1}, {4, 0}, {5, 2}, {4, 4}, {2, 5}, {0, 4}}), "0123 0345 056");
}

TEST(FacePieces, OfAQuadrilateralThatIsNotConvexHaveTheInnerDiagonal) {
    EXPECT_EQ(cut({{0, 0}, {1, 3}, {0, 1}, {-1, 3}}), "0123") << "from the first corner it is inside";
    EXPECT_EQ(cut({{0, 3}, {-1, 0}, {0, 1}, {1, 0}}), "0123") << "the corner that turns in is its other end";
    EXPECT_EQ(cut({{1, 0}, {0, 3}, {-1, 0}, {0, 1}}), "3012");
}

TEST(FacePieces, AreTrianglesWhereTheOtherDiagonalWouldBeThin) {
    // Point 2 hangs on the line from 1 to 3: of the fan only 0 3 4 5 is a quadrilateral.
    EXPECT_EQ(cut({{0, 0}, {4, 0}, {4, 2}, {4, 4}, {2, 6}, {0, 4}}), "012 0234 045");
}

TEST(FacePieces, OfFacesThatAFanDoesNotFillAreEars) {
    // An L, whose first corner does not see all others.
    const std::string pieces = cut({{1, 3}, {1, 1}, {3, 1}, {3, 0}, {0, 0}, {0, 3}});
    EXPECT_EQ(std::ranges::count(pieces, ' '), 3) << pieces;
}

} // namespace
} // namespace isotet::linear
