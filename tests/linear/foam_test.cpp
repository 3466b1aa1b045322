// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces in a foam of truncated octahedra: hexagons and squares in every direction.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>

namespace isotet {
namespace {

Grid foam(std::uint64_t side, const std::string& field) {
    MakeOptions options;
    options.shape = "kelvin";
    options.side = side;
    options.fields = {field};
    return make_grid(options).value();
}

Surface surface_at(const Grid& grid, double isovalue, Method method) {
    ContourOptions options;
    options.method = method;
    options.edge_ends = true;
    const std::string name = grid.point_fields[0].name;
    Contour contour = Contour::create({grid, find_field(grid, name).value(), {}, {}}, options).value();
    return contour.extract(isovalue).value().surfaces[0].surface;
}

TEST(Foam, IsSplitIntoPyramidsAlone) {
    const LinearGrid linear = linearize(foam(3, "sphere")).value();
    EXPECT_EQ(linear.report.polyhedra, 54u);
    EXPECT_EQ(linear.report.cells, 54u * (6 + 2 * 8)) << "a hexagon is two quadrilaterals";
    EXPECT_EQ(linear.report.moved_centres + linear.report.folded + linear.report.open, 0u);
}

TEST(Foam, FillsItsSpace) {
    const Grid grid = foam(4, "plane");
    const ContourSpectrum spectrum = contour_spectrum_over_range(grid, find_field(grid, "plane").value(), 2).value();
    const double quarter = 2.0 / (4 * 4 + 2); // of a cube: half of it is one octahedron
    EXPECT_NEAR(spectrum.volume, 128 * 32 * std::pow(quarter, 3), 1e-5);
}

TEST(Foam, HasClosedSurfacesByEveryMethod) {
    for (const char* field : {"sphere", "gyroid", "integer"}) {
        const Grid grid = foam(5, field);
        const PointField values = find_field(grid, field).value();
        for (const double isovalue : {0.5, 0.75, 1.0, 2.0}) {
            for (const Method method : {Method::direct, Method::clusters}) {
                CheckOptions options;
                options.grid = &grid;
                options.field = &values;
                const SurfaceReport report = check(surface_at(grid, isovalue, method), options).value();
                EXPECT_TRUE(report.sound) << field << ' ' << isovalue;
            }
        }
    }
}

TEST(Foam, GivesAPlaneOfALinearField) {
    const Grid grid = foam(5, "plane");
    const Surface surface = surface_at(grid, 0.3, Method::clusters);
    ASSERT_GT(surface.vertex_count(), 100u);
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto at = [&](std::size_t axis) { return surface.positions.at(v, axis); };
        ASSERT_NEAR((at(0) + 2 * at(1) + 3 * at(2)) / std::sqrt(14.0), 0.3, 1e-6);
    }
}

} // namespace
} // namespace isotet
