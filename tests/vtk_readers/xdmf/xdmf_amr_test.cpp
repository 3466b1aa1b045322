// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// XDMF's evenly spaced grids on several levels: the grid of the same boxes in VTH.
#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "readers/amr_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// As Origin and spacing, or as coordinates along each axis.
std::string geometry(const io::amr::Hierarchy& all, std::size_t level, const io::amr::CellBox& box, bool rectilinear) {
    std::string out = fmt::format("<Geometry GeometryType=\"{}\">", rectilinear ? "VXVYVZ" : "ORIGIN_DXDYDZ");
    const auto at = [&](std::size_t axis, std::int64_t point) {
        return all.origin[axis] + all.levels[level].spacing[axis] * static_cast<double>(point);
    };
    const auto item = [&](const std::vector<double>& numbers) {
        out += fmt::format("<DataItem Dimensions=\"{}\" Format=\"XML\">{}</DataItem>", numbers.size(),
                           fmt::join(numbers, " "));
    };
    if (rectilinear) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<double> along;
            for (std::int64_t point = box.first[axis]; point <= box.last[axis] + 1; ++point)
                along.push_back(at(axis, point));
            item(along);
        }
    } else {
        const auto& [x, y, z] = all.levels[level].spacing;
        item({at(2, box.first[2]), at(1, box.first[1]), at(0, box.first[0])});
        item({z, y, x});
    }
    return out + "</Geometry>";
}

std::string collection(const io::amr::Hierarchy& all, bool rectilinear) {
    std::string out = "<Xdmf Version=\"3.0\"><Domain><Grid GridType=\"Collection\" CollectionType=\"Spatial\">\n";
    std::size_t number = 0;
    for (std::size_t level = all.levels.size(); level-- > 0;) // the finest first: the order does not count
        for (const io::amr::CellBox& box : all.levels[level].boxes) {
            std::vector<double> values;
            for (const auto& middle : middles_of(all, level, box)) values.push_back(middle[0]);
            out += fmt::format("<Grid Name=\"box{}\"><Topology TopologyType=\"{}\" Dimensions=\"{} {} {}\"/>{}",
                               number++, rectilinear ? "3DRectMesh" : "3DCoRectMesh", box.cells(2) + 1,
                               box.cells(1) + 1, box.cells(0) + 1, geometry(all, level, box, rectilinear));
            out += fmt::format("<Attribute Name=\"s\" Center=\"Cell\"><DataItem Dimensions=\"{} {} {}\" Format=\"XML\" "
                               "Precision=\"8\">{}</DataItem></Attribute></Grid>\n",
                               box.cells(2), box.cells(1), box.cells(0), fmt::join(values, " "));
        }
    return out + "</Grid></Domain></Xdmf>\n";
}

std::vector<std::array<double, 4>> values_at_places(const Grid& grid) {
    std::vector<std::array<double, 4>> out;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        out.push_back(
            {grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2), grid.point_fields.at(0).values.at(i)});
    std::ranges::sort(out);
    return out;
}

ReadResult read_text(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("a.xmf")) << text;
    auto result = read(folder.file("a.xmf"));
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return *std::move(result);
}

TEST(XdmfAmr, IsTheGridOfTheSameBoxesInVth) {
    const io::amr::Hierarchy boxes = nested_boxes(2, 2);
    const TemporaryFolder folder;
    const Grid expected = read(AmrFile{.boxes = boxes}.write(folder.file(""))).value().grid;
    for (const bool rectilinear : {false, true}) {
        const ReadResult found = read_text(collection(boxes, rectilinear));
        EXPECT_EQ(found.grid.cells.count(), expected.cells.count());
        EXPECT_EQ(values_at_places(found.grid), values_at_places(expected));
        ASSERT_EQ(found.grid.cell_fields.size(), 1u);
    }
}

TEST(XdmfAmr, BlocksBesideEachOtherStayBlocks) {
    io::amr::Hierarchy boxes;
    boxes.levels = {{{1, 1, 1}, {{{0, 0, 0}, {1, 1, 1}}}}, {{0.5, 0.5, 0.5}, {{{4, 0, 0}, {7, 3, 3}}}}};
    const ReadResult found = read_text(collection(boxes, false));
    EXPECT_EQ(found.info.blocks.size(), 2u);
    EXPECT_EQ(found.grid.cells.count(), 8u + 64u);
}

} // namespace
} // namespace isotet::test
