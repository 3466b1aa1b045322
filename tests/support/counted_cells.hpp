// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files whose cells are counted as they go by.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include <isotet/grid.hpp>
#include <isotet/read.hpp>

#include "grid/cells.hpp"

namespace isotet::test {

inline bool counted_same_bytes(const Array& a, const Array& b) {
    return a.type() == b.type() && a.bytes() == b.bytes() &&
           (a.bytes() == 0 || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

/// Report, sample, points, fields and notes are those of all cells.
///
/// `stays`   whether the cells stay in the file
inline void expect_counted(const std::string& file, bool stays, const ReadOptions& options = {}) {
    const SurveyedGrid counted = read_surveyed(file, options).value();
    const ReadResult all = read(file, options).value();
    ASSERT_EQ(counted.report.has_value(), stays);
    EXPECT_EQ(counted.read.notes, all.notes);
    EXPECT_TRUE(counted_same_bytes(counted.read.grid.points, all.grid.points));
    ASSERT_EQ(counted.read.grid.cell_fields.size(), all.grid.cell_fields.size());
    for (std::size_t i = 0; i < all.grid.cell_fields.size(); ++i)
        EXPECT_TRUE(counted_same_bytes(counted.read.grid.cell_fields[i].values, all.grid.cell_fields[i].values));
    if (!stays) {
        EXPECT_EQ(counted.read.grid.cells.count(), all.grid.cells.count());
        return;
    }
    const GridReport expected = survey(all.grid, {.faces = false}).value();
    EXPECT_EQ(counted.report->points, expected.points);
    EXPECT_EQ(counted.report->cells, expected.cells);
    EXPECT_EQ(counted.report->cells_by_type, expected.cells_by_type);
    EXPECT_EQ(counted.report->tets, expected.tets);
    EXPECT_EQ(counted.report->inverted_tets, expected.inverted_tets);
    EXPECT_EQ(counted.report->collapsed_tets, expected.collapsed_tets);
    EXPECT_EQ(counted.report->flat_tets, expected.flat_tets);
    EXPECT_EQ(counted.report->cells_left_out, expected.cells_left_out);
    EXPECT_EQ(counted.report->unused_points, expected.unused_points);
    EXPECT_EQ(counted.report->lower, expected.lower);
    EXPECT_EQ(counted.report->upper, expected.upper);
    ASSERT_EQ(counted.read.grid.point_fields.size(), all.grid.point_fields.size());
    for (std::size_t i = 0; i < all.grid.point_fields.size(); ++i)
        EXPECT_TRUE(counted_same_bytes(counted.read.grid.point_fields[i].values, all.grid.point_fields[i].values));
    EXPECT_EQ(counted.read.cells_in_file, all.grid.cells.count());
    const core::CellReader sample = core::CellReader::open({all.grid.points, counted.read.grid.cells, {}, {}}).value(),
                           cells = core::CellReader::open(all.grid).value();
    ASSERT_EQ(counted.sampled.size(), sample.count());
    for (std::size_t i = 0; i < sample.count(); ++i) {
        const std::uint64_t cell = counted.sampled[i];
        ASSERT_EQ(sample.type(i), cells.type(cell));
        for (std::uint64_t k = 0; k < cells.corners(cell); ++k)
            ASSERT_EQ(sample.corner(sample.first(i) + k), cells.corner(cells.first(cell) + k)) << cell;
    }
}

} // namespace isotet::test
