// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedral grids for files, in the shape that most formats have, and what must hold of what is read back.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/read.hpp>

#include "grid/cell_faces.hpp"
#include "linear/polyhedral_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {

/// The height, of which every isosurface is a plane.
inline double height_at(double x, double y, double z) { return x + 2 * y - 0.5 * z; }

/// With the point fields f, the height, and g, of four values at random, and the cell field c, the number.
inline Grid with_fields_for_files(Grid grid) {
    std::mt19937 random(5);
    std::vector<double> heights, values, numbers;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        heights.push_back(height_at(grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2)));
        values.push_back(random() % 4);
    }
    for (std::size_t i = 0; i < grid.cells.count(); ++i) numbers.push_back(static_cast<double>(i));
    grid.point_fields = {{"f", Array::own(std::move(heights))}, {"g", Array::own(std::move(values))}};
    grid.cell_fields = {{"c", Array::own(std::move(numbers))}};
    return grid;
}

/// Polyhedra with hanging points beside hexahedra.
inline Grid octree_for_files(unsigned seed = 3) { return with_fields_for_files(octree_grid({.seed = seed})); }

inline Grid hexahedra_for_files() {
    Grid grid = made_grid("hex", 4, {}, 3);
    grid.points = grid.points.visit([](auto from) { // 32 bits in the file, or 64: the same numbers
        std::vector<double> points;
        for (const auto x : from) points.push_back(static_cast<double>(static_cast<float>(x)));
        return Array::own(std::move(points), 3);
    });
    return with_fields_for_files(std::move(grid));
}

/// Every face once, and each cell's faces by number.
struct FaceTable {
    std::vector<FaceLoop> faces;                  ///< points from 0
    std::vector<std::vector<std::int64_t>> cells; ///< of polyhedra only; faces from 0
    std::vector<std::vector<bool>> second;        ///< another cell has this face, too, with a lower number

    explicit FaceTable(const Grid& grid) {
        const auto reader = core::FaceReader::open(grid.cells).value();
        std::map<FaceLoop, std::int64_t> known;
        for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
            if (reader.begin(cell) == reader.end(cell)) continue;
            auto& own = cells.emplace_back();
            auto& repeated = second.emplace_back();
            for (std::uint64_t at = reader.begin(cell) + 1; at < reader.end(cell);) {
                FaceLoop loop(reader.at(at++));
                for (auto& point : loop) point = static_cast<std::int64_t>(reader.at(at++));
                FaceLoop sorted = loop;
                std::ranges::sort(sorted);
                const auto [place, is_new] = known.emplace(sorted, static_cast<std::int64_t>(faces.size()));
                if (is_new) faces.push_back(loop);
                own.push_back(place->second);
                repeated.push_back(!is_new);
            }
        }
    }
};

/// The corners of a cell.
inline std::vector<std::int64_t> corners_of_cell(const Grid& grid, std::size_t cell) {
    std::vector<std::int64_t> out;
    for (auto i = static_cast<std::size_t>(grid.cells.offsets.at(cell)); i < grid.cells.offsets.at(cell + 1); ++i)
        out.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    return out;
}

/// Hexahedra with hanging points, as polyhedra too.
inline Grid all_polyhedra(const Grid& grid) {
    const auto reader = core::FaceReader::open(grid.cells).value();
    PolyhedronList list;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        CellFaces faces;
        const std::vector<std::int64_t> corners = corners_of_cell(grid, cell);
        if (reader.begin(cell) == reader.end(cell)) {
            for (const core::CellFace& face : core::shape_of(core::CellKind::hexahedron).faces()) {
                FaceLoop& loop = faces.emplace_back();
                for (const std::uint8_t corner : face.all()) loop.push_back(corners[corner]);
            }
        } else {
            for (std::uint64_t at = reader.begin(cell) + 1; at < reader.end(cell);) {
                FaceLoop& loop = faces.emplace_back(reader.at(at++));
                for (auto& point : loop) point = static_cast<std::int64_t>(reader.at(at++));
            }
        }
        list.add(faces);
    }
    Grid out = grid;
    out.cells = list.cells();
    return out;
}

inline ContourResult surface_for_files(const Grid& grid, const Field& field, double isovalue) {
    return Contour::create({grid, {field.name, field.values, false, {}}, {}, {}},
                           {.edge_ends = true, .source_cells = true})
        .value()
        .extract(isovalue)
        .value();
}

inline const Field& field_named(const Grid& grid, const std::string& name) {
    const auto found = std::ranges::find(grid.point_fields, name, &Field::name);
    EXPECT_NE(found, grid.point_fields.end()) << name;
    return *found;
}

/// No hole inside, planes are planes.
inline void expect_sound_polyhedra(const Grid& grid) {
    const LinearizeReport report = linearize(grid).value().report;
    EXPECT_EQ(report.open, 0u);
    EXPECT_EQ(report.folded, 0u);
    EXPECT_EQ(survey(grid).value().cells_left_out, 0u);
    const Field& random = field_named(grid, "g");
    const PointField values{random.name, random.values, false, {}};
    const SurfaceReport found =
        check(surface_for_files(grid, random, 2).surfaces[0].surface, {.grid = &grid, .field = &values}).value();
    EXPECT_TRUE(found.sound) << (found.findings.empty() ? "" : found.findings[0].what);
    EXPECT_GT(found.triangles, 0u);
    const Field& height = field_named(grid, "f");
    double lowest = height.values.at(0), highest = lowest;
    for (std::size_t i = 0; i < height.values.tuples(); ++i) {
        lowest = std::min(lowest, height.values.at(i));
        highest = std::max(highest, height.values.at(i));
    }
    const double middle = (lowest + highest) / 2;
    const Surface plane = surface_for_files(grid, height, middle).surfaces[0].surface;
    EXPECT_GT(plane.vertex_count(), 0u);
    for (std::size_t v = 0; v < plane.vertex_count(); ++v) {
        const auto at = position_of(plane, v);
        ASSERT_NEAR(height_at(at[0], at[1], at[2]), middle, 1e-6 * (highest - lowest));
    }
}

/// Polyhedra, and the surface of `sample`, whatever the order of cells.
inline void expect_surface_of(const Grid& sample, const Grid& grid) {
    for (const auto& [name, isovalue] : {std::pair("g", 2.0), std::pair("g", 0.5)}) {
        const auto expected =
            sets_of(surface_for_files(sample, field_named(sample, name), isovalue).surfaces[0].surface);
        const auto found = sets_of(surface_for_files(grid, field_named(grid, name), isovalue).surfaces[0].surface);
        EXPECT_GT(found.triangle_count(), 0u);
        EXPECT_EQ(found.triangle_count(), expected.triangle_count()) << name << " = " << isovalue;
        EXPECT_EQ(found.positions(), expected.positions()) << name << " = " << isovalue;
    }
}

} // namespace isotet::test
