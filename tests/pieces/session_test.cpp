// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sessions with pieces: the same union, by every method, over time steps and moving points.
#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/pieces.hpp>

#include "pieces/partition.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

/// Time steps of a field, large and in double precision, so that storage depends on its range.
PointField at_time(const Grid& grid, double time) {
    std::vector<double> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        values.push_back(100'000 + 13 * grid.point_fields[0].values.at(i) * (1 + time) + time);
    return field_of(std::move(values), "pressure");
}

Grid far_grid() {
    Grid grid = made_grid("mixed", 6, {"gyroid"});
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < grid.points.size(); ++i)
        coordinates.push_back(grid.points.at(i / 3, i % 3) * 777.77 + 400'000.3);
    grid.points = Array::own(std::move(coordinates), 3);
    return grid;
}

std::vector<TriangleBits> of_session(Contour& session, double isovalue) {
    return triangle_set(session.extract(isovalue).value().surfaces[0].surface);
}

ContourInput input_of(const Grid& grid, PointField field) {
    ContourInput input;
    input.grid = grid;
    input.field = std::move(field);
    return input;
}

TEST(SessionsOfPieces, GiveTheSurfaceOfTheWholeOverTimeSteps) {
    const Grid grid = far_grid();
    for (const Method method : {Method::clusters, Method::direct}) {
        constexpr std::uint64_t count = 3;
        std::vector<Grid> pieces;
        for (std::uint64_t i = 0; i < count; ++i) pieces.push_back(take_piece(grid, {i, count}).value());
        std::vector<std::optional<Contour>> sessions(count);
        std::optional<Contour> whole;
        std::vector<ContourUpdate> updates;
        for (const double time : {0.0, 0.0, 0.5, 1.0}) {
            ContourOptions options;
            options.method = method;
            if (!whole) whole = Contour::create(input_of(grid, at_time(grid, time)), options).value();
            else
                EXPECT_EQ(whole->set(input_of(grid, at_time(grid, time))).value() == ContourUpdate::grid,
                          method == Method::direct);
            std::vector<Survey> surveys;
            for (const Grid& piece : pieces) surveys.push_back(survey_piece(piece, at_time(piece, time)).value());
            options.frame = make_frame(surveys).value();
            std::vector<TriangleBits> together;
            for (std::uint64_t i = 0; i < count; ++i) {
                ContourInput input = input_of(pieces[i], at_time(pieces[i], time));
                if (!sessions[i]) sessions[i] = Contour::create(std::move(input), options).value();
                else updates.push_back(sessions[i]->set(std::move(input), options).value());
                for (const auto& triangle : of_session(*sessions[i], 100'003)) together.push_back(triangle);
            }
            ASSERT_TRUE(sorted(std::move(together)) == of_session(*whole, 100'003)) << time;
        }
        using enum ContourUpdate;
        if (method == Method::clusters) {
            EXPECT_EQ(updates, (std::vector{nothing, nothing, nothing, field, field, field, field, field, field}));
        }
    }
}

TEST(SessionsOfPieces, StorePointsAgainForAFrameOfMovedPoints) {
    const Grid grid = far_grid();
    const Grid piece = take_piece(grid, {1, 2}).value();
    ContourOptions options;
    options.method = Method::clusters;
    options.frame = make_frame(std::vector{survey_piece(grid, at_time(grid, 0)).value()}).value();
    Contour session = Contour::create(input_of(piece, at_time(piece, 0)), options).value();
    ASSERT_TRUE(session.prepare());
    Survey wider = options.frame->whole;
    wider.upper[0] += 1000;
    options.frame = make_frame(std::span(&wider, 1)).value();
    EXPECT_EQ(session.set(input_of(piece, at_time(piece, 0)), options).value(), ContourUpdate::points);
    Contour again = Contour::create(input_of(piece, at_time(piece, 0)), options).value();
    EXPECT_EQ(of_session(session, 100'003), of_session(again, 100'003));
    options.frame.reset();
    EXPECT_EQ(session.set(input_of(piece, at_time(piece, 0)), options).value(), ContourUpdate::grid);
    EXPECT_EQ(session.set(input_of(piece, at_time(piece, 0)), options).value(), ContourUpdate::grid);
    Grid renumbered = piece;
    ASSERT_TRUE(session.prepare());
    renumbered.point_numbers = {};
    EXPECT_EQ(session.set(input_of(renumbered, at_time(piece, 0)), options).value(), ContourUpdate::grid);
}

TEST(SessionsOfPieces, RefuseAFrameThatDoesNotHoldTheField) {
    const Grid grid = far_grid();
    ContourOptions options;
    options.frame = make_frame(std::vector{survey_piece(grid, at_time(grid, 0)).value()}).value();
    for (const Method method : {Method::clusters, Method::direct}) {
        options.method = method;
        Contour session = Contour::create(input_of(grid, at_time(grid, 1)), options).value();
        EXPECT_EQ(session.extract(100'003).error().code, ErrorCode::invalid_argument);
    }
}

} // namespace
} // namespace isotet::test
