// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells between isovalues: their boundary is the solid, vertex by vertex, and each of them is sound.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/solid.hpp>

#include "grid/orientation.hpp"
#include "solid/all_cases.hpp"
#include "solid/cell_boundary.hpp"
#include "support/mixed_grid.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

ContourOptions with_ends(ContourOptions options) {
    options.edge_ends = options.source_cells = true;
    return options;
}

ContourInput clip_input(const NastyGrid& g) { return {g.grid, g.field, {{"value", g.field.values}}, {}}; }

Clipper clipper_of(const NastyGrid& g, const ContourOptions& options) {
    Result<Clipper> made = Clipper::create(clip_input(g), with_ends(options));
    EXPECT_TRUE(static_cast<bool>(made)) << (made ? "" : made.error().message);
    return *std::move(made);
}

std::size_t unused_points(const Grid& grid) {
    std::vector<bool> used(grid.points.tuples());
    for (std::size_t i = 0; i < grid.cells.connectivity.tuples(); ++i)
        used[static_cast<std::size_t>(grid.cells.connectivity.at(i))] = true;
    return static_cast<std::size_t>(std::ranges::count(used, false));
}

/// Without infinite values, between which several isovalues have one place, and without those that are stored as 0.
NastyGrid tame(NastyGrid g) {
    std::vector<float> values;
    for (std::size_t i = 0; i < g.field.values.tuples(); ++i) {
        const auto value = static_cast<float>(g.field.values.at(i));
        values.push_back(std::isinf(value) ? 7 : std::abs(value) < 1e-30F ? 0 : value);
    }
    g.field.values = Array::own(std::move(values));
    return g;
}

std::vector<SolidRange> ranges_of(const std::vector<double>& isovalues) {
    std::vector<SolidRange> out;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        out.push_back(SolidRange::above(isovalues[i]));
        out.push_back(SolidRange::below(isovalues[i]));
        if (i > 0) out.push_back({isovalues[i - 1], isovalues[i]});
    }
    return out;
}

/// What must hold of cells that are no worse than those of the grid.
struct Soundness {
    bool shells = true, upright = true;
};

void expect_sound(const ClippedGrid& clipped, const Soundness& wanted) {
    EXPECT_EQ(unused_points(clipped.grid), 0u);
    std::size_t open = 0, inverted = 0, descending = 0;
    const FacesOfCells cells(clipped.grid);
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        open += !is_shell(cells.of(cell));
        inverted += !(cells.six_volumes(cell) > 0);
        descending += cell > 0 && clipped.source_cells.at(cell) < clipped.source_cells.at(cell - 1);
    }
    EXPECT_EQ(descending, 0u);
    EXPECT_EQ(wanted.shells ? open : 0, 0u);
    EXPECT_EQ(wanted.upright ? inverted : 0, 0u);
}

void expect_clips(const NastyGrid& g, const ContourOptions& options, const std::vector<double>& isovalues,
                  const Soundness& wanted = {}) {
    Clipper clipper = clipper_of(g, options);
    Solids solids = Solids::create(clip_input(g), with_ends(options)).value();
    for (const SolidRange& range : ranges_of(isovalues)) {
        SCOPED_TRACE(testing::Message() << "from " << range.lower << " to " << range.upper);
        const Result<ClippedGrid> clipped = clipper.clip(range);
        ASSERT_TRUE(static_cast<bool>(clipped)) << clipped.error().message;
        ASSERT_EQ(difference(*clipped, solids.extract(range).value()), 0u);
        expect_sound(*clipped, wanted);
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Clip, OfTetsHasTheSolidAsItsBoundary) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const NastyGrid smooth = nasty_grid(seed, {.side = 4, .values = 0, .missing = 0.1});
        expect_clips(smooth, {}, {-0.7, -0.1, 0.4}, {.upright = false}); // rounded to float
        expect_clips(smooth, {.precision = Precision::float64}, {-0.7, -0.1, 0.4});
    }
}

TEST(Clip, OfTetsFullOfTiesHasTheSolidAsItsBoundary) {
    for (const std::uint32_t seed : Seeds(100, 6))
        expect_clips(tame(nasty_grid(seed, {.side = 4,
                                            .values = 2 + int(seed) % 4,
                                            .no_data = 0.02 * (seed % 3),
                                            .missing = 0.1,
                                            .mirrored = 0.3})),
                     {.precision = Precision::float64}, {-1, -0.5, 0, 1});
}

TEST(Clip, OfRepeatedTetsHasTheSolidAsItsBoundary) {
    for (const std::uint32_t seed : Seeds(200, 4))
        expect_clips(tame(nasty_grid(seed, {.side = 4, .values = 4, .repeated = 0.1, .wide = true})),
                     {.precision = Precision::float64}, {-0.5, 0, 0.5});
}

TEST(Clip, OfAllKindsOfCellsHasTheSolidAsItsBoundary) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(300, 2))
            for (const bool split : {false, true}) {
                SCOPED_TRACE(testing::Message() << shape << (split ? ", split" : ""));
                ContourOptions options{.precision = Precision::float64};
                options.split_cells = split;
                expect_clips(mixed_grid(seed, {.shape = shape,
                                               .side = 3,
                                               .values = seed % 2 ? 4 : 0,
                                               .no_data = 0.01 * (seed % 2),
                                               .missing = 0.1,
                                               .mirrored = 0.2,
                                               .wide = true}),
                             options, {0.1, 0.5, 1, 2});
            }
}

TEST(Clip, OfCellsWithWarpedFacesHasTheSolidAsItsBoundary) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(350, 2)) {
            SCOPED_TRACE(shape);
            expect_clips(mixed_grid(seed, {.shape = shape,
                                           .side = 3,
                                           .values = seed % 2 ? 4 : 0,
                                           .missing = 0.1,
                                           .moved = 0.1,
                                           .wide = true}),
                         {.precision = Precision::float64}, {-0.3, 0, 0.5, 1}, {.upright = false});
        }
}

TEST(Clip, OfCollapsedCellsHasAboutTheVolumeOfTheSolid) {
    for (const std::uint32_t seed : Seeds(400, 4)) {
        const NastyGrid g = mixed_grid(seed, {.side = 4, .values = seed % 2 ? 3 : 0, .collapsed = 0.1, .wide = true});
        Clipper clipper = clipper_of(g, {.precision = Precision::float64});
        Solids solids = Solids::create(clip_input(g), {.precision = Precision::float64}).value();
        for (const SolidRange& range : ranges_of({0.1, 1})) {
            const ClippedGrid clipped = clipper.clip(range).value();
            const double warp = 0.05 * solids.grid_volume(); // faces are not flat, and not all cells stay whole
            EXPECT_NEAR(total_volume(clipped.grid), solids.extract(range).value().volume, warp);
            EXPECT_EQ(unused_points(clipped.grid), 0u);
        }
    }
}

TEST(Clip, OfEveryWayToPutCornersBelowAtAndAboveIsSound) {
    for (const core::CellKind kind : core::cell_kinds) {
        SCOPED_TRACE(testing::Message() << core::corner_count(kind) << " corners");
        const NastyGrid g = all_cases(kind);
        Clipper clipper = clipper_of(g, {.precision = Precision::float64});
        Solids solids = Solids::create(clip_input(g), with_ends({.precision = Precision::float64})).value();
        for (const SolidRange& range : {SolidRange::above(1), SolidRange::below(1), SolidRange{1, 2}}) {
            SCOPED_TRACE(testing::Message() << "from " << range.lower << " to " << range.upper);
            const ClippedGrid clipped = clipper.clip(range).value();
            const Solid solid = solids.extract(range).value();
            expect_sound(clipped, {});
            EXPECT_NEAR(total_volume(clipped.grid), solid.volume, 1e-9 * solids.grid_volume());
            const bool one_isovalue = !std::isfinite(range.upper) || !std::isfinite(range.lower);
            EXPECT_EQ(one_isovalue && kind != core::CellKind::hexahedron ? difference(clipped, solid) : 0, 0u);
        }
    }
}

/// The share of a tet where a linear field with these values is at least v, by sorting its corners.
double share_above(std::array<double, 4> f, double v) {
    std::ranges::sort(f);
    const auto part = [&](std::size_t a, std::size_t b) { return (f[b] - v) / (f[b] - f[a]); };
    if (v <= f[0]) return 1;
    if (v > f[3]) return 0;
    if (v <= f[1]) return 1 - (1 - part(0, 1)) * (1 - part(0, 2)) * (1 - part(0, 3));
    if (v > f[2]) return part(0, 3) * part(1, 3) * part(2, 3);
    const double a = part(0, 2), b = part(0, 3), c = part(1, 2), d = part(1, 3);
    return a * c + a * d * (1 - c) + b * d * (1 - a); // three tets of the wedge
}

TEST(Clip, OfEachTetHasTheVolumeThatTheReferenceSays) {
    const NastyGrid g = nasty_grid(7, {.side = 5, .values = 0, .wide = true});
    Clipper clipper = clipper_of(g, {.precision = Precision::float64});
    const core::CellReader cells = core::CellReader::open(g.grid).value();
    const core::PointReader points(g.grid.points);
    for (const double isovalue : {-0.6, 0.0, 0.3}) {
        const ClippedGrid clipped = clipper.clip(SolidRange::above(isovalue)).value();
        std::vector<double> volumes(cells.count());
        const FacesOfCells pieces(clipped.grid);
        for (std::size_t cell = 0; cell < pieces.count(); ++cell)
            volumes[static_cast<std::size_t>(clipped.source_cells.at(cell))] += pieces.six_volumes(cell);
        for (std::size_t cell = 0; cell < cells.count(); ++cell) {
            const core::Tet tet = *cells.tets(cell).begin();
            std::array<double, 4> values;
            for (std::size_t k = 0; k < 4; ++k) values[k] = g.field.values.at(tet[k]);
            const double whole = std::abs(points.six_volumes(tet));
            ASSERT_NEAR(volumes[cell], share_above(values, isovalue) * whole, 1e-12) << "cell " << cell;
        }
    }
}

TEST(Clip, CarriesFieldsAsTheSolidDoes) {
    const NastyGrid g = mixed_grid(11, {.side = 4, .values = 0, .moved = 0.1});
    std::vector<std::int16_t> numbers(g.grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int16_t>(3 * i);
    ContourInput input = clip_input(g);
    input.cell_fields = {{"number", Array::own(std::move(numbers))}};
    const ClippedGrid clipped = Clipper::create(input, with_ends({})).value().clip(SolidRange::above(0.1)).value();
    for (std::size_t cell = 0; cell < clipped.grid.cells.count(); ++cell)
        ASSERT_EQ(clipped.grid.cell_fields[0].values.at(cell), 3 * clipped.source_cells.at(cell));
    const Solid solid = Solids::create(input, with_ends({})).value().extract(SolidRange::above(0.1)).value();
    std::map<std::array<double, 3>, double> values;
    const auto place = [](const Array& points, std::size_t i) {
        return std::array{points.at(i, 0), points.at(i, 1), points.at(i, 2)};
    };
    for (std::size_t i = 0; i < clipped.grid.points.tuples(); ++i)
        values[place(clipped.grid.points, i)] = clipped.grid.point_fields[0].values.at(i);
    for (std::size_t i = 0; i < solid.surface.vertex_count(); ++i)
        ASSERT_EQ(values.at(place(solid.surface.positions, i)), solid.surface.point_fields[0].values.at(i));
}

std::string bytes_of_arrays(const ClippedGrid& clipped) {
    std::string out;
    const Grid& grid = clipped.grid;
    for (const Array* array : {&grid.points, &grid.cells.connectivity, &grid.cells.offsets, &grid.cells.types,
                               &grid.cells.faces, &grid.cells.face_offsets, &grid.point_fields[0].values,
                               &clipped.source_cells, &clipped.edge_ends, &clipped.edge_weights})
        out.append(static_cast<const char*>(array->data()), array->bytes());
    return out;
}

TEST(Clip, IsTheSameFromBothMethodsAndAnyThreads) {
    for (const std::uint32_t seed : Seeds(600, 2)) {
        const NastyGrid g = mixed_grid(seed, {.side = 12, .values = seed % 2 ? 5 : 0, .moved = 0.1});
        std::set<std::string> all;
        for (const int threads : {1, 5})
            for (const Method method : {Method::direct, Method::clusters}) {
                ContourOptions options;
                options.method = method;
                Clipper clipper = Clipper::create(clip_input(g), with_ends(options), {.threads = threads}).value();
                all.insert(bytes_of_arrays(clipper.clip({0.1, 3}, {}, {.threads = threads}).value()));
            }
        EXPECT_EQ(all.size(), 1u);
    }
}

TEST(Clip, WithoutPolyhedraFillsTheSameSpace) {
    for (const std::uint32_t seed : Seeds(700, 2)) {
        const NastyGrid g = mixed_grid(seed, {.side = 5, .values = seed % 2 ? 4 : 0, .wide = true});
        Clipper clipper = clipper_of(g, {.precision = Precision::float64});
        for (const SolidRange& range : ranges_of({0.2, 0.7})) {
            const ClippedGrid with = clipper.clip(range).value(),
                              without = clipper.clip(range, {.polyhedra = false}).value();
            const FacesOfCells cells(without.grid);
            for (std::size_t cell = 0; cell < cells.count(); ++cell) ASSERT_NE(cells.type(cell), 42);
            EXPECT_GT(with.polyhedra, 0u);
            EXPECT_EQ(without.polyhedra, 0u);
            EXPECT_NEAR(total_volume(without.grid, InsideOut::negative), total_volume(with.grid), 1e-12);
            // Cells are flat, up to rounding, where the point inside lies in the plane of a face.
            expect_sound(without, {.upright = false});
            std::size_t inverted = 0;
            for (std::size_t cell = 0; cell < cells.count(); ++cell)
                inverted += cells.signed_six_volumes(cell) < -1e-15;
            EXPECT_EQ(inverted > 0, without.folded_pieces > 0);
        }
    }
}

TEST(Clip, IsTheWholeGridOrNothingWhereTheIsovalueIsOutsideTheRange) {
    const NastyGrid g = mixed_grid(5, {.side = 3});
    Clipper clipper = clipper_of(g, {});
    const ClippedGrid all = clipper.clip(SolidRange::above(-10)).value();
    EXPECT_EQ(all.whole_cells, g.grid.cells.count());
    EXPECT_EQ(all.cut_cells, 0u);
    const ClippedGrid none = clipper.clip(SolidRange::above(10)).value();
    EXPECT_EQ(none.grid.cells.count(), 0u);
    EXPECT_EQ(none.grid.points.tuples(), 0u);
}

TEST(ClipMisuse, RangesAndOptionsThatMakeNoSenseAreErrors) {
    const NastyGrid g = mixed_grid(5, {.side = 2});
    Clipper clipper = clipper_of(g, {});
    for (const SolidRange& range : {SolidRange{1, 1}, SolidRange{}, SolidRange{std::nan(""), 1}})
        EXPECT_EQ(clipper.clip(range).error().code, ErrorCode::invalid_argument);
    for (const Normals normals : {Normals::face, Normals::vertex, Normals::gradient}) {
        ContourOptions options;
        options.normals = normals;
        EXPECT_EQ(Clipper::create(clip_input(g), options).error().code, ErrorCode::invalid_argument);
    }
    const Clipper other = std::move(clipper);
    EXPECT_EQ(clipper.clip({0, 1}).error().code, ErrorCode::invalid_argument); // NOLINT
}

TEST(Clip, TurnsTetsOfCurvedCellsOutward) {
    Grid grid; // the nodes of a quadratic wedge go around it the other way than those of a linear one
    grid.points =
        Array::own(std::vector<double>{0, 0, 0,  1, 0,  0, 0, 1,  0,  0, 0, 1,  1, 0, 1, 0,  1, 1, .5, 0, 0, .5, .5,
                                       0, 0, .5, 0, .5, 0, 1, .5, .5, 1, 0, .5, 1, 0, 0, .5, 1, 0, .5, 0, 1, .5},
                   3);
    std::vector<std::int64_t> nodes(15);
    std::iota(nodes.begin(), nodes.end(), 0);
    grid.cells.connectivity = Array::own(nodes);
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 15});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{26});
    const PointField x = find_field(grid, "x").value();
    for (const bool refined : {false, true})
        for (const double below : {0.6, 5.0}) {
            SCOPED_TRACE(testing::Message() << refined << " " << below);
            ContourOptions options;
            if (refined) options.refine = RefineOptions{};
            Clipper clipper = Clipper::create({grid, x, {}, {}}, options).value();
            const Grid clipped = clipper.clip(SolidRange::below(below)).value().grid;
            const core::PointReader points(clipped.points);
            const auto cells = core::CellReader::open(clipped).value();
            double six_volumes = 0;
            for (std::size_t cell = 0; cell < cells.count(); ++cell) {
                if (cells.type(cell) != 10) continue;
                core::Tet tet;
                for (std::size_t k = 0; k < 4; ++k) tet[k] = cells.corner(cells.first(cell) + k);
                EXPECT_GT(points.six_volumes(tet), 0);
                six_volumes += points.six_volumes(tet);
            }
            if (below == 5) {
                EXPECT_NEAR(six_volumes, 3, 1e-12);
            }
        }
}

} // namespace
} // namespace isotet::test
