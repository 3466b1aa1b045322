// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// write_grid(): what it refuses, and what its bytes are. That VTK reads them is tested beside it.
#include <algorithm>
#include <atomic>

#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "files/sample_files.hpp"

namespace isotet::test {
namespace {

Error refused(const Grid& grid, const std::string& format = "vtu") {
    const Folder folder;
    const auto report = write_grid(grid, folder / "out", {format});
    EXPECT_FALSE(report);
    EXPECT_EQ(folder.entries(), 0U);
    return report ? Error{} : report.error();
}

TEST(WriteGrid, RefusesCellsThatDoNotFitTogether) {
    Grid grid = tet_grid();
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 1, 2, 3});
    EXPECT_EQ(refused(grid).message,
              "the connectivity has 7 entries, not a multiple of 4, the corners of a tetrahedron");
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 1, 2, 3, -1});
    EXPECT_EQ(refused(grid).message, "connectivity[7] is point -1, but the grid has 5 points");
    grid.cells.connectivity = Array::own(std::vector<float>{0, 1, 2, 3});
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_argument);

    grid = mixed_grid();
    grid.cells.offsets = Array::own(std::vector<std::uint64_t>{6, 2, 11});
    EXPECT_EQ(refused(grid).message, "offsets[1] is 2 after 6: offsets may not fall");
    grid.cells.offsets = Array::own(std::vector<std::uint64_t>{2, 6, 12});
    EXPECT_EQ(refused(grid).message, "offsets run from 2 to 12, but the connectivity has 11 entries");
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{-2, 6, 11});
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_data);
    grid.cells.offsets = Array::own(std::vector<std::uint64_t>{2, 6});
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_argument);
    grid.cells.offsets = {};
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_argument);

    grid = mixed_grid();
    grid.cells.types = Array::own(std::vector<std::uint8_t>{10, 42});
    EXPECT_EQ(refused(grid).message, "cells[1] is a polyhedron, whose faces are not known: it cannot be written");
}

TEST(WriteGrid, KeepsPolyhedraWithTheirFaces) {
    const Folder folder;
    MakeOptions options;
    options.shape = "kelvin";
    options.side = 2;
    Grid grid = make_grid(options).value();
    for (const Compression compression : {Compression::none, Compression::zlib}) {
        ASSERT_TRUE(write_grid(grid, folder / "foam.vtu", {.compression = compression}));
        const Grid read = isotet::read(folder / "foam.vtu").value().grid;
        EXPECT_TRUE(std::ranges::equal(read.cells.faces.as<std::int32_t>(), grid.cells.faces.as<std::int32_t>()));
        for (std::size_t i = 0; i <= grid.cells.count(); ++i)
            EXPECT_EQ(read.cells.face_offsets.at(i), grid.cells.face_offsets.at(i));
    }
    EXPECT_EQ(refused(grid, "vtk").message, "the grid has polyhedra, which are written into .vtu only");
    grid.cells.faces = Array::own(std::vector<std::int32_t>(grid.cells.faces.size(), 100'000));
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_data);
}

TEST(WriteGrid, RefusesFieldsOfTheWrongLength) {
    Grid grid = tet_grid();
    grid.point_fields[0].values = Array::own(std::vector<float>{1, 2});
    EXPECT_EQ(refused(grid).message, "the point field \"field one\" has 2 tuples, not 5");
    grid = tet_grid();
    grid.cell_fields[0].values = Array::own(std::vector<float>{1, 2, 3});
    EXPECT_EQ(refused(grid).message, "the cell field \"v\" has 3 tuples, not 2");
}

TEST(WriteGrid, RefusesPointsThatAreNotThreeFloatingNumbers) {
    Grid grid = tet_grid();
    grid.points = Array::own(std::vector<double>(10), 2);
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_argument);
    grid.points = Array::own(std::vector<std::int32_t>(15), 3);
    EXPECT_EQ(refused(grid).code, ErrorCode::invalid_argument);
}

TEST(WriteGrid, KnowsItsFormats) {
    EXPECT_EQ(refused(tet_grid(), "vtp").message,
              "the format \"vtp\" is not one in which a grid can be written: vtu, vtk");
}

TEST(WriteGrid, IsTheSameBytesWithGivenAndWithGeneratedOffsets) {
    const Folder folder;
    Grid grid = tet_grid();
    for (const auto* format : {"vtu", "vtk"}) {
        grid = tet_grid();
        ASSERT_TRUE(write_grid(grid, folder / "uniform", {format}));
        grid.cells.offsets = Array::own(std::vector<std::int32_t>{0, 4, 8});
        grid.cells.types = Array::own(std::vector<std::uint8_t>{10, 10});
        ASSERT_TRUE(write_grid(grid, folder / "given", {format}));
        EXPECT_TRUE(content_of(folder / "uniform") == content_of(folder / "given")) << format;
    }
}

TEST(WriteGrid, HoldsAGridWithoutCells) {
    const Folder folder;
    for (const auto* format : {"vtu", "vtk"}) {
        EXPECT_TRUE(write_grid(Grid{}, folder / "out", {format})) << format;
    }
}

TEST(WriteGrid, LeavesNoFileWhenCancelled) {
    const Folder folder;
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto report = write_grid(tet_grid(), folder / "out.vtu", {}, {.progress = progress});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
    EXPECT_EQ(folder.entries(), 0U);
}

} // namespace
} // namespace isotet::test
