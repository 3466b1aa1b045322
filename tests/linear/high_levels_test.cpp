// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hanging points in grids with Lagrange cells of degree 3 and above, and with Bezier cells.
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/solid.hpp>

#include "grid/cell/node_order.hpp"
#include "linear/curved_grid.hpp"
#include "linear/refined_cells.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test::high_levels {
namespace {

/// The degree of a cell; 1: a linear cell.
using DegreeOf = std::function<unsigned(std::size_t)>;

enum class Nodes : std::uint8_t { lagrange, bezier };

/// The weights of a linear cell's corners.
std::vector<double> corner_weights(core::CellKind kind, double u, double v, double w) {
    if (kind == core::CellKind::tetrahedron) return {1 - u - v - w, u, v, w};
    if (kind == core::CellKind::wedge)
        return {(1 - u - v) * (1 - w), u * (1 - w), v * (1 - w), (1 - u - v) * w, u * w, v * w};
    if (kind == core::CellKind::pyramid) {
        const double a = w < 1 ? u / (1 - w) : 0, b = w < 1 ? v / (1 - w) : 0;
        return {(1 - a) * (1 - b) * (1 - w), a * (1 - b) * (1 - w), a * b * (1 - w), (1 - a) * b * (1 - w), w};
    }
    return {(1 - u) * (1 - v) * (1 - w), u * (1 - v) * (1 - w), u * v * (1 - w), (1 - u) * v * (1 - w),
            (1 - u) * (1 - v) * w,       u * (1 - v) * w,       u * v * w,       (1 - u) * v * w};
}

/// The same cells with nodes on lattices. Nodes at one place are one, as after merging points.
Grid cells_of_degree(const Grid& grid, const DegreeOf& degree_of, const std::function<At(At)>& warp = {},
                     Nodes nodes = Nodes::lagrange) {
    std::map<std::array<std::int64_t, 3>, std::int64_t> known;
    std::vector<double> points;
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    const core::CellReader reader = core::CellReader::open(grid).value();
    for (std::size_t cell = 0; cell < reader.count(); ++cell) {
        const core::WholeCell whole = reader.whole(cell);
        const unsigned degree = degree_of(cell);
        for (const auto& [u, v, w] : core::nodes_of_degree(whole.kind, degree, core::NodeOrder::vtk)) {
            const auto weights = corner_weights(whole.kind, u / double(degree), v / double(degree), w / double(degree));
            At place{};
            std::array<std::int64_t, 3> key{};
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t i = 0; i < weights.size(); ++i)
                    place[k] += weights[i] * grid.points.at(static_cast<std::size_t>(whole.corners[i]), k);
                key[k] = std::llround(place[k] * 1e7);
            }
            const auto [found, is_new] = known.try_emplace(key, static_cast<std::int64_t>(points.size() / 3));
            if (is_new)
                for (const double x : warp ? warp(place) : place) points.push_back(x);
            connectivity.push_back(found->second);
        }
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        constexpr std::array<std::uint8_t, 4> linear{10, 14, 13, 12}, lagrange{71, 74, 73, 72}, bezier{78, 0, 80, 79};
        types.push_back((degree == 1              ? linear
                         : nodes == Nodes::bezier ? bezier
                                                  : lagrange)[static_cast<std::size_t>(whole.kind)]);
    }
    Grid out;
    out.points = Array::own(std::move(points), 3);
    out.cells.connectivity = Array::own(std::move(connectivity));
    out.cells.offsets = Array::own(std::move(offsets));
    out.cells.types = Array::own(std::move(types));
    return out;
}

DegreeOf all_of(unsigned degree) {
    return [degree](std::size_t) { return degree; };
}

/// Cells cut at random, some of the parts again.
Grid levels(const std::string& shape, unsigned seed = 1) {
    RefinedCells cells(make_grid({shape, shape == "mixed" ? 3u : 2u, {}, seed}).value());
    std::mt19937 random(seed);
    for (const double probability : {0.3, 0.2}) cells.refine(probability, random);
    return cells.grid();
}

/// A hexahedron beside some, at the face where x is 1.
Grid coarse_beside(int across, int up) {
    std::vector<double> points;
    std::vector<std::int64_t> connectivity{0, 1, 2, 3, 4, 5, 6, 7};
    const auto add = [&](double x, double y, double z) {
        points.insert(points.end(), {x, y, z});
        return static_cast<std::int64_t>(points.size() / 3 - 1);
    };
    for (const double z : {0.0, 1.0})
        for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) add(x, y, z);
    for (int i = 0; i < across * up; ++i) {
        const double y = i % across, z = i / across; // NOLINT(bugprone-integer-division)
        for (const double top : {0.0, 1.0})
            for (const auto& [x, right] : {std::pair{1.0, 0.0}, {1.5, 0.0}, {1.5, 1.0}, {1.0, 1.0}})
                connectivity.push_back(add(x, (y + right) / across, (z + top) / up));
    }
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.uniform_type = CellType::hexahedron;
    grid.cells.connectivity = Array::own(std::move(connectivity));
    return grid;
}

double slanted(At p) { return 0.31 * p[0] + 0.52 * p[1] + 0.79 * p[2]; }
double squared(At p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

double bumpy(At p) { return squared(p) + 0.1 * std::sin(7 * p[0] + 5 * p[1]); }

At place_of(const Array& places, std::size_t i) { return {places.at(i, 0), places.at(i, 1), places.at(i, 2)}; }

PointField field_at(const Grid& grid, const std::function<double(At)>& at) {
    std::vector<double> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) values.push_back(at(place_of(grid.points, i)));
    return {"value", Array::own(std::move(values)), false, {}};
}

Surface surface_of(const Grid& grid, const PointField& field, double isovalue, double tolerance = 0) {
    ContourOptions options{.precision = Precision::float64};
    if (tolerance > 0) options.refine.emplace().tolerance = tolerance;
    return Contour::create({grid, field, {}, {}}, options).value().extract(isovalue).value().surfaces[0].surface;
}

/// The boundary, a surface inside it and both solids are closed.
void expect_closed(const ClosedGrid& found, const std::function<double(At)>& inside, double isovalue) {
    const SurfaceReport boundary = check(boundary_of(found.grid).value()).value();
    EXPECT_TRUE(boundary.closed);
    EXPECT_EQ(close_hanging_points(found.grid)->report.points, 0u) << "nothing is left";
    const PointField field = field_at(found.grid, inside);
    for (const double tolerance : {0.0, 0.02}) {
        const Surface surface = surface_of(found.grid, field, isovalue, tolerance);
        ASSERT_GT(surface.triangle_count(), 0u);
        EXPECT_TRUE(check(surface).value().closed) << tolerance;
    }
    auto solids = Solids::create({found.grid, field, {}, {}}, {}).value();
    double volume = 0;
    for (const SolidRange side : {SolidRange{-INFINITY, isovalue}, SolidRange{isovalue, INFINITY}}) {
        const SurfaceReport report = check(solids.extract(side).value().surface).value();
        EXPECT_TRUE(report.closed);
        volume += report.volume;
    }
    EXPECT_NEAR(volume, boundary.volume, 1e-5);
}

/// Its surface is the plane, and as large as the plane is in the cube.
void expect_plane(const ClosedGrid& found, double area) {
    for (const double tolerance : {0.0, 1e-3}) {
        const Surface surface = surface_of(found.grid, field_at(found.grid, slanted), 0.123, tolerance);
        for (std::size_t v = 0; v < surface.vertex_count(); ++v)
            ASSERT_NEAR(slanted(place_of(surface.positions, v)), 0.123, 1e-12);
        EXPECT_NEAR(check(surface).value().area, area, 1e-9);
    }
}

double area_of_plane() {
    const Grid cube = make_grid({"kuhn", 2, {}, 1}).value();
    return check(surface_of(cube, field_at(cube, slanted), 0.123)).value().area;
}

ClosedGrid closed(const Grid& grid) {
    ClosedGrid found = close_hanging_points(grid).value();
    EXPECT_GT(found.report.cells, 0u);
    EXPECT_EQ(found.report.open_faces, 0u);
    return found;
}

TEST(HighLevels, AreClosedInCellsOfAnyKindAndDegree) {
    const double area = area_of_plane();
    for (const auto& [shape, degree] : some_of<std::pair<const char*, unsigned>>({{"mixed", 3u},
                                                                                  {"kuhn", 3u},
                                                                                  {"kuhn", 4u},
                                                                                  {"hex", 4u},
                                                                                  {"kuhn", 5u},
                                                                                  {"hex", 5u},
                                                                                  {"wedge", 4u},
                                                                                  {"pyramid", 3u}})) {
        SCOPED_TRACE(shape + std::string(" of degree ") + std::to_string(degree));
        const ClosedGrid found = closed(cells_of_degree(levels(shape), all_of(degree)));
        EXPECT_EQ(found.report.curved_cells, found.report.cells);
        expect_closed(found, bumpy, 0.37);
        expect_plane(found, area);
        EXPECT_NEAR(check(boundary_of(found.grid).value())->area, 24, 1e-5) << "no face inside is left";
    }
}

TEST(HighLevels, NothingIsOpenOnCurvedShapes) {
    const auto warp = [](At p) {
        const At bulged = bulge(p);
        At out = p;
        for (std::size_t k = 0; k < 3; ++k) out[k] += 0.3 * (bulged[k] - p[k]);
        return out;
    };
    // Cubic tets beside curved edges may become folded polyhedra.
    for (const auto& [shape, degree] : some_of<std::pair<const char*, unsigned>>(
             {{"hex", 3u}, {"hex", 4u}, {"mixed", 3u}, {"kuhn", 3u}, {"kuhn", 4u}})) {
        SCOPED_TRACE(shape + std::string(" of degree ") + std::to_string(degree));
        const ClosedGrid found = closed(cells_of_degree(levels(shape, 2), all_of(degree), warp));
        EXPECT_GT(found.report.near_faces, 0u);
        const PointField field = field_at(found.grid, bumpy);
        for (const double tolerance : {0.0, 0.01, 0.002}) {
            const SurfaceReport report = check(surface_of(found.grid, field, 0.37, tolerance)).value();
            ASSERT_GT(report.triangles, 0u);
            EXPECT_EQ(report.boundary_edges, 0u) << tolerance;
            if (shape == std::string("hex")) {
                EXPECT_TRUE(report.closed) << tolerance;
            }
        }
    }
}

TEST(HighLevels, AreClosedBesideCellsOfLowerDegree) {
    const double area = area_of_plane();
    for (const char* shape : {"hex", "kuhn"})
        for (const unsigned degree : {3u, 4u}) {
            SCOPED_TRACE(shape + std::string(" of degree ") + std::to_string(degree));
            const Grid grid = levels(shape, 3);
            const std::size_t large = make_grid({shape, 2, {}, 3})->cells.count();
            const auto cells = core::CellReader::open(grid).value();
            // Of one size, cells have one degree.
            const auto degree_by_size = [&](bool of_large, std::size_t cell) {
                double longest = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    longest = std::max(longest, std::abs(grid.points.at(cells.whole(cell).corners[0], k) -
                                                         grid.points.at(cells.whole(cell).corners[1], k)));
                return (longest > 0.9 * 2 / std::cbrt(static_cast<double>(large) / (shape[0] == 'k' ? 6 : 1))) ==
                               of_large
                           ? degree
                           : 1u;
            };
            for (const bool of_large : {false, true}) {
                SCOPED_TRACE(of_large ? "large cells" : "small cells");
                const ClosedGrid found =
                    closed(cells_of_degree(grid, [&](std::size_t cell) { return degree_by_size(of_large, cell); }));
                expect_closed(found, bumpy, 0.37);
                expect_plane(found, area);
            }
        }
}

TEST(HighLevels, AreClosedInBezierCells) {
    const double area = area_of_plane();
    for (const char* shape : {"kuhn", "hex", "wedge"})
        for (const unsigned degree : some_of({2u, 3u})) {
            SCOPED_TRACE(shape + std::string(" of degree ") + std::to_string(degree));
            const ClosedGrid found = closed(cells_of_degree(levels(shape), all_of(degree), {}, Nodes::bezier));
            expect_closed(found, bumpy, 0.37);
            expect_plane(found, area);
        }
}

TEST(HighLevels, ACellTakesWhatHangsOnOneFace) {
    for (const auto& [across, up] : {std::pair{2, 2}, {4, 2}, {3, 3}})
        for (const unsigned degree : {3u, 4u, 5u})
            for (const unsigned degree_of_small : {1u, 2u, degree}) {
                SCOPED_TRACE(std::to_string(across * up) + " of degree " + std::to_string(degree_of_small) +
                             " beside " + std::to_string(degree));
                RefinedCells shared(coarse_beside(across, up));
                const Grid grid = cells_of_degree(
                    shared.grid(), [&](std::size_t cell) { return cell == 0 ? degree : degree_of_small; });
                const ClosedGrid found = closed(grid);
                EXPECT_EQ(found.report.points, static_cast<std::uint64_t>((across + 1) * (up + 1) - 4));
                EXPECT_EQ(found.report.cells, 1u);
                EXPECT_EQ(found.report.curved_cells, 1u);
                const auto around = [](At p) { return squared({p[0] - 1, p[1] - 0.5, p[2] - 0.5}); };
                expect_closed(found, around, 0.1);
            }
}

TEST(HighLevels, GridsWithoutLevelsKeepTheirArrays) {
    for (const unsigned degree : {3u, 4u}) {
        const Grid grid = cells_of_degree(make_grid({"mixed", 3, {}, 1}).value(), all_of(degree));
        const ClosedGrid found = close_hanging_points(grid).value();
        EXPECT_EQ(found.report.points + found.report.cells + found.report.open_faces, 0u);
        EXPECT_EQ(found.grid.cells.connectivity.data(), grid.cells.connectivity.data());
    }
}

} // namespace
} // namespace isotet::test::high_levels
