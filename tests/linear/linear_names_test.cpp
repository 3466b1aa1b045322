// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lagrange and Bezier cells of degree 1 are linear cells.
#include <cstring>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/make.hpp>

#include "grid/cell/linear_names.hpp"

namespace isotet::test {
namespace {

/// The same cells by other types.
Grid renamed(Grid grid, std::uint8_t first) {
    const std::map<int, int> place{{10, 0}, {12, 1}, {13, 2}, {14, 3}};
    std::vector<std::uint8_t> types;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell)
        types.push_back(static_cast<std::uint8_t>(first + place.at(static_cast<int>(grid.cells.types.at(cell)))));
    grid.cells.types = Array::own(std::move(types));
    return grid;
}

std::string bytes_of_array(const Array& array) { return {static_cast<const char*>(array.data()), array.bytes()}; }

Surface surface_of(const Grid& grid) {
    ContourOptions options;
    options.refine.emplace();
    auto session = Contour::create({grid, {"f", grid.point_fields[0].values, false, {}}, {}, {}}, options).value();
    return session.extract(0.6).value().surfaces[0].surface;
}

TEST(CellsOfDegreeOne, AreTheLinearCellsThatTheyAre) {
    const Grid linear = make_grid({"mixed", 3, {"sphere"}, 3}).value();
    const Surface expected = surface_of(linear);
    ASSERT_GT(expected.triangle_count(), 100u);
    for (const std::uint8_t first : {core::first_lagrange, core::first_bezier}) {
        const Surface found = surface_of(renamed(linear, first));
        EXPECT_EQ(bytes_of_array(found.positions), bytes_of_array(expected.positions));
        EXPECT_EQ(bytes_of_array(found.triangles), bytes_of_array(expected.triangles));
    }
}

TEST(CellsOfDegreeOne, AreNamedByTypeAndNumberOfNodes) {
    EXPECT_EQ(core::linear_name_of(71, 4), 10);
    EXPECT_EQ(core::linear_name_of(72, 8), 12);
    EXPECT_EQ(core::linear_name_of(73, 6), 13);
    EXPECT_EQ(core::linear_name_of(74, 5), 14);
    EXPECT_EQ(core::linear_name_of(81, 5), 14);
    EXPECT_EQ(core::linear_name_of(71, 10), std::nullopt);
    EXPECT_EQ(core::linear_name_of(72, 4), std::nullopt);
    EXPECT_EQ(core::linear_name_of(70, 4), std::nullopt);

    Cells cells;
    cells.types = Array::own(std::vector<std::uint8_t>{71, 71, 5});
    cells.offsets = Array::own(std::vector<std::int32_t>{0, 4, 14, 17});
    const Array named = core::with_linear_names(cells).types;
    EXPECT_EQ(std::vector<std::uint8_t>(named.as<std::uint8_t>().begin(), named.as<std::uint8_t>().end()),
              (std::vector<std::uint8_t>{10, 71, 5}));
    cells.offsets = Array::own(std::vector<std::int32_t>{0, 4});
    EXPECT_FALSE(core::has_linear_names(cells)) << "offsets that do not fit";
}

} // namespace
} // namespace isotet::test
