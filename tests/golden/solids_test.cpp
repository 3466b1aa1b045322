// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids of the real grids in data/: closed, and what lies above and below an isovalue makes up the grid.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/solid.hpp>

#include "golden/golden_files.hpp"

namespace isotet::test {
namespace {

class GoldenSolids : public testing::TestWithParam<GoldenFile> {};

std::vector<GoldenFile> grids_for_solids() {
    std::vector<GoldenFile> files;
    for (const GoldenFile& file : golden_files)
        if (!file.reader_process || ISOTET_GOLDEN_VTK) files.push_back(file);
    return files;
}

bool has_repeated_cells(const Grid& grid) { return survey(grid).value().repeated_tets > 0; }

TEST_P(GoldenSolids, AboveAndBelowMakeUpTheGrid) {
    const Grid grid = read_golden(GetParam().path).value().grid;
    const bool must_close = !has_repeated_cells(grid);
    for (const std::string& name : {fields_to_contour(grid).front(), std::string("z")}) {
        SCOPED_TRACE(name);
        Solids solids =
            Solids::create({grid, find_field(grid, name).value(), {}, {}}, {.precision = Precision::float64}).value();
        const FieldReport field = solids.field().value();
        const double isovalue = field.lower + 0.375 * (field.upper - field.lower);
        const Solid above = solids.extract(SolidRange::above(isovalue)).value();
        const Solid below = solids.extract(SolidRange::below(isovalue)).value();
        EXPECT_NEAR(above.volume + below.volume, solids.grid_volume(), 1e-9 * std::abs(solids.grid_volume()));
        EXPECT_EQ(must_close ? above.open_edges + below.open_edges : 0, 0u);
    }
}

std::string solid_name(const testing::TestParamInfo<GoldenFile>& info) {
    std::string name = info.param.path;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Data, GoldenSolids, testing::ValuesIn(grids_for_solids()), solid_name);

} // namespace
} // namespace isotet::test
