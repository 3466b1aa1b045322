// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pieces with polyhedra: derived points are those of the whole, however pieces number their points.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pieces.hpp>

#include "linear/polyhedral_grid.hpp"
#include "pieces/partition.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

/// A field that is not linear, large and in double precision, with no data here and there.
PointField pressure_of(const Grid& grid, std::uint32_t seed) {
    std::vector<double> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        const double x = grid.points.at(i, 0), y = grid.points.at(i, 1), z = grid.points.at(i, 2);
        values.push_back(101'325.123 + std::sin(3 * x + seed) * std::cos(2 * y) + z * z);
    }
    if (seed % 2) values[seed * 37 % values.size()] = std::numeric_limits<double>::quiet_NaN();
    return {"pressure", Array::own(std::move(values)), false, {}};
}

Array renumbered(const Array& indices, const std::vector<std::int64_t>& place) {
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < indices.size(); ++i) out.push_back(place[static_cast<std::size_t>(indices.at(i))]);
    return Array::own(std::move(out));
}

/// The same cells with points in another order.
ContourInput with_shuffled_points(const ContourInput& input, std::mt19937& random) {
    const Grid& grid = input.grid;
    std::vector<std::uint64_t> order(grid.points.tuples());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<std::int64_t> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<std::int64_t>(i);
    ContourInput out = input;
    out.grid.points = taken(grid.points, order);
    out.grid.point_numbers = taken(grid.point_numbers, order);
    out.grid.cells.connectivity = renumbered(grid.cells.connectivity, place);
    std::vector<std::int64_t> faces;
    const Array& stream = grid.cells.faces;
    const auto next = [&](std::size_t i) { return static_cast<std::int64_t>(stream.at(i)); };
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        auto at = static_cast<std::size_t>(grid.cells.face_offsets.at(cell));
        const auto end = static_cast<std::size_t>(grid.cells.face_offsets.at(cell + 1));
        if (at < end) faces.push_back(next(at++));
        while (at < end) {
            const std::int64_t count = next(at++);
            faces.push_back(count);
            for (std::int64_t i = 0; i < count; ++i) faces.push_back(place[static_cast<std::size_t>(next(at++))]);
        }
    }
    out.grid.cells.faces = Array::own(std::move(faces));
    out.field.values = taken(input.field.values, order);
    return out;
}

struct Pieces {
    std::vector<ContourInput> inputs;
    std::vector<std::uint64_t> first_cells;
    Frame frame;
};

Pieces shuffled_pieces(const ContourInput& whole, std::uint64_t count, std::uint32_t seed, bool split_cells) {
    std::mt19937 random(seed);
    Pieces out;
    std::vector<Survey> surveys;
    for (std::uint64_t k = 0; k < count; ++k) {
        const FramedPiece piece = take_piece(whole, {k, count}, {split_cells}).value();
        out.inputs.push_back(with_shuffled_points(piece.input, random));
        out.first_cells.push_back(piece.first_cell);
        surveys.push_back(survey_piece(out.inputs.back(), {split_cells}).value());
    }
    out.frame = make_frame(surveys).value();
    return out;
}

TEST(PiecesWithPolyhedra, GiveTheSurfaceOfTheWhole) {
    for (const std::uint32_t seed : Seeds(1, 6)) {
        const Grid grid = octree_grid({.seed = seed, .moved = 0.04});
        const ContourInput whole{grid, pressure_of(grid, seed), {}, {}};
        const double isovalue = 101'328.5;
        ContourOptions options;
        options.method = seed % 2 ? Method::clusters : Method::direct;
        options.split_cells = seed % 3 == 0;
        options.edge_ends = true;
        const auto expected =
            triangle_set(Contour::create(whole, options).value().extract(isovalue).value().surfaces[0].surface);
        ASSERT_GT(expected.size(), 100u);
        const Pieces pieces = shuffled_pieces(whole, 1 + seed % 5, seed, options.split_cells);
        options.frame = pieces.frame;
        std::vector<TriangleBits> together;
        std::vector<std::int64_t> derived_ends;
        for (std::size_t k = 0; k < pieces.inputs.size(); ++k) {
            Contour session = Contour::create(pieces.inputs[k], options).value();
            const Surface surface = session.extract(isovalue).value().surfaces[0].surface;
            add_triangles(surface, together);
            const Surface numbered =
                number_as_whole(surface, pieces.inputs[k].grid.point_numbers, pieces.first_cells[k]).value();
            std::vector<std::int64_t> here;
            for (const std::int64_t end : numbered.edge_ends.as<std::int64_t>())
                if (end >= static_cast<std::int64_t>(grid.points.tuples())) here.push_back(end);
            std::ranges::sort(here);
            here.erase(std::unique(here.begin(), here.end()), here.end());
            derived_ends.insert(derived_ends.end(), here.begin(), here.end());
        }
        ASSERT_TRUE(sorted(std::move(together)) == expected) << seed;
        ASSERT_FALSE(derived_ends.empty());
        std::ranges::sort(derived_ends);
        ASSERT_EQ(std::ranges::adjacent_find(derived_ends), derived_ends.end()) << "two pieces have one derived point";
    }
}

TEST(PiecesWithPolyhedra, TakeFieldsOfIntegersAlsoWhereTheyHaveNone) {
    const Grid grid = octree_grid({.seed = 2, .moved = 0.04});
    std::vector<std::int32_t> values(grid.points.tuples());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(i * 37 % 101);
    const PointField field{"number", Array::own(std::move(values)), false, {}};
    const ContourInput whole{grid, field, {}, {}};
    for (const Method method : {Method::direct, Method::clusters}) {
        ContourOptions options;
        options.method = method;
        const auto expected =
            triangle_set(Contour::create(whole, options).value().extract(50.5).value().surfaces[0].surface);
        ASSERT_GT(expected.size(), 100u);
        const std::uint64_t count = grid.cells.count() + 3; // one cell each, or none
        std::vector<TriangleBits> together;
        for (std::uint64_t k = 0; k < count; ++k) {
            const FramedPiece piece = take_piece(whole, {k, count}).value();
            options.frame = piece.frame;
            auto session = Contour::create(piece.input, options);
            ASSERT_TRUE(session) << k << ": " << session.error().message;
            const auto surface = session->extract(50.5);
            ASSERT_TRUE(surface) << k << ": " << surface.error().message;
            add_triangles(surface->surfaces[0].surface, together);
        }
        EXPECT_TRUE(sorted(std::move(together)) == expected);
    }
}

TEST(PiecesWithPolyhedra, AreMadeLinearByTheNumbersOfTheirPoints) {
    const Grid grid = octree_grid({.seed = 2});
    const ContourInput whole{grid, pressure_of(grid, 2), {}, {}};
    const LinearGrid expected = linearize(grid).value();
    const ContourInput piece = shuffled_pieces(whole, 1, 7, false).inputs[0];
    const LinearGrid linear = linearize(piece.grid).value();
    const std::uint64_t users = linear.user_points;
    ASSERT_EQ(linear.derived.count(), expected.derived.count());
    ASSERT_EQ(linear.grid.cells.count(), expected.grid.cells.count());
    ASSERT_EQ(linear.grid.point_numbers.tuples(), users + linear.derived.count());
    const auto number = [&](double point) { // in the whole grid; derived points come in the order of cells
        const auto index = static_cast<std::uint64_t>(point);
        return index < users ? linear.grid.point_numbers.at(index)
                             : static_cast<double>(grid.points.tuples() + index - users);
    };
    for (std::size_t i = 0; i < linear.grid.cells.connectivity.size(); ++i)
        ASSERT_EQ(number(linear.grid.cells.connectivity.at(i)), expected.grid.cells.connectivity.at(i)) << i;
    for (std::size_t row = 0; row < linear.derived.count(); ++row)
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_EQ(linear.grid.points.at(users + row, axis),
                      expected.grid.points.at(grid.points.tuples() + row, axis));
}

TEST(PiecesWithPolyhedra, RefuseNumbersThatLeaveNoneForDerivedPoints) {
    Grid grid = octree_grid({.seed = 2});
    std::vector<std::int64_t> numbers(grid.points.tuples());
    std::iota(numbers.rbegin(), numbers.rend(),
              std::numeric_limits<std::int64_t>::max() - static_cast<std::int64_t>(numbers.size()));
    grid.point_numbers = Array::own(std::move(numbers));
    const auto made = linearize(grid);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::invalid_data);
    EXPECT_NE(made.error().message.find("derived points need larger ones"), std::string::npos) << made.error().message;
}

TEST(PiecesWithPolyhedra, RefuseAFaceWithAPointThatTheCellHasNot) {
    Grid grid = octree_grid({.seed = 2});
    std::vector<std::int64_t> faces;
    for (std::size_t i = 0; i < grid.cells.faces.size(); ++i)
        faces.push_back(static_cast<std::int64_t>(grid.cells.faces.at(i)));
    faces[2] = static_cast<std::int64_t>(grid.points.tuples()) - 1; // the first point of the first face
    grid.cells.faces = Array::own(std::move(faces));
    const auto piece = take_cells(grid, 0, 1);
    ASSERT_FALSE(piece);
    EXPECT_NE(piece.error().message.find("which its connectivity has not"), std::string::npos) << piece.error().message;
}

} // namespace
} // namespace isotet::test
