// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// GridFile gives the surfaces of a session on the grid that is read whole, whatever it leaves unread.
#include <isotet/grid_file.hpp>

#include <array>
#include <memory>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/fields.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/write.hpp>

#include "support/surface_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

const std::vector<double> isovalues{0.1, -0.7};

Grid made(const std::string& shape, std::uint64_t side = 16) {
    return make_grid({.shape = shape, .side = side, .fields = {"gyroid", "sphere"}}).value();
}

GridFile opened(const std::string& path) {
    Result<GridFile> file = GridFile::open(path);
    EXPECT_TRUE(file) << file.error().message;
    return *std::move(file);
}

/// Of a session that has the whole grid.
ContourResult expected(const Grid& grid, const std::string& field, const std::vector<std::string>& with = {},
                       ContourOptions options = {}) {
    ContourInput input{close_hanging_points(grid).value().grid, {}, {}, {}};
    input.field = find_field(input.grid, field).value();
    for (const std::string& name : with) {
        for (const Field& one : grid.point_fields)
            if (one.name == name) input.point_fields.push_back(one);
        for (const Field& one : grid.cell_fields)
            if (one.name == name) input.cell_fields.push_back(one);
        if (looks_like_expression(name)) input.point_fields.push_back({name, find_field(grid, name).value().values});
    }
    options.surfaces = isovalues.size();
    return Contour::create(std::move(input), options).value().extract(isovalues).value();
}

void expect_same(const ContourResult& made, const ContourResult& expected) {
    ASSERT_EQ(made.surfaces.size(), expected.surfaces.size());
    for (std::size_t i = 0; i < made.surfaces.size(); ++i) {
        EXPECT_GT(made.surfaces[i].surface.triangle_count(), 0U);
        EXPECT_TRUE(bytes_of(made.surfaces[i].surface) == bytes_of(expected.surfaces[i].surface)) << i;
    }
}

TEST(GridFile, GivesTheSurfacesOfTheWholeGrid) {
    const TemporaryFolder folder;
    for (const char* shape : {"kuhn", "shuffled", "hex", "mixed", "kelvin"})
        for (const char* name : {"raw.vtu", "grid.vtk"}) {
            SCOPED_TRACE(testing::Message() << shape << " " << name);
            const std::string path = folder.file(name);
            const Grid grid = made(shape, shape == std::string("kelvin") ? 4 : 16);
            const auto written = write_grid(grid, path);
            if (!written) continue; // polyhedra in a legacy file
            const GridFile file = opened(path);
            EXPECT_EQ(file.info().fields.size(), 2U);
            expect_same(file.contour("gyroid", isovalues).value(), expected(grid, "gyroid"));
            expect_same(file.contour("gyroid", isovalues, {.with = {"sphere", "2*sphere"}}).value(),
                        expected(grid, "gyroid", {"sphere", "2*sphere"}));
            expect_same(file.contour("gyroid + x", isovalues).value(), expected(grid, "gyroid + x"));
        }
}

TEST(GridFile, GivesSourceCellsOfTheWholeGrid) {
    const TemporaryFolder folder;
    FileContourOptions options;
    options.contour.source_cells = true;
    for (const char* shape : {"shuffled", "mixed"}) {
        const Grid grid = made(shape);
        ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
        options.contour.expected_isovalues = isovalues;
        options.contour.surfaces = isovalues.size();
        FileSession started = opened(folder.file("grid.vtu")).session("gyroid", options).value();
        expect_same(started.contour.extract(isovalues).value(), expected(grid, "gyroid", {}, options.contour));
    }
}

TEST(GridFile, ReadsAllCellsForMoreIsovaluesThanAreFiltered) {
    const TemporaryFolder folder;
    const Grid grid = made("kuhn", 6);
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    FileContourOptions options;
    options.contour.method = Method::direct;
    std::vector<double> many(256, 0.1);
    many[1] = -0.7;
    ContourResult found = opened(folder.file("grid.vtu")).contour("gyroid", many, options).value();
    found.surfaces.resize(2);
    expect_same(found, expected(grid, "gyroid", {}, options.contour));
}

TEST(GridFile, CarriesCellFieldsAndReadsAllForThem) {
    const TemporaryFolder folder;
    Grid grid = made("mixed");
    std::vector<float> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i % 7);
    grid.cell_fields = {{"number", Array::own(numbers)}};
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    const GridFile file = opened(folder.file("grid.vtu"));
    const ContourResult result = file.contour("gyroid", isovalues, {.with = {"number"}}).value();
    expect_same(result, expected(grid, "gyroid", {"number"}));
    EXPECT_EQ(result.surfaces[0].surface.cell_fields.size(), 1U);
}

bool is_closed(const Surface& surface) { return check(surface).value().boundary_edges == 0; }

TEST(GridFile, ClosesSurfacesBetweenLevels) {
    const std::vector<double> levels{0.4, 0.6};
    const TemporaryFolder folder;
    const Grid grid = made("octree", 8);
    ASSERT_TRUE(write_grid(grid, folder.file("levels.vtu")));
    const GridFile file = opened(folder.file("levels.vtu"));
    for (const bool close : {true, false}) {
        FileContourOptions options;
        options.close_hanging_points = close;
        options.contour.surfaces = isovalues.size();
        FileSession all = file.session("sphere", options).value(); // expects no isovalues: reads all cells
        EXPECT_EQ(all.notes.empty(), !close);
        ContourInput input{close ? close_hanging_points(grid).value().grid : grid, {}, {}, {}};
        input.field = find_field(input.grid, "sphere").value();
        Contour session = Contour::create(std::move(input), options.contour).value();
        expect_same(all.contour.extract(levels).value(), session.extract(levels).value());
        EXPECT_EQ(is_closed(file.contour("sphere", levels, options).value().surfaces[0].surface), close);
    }
}

TEST(GridFile, GivesASessionThatReadsTheRestWhenItIsNeeded) {
    const TemporaryFolder folder;
    const Grid grid = made("kuhn");
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    const GridFile file = opened(folder.file("grid.vtu"));
    FileContourOptions options;
    options.contour.surfaces = 3;
    options.contour.expected_isovalues = {0.1};
    FileSession started = file.session("gyroid", options).value();
    expect_same(started.contour.extract(isovalues).value(), expected(grid, "gyroid"));
}

TEST(GridFile, TakesFieldsOfALaterStep) {
    const TemporaryFolder folder;
    Grid grid = made("hex");
    ASSERT_TRUE(write_grid(grid, folder.file("a.vtu")));
    grid.point_fields[0].name = "later";
    ASSERT_TRUE(write_grid(grid, folder.file("b.vtu")));
    folder.write("run.pvd", R"(<VTKFile type="Collection"><Collection>
        <DataSet timestep="0" file="a.vtu"/><DataSet timestep="2" file="b.vtu"/></Collection></VTKFile>)");
    const GridFile file = opened(folder.file("run.pvd"));
    ASSERT_EQ(file.info().times.size(), 2U);
    expect_same(file.contour("later", isovalues, {.step = 1}).value(), expected(grid, "later"));
    EXPECT_EQ(file.contour("later", isovalues).error().code, ErrorCode::invalid_argument);
    const ReadResult step = file.read(1, std::vector<std::string>{"sphere"}).value();
    ASSERT_EQ(step.grid.point_fields.size(), 1U);
    EXPECT_EQ(step.grid.point_fields[0].name, "sphere");
}

TEST(GridFile, GivesTheSurfacesOfAPackedFile) {
    const TemporaryFolder folder;
    const Grid grid = made("kuhn", 12);
    const PackedGrid packed = pack(grid, find_field(grid, "gyroid").value(), {.gradients = false}).value();
    const PackedGrid other = packed.with_field(find_field(grid, "sphere").value()).value();
    SavePackedOptions saving;
    saving.more_fields = {other};
    ASSERT_TRUE(save_packed(packed, folder.file("grid.isotet"), saving));
    const GridFile file = opened(folder.file("grid.isotet"));
    const ContourResult carried = file.contour("gyroid", isovalues, {.with = {"sphere"}}).value();
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        ExtractOptions options;
        options.packed_fields = {other};
        const Extraction expected = extract(packed, isovalues[i], options).value();
        EXPECT_TRUE(bytes_of(carried.surfaces[i].surface) == bytes_of(expected.surface));
    }
    FileContourOptions gradients; // which were not packed
    gradients.contour.normals = Normals::gradient;
    const ContourResult lit = file.contour("gyroid", isovalues, gradients).value();
    EXPECT_EQ(lit.surfaces[0].surface.normals.tuples(), lit.surfaces[0].surface.vertex_count());
}

TEST(GridFile, SaysWhatIsNotThere) {
    const TemporaryFolder folder;
    EXPECT_EQ(GridFile::open(folder.file("none.vtu")).error().code, ErrorCode::file);
    ASSERT_TRUE(write_grid(made("kuhn", 4), folder.file("grid.vtu")));
    const GridFile file = opened(folder.file("grid.vtu"));
    EXPECT_EQ(file.contour("giroid", isovalues).error().message,
              "there is no field 'giroid': the grid has 'gyroid', 'sphere'");
    EXPECT_EQ(file.contour("gyroid + ", isovalues).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(file.contour("gyroid", isovalues, {.step = 1}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(file.read(0, std::vector<std::string>{"pressure"}).error().code, ErrorCode::invalid_argument);
}

} // namespace
} // namespace isotet::test
