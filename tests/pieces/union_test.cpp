// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The union law: the surfaces of the pieces of a grid are together the surface of the whole, triangle for triangle, bit
// for bit, however it is cut, and however points and cells of the pieces are numbered.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/pieces.hpp>

#include "pieces/partition.hpp"
#include "support/engines.hpp"
#include "support/mixed_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

enum class PointsAre { as_made, far_away };
enum class ValuesAre { as_made, pressures, large_integers, tiny };

/// Coordinates as of a map, values as of the atmosphere: what single precision has to round.
NastyGrid changed(NastyGrid g, PointsAre points, ValuesAre values) {
    if (points == PointsAre::far_away) {
        std::vector<double> out;
        for (std::size_t i = 0; i < g.grid.points.size(); ++i)
            out.push_back(g.grid.points.at(i / 3, i % 3) * 1234.5678901 + (i % 3 == 0 ? 500'000.1 : 5'400'000.3));
        g.grid.points = Array::own(std::move(out), 3);
    }
    if (values == ValuesAre::as_made) return g;
    std::vector<double> doubles;
    std::vector<std::int64_t> integers;
    for (std::size_t i = 0; i < g.field.values.size(); ++i) {
        const double value = g.field.values.at(i);
        doubles.push_back(values == ValuesAre::tiny ? 1e-25 * (value + 1.1) : 101'325 + 20.123456789 * value);
        integers.push_back((std::int64_t{1} << 40) + (std::isfinite(value) ? std::int64_t(value * 1000) : 0));
    }
    g.field.values =
        values == ValuesAre::large_integers ? Array::own(std::move(integers)) : Array::own(std::move(doubles));
    return g;
}

/// Isovalues between values, and one that ties.
std::vector<double> isovalues_of(const PointField& field) {
    std::vector<double> finite;
    for (std::size_t i = 0; i < field.values.size(); ++i)
        if (const double value = field.values.at(i); std::isfinite(value)) finite.push_back(value);
    std::sort(finite.begin(), finite.end());
    const double middle = finite[finite.size() / 2];
    return {middle, finite.front() + 0.37 * (finite.back() - finite.front()), finite[finite.size() / 5]};
}

struct LawOptions {
    std::size_t pieces = 4;
    Precision precision = Precision::float32;
    bool split_cells = false;
    bool reference = false; ///< the slow engine, too
};

void expect_union(const NastyGrid& g, std::uint32_t seed, const LawOptions& law) {
    const std::vector<GridPiece> pieces = partition(g.grid, g.field, law.pieces, seed);
    const Frame frame = frame_of(pieces, {law.split_cells});
    PackOptions pack_options;
    pack_options.precision = law.precision;
    pack_options.split_cells = law.split_cells;
    DirectOptions direct_options;
    direct_options.precision = law.precision;
    direct_options.split_cells = law.split_cells;
    const PackedGrid whole = pack(g.grid, g.field, pack_options).value();
    const std::vector<double> isovalues = isovalues_of(g.field);
    const auto whole_direct = extract_direct(g.grid, g.field, isovalues, direct_options).value();
    pack_options.frame = direct_options.frame = frame;

    std::vector<std::vector<TriangleBits>> packed(isovalues.size()), slow(isovalues.size()), direct(isovalues.size()),
        slow_direct(isovalues.size());
    for (const GridPiece& piece : pieces) {
        const PackedGrid part = pack(piece.grid, piece.field, pack_options).value();
        const auto straight = extract_direct(piece.grid, piece.field, isovalues, direct_options).value();
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            add_triangles(extract(part, isovalues[i]).value().surface, packed[i]);
            add_triangles(straight.surfaces[i].surface, direct[i]);
        }
        if (!law.reference) continue;
        const auto slowly = extract_direct_by_reference(piece.grid, piece.field, isovalues, direct_options).value();
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            add_triangles(extract_on(Engine::reference, part, isovalues[i]).value().surface, slow[i]);
            add_triangles(slowly.surfaces[i].surface, slow_direct[i]);
        }
    }
    std::size_t most = 0;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "isovalue " << isovalues[i] << ", " << law.pieces << " pieces");
        const auto expected = triangle_set(extract(whole, isovalues[i]).value().surface);
        most = std::max(most, expected.size());
        ASSERT_TRUE(sorted(std::move(direct[i])) == triangle_set(whole_direct.surfaces[i].surface));
        // Of cells that collapse to the same tet in two pieces, the whole keeps one.
        const bool repeats = whole.report().repeated_tets > 0;
        ASSERT_TRUE(repeats || sorted(std::move(packed[i])) == expected);
        if (!law.reference) continue;
        ASSERT_TRUE(repeats || sorted(std::move(slow[i])) == expected);
        ASSERT_TRUE(sorted(std::move(slow_direct[i])) == triangle_set(whole_direct.surfaces[i].surface));
    }
    ASSERT_GT(most, 10u);
}

TEST(UnionOfPieces, IsTheSurfaceOfTheWholeForTets) {
    for (const std::uint32_t seed : Seeds(1, 8)) {
        NastyOptions options;
        options.side = 5;
        options.values = int(seed % 2) * 4;
        options.no_data = 0.01 * (seed % 3);
        options.missing = 0.1;
        options.mirrored = 0.4;
        options.inverted = seed % 4 == 0 ? 0.2 : 0;
        expect_union(nasty_grid(seed, options), seed, {.pieces = 1 + seed % 8, .reference = seed % 4 == 1});
    }
}

TEST(UnionOfPieces, IsTheSurfaceOfTheWholeForRoundedPointsAndValues) {
    for (const std::uint32_t seed : Seeds(1, 12)) {
        NastyOptions options;
        options.side = 5;
        options.values = int(seed % 2) * 4;
        options.no_data = 0.01;
        options.mirrored = 0.3;
        options.wide = true;
        const ValuesAre values[] = {ValuesAre::as_made, ValuesAre::pressures, ValuesAre::large_integers,
                                    ValuesAre::tiny};
        const NastyGrid g = changed(nasty_grid(seed, options), seed % 3 ? PointsAre::far_away : PointsAre::as_made,
                                    values[seed / 2 % 4]);
        expect_union(g, seed, {.pieces = 2 + seed % 7, .reference = seed % 6 == 1});
    }
}

TEST(UnionOfPieces, IsTheSurfaceOfTheWholeForNativeCells) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(1, 4)) {
            SCOPED_TRACE(shape);
            const NastyGrid g = changed(mixed_grid(seed, {.shape = shape,
                                                          .side = 5,
                                                          .values = int(seed % 2) * 4,
                                                          .no_data = 0.02,
                                                          .missing = 0.1,
                                                          .mirrored = 0.3,
                                                          .moved = seed % 2 ? 0.1 : 0.6}),
                                        seed % 2 ? PointsAre::far_away : PointsAre::as_made,
                                        seed % 3 ? ValuesAre::pressures : ValuesAre::as_made);
            expect_union(g, seed, {.pieces = 2 + seed % 5, .reference = seed == 1});
        }
}

TEST(UnionOfPieces, IsTheSurfaceOfTheWholeForSplitAndCollapsedCells) {
    for (const std::uint32_t seed : Seeds(1, 8)) {
        const NastyGrid g = changed(mixed_grid(seed, {.side = 5,
                                                      .values = int(seed % 2) * 4,
                                                      .no_data = 0.02,
                                                      .mirrored = 0.3,
                                                      .moved = 0.2,
                                                      .collapsed = seed % 2 ? 0.1 : 0}),
                                    PointsAre::far_away, seed % 3 ? ValuesAre::as_made : ValuesAre::pressures);
        expect_union(g, seed, {.pieces = 3, .split_cells = seed % 4 < 2, .reference = seed == 1});
    }
}

TEST(UnionOfPieces, IsTheSurfaceOfTheWholeInDoublePrecision) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        const NastyGrid g = changed(mixed_grid(seed, {.side = 5, .values = int(seed % 2) * 4, .no_data = 0.02}),
                                    PointsAre::far_away, seed % 2 ? ValuesAre::pressures : ValuesAre::large_integers);
        expect_union(g, seed, {.pieces = 4, .precision = Precision::float64, .reference = true});
    }
}

/// Set again, the surfaces of the pieces are that of a whole that is set again.
TEST(UnionOfPieces, HoldsAfterSettingFieldsAndPoints) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        const NastyGrid g =
            changed(mixed_grid(seed, {.side = 5, .values = 0, .moved = 0.05}), PointsAre::far_away, ValuesAre::as_made);
        const NastyGrid later = changed(mixed_grid(seed, {.side = 5, .values = 0, .moved = 0.05}), PointsAre::far_away,
                                        ValuesAre::pressures);
        std::vector<double> moved;
        for (std::size_t i = 0; i < g.grid.points.size(); ++i) moved.push_back(g.grid.points.at(i / 3, i % 3) * 1.01);
        const Array points = Array::own(moved, 3);

        const bool split_cells = seed % 2 == 0;
        const auto pieces = partition(g.grid, g.field, 3, seed);
        std::vector<Survey> surveys;
        for (const GridPiece& piece : pieces) {
            Grid next = piece.grid;
            next.points = taken(points, piece.points);
            surveys.push_back(
                survey_piece(next, {"value", taken(later.field.values, piece.points), false, {}}, {split_cells})
                    .value());
        }
        const Frame frame = frame_of(pieces, {split_cells}), next = make_frame(surveys).value();
        const PackedGrid whole = pack(g.grid, g.field, {.split_cells = split_cells})
                                     .value()
                                     .with_points(points)
                                     .value()
                                     .with_field(later.field)
                                     .value();
        const double isovalue = isovalues_of(later.field)[1];
        std::vector<TriangleBits> together;
        for (const GridPiece& piece : pieces) {
            const PackedGrid first =
                pack(piece.grid, piece.field, {.split_cells = split_cells, .frame = frame}).value();
            EXPECT_EQ(first.with_points(taken(points, piece.points)).error().code, ErrorCode::invalid_argument);
            const PackedGrid part = first.with_frame(next)
                                        .with_points(taken(points, piece.points))
                                        .value()
                                        .with_field({"value", taken(later.field.values, piece.points), false, {}})
                                        .value();
            EXPECT_EQ(*part.frame(), next);
            add_triangles(extract(part, isovalue).value().surface, together);
        }
        ASSERT_TRUE(sorted(std::move(together)) == triangle_set(extract(whole, isovalue).value().surface));
    }
}

/// A grid without global numbers: pieces and whole rank points by coordinates.
TEST(UnionOfPieces, HoldsWithPointsNumberedByCoordinates) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        NastyGrid g = changed(mixed_grid(seed, {.side = 5, .values = int(seed % 2) * 4, .moved = 0.2}),
                              seed % 2 ? PointsAre::far_away : PointsAre::as_made, ValuesAre::pressures);
        auto pieces = partition(g.grid, g.field, 4, seed);
        const Frame frame = frame_of(pieces, {.split_cells = true});
        g.grid.point_numbers = number_points_by_coordinates(g.grid.points).value();
        const PackedGrid whole = pack(g.grid, g.field, {.split_cells = true}).value();
        const double isovalue = isovalues_of(g.field)[1];
        std::vector<TriangleBits> together;
        for (GridPiece& piece : pieces) {
            piece.grid.point_numbers = number_points_by_coordinates(piece.grid.points).value();
            const PackedGrid part = pack(piece.grid, piece.field, {.split_cells = true, .frame = frame}).value();
            add_triangles(extract(part, isovalue).value().surface, together);
        }
        ASSERT_TRUE(sorted(std::move(together)) == triangle_set(extract(whole, isovalue).value().surface));
    }
}

/// What pieces take is needed: without it the same comparison fails.
TEST(UnionOfPieces, IsAnotherSurfaceWithoutFrameOrNumbers) {
    const NastyGrid g =
        changed(mixed_grid(3, {.side = 5, .values = 0, .moved = 0.2}), PointsAre::far_away, ValuesAre::pressures);
    const double isovalue = isovalues_of(g.field)[1];
    auto pieces = partition(g.grid, g.field, 4, 3);
    const Frame frame = frame_of(pieces, {.split_cells = true});
    const auto together = [&](const std::optional<Frame>& framed) {
        std::vector<TriangleBits> out;
        for (const GridPiece& piece : pieces) {
            PackOptions options;
            options.split_cells = true;
            options.frame = framed;
            add_triangles(extract(pack(piece.grid, piece.field, options).value(), isovalue).value().surface, out);
        }
        return sorted(std::move(out));
    };
    const auto whole =
        triangle_set(extract(pack(g.grid, g.field, {.split_cells = true}).value(), isovalue).value().surface);
    EXPECT_EQ(together(frame), whole);
    EXPECT_NE(together({}), whole);
    for (GridPiece& piece : pieces) piece.grid.point_numbers = {};
    EXPECT_NE(together(frame), whole);
}

/// Each vertex and each carried value, too; vertices keep the user's numbers of their ends.
TEST(UnionOfPieces, CarriesTheValuesOfTheWhole) {
    const NastyGrid g =
        changed(mixed_grid(2, {.side = 5, .values = 4, .moved = 0.1}), PointsAre::far_away, ValuesAre::pressures);
    const NastyGrid other = changed(mixed_grid(2, {.side = 5, .values = 0}), PointsAre::as_made, ValuesAre::pressures);
    const auto values_at = [](const Surface& surface, const std::vector<std::uint64_t>* numbers, auto& out) {
        for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
            auto number = [&](std::size_t end) {
                const auto user = static_cast<std::uint64_t>(surface.edge_ends.as<std::int64_t>()[2 * v + end]);
                return numbers ? (*numbers)[user] : user;
            };
            out[{number(0), number(1)}].insert(std::bit_cast<std::uint64_t>(surface.point_fields[0].values.at(v)));
        }
    };
    using Values = std::map<std::pair<std::uint64_t, std::uint64_t>, std::set<std::uint64_t>>;
    ExtractOptions extract_options;
    extract_options.edge_ends = true;
    extract_options.point_fields = {{"other", other.field.values}};
    const double isovalue = isovalues_of(g.field)[1];
    Values whole, packed, direct;
    values_at(extract(pack(g.grid, g.field).value(), isovalue, extract_options).value().surface, nullptr, whole);

    const auto pieces = partition(g.grid, g.field, 3, 2);
    std::vector<Survey> surveys;
    std::vector<Field> carried;
    for (const GridPiece& piece : pieces) {
        carried.push_back({"other", taken(other.field.values, piece.points)});
        const Field fields[] = {{"value", piece.field.values}, carried.back()};
        surveys.push_back(survey_piece(piece.grid, fields).value());
    }
    const Frame frame = make_frame(surveys).value();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        extract_options.point_fields = {carried[i]};
        const PackedGrid part = pack(pieces[i].grid, pieces[i].field, {.frame = frame}).value();
        values_at(extract(part, isovalue, extract_options).value().surface, &pieces[i].points, packed);
        DirectOptions options;
        options.extract = extract_options;
        options.frame = frame;
        values_at(extract_direct(pieces[i].grid, pieces[i].field, std::span(&isovalue, 1), options)
                      .value()
                      .surfaces[0]
                      .surface,
                  &pieces[i].points, direct);
    }
    ASSERT_GT(whole.size(), 100u);
    EXPECT_EQ(packed, whole);
    EXPECT_EQ(direct, whole);
}

} // namespace
} // namespace isotet::test
