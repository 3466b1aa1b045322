// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Patches of grids on solids: each triangle of the boundary has the number of the patch that it lies on.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <isotet/linear_cells.hpp>
#include <isotet/solid.hpp>

#include "grid/patches.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

constexpr std::array<const char*, 6> names{"left", "right", "front", "back", "bottom", "top"};

/// Side s of the cube from -1 to 1 has patch 10 + s: all its points, as one face.
BoundaryPatches sides_as_sets(const Grid& grid) {
    core::PatchList list;
    for (std::size_t side = 0; side < 6; ++side) {
        const auto number = static_cast<std::int64_t>(10 + side);
        list.name(number, names[side]);
        for (std::size_t point = 0; point < grid.points.tuples(); ++point)
            if (grid.points.at(point, side / 2) == (side % 2 == 0 ? -1 : 1))
                list.point(static_cast<std::int64_t>(point));
        list.end_face(number);
    }
    return list.finish();
}

/// The same by the corners of each hexahedron there.
BoundaryPatches sides_of_hexahedra(const Grid& grid) {
    core::PatchList list;
    const auto corner = [&](std::size_t cell, std::size_t k) {
        return static_cast<std::size_t>(grid.cells.connectivity.at(8 * cell + k));
    };
    for (std::size_t side = 0; side < 6; ++side)
        for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
            for (std::size_t k = 0; k < 8; ++k)
                if (grid.points.at(corner(cell, k), side / 2) == (side % 2 == 0 ? -1 : 1))
                    list.point(static_cast<std::int64_t>(corner(cell, k)));
            list.end_face(static_cast<std::int64_t>(10 + side));
        }
    return list.finish();
}

void expect_marked(const Solid& solid) {
    const auto patch = std::ranges::find(solid.surface.cell_fields, "patch", &Field::name);
    ASSERT_NE(patch, solid.surface.cell_fields.end());
    for (std::size_t i = 0; i < solid.surface.triangle_count(); ++i) {
        std::int64_t expected = -1;
        for (std::size_t side = 0; side < 6 && i >= solid.isosurface_triangles; ++side) {
            bool is_there = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto vertex = static_cast<std::size_t>(solid.surface.triangles.at(i, k));
                is_there &= solid.surface.positions.at(vertex, side / 2) == (side % 2 == 0 ? -1 : 1);
            }
            if (is_there) expected = static_cast<std::int64_t>(10 + side);
        }
        ASSERT_EQ(patch->values.at(i), static_cast<double>(expected)) << "triangle " << i;
    }
}

void expect_all_sides(Solids& solids) {
    const Solid whole = solids.extract(SolidRange::above(-100)).value();
    expect_marked(whole);
    ASSERT_EQ(whole.patches.size(), 6u);
    for (std::size_t side = 0; side < 6; ++side) {
        EXPECT_EQ(whole.patches[side].number, static_cast<std::int64_t>(10 + side));
        EXPECT_NEAR(whole.patches[side].area, 4, 1e-5);
    }
    expect_marked(solids.extract(SolidRange::below(1.1)).value());
}

TEST(Patches, OfAllKindsOfCellsAreMarked) {
    for (const char* shape : {"kuhn", "hex", "mixed", "wedge"}) {
        SCOPED_TRACE(shape);
        Grid grid = made_grid(shape, 4, {"sphere"});
        grid.patches = sides_as_sets(grid);
        Solids solids = Solids::create({grid, point_field(grid), {}, {}}).value();
        expect_all_sides(solids);
        EXPECT_EQ(solids.extract(SolidRange::above(0)).value().patches[1].name, "right");
    }
}

TEST(Patches, OfCellsWithHangingPointsAreThoseOfTheirFaces) {
    const Grid grid = made_grid("octree", 4, {"sphere"});
    Grid with_patches = grid;
    with_patches.patches = sides_of_hexahedra(grid);
    const ClosedGrid closed = close_hanging_points(with_patches).value();
    ASSERT_GT(closed.report.points, 0u);
    Solids solids = Solids::create({closed.grid, point_field(grid), {}, {}}).value();
    expect_all_sides(solids);
}

TEST(Patches, OfCurvedCellsReachPointsThatRefinementMakes) {
    Grid grid = made_grid("hex27", 1, {"sphere"});
    grid.patches = sides_as_sets(grid);
    ContourOptions options;
    options.refine = RefineOptions{};
    options.refine->tolerance = 0.1;
    Solids solids = Solids::create({grid, point_field(grid), {}, {}}, options).value();
    expect_all_sides(solids);
}

TEST(Patches, ThatDoNotFitAreErrors) {
    const Grid grid = made_grid("hex", 2, {"sphere"});
    Grid far = grid, falling = grid, short_of_one = grid;
    far.patches = {Array::own(std::vector<std::int64_t>{0, 1, 99}), Array::own(std::vector<std::int64_t>{0, 3}),
                   Array::own(std::vector<std::int64_t>{0})};
    falling.patches = {Array::own(std::vector<std::int64_t>{0, 1, 2}), Array::own(std::vector<std::int64_t>{0, 4, 3}),
                       Array::own(std::vector<std::int64_t>{0, 0})};
    short_of_one.patches = {Array::own(std::vector<std::int64_t>{0, 1, 2}), Array::own(std::vector<std::int64_t>{0}),
                            Array::own(std::vector<std::int64_t>{0})};
    for (const Grid& wrong : {far, falling, short_of_one}) {
        const auto solids = Solids::create({wrong, point_field(grid), {}, {}});
        ASSERT_FALSE(solids);
        EXPECT_EQ(solids.error().code, ErrorCode::invalid_data);
    }
}

} // namespace
} // namespace isotet::test
