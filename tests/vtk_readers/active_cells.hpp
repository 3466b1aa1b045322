// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of which active cells only are read.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/extract.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/read.hpp>

#include "grid/cells.hpp"

namespace isotet::test {

inline bool are_same(const Array& a, const Array& b) {
    return a.type() == b.type() && a.bytes() == b.bytes() &&
           (a.bytes() == 0 || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

/// Cells at the boundary have their values, and digests the least and the greatest of all.
inline void expect_cells_at_boundary(const std::string& file, const ReadResult& all, ReadOptions options) {
    options.active_cells->boundary->wants_cells = options.active_cells->digests = true;
    const auto some = read(file, options);
    ASSERT_TRUE(some) << some.error().message;
    if (!some->cells_in_file) return; // pieces repeat cells
    const Grid& found = options.active_cells->boundary->cells;
    std::multimap<std::vector<std::uint64_t>, std::size_t> cells;
    const core::CellReader whole = core::CellReader::open(all.grid).value(),
                           around = core::CellReader::open(found).value();
    const auto corners_of = [](const core::CellReader& reader, std::size_t cell) {
        std::vector<std::uint64_t> corners(reader.corners(cell));
        for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = reader.corner(reader.first(cell) + i);
        return corners;
    };
    for (std::size_t cell = 0; cell < whole.count(); ++cell) cells.emplace(corners_of(whole, cell), cell);
    ASSERT_EQ(found.cell_fields.size(), all.grid.cell_fields.size());
    EXPECT_GT(found.cells.count(), 0u);
    for (std::size_t cell = 0; cell < found.cells.count(); ++cell) {
        const auto known = cells.find(corners_of(around, cell));
        ASSERT_NE(known, cells.end());
        if (cells.count(known->first) > 1) continue;
        for (std::size_t f = 0; f < found.cell_fields.size(); ++f) {
            const double value = found.cell_fields[f].values.at(cell);
            const double expected = all.grid.cell_fields[f].values.at(known->second);
            EXPECT_TRUE(value == expected || (std::isnan(value) && std::isnan(expected)));
        }
    }
    for (const Field& field : all.grid.cell_fields) {
        if (field.values.components() != 1) continue;
        const auto digest = std::ranges::find(some->digests, field.name, &Field::name);
        ASSERT_NE(digest, some->digests.end());
        const auto ends = [](const Array& values) {
            std::pair range(INFINITY, -INFINITY);
            for (std::size_t i = 0; i < values.tuples(); ++i)
                if (std::isfinite(values.at(i)))
                    range = {std::min<double>(range.first, values.at(i)), std::max<double>(range.second, values.at(i))};
            return range;
        };
        EXPECT_EQ(ends(digest->values), ends(field.values));
    }
}

/// Isovalues of shares are those of all cells, where the file is one piece for those of the volume.
inline void expect_shares(const std::string& file, const ReadResult& all, const std::string& field_name,
                          ReadOptions options) {
    const auto field = find_field(all.grid, field_name).value();
    for (const auto of : {IsovalueShare::Of::points, IsovalueShare::Of::volume}) {
        options.active_cells = ReadActiveCells{field_name, {}, {}};
        options.active_cells->shares = {{of, 40}, {of, 70}};
        const auto some = read(file, options);
        ASSERT_TRUE(some) << some.error().message;
        if (!some->cells_in_file && of == IsovalueShare::Of::volume) continue;
        EXPECT_TRUE(some->cells_in_file);
        EXPECT_EQ(some->share_isovalues, isovalues_at(all.grid, field, options.active_cells->shares).value());
    }
}

/// Points, their bounds, the boundary, fields, notes and surfaces with cell fields of the file with active cells are those with all.
inline void expect_same_of_active_cells(const std::string& file, const std::string& field_name,
                                        const std::vector<double>& isovalues, ReadOptions options = {}) {
    const auto all = read(file, options);
    options.active_cells = ReadActiveCells{field_name, isovalues, {}};
    options.active_cells->bounds = true;
    const auto boundary = std::make_shared<StreamedBoundary>();
    boundary->of_steps = true;
    options.active_cells->boundary = boundary;
    const auto some = read(file, options);
    ASSERT_TRUE(some) << some.error().message;
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(some->cells_in_file, all->grid.cells.count());
    EXPECT_LE(some->grid.cells.count(), all->grid.cells.count());
    const GridReport report = survey(all->grid, {.faces = false}).value();
    ASSERT_TRUE(some->bounds);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ((*some->bounds)[axis], report.lower[axis]);
        EXPECT_EQ((*some->bounds)[axis + 3], report.upper[axis]);
    }
    EXPECT_EQ(some->notes, all->notes);
    EXPECT_TRUE(are_same(some->grid.points, all->grid.points));
    ASSERT_EQ(some->grid.point_fields.size(), all->grid.point_fields.size());
    for (std::size_t i = 0; i < all->grid.point_fields.size(); ++i)
        EXPECT_TRUE(are_same(some->grid.point_fields[i].values, all->grid.point_fields[i].values));
    const Surface walls = boundary_of(all->grid).value();
    for (const bool again : {false, true}) { // the next step has the same cells
        if (again) {
            ASSERT_TRUE(read(file, options));
        }
        ASSERT_TRUE(boundary->is_there);
        EXPECT_GT(walls.triangle_count(), 0u);
        EXPECT_TRUE(are_same(boundary->surface.positions, walls.positions));
        EXPECT_TRUE(are_same(boundary->surface.triangles, walls.triangles));
        EXPECT_TRUE(are_same(boundary->surface.edge_ends, walls.edge_ends));
    }
    expect_cells_at_boundary(file, *all, options);
    expect_shares(file, *all, field_name, options);
    options.active_cells->boundary.reset();
    options.active_cells->options.extract.normals = Normals::gradient;
    const auto around = read(file, options);
    ASSERT_TRUE(around) << around.error().message;
    EXPECT_EQ(around->cells_in_file, all->grid.cells.count());
    EXPECT_GE(around->grid.cells.count(), some->grid.cells.count());
    const auto field = find_field(all->grid, field_name).value();
    DirectOptions direct;
    direct.extract.normals = Normals::gradient;
    direct.extract.cell_fields = all->grid.cell_fields;
    const auto expected = extract_direct(all->grid, field, isovalues, direct).value();
    direct.active_cells_only = true;
    direct.extract.cell_fields = around->grid.cell_fields;
    const auto with_normals = extract_direct(around->grid, field, isovalues, direct).value();
    ASSERT_FALSE(with_normals.needs_all_cells);
    direct.extract.normals = Normals::none;
    direct.extract.cell_fields = some->grid.cell_fields;
    const auto found = extract_direct(some->grid, field, isovalues, direct).value();
    ASSERT_FALSE(found.needs_all_cells);
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        EXPECT_GT(expected.surfaces[i].surface.triangle_count(), 0u);
        EXPECT_TRUE(are_same(found.surfaces[i].surface.positions, expected.surfaces[i].surface.positions));
        EXPECT_TRUE(are_same(found.surfaces[i].surface.triangles, expected.surfaces[i].surface.triangles));
        EXPECT_TRUE(are_same(with_normals.surfaces[i].surface.normals, expected.surfaces[i].surface.normals));
        const auto& fields = expected.surfaces[i].surface.cell_fields;
        ASSERT_EQ(found.surfaces[i].surface.cell_fields.size(), fields.size());
        for (std::size_t f = 0; f < fields.size(); ++f) {
            EXPECT_EQ(found.surfaces[i].surface.cell_fields[f].name, fields[f].name);
            EXPECT_TRUE(are_same(found.surfaces[i].surface.cell_fields[f].values, fields[f].values));
            EXPECT_TRUE(are_same(with_normals.surfaces[i].surface.cell_fields[f].values, fields[f].values));
        }
    }
}

} // namespace isotet::test
