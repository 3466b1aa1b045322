// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// close_hanging_points(): cells list the points on their faces and edges, and surfaces are closed.
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/active_cells.hpp>
#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>
#include <isotet/solid.hpp>

#include "linear/quadratic_cells.hpp"
#include "linear/refined_cells.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using Place = std::array<double, 3>;
using Way = std::function<Place(Place)>;

struct Cubes {
    Place lowest;
    double edge;
    std::array<int, 3> counts;
};

enum class Corner { shared, apart };

/// Hexahedra in boxes of cubes; points of the same place are one, or each cell has its own.
Grid boxes(const std::vector<Cubes>& all, const Way& moved = [](Place p) { return p; }, Corner kind = Corner::shared) {
    constexpr int corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    std::map<std::array<long, 3>, std::int64_t> known;
    std::vector<double> points;
    std::vector<std::int64_t> connectivity;
    for (const auto& [lowest, edge, n] : all)
        for (int i = 0; i < n[0] * n[1] * n[2]; ++i)
            for (const auto& corner : corners) {
                const std::array<int, 3> cell{i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
                Place place;
                std::array<long, 3> key;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    place[axis] = lowest[axis] + edge * (cell[axis] + corner[axis]);
                    key[axis] = std::lround(place[axis] * 1e6);
                }
                const auto next = static_cast<std::int64_t>(points.size() / 3);
                const auto [at, is_new] = known.emplace(key, next);
                connectivity.push_back(is_new || kind == Corner::apart ? next : at->second);
                if (is_new || kind == Corner::apart)
                    for (const double x : moved(place)) points.push_back(x);
            }
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.uniform_type = CellType::hexahedron;
    grid.cells.connectivity = Array::own(std::move(connectivity));
    return grid;
}

/// A cube of edge 2 beside one of `count`^3 cubes.
std::vector<Cubes> coarse_beside(int count) {
    return {{{0, 0, 0}, 2, {1, 1, 1}}, {{2, 0, 0}, 2.0 / count, {count, count, count}}};
}

Place bent(Place p) {
    const double angle = 0.2 * p[1], radius = 5 + p[0];
    return {radius * std::cos(angle), radius * std::sin(angle), p[2]};
}

Place place_of(const Array& places, std::size_t i) { return {places.at(i, 0), places.at(i, 1), places.at(i, 2)}; }

PointField field_at(const Grid& grid, const std::function<double(Place)>& at) {
    std::vector<double> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) values.push_back(at(place_of(grid.points, i)));
    return {"value", Array::own(std::move(values)), false, {}};
}

double slanted(Place p) { return 0.31 * p[0] + 0.52 * p[1] + 0.79 * p[2]; }

enum class Around { not_needed, nothing_hangs, may_hang };

/// What CellsAround tells of the cells that an isovalue cuts.
Around around_cut_cells(const Grid& grid, const PointField& field, double isovalue) {
    const std::array isovalues{isovalue};
    const CellType type = grid.cells.uniform_type;
    auto filter = ActiveCellFilter::create(grid.points, field, isovalues, type).value();
    filter.add(0, grid.cells.connectivity);
    Grid cut = grid;
    cut.cells = filter.finish().value();
    auto around = CellsAround::of(cut, field, isovalues).value();
    const std::vector<std::uint8_t> types(grid.cells.count(), static_cast<std::uint8_t>(type));
    if (around.are_needed()) around.add(types, grid.cells.connectivity);
    if (around.may_have_hanging_points().value()) return Around::may_hang;
    return around.are_needed() ? Around::nothing_hangs : Around::not_needed;
}

bool has_cut_hanging_points(const Grid& grid, double isovalue) {
    return around_cut_cells(grid, field_at(grid, slanted), isovalue) == Around::may_hang;
}

ClosedGrid closed(const Grid& grid) { return close_hanging_points(grid).value(); }

Surface surface_of(const Grid& grid, const PointField& field, double isovalue, Method method = Method::direct,
                   bool split_cells = false) {
    ContourOptions options{.method = method, .precision = Precision::float64, .split_cells = split_cells};
    options.edge_ends = true;
    return Contour::create({grid, field, {}, {}}, options).value().extract(isovalue).value().surfaces[0].surface;
}

SurfaceReport boundary_report(const Grid& grid) { return check(boundary_of(grid).value()).value(); }

/// The boundary is closed, and the surface is open only there.
void expect_closed(const Grid& grid, const PointField& field, double isovalue) {
    EXPECT_TRUE(boundary_report(grid).closed);
    for (const bool split_cells : {false, true}) {
        const Surface surface = surface_of(grid, field, isovalue, Method::direct, split_cells);
        ASSERT_GT(surface.triangle_count(), 0u);
        const SurfaceReport report =
            check(surface, {.grid = &grid, .field = &field, .split_cells = split_cells}).value();
        EXPECT_EQ(report.blamed_edges, 0u);
        EXPECT_EQ(report.hanging_edges, 0u);
    }
}

TEST(CloseHangingPoints, LeavesNothingOpenInOctrees) {
    for (const char* shape : {"octree", "octree-random", "octree-bent", "octree-tets"})
        for (const std::uint64_t seed : {1u, 2u}) {
            SCOPED_TRACE(shape + std::string(" seed ") + std::to_string(seed));
            const Grid grid = made_grid(shape, 3, {"sphere", "gyroid", "integer"}, seed);
            const ClosedGrid found = closed(grid);
            if (shape != std::string("octree-bent")) {
                EXPECT_EQ(found.report.points, count_hanging_points(grid).value());
            }
            EXPECT_EQ(found.report.open_faces, 0u);
            EXPECT_EQ(found.report.near_faces, 0u);
            EXPECT_EQ(count_hanging_points(found.grid).value(), 0u);
            const SurfaceReport boundary = boundary_report(found.grid);
            EXPECT_TRUE(boundary.closed);
            EXPECT_NEAR(boundary.volume, 8, 1e-6);
            EXPECT_NEAR(boundary.area, 24, 1e-5) << "no face inside is left";
            for (std::size_t i = 0; i < 3; ++i)
                expect_closed(found.grid, point_field(grid, i), std::array{0.55, 0.3, 2.0}[i]);
            const Surface sphere = surface_of(found.grid, point_field(grid, 0), 0.55, Method::clusters);
            EXPECT_TRUE(check(sphere).value().closed);
        }
}

TEST(CloseHangingPoints, OpenSurfacesAreWhatTheyRepair) {
    const Grid grid = made_grid("octree-random", 4, {"sphere"});
    const Surface open = surface_of(grid, point_field(grid), 0.55);
    EXPECT_FALSE(check(open).value().closed);
}

TEST(CloseHangingPoints, SolidsAreClosedAndFillTheGrid) {
    for (const char* shape : {"octree-bent", "octree-tets"}) {
        const Grid grid = made_grid(shape, 3, {"gyroid"});
        auto solids = Solids::create({closed(grid).grid, point_field(grid), {}, {}}, {}).value();
        double volume = 0;
        for (const SolidRange side : {SolidRange{-INFINITY, 0.3}, SolidRange{0.3, INFINITY}}) {
            const SurfaceReport report = check(solids.extract(side).value().surface).value();
            EXPECT_TRUE(report.closed) << shape;
            volume += report.volume;
        }
        EXPECT_NEAR(volume, 8, 1e-5) << shape;
    }
}

/// The part of a plane that is in the cube, whichever cells are cut.
TEST(CloseHangingPoints, RefiningAnyCellsLeavesThePlaneOfALinearField) {
    for (const char* shape : {"hex", "perturbed", "wedge", "pyramid", "mixed"})
        for (unsigned seed = 1; seed <= 2; ++seed) {
            SCOPED_TRACE(shape + std::string(" seed ") + std::to_string(seed));
            RefinedCells cells(made_grid(shape, shape == std::string("mixed") ? 3 : 2, {}, seed));
            const Grid whole = cells.grid();
            std::mt19937 random(seed);
            for (const double probability : {0.3, 0.2}) cells.refine(probability, random);
            const ClosedGrid found = closed(cells.grid());
            EXPECT_GT(found.report.points, 0u);
            EXPECT_EQ(found.report.open_faces, 0u);
            EXPECT_EQ(found.report.near_faces, 0u);
            EXPECT_TRUE(boundary_report(found.grid).closed);
            const PointField field = field_at(found.grid, slanted);
            EXPECT_LT(found.largest_difference(field.values).value(), 1e-12);
            const Surface surface = surface_of(found.grid, field, 0.123);
            for (std::size_t v = 0; v < surface.vertex_count(); ++v)
                ASSERT_NEAR(slanted(place_of(surface.positions, v)), 0.123, 1e-12);
            const Grid closed_whole = closed(whole).grid;
            const Surface before = surface_of(closed_whole, field_at(closed_whole, slanted), 0.123);
            EXPECT_NEAR(check(surface).value().area, check(before).value().area, 1e-10);
            expect_closed(found.grid, field, 0.123);
        }
}

TEST(CloseHangingPoints, LeavesCellsAwayFromLevelsAsTheyAre) {
    const Grid grid = made_grid("octree", 4, {"gyroid"});
    const ClosedGrid found = closed(grid);
    const auto types = found.grid.cells.types.as<std::uint8_t>();
    EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count(types, 42)), found.report.cells);
    EXPECT_LT(found.report.cells, grid.cells.count() / 2);
    std::set<Place> after;
    const Surface surface = surface_of(found.grid, point_field(grid), 0.3);
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) after.insert(place_of(surface.positions, v));
    const Surface before = surface_of(grid, point_field(grid), 0.3);
    std::set<Place> points;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) points.insert(place_of(grid.points, i));
    for (std::size_t v = 0; v < before.vertex_count(); ++v) {
        if (after.contains(place_of(before.positions, v))) continue;
        Place middle{};
        for (std::size_t end = 0; end < 2; ++end)
            for (std::size_t axis = 0; axis < 3; ++axis)
                middle[axis] += place_of(grid.points, static_cast<std::size_t>(before.edge_ends.at(v, end)))[axis] / 2;
        EXPECT_TRUE(points.contains(middle)) << "only those on edges that have points between are gone";
    }
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
        if (types[cell] == 42) continue;
        const auto first = static_cast<std::size_t>(found.grid.cells.offsets.at(cell));
        for (std::size_t i = 0; i < 8; ++i)
            ASSERT_EQ(found.grid.cells.connectivity.at(first + i), grid.cells.connectivity.at(8 * cell + i));
    }
}

TEST(CloseHangingPoints, SharesTheArraysOfGridsWithoutHangingPoints) {
    for (const char* shape : {"kuhn", "hex", "mixed", "kelvin", "tet10"}) {
        const Grid grid = made_grid(shape, 3, {});
        const ClosedGrid found = closed(grid);
        EXPECT_EQ(found.grid.cells.connectivity.data(), grid.cells.connectivity.data()) << shape;
        EXPECT_EQ(found.report.points + found.report.open_faces, 0u) << shape;
        EXPECT_TRUE(found.report.notes().empty());
        if (grid.cells.types.empty() && shape != std::string("tet10")) {
            EXPECT_FALSE(has_cut_hanging_points(grid, 0.1)) << shape;
        }
    }
}

TEST(CloseHangingPoints, TakesAnyRatioAndSeveralLevelsAtOneFace) {
    for (int count = 2; count <= 9; ++count) {
        const Grid grid = boxes(coarse_beside(count));
        const ClosedGrid found = closed(grid);
        const auto side = static_cast<std::uint64_t>(count + 1);
        EXPECT_EQ(found.report.points, side * side - 4);
        EXPECT_EQ(found.report.faces, 1u);
        EXPECT_EQ(found.report.levels, static_cast<std::uint64_t>(std::ceil(std::log2(count))));
        EXPECT_TRUE(has_cut_hanging_points(grid, 1.1));
        EXPECT_FALSE(has_cut_hanging_points(grid, -9.0)) << "no cell is cut";
        expect_closed(found.grid, field_at(grid, slanted), 1.1);
    }
    const Grid levels = boxes({{{0, 0, 0}, 4, {1, 1, 1}},
                               {{4, 0, 0}, 2, {1, 2, 1}},
                               {{4, 0, 2}, 2, {1, 1, 1}},
                               {{4, 2, 2}, 1, {2, 1, 2}},
                               {{4, 3, 2}, 0.5, {4, 2, 4}}});
    const ClosedGrid found = closed(levels);
    EXPECT_EQ(found.report.open_faces, 0u);
    EXPECT_EQ(found.report.levels, 3u);
    expect_closed(found.grid, field_at(levels, slanted), 2.3);
}

Place turned(Place p) {
    const double a = 0.7, b = 0.4;
    const Place q{std::cos(a) * p[0] - std::sin(a) * p[1], std::sin(a) * p[0] + std::cos(a) * p[1], p[2]};
    return {q[0], std::cos(b) * q[1] - std::sin(b) * q[2], std::sin(b) * q[1] + std::cos(b) * q[2]};
}

TEST(CellsAround, FindLargerCellsThatTheIsovalueDoesNotCut) {
    for (const Way& way : {Way([](Place p) { return p; }), Way(turned), Way(bent)})
        for (int count = 2; count <= 9; ++count) {
            SCOPED_TRACE(count);
            const Grid grid = boxes(coarse_beside(count), way), places = boxes(coarse_beside(count));
            for (const bool edges : {false, true}) {
                std::vector<double> values; // only hanging points inside of the face, or on its edges, are above
                for (std::size_t i = 0; i < places.points.tuples(); ++i) {
                    const Place p = place_of(places.points, i);
                    const bool y = p[1] > 1e-9 && p[1] < 2 - 1e-9, z = p[2] > 1e-9 && p[2] < 2 - 1e-9;
                    values.push_back(std::abs(p[0] - 2) < 1e-9 && (edges ? y != z : y && z) ? 1 : 0);
                }
                const PointField field{"value", Array::own(std::move(values)), false, {}};
                EXPECT_EQ(around_cut_cells(grid, field, 0.5), Around::may_hang);
                std::vector<double> below(field.values.as<double>().begin(), field.values.as<double>().end());
                for (double& value : below) value = -value;
                EXPECT_EQ(around_cut_cells(grid, {"value", Array::own(std::move(below)), false, {}}, -0.5),
                          Around::may_hang);
            }
        }
}

TEST(CellsAround, AreNotNeededWhereNothingIsBeyondTheFacesOfCutCells) {
    for (const Way& way : {Way([](Place p) { return p; }), Way(turned)})
        for (const double isovalue : {0.3, 1.1, 2.0})
            EXPECT_EQ(around_cut_cells(boxes({{{0, 0, 0}, 0.25, {8, 8, 8}}}, way),
                                       field_at(boxes({{{0, 0, 0}, 0.25, {8, 8, 8}}}), slanted), isovalue),
                      Around::not_needed);
    const Grid one = boxes({{{0, 0, 0}, 1, {4, 4, 4}}});
    EXPECT_EQ(around_cut_cells(one, field_at(one, [](Place p) { return p[0]; }), 2), Around::not_needed)
        << "a plane of points";
}

TEST(CellsAround, FindNothingInHollowGridsWithoutLevels) {
    const auto expect_nothing = [](const Grid& grid, double isovalue) {
        EXPECT_EQ(around_cut_cells(grid, field_at(grid, slanted), isovalue), Around::nothing_hangs);
    };
    expect_nothing(boxes({{{0, 0, 0}, 1, {4, 2, 4}}, {{0, 2, 0}, 1, {2, 2, 4}}}), 2.6);
    expect_nothing(boxes({{{0, 0, 0}, 1, {6, 6, 2}}, {{0, 0, 2}, 1, {2, 6, 2}}, {{4, 0, 2}, 1, {2, 6, 2}}}, turned),
                   2.6);
    const auto layers = [](Place p) { // flat cells that are larger the farther they are from the wall
        const double angle = 0.2 * p[1], radius = 5 + 0.01 * p[0] * p[0];
        return Place{radius * std::cos(angle), radius * std::sin(angle), p[2]};
    };
    expect_nothing(boxes({{{0, 0, 0}, 1, {12, 8, 8}}}, layers), 4);
}

/// As close_hanging_points() tells of all cells, from those at the boundary, too.
void expect_found_at_boundary(const Grid& grid) {
    const HangingReport report = closed(grid).report;
    const bool hang = report.points > 0 || report.open_faces > 0;
    const Surface boundary = boundary_of(grid).value();
    EXPECT_EQ(has_hanging_points(grid, boundary).value(), hang);
    std::vector<std::uint8_t> at_boundary(grid.points.tuples());
    for (const std::int64_t point : boundary.edge_ends.as<std::int64_t>())
        at_boundary[static_cast<std::size_t>(point)] = 1;
    const std::size_t corners = grid.cells.connectivity.tuples() / grid.cells.count();
    Grid around = grid;
    std::vector<std::int64_t> kept;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        std::vector<std::int64_t> own;
        for (std::size_t k = 0; k < corners; ++k)
            own.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(corners * cell + k)));
        if (std::ranges::any_of(own,
                                [&](std::int64_t point) { return at_boundary[static_cast<std::size_t>(point)] != 0; }))
            kept.insert(kept.end(), own.begin(), own.end());
    }
    EXPECT_LE(kept.size(), grid.cells.connectivity.tuples());
    around.cells.connectivity = Array::own(std::move(kept));
    EXPECT_EQ(has_hanging_points(around, boundary).value(), hang);
}

TEST(HasHangingPoints, TellsByCellsAtTheBoundaryWhatAllCellsTell) {
    for (const Way& way : {Way([](Place p) { return p; }), Way(turned), Way(bent)}) {
        for (int count = 2; count <= 5; ++count) expect_found_at_boundary(boxes(coarse_beside(count), way));
        expect_found_at_boundary(boxes({{{0, 0, 0}, 0.25, {8, 8, 8}}}, way));
        expect_found_at_boundary(boxes({{{0, 0, 0}, 1, {4, 2, 4}}, {{0, 2, 0}, 1, {2, 2, 4}}}, way));
        expect_found_at_boundary(boxes({{{0, 0, 0}, 1, {4, 2, 4}}, {{0, 2, 0}, 0.5, {8, 3, 7}}}, way));
        expect_found_at_boundary(boxes({{{0, 0, 0}, 3, {1, 2, 2}}, {{3, 0, 0}, 2, {1, 3, 3}}}, way)); // stays open
    }
    for (const char* shape : {"kuhn", "shuffled", "perturbed"}) {
        SCOPED_TRACE(shape);
        Grid grid = make_grid({.shape = shape, .side = 6}).value();
        grid.cells.types = grid.cells.offsets = Array();
        grid.cells.uniform_type = CellType::tetrahedron;
        expect_found_at_boundary(grid);
    }
}

TEST(HasHangingPoints, RefusesTheBoundaryOfAnotherGrid) {
    const Grid grid = boxes(coarse_beside(2));
    const Surface other = boundary_of(boxes({{{0, 0, 0}, 0.25, {8, 8, 8}}})).value();
    EXPECT_EQ(has_hanging_points(grid, other).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(has_hanging_points(grid, {}).error().code, ErrorCode::invalid_argument);
}

TEST(CloseHangingPoints, GivesAnEdgeThePointsOfAllFacesAroundIt) {
    const Grid grid = boxes({{{0, 0, 0}, 6, {1, 1, 1}},
                             {{6, 0, 0}, 3, {2, 2, 2}},
                             {{0, 6, 0}, 2, {3, 3, 3}}}); // halves and thirds at the edge of both
    const ClosedGrid found = closed(grid);
    EXPECT_EQ(found.report.faces, 2u);
    EXPECT_EQ(found.report.cells, 4u) << "the cube, and those beside that have the other's points on an edge";
    expect_closed(found.grid, field_at(grid, slanted), 4.4);
}

TEST(CloseHangingPoints, FollowsSmallerCellsAtCurvedShapes) {
    const Grid grid = boxes(coarse_beside(4), bent);
    const ClosedGrid found = closed(grid);
    EXPECT_EQ(found.report.near_faces, 1u);
    EXPECT_NEAR(found.report.largest_distance, 7 * (1 - std::cos(0.2)), 1e-3) << "a chord's height";
    EXPECT_EQ(found.report.notes().size(), 2u);
    expect_closed(found.grid, field_at(grid, slanted), 3);
}

TEST(CloseHangingPoints, TellsWhatStaysOpen) {
    const Grid grid = boxes({{{0, 0, 0}, 3, {1, 2, 2}}, {{3, 0, 0}, 2, {1, 3, 3}}});
    const ClosedGrid found = closed(grid);
    EXPECT_EQ(found.report.points, 0u);
    EXPECT_GT(found.report.open_faces, 0u);
    EXPECT_EQ(found.grid.cells.connectivity.data(), grid.cells.connectivity.data());
    ASSERT_EQ(found.report.notes().size(), 1u);
    EXPECT_NE(found.report.notes()[0].find("do not cover them"), std::string::npos);
}

TEST(CloseHangingPoints, LeavesHolesAsTheyAre) {
    Grid grid; // a cube, and of the one beside it five of six pyramids: the one at the first cube is missing
    for (const double apex : {1.7, 1.5, 1.25, 1.1}) {
        grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0,    1,  1, 1,
                                                     1, 0, 1, 1, 2, 0, 0, 2, 1, 0, 2, 0, 1, 2, 1, 1, apex, .5, .5},
                                 3);
        grid.cells.connectivity =
            Array::own(std::vector<std::int64_t>{0,  1, 2, 3,  4, 5,  6, 7,  1,  8, 9,  2, 12, 5, 6, 11, 10,
                                                 12, 1, 5, 10, 8, 12, 8, 10, 11, 9, 12, 9, 11, 6, 2, 12});
        grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 8, 13, 18, 23, 28, 33});
        grid.cells.types = Array::own(std::vector<std::uint8_t>{12, 14, 14, 14, 14, 14});
        const ClosedGrid closed = close_hanging_points(grid).value();
        EXPECT_EQ(closed.report.points, 0u);
        EXPECT_EQ(closed.report.open_faces, 0u);
    }
}

TEST(CloseHangingPoints, NeedsPointsThatAreOne) {
    const Grid apart = boxes(coarse_beside(2), [](Place p) { return p; }, Corner::apart);
    EXPECT_EQ(closed(apart).report.points, 0u);
    EXPECT_EQ(closed(merge_points(apart).value().grid).report.points, 5u);
}

TEST(CloseHangingPoints, InterpolatesFromLargerCells) {
    const Grid grid = made_grid("octree-bent", 3, {"sphere", "integer"});
    const ClosedGrid found = closed(grid);
    const Array sphere = point_field(grid).values;
    EXPECT_GT(found.largest_difference(sphere).value(), 0.001);
    const Array taken = found.interpolated(sphere).value();
    EXPECT_EQ(taken.type(), ScalarType::float32);
    EXPECT_EQ(found.largest_difference(taken).value(), 0);
    std::uint64_t changed = 0;
    for (std::size_t i = 0; i < taken.tuples(); ++i) changed += taken.at(i) != sphere.at(i);
    EXPECT_LE(changed, found.report.points);
    EXPECT_GT(changed, found.report.points / 2);
    EXPECT_EQ(found.interpolated(point_field(grid, 1).values).value().type(), ScalarType::float64);
    const Array places = found.interpolated(grid.points).value();
    for (std::size_t i = 0; i < places.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(places.at(i, axis), grid.points.at(i, axis), 1e-6) << "coordinates are fields, too";
    EXPECT_EQ(found.interpolated(Array::own(std::vector<float>(3))).error().code, ErrorCode::invalid_argument);
}

TEST(CloseHangingPoints, ConvergesToTheSphereAtSecondOrder) {
    for (const bool quadratic : {false, true}) {
        SCOPED_TRACE(quadratic);
        std::vector<double> errors;
        for (const std::uint64_t side : {3u, 6u, 12u}) {
            const Grid linear = made_grid("octree-random", quadratic ? side / 2 + 1 : side, {});
            const ClosedGrid found = closed(quadratic ? quadratic_cells(linear) : linear);
            const PointField field = field_at(found.grid, [](Place p) { return std::hypot(p[0], p[1], p[2]); });
            const Surface surface = surface_of(found.grid, field, 0.7);
            double largest = 0;
            for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
                const double radius =
                    std::hypot(surface.positions.at(v, 0), surface.positions.at(v, 1), surface.positions.at(v, 2));
                largest = std::max(largest, std::abs(radius - 0.7));
            }
            errors.push_back(largest);
        }
        const double rate = quadratic ? 2.2 : 2.8; // 2, 4 and 7 cells along an edge; 3, 6 and 12
        EXPECT_GT(errors[0] / errors[1], rate);
        EXPECT_GT(errors[1] / errors[2], rate);
    }
}

double squared(Place p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }
double bumpy(Place p) { return std::sin(5 * p[0]) + std::cos(4 * p[1] + p[0]) * std::sin(3 * p[2]); }

/// Quadratic cells of all kinds, cut at random or by octrees.
std::vector<std::pair<std::string, Grid>> quadratic_levels(NodesOn on) {
    std::vector<std::pair<std::string, Grid>> out;
    for (const char* shape : {"octree-random", "octree-tets"})
        out.emplace_back(shape, quadratic_cells(made_grid(shape, 2, {}), on));
    for (const char* shape : some_of({"hex", "wedge", "pyramid", "mixed"})) {
        RefinedCells cells(made_grid(shape, shape == std::string("mixed") ? 3 : 2, {}));
        std::mt19937 random(1);
        for (const double probability : {0.3, 0.2}) cells.refine(probability, random);
        out.emplace_back(shape, quadratic_cells(cells.grid(), on));
    }
    return out;
}

TEST(CloseHangingPoints, ClosesQuadraticCells) {
    for (const NodesOn on : {NodesOn::edges, NodesOn::faces})
        for (const auto& [shape, grid] : quadratic_levels(on)) {
            SCOPED_TRACE(shape + (on == NodesOn::faces ? ", nodes on faces" : ""));
            const ClosedGrid found = closed(grid);
            EXPECT_GT(found.report.curved_cells, 0u);
            EXPECT_EQ(found.report.curved_cells, found.report.cells);
            EXPECT_EQ(found.report.open_faces, 0u);
            EXPECT_EQ(found.points.tuples(), 0u) << "values are their own";
            EXPECT_EQ(closed(found.grid).report.points, 0u) << "nothing is left";
            const SurfaceReport boundary = boundary_report(found.grid);
            EXPECT_TRUE(boundary.closed);
            EXPECT_NEAR(boundary.volume, 8, 1e-6);
            EXPECT_NEAR(boundary.area, 24, 1e-5);
            for (const auto& [name, at, isovalue] : {std::tuple("sphere", &squared, 0.37), {"bumpy", &bumpy, 0.31}}) {
                const PointField field = field_at(found.grid, at);
                for (const double tolerance : {0.0, 0.02}) {
                    ContourOptions options{.precision = Precision::float64};
                    if (tolerance > 0) options.refine.emplace().tolerance = tolerance;
                    const Surface surface = Contour::create({found.grid, field, {}, {}}, options)
                                                .value()
                                                .extract(isovalue)
                                                .value()
                                                .surfaces[0]
                                                .surface;
                    ASSERT_GT(surface.triangle_count(), 0u);
                    if (name == std::string("sphere")) {
                        EXPECT_TRUE(check(surface).value().closed) << tolerance;
                    }
                }
                auto solids = Solids::create({found.grid, field, {}, {}}, {}).value();
                double volume = 0;
                for (const SolidRange side : {SolidRange{-INFINITY, isovalue}, SolidRange{isovalue, INFINITY}}) {
                    const SurfaceReport report = check(solids.extract(side).value().surface).value();
                    EXPECT_TRUE(report.closed) << name;
                    volume += report.volume;
                }
                EXPECT_NEAR(volume, 8, 1e-5) << name;
            }
        }
}

TEST(CloseHangingPoints, KeepsThePlaneOfALinearFieldInQuadraticCells) {
    for (const auto& [shape, grid] : quadratic_levels(NodesOn::edges)) {
        const Grid all = closed(grid).grid;
        const Surface surface = surface_of(all, field_at(all, slanted), 0.123);
        for (std::size_t v = 0; v < surface.vertex_count(); ++v)
            ASSERT_NEAR(slanted(place_of(surface.positions, v)), 0.123, 1e-12) << shape;
        EXPECT_NEAR(check(surface).value().area,
                    check(surface_of(made_grid("kuhn", 2, {}), field_at(made_grid("kuhn", 2, {}), slanted), 0.123))
                        .value()
                        .area,
                    1e-9)
            << shape;
    }
}

TEST(CloseHangingPoints, GivesTheSameBytesForAnyThreadCount) {
    const Grid grid = made_grid("octree-random", 5, {});
    const ClosedGrid one = close_hanging_points(grid, {.threads = 1}).value();
    for (const int threads : {2, 7}) {
        const ClosedGrid other = close_hanging_points(grid, {.threads = threads}).value();
        for (const auto member : {&Cells::connectivity, &Cells::offsets, &Cells::faces, &Cells::face_offsets}) {
            const Array &a = one.grid.cells.*member, &b = other.grid.cells.*member;
            ASSERT_EQ(a.bytes(), b.bytes());
            EXPECT_EQ(std::memcmp(a.data(), b.data(), a.bytes()), 0);
        }
        EXPECT_EQ(std::memcmp(one.parents.weights.data(), other.parents.weights.data(), one.parents.weights.bytes()),
                  0);
    }
}

TEST(CloseHangingPoints, EndsWhenItIsCancelledAndChecksTheGrid) {
    const std::atomic<bool> cancel{true};
    isotet::Run run;
    run.progress.cancel = &cancel;
    const Grid grid = made_grid("octree", 3, {});
    EXPECT_EQ(close_hanging_points(grid, run).error().code, ErrorCode::cancelled);
    Grid broken = grid;
    broken.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 1'000'000});
    EXPECT_EQ(close_hanging_points(broken).error().code, ErrorCode::invalid_data);
    const std::array isovalues{1.1};
    PointField field = field_at(grid, slanted);
    EXPECT_EQ(CellsAround::of(broken, field, isovalues).error().code, ErrorCode::invalid_data);
    EXPECT_EQ(CellsAround::of(grid, field, isovalues, run).error().code, ErrorCode::cancelled);
    CellsAround around = CellsAround::of(grid, field, isovalues).value();
    around.add(std::vector<std::uint8_t>(grid.cells.count(), 12), grid.cells.connectivity);
    EXPECT_EQ(around.may_have_hanging_points(run).error().code, ErrorCode::cancelled);
    EXPECT_TRUE(around.may_have_hanging_points());
    field.values = Array::own(std::vector<double>(3));
    EXPECT_EQ(CellsAround::of(grid, field, isovalues).error().code, ErrorCode::invalid_argument);
}

TEST(KnownClosing, GivesWhatTheLastGridGaveWhereCellsAndPointsAreTheSame) {
    const auto levels = [] {
        Grid grid = make_grid({.shape = "octree-random", .side = 3, .fields = {"sphere"}}).value();
        grid.cell_fields.clear();
        return grid;
    };
    Grid moved = levels();
    std::vector<float> places(moved.points.as<float>().begin(), moved.points.as<float>().end());
    for (float& place : places) place *= 2;
    moved.points = Array::own(std::move(places), 3);
    const Grid without = make_grid({.shape = "hex", .side = 3, .fields = {"sphere"}}).value();
    KnownClosing known;
    const void* memory = nullptr;
    for (const auto& [grid, is_known] : {std::pair{levels(), false},
                                         {levels(), true},
                                         {moved, false},
                                         {without, false},
                                         {without, true},
                                         {levels(), false}}) {
        const ClosedGrid closed = known.of(grid).value(), expected = close_hanging_points(grid).value();
        EXPECT_EQ(closed.report.points, expected.report.points);
        EXPECT_EQ(closed.report.cells, expected.report.cells);
        EXPECT_EQ(closed.points.tuples(), expected.points.tuples());
        EXPECT_EQ(closed.grid.points.data(), grid.points.data());
        ASSERT_EQ(closed.grid.point_fields.size(), 1U);
        EXPECT_EQ(closed.grid.point_fields[0].values.data(), grid.point_fields[0].values.data());
        for (const auto& [a, b] : {std::pair{&closed.grid.cells.connectivity, &expected.grid.cells.connectivity},
                                   {&closed.grid.cells.faces, &expected.grid.cells.faces}}) {
            ASSERT_EQ(a->bytes(), b->bytes());
            if (a->bytes() > 0) {
                EXPECT_EQ(std::memcmp(a->data(), b->data(), a->bytes()), 0);
            }
        }
        if (is_known && expected.report.cells > 0) {
            EXPECT_EQ(closed.grid.cells.connectivity.data(), memory);
        }
        memory = closed.grid.cells.connectivity.data();
    }
}

} // namespace
} // namespace isotet::test
