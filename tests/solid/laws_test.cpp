// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids of random grids: every edge is used equally often in both directions, and what lies above and below an isovalue
// makes up the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/check.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/solid.hpp>
#include <isotet/surface.hpp>

#include "solid/all_cases.hpp"
#include "support/mixed_grid.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// Edges that are not used equally often in both directions, counted in the plainest way.
std::size_t unbalanced_edges(const Surface& surface) {
    std::map<std::pair<std::uint64_t, std::uint64_t>, int> uses;
    const auto triangles = surface.triangles.as<std::uint32_t>();
    for (std::size_t i = 0; i < triangles.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = triangles[i + k], b = triangles[i + (k + 1) % 3];
            if (a < b) ++uses[{a, b}];
            else --uses[{b, a}];
        }
    std::size_t count = 0;
    for (const auto& [edge, sum] : uses) count += sum != 0;
    return count;
}

/// Triangles on the vertices of another one, the other way round.
std::size_t back_to_back(const Surface& surface) {
    std::map<std::array<std::uint32_t, 3>, int> turns;
    const auto triangles = surface.triangles.as<std::uint32_t>();
    std::size_t count = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        std::array<std::uint32_t, 3> from_lowest{triangles[i], triangles[i + 1], triangles[i + 2]};
        std::ranges::rotate(from_lowest, std::ranges::min_element(from_lowest));
        count += turns.contains({from_lowest[0], from_lowest[2], from_lowest[1]});
        ++turns[from_lowest];
    }
    return count;
}

/// Edges at which two triangles lie flat on each other.
std::size_t folds(const Surface& surface) {
    using Vector = std::array<double, 3>;
    const auto triangles = surface.triangles.as<std::uint32_t>();
    const auto at = [&](std::uint32_t vertex) {
        return Vector{surface.positions.at(vertex, 0), surface.positions.at(vertex, 1),
                      surface.positions.at(vertex, 2)};
    };
    const auto difference = [](const Vector& a, const Vector& b) {
        return Vector{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Vector>> normals; // by directed edge
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const Vector a = difference(at(triangles[i + 1]), at(triangles[i])),
                     b = difference(at(triangles[i + 2]), at(triangles[i]));
        Vector normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        const double length = std::sqrt(dot(normal, normal));
        if (length < 1e-9) continue;
        for (double& x : normal) x /= length;
        for (std::size_t k = 0; k < 3; ++k) normals[{triangles[i + k], triangles[i + (k + 1) % 3]}].push_back(normal);
    }
    std::size_t count = 0;
    for (const auto& [edge, some] : normals) {
        const auto back = normals.find({edge.second, edge.first});
        if (back == normals.end() || edge.first > edge.second) continue;
        for (const Vector& one : some)
            for (const Vector& other : back->second) count += dot(one, other) < -1 + 1e-10;
    }
    return count;
}

/// The 24 ways to number the corners of a hexahedron that do not turn it inside out.
std::vector<std::array<std::uint8_t, 8>> turns_of_a_hexahedron() {
    using Turn = std::array<std::uint8_t, 8>;
    const Turn about_z{1, 2, 3, 0, 5, 6, 7, 4}, about_x{3, 2, 6, 7, 0, 1, 5, 4};
    std::vector<Turn> all{{0, 1, 2, 3, 4, 5, 6, 7}};
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const Turn& next : {about_z, about_x}) {
            Turn made{};
            for (std::size_t k = 0; k < 8; ++k) made[k] = all[i][next[k]];
            if (std::ranges::find(all, made) == all.end()) all.push_back(made);
        }
    return all;
}

/// Hexahedra askew in space with the values 0, 1 and 2, their corners and points in any order.
NastyGrid turned_hexahedra(std::uint32_t seed, bool single) {
    std::mt19937 random(seed);
    const Grid made = made_grid("hex", 4, {});
    const std::size_t count = made.points.tuples();
    std::vector<std::int64_t> place(count);
    std::iota(place.begin(), place.end(), 0);
    for (std::size_t i = count; i > 1; --i) std::swap(place[i - 1], place[random() % i]);
    std::vector<double> points(3 * count), values(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = made.points.at(i, 0), y = made.points.at(i, 1), z = made.points.at(i, 2);
        const auto to = static_cast<std::size_t>(place[i]);
        points[3 * to] = 0.36 * x + 0.48 * y - 0.8 * z;
        points[3 * to + 1] = -0.8 * x + 0.6 * y;
        points[3 * to + 2] = 0.48 * x + 0.64 * y + 0.6 * z;
        values[to] = random() % 3;
    }
    const auto turns = turns_of_a_hexahedron();
    std::vector<std::int64_t> connectivity, offsets{0};
    for (std::size_t cell = 0; cell < made.cells.count(); ++cell) {
        for (const std::uint8_t corner : turns[random() % turns.size()])
            connectivity.push_back(place[static_cast<std::size_t>(made.cells.connectivity.at(8 * cell + corner))]);
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    NastyGrid out;
    out.grid.points =
        single ? Array::own(std::vector<float>(points.begin(), points.end()), 3) : Array::own(std::move(points), 3);
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    out.grid.cells.offsets = Array::own(std::move(offsets));
    out.grid.cells.types = Array::own(std::vector<std::uint8_t>(made.cells.count(), 12));
    out.field = {"value", Array::own(std::move(values)), false, {}};
    return out;
}

Solids solids_of(const NastyGrid& g, const ContourOptions& options) {
    ContourInput input{g.grid, g.field, {{"value", g.field.values}}, {}};
    Result<Solids> solids = Solids::create(std::move(input), options);
    EXPECT_TRUE(static_cast<bool>(solids)) << (solids ? "" : solids.error().message);
    return *std::move(solids);
}

struct Tolerance {
    double volume; ///< of the grid's
};

void expect_whole(const NastyGrid& g, const ContourOptions& options, const std::vector<double>& isovalues,
                  const Tolerance& tolerance) {
    Solids solids = solids_of(g, options);
    const double near = tolerance.volume * std::abs(solids.grid_volume());
    double before = 0;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "isovalue " << isovalues[i]);
        const Solid above = solids.extract(SolidRange::above(isovalues[i])).value();
        const Solid below = solids.extract(SolidRange::below(isovalues[i])).value();
        for (const Solid* solid : {&above, &below}) {
            ASSERT_EQ(solid->open_edges, 0u);
            ASSERT_EQ(unbalanced_edges(solid->surface), 0u);
            ASSERT_EQ(back_to_back(solid->surface), 0u);
        }
        ASSERT_NEAR(above.volume + below.volume, solids.grid_volume(), near);
        if (i > 0) {
            const Solid between = solids.extract({isovalues[i - 1], isovalues[i]}).value();
            ASSERT_EQ(between.open_edges, 0u);
            ASSERT_EQ(unbalanced_edges(between.surface), 0u);
            ASSERT_NEAR(between.volume, below.volume - before, near);
        }
        before = below.volume;
    }
}

constexpr Tolerance of_floats{2e-6}, of_doubles{1e-12};

TEST(Solid, OfTetsIsClosedAndWhole) {
    for (const std::uint32_t seed : Seeds(1, 8)) {
        const NastyGrid smooth = nasty_grid(seed, {.side = 6, .values = 0, .missing = 0.1});
        expect_whole(smooth, {}, {-0.7, -0.1, 0.4}, of_floats);
        expect_whole(smooth, {.precision = Precision::float64}, {-0.7, -0.1, 0.4}, of_doubles);
    }
}

TEST(Solid, OfTetsFullOfTiesIsClosedAndWhole) {
    for (const std::uint32_t seed : Seeds(100, 12))
        expect_whole(
            nasty_grid(seed, {.side = 4, .values = 2 + int(seed) % 4, .no_data = 0.02 * (seed % 3), .missing = 0.1}),
            {.precision = Precision::float64}, {-1, -0.5, 0, 1}, of_doubles);
}

TEST(Solid, OfTangledTetsIsClosed) {
    for (const std::uint32_t seed : Seeds(200, 8))
        expect_whole(nasty_grid(seed, {.side = 5, .values = 4, .inverted = 0.1, .mirrored = 0.3, .wide = true}),
                     {.precision = Precision::float64}, {-0.5, 0, 0.5}, of_doubles);
}

TEST(Solid, OfAllKindsOfCellsIsClosedAndWhole) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(300, 4))
            for (const bool split : {false, true}) {
                SCOPED_TRACE(testing::Message() << shape << (split ? ", split" : ""));
                ContourOptions options{.precision = Precision::float64};
                options.split_cells = split;
                expect_whole(mixed_grid(seed, {.shape = shape,
                                               .side = 4,
                                               .values = 4,
                                               .no_data = 0.01 * (seed % 2),
                                               .missing = 0.1,
                                               .mirrored = 0.2,
                                               .wide = true}),
                             options, {0, 0.5, 1, 2}, of_doubles);
            }
}

TEST(Solid, OfCellsWithWarpedFacesIsClosedAndWhole) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(350, 4))
            expect_whole(mixed_grid(seed, {.shape = shape,
                                           .side = 4,
                                           .values = seed % 2 ? 4 : 0,
                                           .missing = 0.1,
                                           .moved = 0.2,
                                           .wide = true}),
                         {.precision = Precision::float64}, {-0.3, 0, 0.5, 1}, of_doubles);
}

TEST(Solid, HasNoDoubleSheets) {
    for (const core::CellKind kind : core::cell_kinds)
        for (const NastyGrid& g : {all_cases(kind), all_neighbours(kind)})
            for (const SolidRange& range : {SolidRange::above(1), SolidRange::below(1), SolidRange{0.5, 1}}) {
                SCOPED_TRACE(testing::Message() << "from " << range.lower << " to " << range.upper);
                const Solid solid = solids_of(g, {.precision = Precision::float64}).extract(range).value();
                EXPECT_EQ(back_to_back(solid.surface), 0u);
                EXPECT_EQ(folds(solid.surface), 0u);
                for (const SurfacePart& part : find_parts(solid.surface).value().parts)
                    EXPECT_GT(part.volume, 1e-9 * part.area);
            }
}

TEST(Solid, HasNoDoubleSheetsWhateverTheOrderOfCorners) {
    EXPECT_EQ(turns_of_a_hexahedron().size(), 24u);
    for (const bool single : {false, true})
        for (const Precision precision : {Precision::float32, Precision::float64})
            for (const std::uint32_t seed : Seeds(900, 6)) {
                SCOPED_TRACE(testing::Message() << (single ? "float32" : "float64") << " points, "
                                                << (precision == Precision::float32 ? "single" : "double"));
                Solids solids = solids_of(turned_hexahedra(seed, single), {.precision = precision});
                for (const SolidRange& range : {SolidRange::above(1), SolidRange::below(1), SolidRange{0.5, 1}}) {
                    const Solid solid = solids.extract(range).value();
                    EXPECT_EQ(solid.open_edges, 0u);
                    EXPECT_EQ(unbalanced_edges(solid.surface), 0u);
                    EXPECT_EQ(back_to_back(solid.surface), 0u);
                    EXPECT_EQ(folds(solid.surface), 0u);
                }
            }
}

/// A field that is 1 on a plane of points and 0 elsewhere: nothing is above 1, and all is below.
TEST(Solid, TakesAPlaneOfPointsAtTheIsovalueForNothing) {
    for (const char* shape : {"kuhn", "hex", "wedge", "mixed"})
        for (const double plane : {0.0, 0.5, 1.0}) {
            SCOPED_TRACE(testing::Message() << shape << " at x = " << plane);
            NastyGrid g{made_grid(shape, 4, {}), {}};
            std::vector<double> values(g.grid.points.tuples());
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = g.grid.points.at(i, 0) == plane;
            g.field = {"value", Array::own(std::move(values)), false, {}};
            Solids solids = solids_of(g, {});
            const Solid above = solids.extract(SolidRange::above(1)).value();
            EXPECT_EQ(above.surface.triangle_count(), 0u);
            EXPECT_EQ(above.surface.vertex_count(), 0u);
            const Solid below = solids.extract(SolidRange::below(1)).value();
            EXPECT_EQ(plane == 0.5 ? below.isosurface_triangles : 0, 0u);
            EXPECT_NEAR(below.volume, solids.grid_volume(), 1e-6);
        }
}

/// The point inside a part of a face that is not flat stays near the part, however small that is.
TEST(Solid, HasNoNeedlesAtWarpedFaces) {
    Grid grid;
    grid.points =
        Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1.4, 0, 1, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 8});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{12});
    const Array values = Array::own(std::vector<double>{0, 0, 0, 0, 0, 1, 0, 0});
    ContourInput input;
    input.grid = grid;
    input.field = {"f", values, false, {}};
    Solids solids = Solids::create(std::move(input), {.precision = Precision::float64}).value();
    for (const double size : {0.3, 0.01, 1e-4}) {
        const Solid solid = solids.extract(SolidRange::above(1 - size)).value();
        ASSERT_EQ(solid.open_edges, 0u);
        for (std::size_t i = 0; i < solid.surface.vertex_count(); ++i) {
            const Array& places = solid.surface.positions;
            EXPECT_LT(std::hypot(places.at(i, 0) - 1, places.at(i, 1), places.at(i, 2) - 1), 2 * size) << size;
        }
        EXPECT_LT(solid.volume, size * size * size);
        const Solid rest = solids.extract(SolidRange::below(1 - size)).value();
        EXPECT_NEAR(solid.volume + rest.volume, solids.grid_volume(), 1e-12);
    }
}

/// Also at points inside cut faces that are not flat.
TEST(Solid, CarriesLinearFieldsExactlyAtWarpedFaces) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"}) {
        const NastyGrid g = mixed_grid(350, {.shape = shape, .side = 4, .moved = 0.2, .wide = true});
        const auto linear = [](const Array& points, std::size_t i) {
            return points.at(i, 0) + 0.5 * points.at(i, 1) - 0.25 * points.at(i, 2) + 0.1;
        };
        std::vector<double> values(g.grid.points.tuples());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = linear(g.grid.points, i);
        const ContourInput input{g.grid, g.field, {{"linear", Array::own(std::move(values))}}, {}};
        ContourOptions options;
        options.precision = Precision::float64;
        options.edge_ends = true;
        const Solid solid = Solids::create(input, options).value().extract(SolidRange::above(0.1)).value();
        std::size_t inside_faces = 0;
        for (std::size_t i = 0; i < solid.surface.vertex_count(); ++i) {
            inside_faces += solid.surface.edge_ends.at(i, 0) == -1;
            ASSERT_NEAR(solid.surface.point_fields[0].values.at(i), linear(solid.surface.positions, i), 1e-9)
                << shape << ", edge " << solid.surface.edge_ends.at(i, 0) << " " << solid.surface.edge_ends.at(i, 1);
        }
        EXPECT_GT(inside_faces, 3u) << shape;
    }
}

TEST(Solid, OfCollapsedCellsIsClosed) {
    for (const std::uint32_t seed : Seeds(400, 8)) {
        Solids solids =
            solids_of(mixed_grid(seed, {.side = 4, .values = 3, .moved = 0.2, .collapsed = 0.1}), {.surfaces = 1});
        for (const double isovalue : {0.5, 1.0}) {
            const Solid solid = solids.extract(SolidRange::above(isovalue)).value();
            ASSERT_EQ(solid.open_edges, 0u);
            ASSERT_EQ(unbalanced_edges(solid.surface), 0u);
        }
    }
}

TEST(Solid, EnclosesTheVolumeOfTheSpectrum) {
    for (const std::uint32_t seed : Seeds(500, 4)) {
        const NastyGrid g = nasty_grid(seed, {.side = 6, .values = 0});
        Solids solids = solids_of(g, {.precision = Precision::float64});
        const std::vector<double> isovalues{-0.8, -0.2, 0.1, 0.6};
        const ContourSpectrum spectrum = contour_spectrum(g.grid, g.field, isovalues).value();
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            const Solid below = solids.extract(SolidRange::below(isovalues[i])).value();
            EXPECT_NEAR(below.volume, spectrum.volume_below[i], 1e-6 * solids.grid_volume());
        }
    }
}

/// Each cell gets points of its own.
Grid taken_apart(const Grid& grid) {
    const auto corners = grid.cells.connectivity;
    std::vector<double> points;
    std::vector<std::int64_t> connectivity(corners.size());
    std::vector<float> values;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto point = static_cast<std::size_t>(corners.at(i));
        for (std::size_t axis = 0; axis < 3; ++axis) points.push_back(grid.points.at(point, axis));
        values.push_back(static_cast<float>(grid.point_fields[0].values.at(point)));
        connectivity[i] = static_cast<std::int64_t>(i);
    }
    Grid out = grid;
    out.points = Array::own(std::move(points), 3);
    out.cells.connectivity = Array::own(std::move(connectivity));
    out.point_fields = {{grid.point_fields[0].name, Array::own(std::move(values))}};
    return out;
}

/// A ball of the field "sphere".
Solid ball_of(const Grid& grid) {
    return Solids::create({grid, point_field(grid), {}, {}}).value().extract(SolidRange::below(0.73)).value();
}

/// Of the isosurface alone.
std::size_t open_edges(const Solid& solid) {
    Surface surface = solid.surface;
    const auto triangles = surface.triangles.as<std::uint32_t>().first(3 * solid.isosurface_triangles);
    surface.triangles = Array::own(std::vector<std::uint32_t>(triangles.begin(), triangles.end()), 3);
    return unbalanced_edges(surface);
}

TEST(Solid, OfCellsThatDoNotFitCountsTheEdgesWhereItsIsosurfaceIsOpenInside) {
    const Grid grid = made_grid("octree", 4, {"sphere"});
    const Solid left = ball_of(grid), closed = ball_of(close_hanging_points(grid).value().grid);
    EXPECT_EQ(left.unfit_edges, open_edges(left));
    EXPECT_GT(left.unfit_edges, 20u);
    EXPECT_EQ(left.open_edges, 0u);
    EXPECT_EQ(closed.unfit_edges, 0u);
}

TEST(Solid, OfDoubledPointsCountsTheEdgesWhereItsIsosurfaceIsOpenInside) {
    for (const char* shape : {"kuhn", "hex"}) {
        const Grid whole = made_grid(shape, 4, {"sphere"});
        const Solid one = ball_of(whole), apart = ball_of(taken_apart(whole));
        EXPECT_EQ(one.seam_edges, 0u);
        EXPECT_EQ(apart.seam_edges, open_edges(apart) - open_edges(one));
        EXPECT_GT(apart.seam_edges, 100u);
        EXPECT_EQ(apart.open_edges, 0u);
        EXPECT_NEAR(apart.volume, one.volume, 1e-6);
    }
}

TEST(Solid, IsTheSameFromBothMethodsAndAnyThreads) {
    for (const std::uint32_t seed : Seeds(600, 3)) {
        const NastyGrid g = mixed_grid(seed, {.side = 6, .values = 5});
        std::vector<std::string> bytes;
        for (const int threads : {1, 2, 7}) {
            ContourInput input{g.grid, g.field, {}, {}};
            Solids solids = Solids::create(input, {.surfaces = 1}, {.threads = threads}).value();
            bytes.push_back(bytes_of(solids.extract({1, 3}, {.threads = threads}).value().surface));
        }
        EXPECT_TRUE(bytes[0] == bytes[1] && bytes[1] == bytes[2]);
        Solids direct = solids_of(g, {.method = Method::direct}), packed = solids_of(g, {.method = Method::clusters});
        const Solid a = direct.extract(SolidRange::above(1.5)).value(),
                    b = packed.extract(SolidRange::above(1.5)).value();
        EXPECT_EQ(a.surface.vertex_count(), b.surface.vertex_count());
        EXPECT_EQ(a.surface.triangle_count(), b.surface.triangle_count());
        EXPECT_NEAR(a.volume, b.volume, 1e-9);
    }
}

TEST(Solid, OfASphereIsItsBallOrTheRestOfTheBox) {
    MakeOptions make;
    make.shape = "hex";
    make.side = 24;
    make.fields = {"sphere"};
    const Grid grid = make_grid(make).value();
    ContourInput input{grid, find_field(grid, "sphere").value(), {}, {}};
    Solids solids = Solids::create(std::move(input)).value();
    const Solid inside = solids.extract(SolidRange::below(0.35)).value();
    const Solid outside = solids.extract(SolidRange::above(0.35)).value();
    EXPECT_EQ(inside.isosurface_triangles, inside.surface.triangle_count());
    EXPECT_GT(outside.surface.triangle_count(), outside.isosurface_triangles);
    const SurfaceReport report = check(outside.surface).value();
    EXPECT_TRUE(report.sound);
    EXPECT_EQ(report.boundary_edges, 0u);
    EXPECT_GT(report.volume, 0);
}

} // namespace
} // namespace isotet::test
