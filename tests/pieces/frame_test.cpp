// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surveys and frames: what they say, and what they refuse.
#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>

#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/frame.hpp>
#include <isotet/pack.hpp>
#include <isotet/pieces.hpp>

#include "pieces/partition.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

static_assert(std::is_trivially_copyable_v<Survey> && std::is_trivially_copyable_v<Frame>);

TEST(Frame, OfPiecesIsThatOfTheWholeInAnyOrder) {
    const NastyGrid g = nasty_grid(3, {.values = 4, .no_data = 0.05, .mirrored = 0.3});
    std::vector<GridPiece> pieces = partition(g.grid, g.field, 5, 3);
    const Frame frame = frame_of(pieces);
    EXPECT_EQ(frame.whole, survey_piece(g.grid, g.field).value());
    std::reverse(pieces.begin(), pieces.end());
    EXPECT_EQ(frame_of(pieces), frame);
}

TEST(Frame, SurvivesBeingSentAsBytes) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const Survey sent = survey_piece(grid, point_field(grid)).value();
    std::array<unsigned char, sizeof(Survey)> bytes{};
    std::memcpy(bytes.data(), &sent, sizeof sent);
    Survey received;
    std::memcpy(&received, bytes.data(), sizeof received);
    EXPECT_EQ(make_frame(std::span(&received, 1)).value(), make_frame(std::span(&sent, 1)).value());
}

TEST(Frame, TellsTheRangeOfTheWhole) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const FieldReport report = pack(grid, point_field(grid)).value().field();
    const Frame frame = frame_of(partition(grid, point_field(grid), 3, 1));
    ASSERT_NE(frame.find("gyroid"), nullptr);
    EXPECT_EQ(frame.find("gyroid")->lower, report.lower);
    EXPECT_EQ(frame.find("gyroid")->upper, report.upper);
    EXPECT_EQ(frame.find("temperature"), nullptr);
}

TEST(Frame, NeedsPiecesThatAgree) {
    const Grid grid = made_grid("kuhn", 2, {"gyroid", "integer"});
    const Survey gyroid = survey_piece(grid, point_field(grid)).value();
    const Survey integer = survey_piece(grid, point_field(grid, 1)).value();
    const Survey both = survey_piece(grid, grid.point_fields).value();
    EXPECT_EQ(merge(gyroid, integer).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(merge(gyroid, both).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(merge(gyroid, Survey{}).value(), gyroid);
    EXPECT_EQ(merge(Survey{}, gyroid).value(), gyroid);
    Survey other = gyroid;
    other.points = ScalarType::float64;
    EXPECT_EQ(merge(gyroid, other).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(make_frame({}).error().code, ErrorCode::invalid_argument);
    Survey broken = gyroid;
    broken.field_count = 1000;
    EXPECT_EQ(merge(broken, broken).error().code, ErrorCode::invalid_argument);
}

TEST(Frame, IsRefusedWhereItDoesNotHoldThePiece) {
    Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PointField field = point_field(grid);
    const std::vector<GridPiece> pieces = partition(grid, field, 4, 1);
    const double isovalue = 0;
    const auto refused = [&](const Frame& frame, const PointField& given) {
        const auto packed = pack(grid, given, {.frame = frame});
        DirectOptions options;
        options.frame = frame;
        const auto direct = extract_direct(grid, given, std::span(&isovalue, 1), options);
        return !packed && !direct && packed.error().code == ErrorCode::invalid_argument &&
               direct.error().code == ErrorCode::invalid_argument;
    };
    const Frame frame = frame_of(pieces);
    EXPECT_FALSE(refused(frame, field));
    EXPECT_TRUE(refused(frame_of({pieces[0]}), field)) << "values outside";
    EXPECT_TRUE(refused(frame, {"other", field.values, false, {}})) << "another name";
    std::vector<double> doubles(field.values.size(), 0.5);
    EXPECT_TRUE(refused(frame, field_of(doubles, "gyroid"))) << "another type";
    Frame other_points = frame;
    other_points.whole.points = ScalarType::float64;
    EXPECT_TRUE(refused(other_points, field));
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < grid.points.size(); ++i) coordinates.push_back(grid.points.at(i / 3, i % 3));
    grid.points = Array::own(coordinates, 3);
    EXPECT_FALSE(refused(other_points, field));
    other_points.whole.upper[1] = 0.5;
    EXPECT_TRUE(refused(other_points, field)) << "points outside";
}

TEST(Frame, LetsAPieceBeEmpty) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const Frame frame = frame_of(partition(grid, point_field(grid), 2, 1));
    Grid empty;
    empty.points = Array::own(std::vector<float>{}, 3);
    empty.cells.connectivity = Array::own(std::vector<std::int32_t>{});
    const PointField nothing = field_of(std::vector<float>{}, "gyroid");
    EXPECT_EQ(survey_piece(empty, nothing).value().field_count, 1u);
    const PackedGrid packed = pack(empty, nothing, {.frame = frame}).value();
    EXPECT_EQ(extract(packed, 0.1).value().surface.triangle_count(), 0u);
    EXPECT_EQ(extract(packed.with_field(nothing).value(), 0.1).value().surface.triangle_count(), 0u);
    const double isovalue = 0.1;
    DirectOptions options;
    options.frame = frame;
    EXPECT_EQ(
        extract_direct(empty, nothing, std::span(&isovalue, 1), options).value().surfaces[0].surface.triangle_count(),
        0u);
    EXPECT_EQ(pack(empty, nothing).error().code, ErrorCode::invalid_data);
}

TEST(Frame, LetsAPieceBeEmptyWhereTheWholeDoesNotHoldTheOrigin) {
    Grid whole = made_grid("hex", 2, {"gyroid"});
    std::vector<double> places;
    for (std::size_t i = 0; i < whole.points.size(); ++i) places.push_back(whole.points.at(i / 3, i % 3) + 1000);
    whole.points = Array::own(std::move(places), 3);
    const ContourInput input{whole, point_field(whole), {}, {}};
    for (const Method method : {Method::direct, Method::clusters})
        for (std::uint64_t k = 0; k < 11; ++k) { // of 8 cells
            const FramedPiece piece = take_piece(input, {k, 11}).value();
            ContourOptions options;
            options.frame = piece.frame;
            options.method = method;
            auto session = Contour::create(piece.input, options);
            ASSERT_TRUE(session) << session.error().message;
            const auto surface = session->extract(0.1);
            ASSERT_TRUE(surface) << surface.error().message;
            if (piece.input.grid.cells.count() == 0) {
                EXPECT_EQ(surface->surfaces[0].surface.triangle_count(), 0u);
            }
        }
}

} // namespace
} // namespace isotet::test
