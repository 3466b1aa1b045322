// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// GridOptions::cells: cells chosen by the values of a cell field.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/grid.hpp>
#include <isotet/scene.hpp>
#include <isotet/jobs/clip_files.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "jobs/read_here.hpp"
#include "support/run_program.hpp"
#include "support/small_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

/// Layers along x, from 0.
std::vector<std::int32_t> layers_of(const Grid& grid, std::size_t layers) {
    std::vector<std::int32_t> numbers(grid.cells.count());
    const auto points = grid.points.as<float>();
    float lower = points[0], upper = points[0];
    for (std::size_t i = 0; i < points.size(); i += 3) {
        lower = std::min(lower, points[i]);
        upper = std::max(upper, points[i]);
    }
    for (std::size_t cell = 0; cell < numbers.size(); ++cell) {
        const auto at = [&](std::size_t i) {
            return grid.cells.offsets.empty() ? 4 * i : static_cast<std::size_t>(grid.cells.offsets.at(i));
        };
        double x = 0;
        for (std::size_t i = at(cell); i < at(cell + 1); ++i)
            x += static_cast<double>(points[3 * static_cast<std::size_t>(grid.cells.connectivity.at(i))]);
        x = x / static_cast<double>(at(cell + 1) - at(cell)) - static_cast<double>(lower);
        numbers[cell] = static_cast<std::int32_t>(x * static_cast<double>(layers) / static_cast<double>(upper - lower));
    }
    return numbers;
}

Grid layered(const std::string& shape, std::uint64_t side = 6, std::size_t layers = 3) {
    Grid grid = test::made_grid(shape, side, {"sphere", "gyroid"});
    grid.cell_fields = {{"layer", Array::own(layers_of(grid, layers))}};
    std::vector<float> tenths;
    for (const std::int32_t layer : grid.cell_fields[0].values.as<std::int32_t>())
        tenths.push_back(static_cast<float>(layer) / 10);
    grid.cell_fields.push_back({"tenth", Array::own(std::move(tenths))});
    return grid;
}

std::string written(const test::TemporaryFolder& folder, const Grid& grid, const std::string& name = "grid.vtu") {
    EXPECT_TRUE(write_grid(grid, folder.file(name)));
    return folder.file(name);
}

Result<Grid> read_chosen(const std::string& file, std::vector<std::string> cells, Listener& listener) {
    GridOptions options;
    options.file = file;
    options.cells = std::move(cells);
    Result<GridSource> source = GridSource::open(options, listener);
    if (!source) return source.error();
    return source->read({}, 0, listener);
}

Grid chosen(const std::string& file, std::vector<std::string> cells) {
    Listener listener;
    return read_chosen(file, std::move(cells), listener).value();
}

std::string refused(const std::string& file, std::vector<std::string> cells) {
    Listener listener;
    const Result<Grid> grid = read_chosen(file, std::move(cells), listener);
    if (grid) return "";
    EXPECT_EQ(grid.error().code, ErrorCode::invalid_argument);
    return grid.error().message;
}

std::vector<bool> kept(const Grid& grid) {
    std::vector<bool> flags(grid.cells.count(), true);
    for (std::size_t cell = 0; cell < flags.size() && !grid.cells.types.empty(); ++cell)
        flags[cell] = grid.cells.types.as<std::uint8_t>()[cell] != 0;
    return flags;
}

Surface surface_of(const std::string& file, std::vector<std::string> cells, Listener& listener,
                   std::optional<Method> method = {}) {
    const test::TemporaryFolder folder;
    ExtractJob job;
    job.grid.file = file;
    job.grid.cells = std::move(cells);
    job.out = folder.file("out.vtp");
    job.field.name = "sphere";
    job.isovalues = {0.5};
    job.contour.method = method;
    job.contour.source_cells = true;
    EXPECT_TRUE(extract_files(job, listener));
    return read_surface(job.out).value().surface;
}

std::vector<std::int64_t> cells_of(const Surface& surface) {
    const auto cells = surface.source_cells.as<std::int64_t>();
    return {cells.begin(), cells.end()};
}

class ChosenCellsOf : public testing::TestWithParam<const char*> {};

TEST_P(ChosenCellsOf, AllNumbersAreTheWholeGrid) {
    const test::TemporaryFolder folder;
    const std::string file = written(folder, layered(GetParam()));
    Listener listener;
    const Surface whole = surface_of(file, {}, listener);
    for (const char* all : {"layer=0,1,2", "layer=0:2", "layer=0:", "layer=:1,2"}) {
        const Surface same = surface_of(file, {all}, listener);
        ASSERT_EQ(same.positions.bytes(), whole.positions.bytes()) << all;
        EXPECT_EQ(std::memcmp(same.positions.data(), whole.positions.data(), whole.positions.bytes()), 0) << all;
        EXPECT_EQ(cells_of(same), cells_of(whole)) << all;
    }
}

/// Faces that the choice opens are rough: points beside them are no hanging ones.
TEST(ChosenCells, OpenNoFacesOnWhichPointsHang) {
    constexpr std::uint64_t side = 16;
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    Grid grid = test::made_grid("kuhn", side, {"gyroid"});
    std::mt19937 random(3);
    const auto share = [&] { return static_cast<float>(random() % 1000) / 1000; };
    const auto places = grid.points.as<float>();
    const auto [lower, upper] = std::ranges::minmax(places);
    std::vector<float> moved(places.begin(), places.end()), part(grid.cells.count());
    for (float& place : moved) place += 0.4F * (share() - 0.5F) * (upper - lower) / side;
    for (float& value : part) value = share();
    grid.points = Array::own(std::move(moved), 3);
    grid.cell_fields = {{"part", Array::own(std::move(part))}};
    ASSERT_TRUE(write_grid(grid, file));
    Listener listener;
    ASSERT_TRUE(read_chosen(file, {"part=:0.5"}, listener));
    EXPECT_EQ(listener.noted.size(), 1U); // how many are chosen
}

/// Source cells are those of the whole grid, whatever method makes the surface.
TEST_P(ChosenCellsOf, DisjointChoicesMakeUpTheSurface) {
    const test::TemporaryFolder folder;
    const std::string file = written(folder, layered(GetParam()));
    for (const std::optional<Method> method : {std::optional<Method>(), {Method::direct}, {Method::clusters}}) {
        Listener listener;
        std::vector<std::int64_t> whole = cells_of(surface_of(file, {}, listener, method)), parts;
        for (const char* choice : {"layer=0", "!layer=0,2", "layer=2:9"}) {
            const auto some = cells_of(surface_of(file, {choice}, listener, method));
            EXPECT_FALSE(some.empty());
            EXPECT_LT(some.size(), whole.size());
            parts.insert(parts.end(), some.begin(), some.end());
        }
        std::ranges::sort(whole);
        std::ranges::sort(parts);
        EXPECT_EQ(parts, whole);
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ChosenCellsOf, testing::Values("kuhn", "mixed"),
                         [](const auto& shape) { return std::string(shape.param); });

TEST(ChosenCells, HaveTheFacesBetweenRegionsAsBoundary) {
    const test::TemporaryFolder folder;
    const std::string file = written(folder, layered("kuhn", 4, 2));
    EXPECT_EQ(boundary_of(chosen(file, {})).value().triangle_count(), 6u * 32);
    EXPECT_EQ(boundary_of(chosen(file, {"layer=1"})).value().triangle_count(), 2u * 32 + 4 * 16);
}

TEST(ChosenCells, OfAGridThatWasReadAreThoseOfReadingIt) {
    const test::TemporaryFolder folder;
    GridOptions options;
    options.file = written(folder, layered("mixed"));
    Listener listener;
    const GridSource source = GridSource::open(options, listener).value();
    const Grid whole = source.read({}, 0, listener).value();
    const Grid some = source.only_cells(whole, {"!layer=0", "tenth=:0.15"}, {}).value();
    EXPECT_EQ(kept(some), kept(chosen(options.file, {"layer=1"})));
    EXPECT_FALSE(source.only_cells(whole, {"layer=7"}, {}));
    EXPECT_FALSE(source.only_cells(whole, {"depth=1"}, {}));
    EXPECT_FALSE(source.only_cells(whole, {"layer=sand"}, {}));
    EXPECT_TRUE(source.only_cells(whole, {"layer=sand"}, {{"layer", 2, "sand"}}));
}

TEST(ChosenCells, HaveTheValuesOfTheirPointsAlone) {
    const test::TemporaryFolder folder;
    Grid grid = layered("kuhn");
    grid.point_fields.push_back({"count", Array::own(std::vector<std::int32_t>(grid.points.tuples(), 7))});
    const Grid some = chosen(written(folder, grid), {"layer=1"});
    std::vector<std::uint8_t> used(some.points.tuples());
    for (std::size_t cell = 0; cell < some.cells.count(); ++cell)
        for (std::size_t k = 4 * cell; some.cells.types.at(cell) != 0 && k < 4 * cell + 4; ++k)
            used[static_cast<std::size_t>(some.cells.connectivity.at(k))] = 1;
    EXPECT_NE(std::ranges::count(used, 0), 0);
    for (std::size_t point = 0; point < used.size(); ++point) {
        const double value = some.point_fields[0].values.at(point);
        EXPECT_EQ(std::isnan(value), used[point] == 0);
        if (used[point]) {
            EXPECT_EQ(value, grid.point_fields[0].values.at(point));
        }
        EXPECT_EQ(some.point_fields.back().values.at(point), 7);
    }
}

TEST(ChosenCells, OfPolyhedraHaveTheValuesOfTheirPointsAlone) {
    const test::TemporaryFolder folder;
    const Grid some = chosen(written(folder, layered("kelvin")), {"layer=1"});
    std::vector<std::uint8_t> used(some.points.tuples());
    for (std::size_t cell = 0; cell < some.cells.count(); ++cell)
        for (auto k = static_cast<std::size_t>(some.cells.offsets.at(cell));
             some.cells.types.at(cell) != 0 && k < static_cast<std::size_t>(some.cells.offsets.at(cell + 1)); ++k)
            used[static_cast<std::size_t>(some.cells.connectivity.at(k))] = 1;
    EXPECT_NE(std::ranges::count(used, 0), 0);
    for (std::size_t point = 0; point < used.size(); ++point)
        EXPECT_EQ(std::isnan(some.point_fields[0].values.at(point)), used[point] == 0) << point;
}

TEST(ChosenCells, LeaveAllNumbersAsTheyAre) {
    const test::TemporaryFolder folder;
    const std::string file = written(folder, layered("mixed"));
    const Grid whole = chosen(file, {}), some = chosen(file, {"layer=1"});
    EXPECT_EQ(some.points.tuples(), whole.points.tuples());
    ASSERT_EQ(some.cells.count(), whole.cells.count());
    for (std::size_t cell = 0; cell < some.cells.count(); ++cell)
        EXPECT_EQ(some.cells.types.at(cell),
                  whole.cell_fields[0].values.at(cell) == 1 ? whole.cells.types.at(cell) : 0);
    ASSERT_EQ(some.cell_fields.size(), whole.cell_fields.size());
    EXPECT_EQ(some.cell_fields[0].values.bytes(), whole.cell_fields[0].values.bytes());
}

TEST(ChosenCells, AreInAllChoices) {
    const test::TemporaryFolder folder;
    const std::string file = written(folder, layered("kuhn"));
    EXPECT_EQ(kept(chosen(file, {"layer=1:", "!layer=2"})), kept(chosen(file, {"layer=1"})));
    EXPECT_EQ(kept(chosen(file, {"tenth=0.1"})), kept(chosen(file, {"layer=1"}))) << "0.1 as the field's float";
    EXPECT_EQ(kept(chosen(file, {"tenth=0.05:0.25"})), kept(chosen(file, {"layer=1,2"})));
}

TEST(ChosenCells, AreToldOfWithoutEmptyCells) {
    const test::TemporaryFolder folder;
    ExtractJob job;
    job.grid.file = written(folder, layered("kuhn"));
    job.grid.cells = {"layer=1", "tenth=:0.2"};
    job.field.name = "sphere";
    job.isovalues = {0.5};
    Listener listener;
    EXPECT_EQ(extract_files(job, listener).value().cells_left_out, 0u);
    EXPECT_EQ(listener.noted, std::vector<std::string>{"432 of 1,296 cells are in layer=1 and tenth=:0.2"});
    ClipJob clip;
    clip.grid = job.grid;
    clip.field.name = "sphere";
    clip.range = SolidRange::above(0.5);
    EXPECT_EQ(clip_files(clip, listener).value().cells_left_out, 0u);
    InfoJob look;
    look.grid = job.grid;
    EXPECT_EQ(look_into(look, listener).value().report.cells_left_out, 0u);
}

TEST(ChosenCells, RefuseWhatTheGridDoesNotHave) {
    const test::TemporaryFolder folder;
    Grid grid = layered("kuhn");
    grid.cell_fields.push_back({"u", Array::own(std::vector<float>(2 * grid.cells.count()), 2)});
    const std::string file = written(folder, grid);
    EXPECT_EQ(refused(file, {"layer"}),
              "`cells` got 'layer', but takes FIELD=NUMBERS, such as region=2,5, or FIELD=A:B");
    EXPECT_EQ(refused(file, {"layr=1"}),
              "`cells` got 'layr=1', but there is no cell field 'layr': the grid has 'layer', 'u', 'tenth'");
    EXPECT_EQ(refused(file, {"layer=7"}), "`cells` got 'layer=7', but no cell has 7: 'layer' has 0, 1, 2");
    EXPECT_EQ(refused(file, {"layer=1,sand"}),
              "`cells` got 'layer=1,sand', but 'sand' is no number, no range A:B that ascends and no region: the file "
              "names none of 'layer'");
    EXPECT_NE(refused(file, {"layer=2:1"}), "");
    EXPECT_NE(refused(file, {"layer=:nan"}), "");
    EXPECT_NE(refused(file, {"layer=1,"}), "");
    EXPECT_EQ(refused(file, {"layer=1", "layer=2"}), "`cells`: none of 1,296 cells is in layer=1 and layer=2");
    EXPECT_EQ(refused(file, {"!layer=0:2"}), "`cells`: none of 1,296 cells is in !layer=0:2");
    EXPECT_NE(refused(file, {"u=1"}).find("'u' has 2 components"), std::string::npos);
    EXPECT_NE(refused("make:kuhn:2", {"layer=1"}).find("the grid has none"), std::string::npos);
}

/// The file's triangles have numbers, too: they are left as they are, beside tets that are chosen.
TEST(ChosenCells, OfGmshAreNamedByPhysicalGroups) {
    for (const char* name : {"inclusions_v22_ascii.msh", "inclusions_v41_ascii.msh", "inclusions_v41_binary.msh"}) {
        const std::string file = test::source_folder().string() + "/data/msh/" + name;
        const Grid grid = chosen(file, {"gmsh:physical=inclusions"});
        const auto counts = count_cells_by_type(grid.cells), all = count_cells_by_type(chosen(file, {}).cells);
        EXPECT_EQ(counts.at(5), all.at(5)) << name;
        EXPECT_EQ(counts.at(10) + counts.at(0), all.at(10)) << name;
        EXPECT_EQ(kept(grid), kept(chosen(file, {"gmsh:physical=2"}))) << name;
        EXPECT_EQ(count_cells_by_type(chosen(file, {"gmsh:physical=inclusions,domain"}).cells), all) << name;
        EXPECT_NE(refused(file, {"gmsh:physical=inclusion"}).find("the file has 'inclusions', 'domain'"),
                  std::string::npos);
        const auto triangles = count_cells_by_type(chosen(file, {"gmsh:physical=3"}).cells);
        EXPECT_EQ(triangles.at(5), all.at(5)) << "of which there are no tets";
        EXPECT_EQ(triangles.at(0), all.at(10)) << name;
    }
}

TEST(ChosenCells, OfGocadAreNamedByVolumes) {
    const std::string file = test::source_folder().string() + "/data/gocad/geomodel3d_tsolid.so";
    EXPECT_EQ(kept(chosen(file, {"tvolume=Region_2,h1_model1_1"})), kept(chosen(file, {"tvolume=0,3"})));
    EXPECT_EQ(kept(chosen(file, {"!tvolume=Region_2"})), kept(chosen(file, {"tvolume=1:"})));
}

TEST(ChosenCells, OfAPackedFileAreThoseOfItsGrid) {
    const test::TemporaryFolder folder;
    PackJob pack;
    pack.grid.file = written(folder, layered("mixed"));
    pack.out = folder.file("grid.isotet");
    pack.fields = {"sphere"};
    pack.cell_fields = {"layer"};
    Listener listener;
    ASSERT_TRUE(pack_file(pack, listener));
    EXPECT_EQ(cells_of(surface_of(pack.out, {"layer=1"}, listener)).size(),
              cells_of(surface_of(pack.grid.file, {"layer=1"}, listener)).size());

    pack.out = folder.file("some.isotet");
    pack.grid.cells = {"layer=1"};
    ASSERT_TRUE(pack_file(pack, listener));
    std::vector<std::int64_t> packed = cells_of(surface_of(pack.out, {}, listener)),
                              direct = cells_of(surface_of(pack.grid.file, {"layer=1"}, listener));
    std::ranges::sort(packed); // of clusters
    std::ranges::sort(direct);
    EXPECT_EQ(packed, direct);
}

/// A step need not have all numbers, but some cell.
TEST(ChosenCells, OfASeriesAreThoseOfEachStep) {
    const test::TemporaryFolder folder;
    Grid grid = layered("kuhn");
    written(folder, grid, "a.vtu");
    std::vector<std::int32_t> moved = layers_of(grid, 3);
    for (std::int32_t& layer : moved) layer = layer == 2 ? 5 : 2 - layer;
    grid.cell_fields[0].values = Array::own(std::move(moved));
    written(folder, grid, "b.vtu");
    ExtractJob job;
    job.grid.file = folder.write("run.pvd", R"(<VTKFile type="Collection"><Collection>
<DataSet timestep="0" file="a.vtu"/><DataSet timestep="1" file="b.vtu"/></Collection></VTKFile>)");
    job.grid.cells = {"layer=0,1"};
    job.field.name = "gyroid";
    job.isovalues = {0.5};
    job.all_steps = true;
    job.out = folder.file("out-{step}.vtp");
    job.contour.source_cells = true;
    Listener listener;
    ASSERT_TRUE(extract_files(job, listener));
    for (const char* step : {"0", "1"}) {
        const Grid read = isotet::read(folder.file(*step == '0' ? "a.vtu" : "b.vtu"), {}).value().grid;
        for (const std::int64_t cell :
             cells_of(read_surface(folder.file("out-" + std::string(step) + ".vtp")).value().surface))
            EXPECT_LE(read.cell_fields[0].values.at(static_cast<std::size_t>(cell)), 1) << step;
    }
    EXPECT_NE(std::ranges::find(listener.noted, "`cells` got 'layer=0,1', but no cell has 0: 'layer' has 1, 2, 5"),
              listener.noted.end());
    job.grid.cells = {"layer=0"};
    EXPECT_FALSE(extract_files(job, listener)) << "nothing is left of step 1";
}

TEST(ChosenCells, KeepTheColoursOfTheirClasses) {
    const test::TemporaryFolder folder;
    const std::string file = written(folder, layered("mixed"));
    const ColorField whole = find_colors(chosen(file, {}), "layer").value().field;
    const ColorField some = find_colors(chosen(file, {"layer=2"}), "layer").value().field;
    EXPECT_EQ(some.classes, whole.classes);
    EXPECT_EQ(some.scale.lower, whole.scale.lower);
    EXPECT_EQ(some.scale.upper, whole.scale.upper);
    const std::string gmsh = test::source_folder().string() + "/data/msh/inclusions_v41_ascii.msh";
    EXPECT_EQ(find_colors(chosen(gmsh, {"gmsh:physical=2"}), "gmsh:physical").value().field.classes,
              find_colors(chosen(gmsh, {}), "gmsh:physical").value().field.classes);
}

/// The field that chooses is not one that is drawn.
TEST(ChosenCells, AreDrawn) {
    const test::TemporaryFolder folder;
    DrawJob job;
    job.grid.file = written(folder, layered("kuhn"));
    job.grid.cells = {"layer=1"};
    job.field.name = "sphere";
    job.isovalues = {0.5};
    job.picture.width = 160;
    job.picture.height = 120;
    job.boundary = 0;
    job.out = folder.file("a.png");
    Listener listener;
    const DrawReport some = draw_files(job, listener).value();
    job.grid.cells = {};
    const DrawReport whole = draw_files(job, listener).value();
    EXPECT_LT(some.input.scene->surfaces().at(0).triangles, whole.input.scene->surfaces().at(0).triangles);
    EXPECT_GT(some.input.scene->surfaces().at(0).triangles, 0u);
}

/// As multi-block data of grids, with a name each.
std::string blocks_of(const test::TemporaryFolder& folder, const std::vector<std::string>& names) {
    std::string sets;
    for (std::size_t i = 0; i < names.size(); ++i) {
        written(folder, layered(i % 2 == 0 ? "kuhn" : "mixed"), names[i] + ".vtu");
        sets +=
            "<DataSet index=\"" + std::to_string(i) + "\" name=\"" + names[i] + "\" file=\"" + names[i] + ".vtu\"/>";
    }
    return folder.write("blocks.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>" +
                                          sets + "</vtkMultiBlockDataSet></VTKFile>");
}

TEST(BlockChoice, PassesOverFieldsThatOtherBlocksHave) {
    const test::TemporaryFolder folder;
    Grid solid = layered("kuhn"), fluid = layered("kuhn");
    const Array values = solid.point_fields.at(0).values;
    solid.point_fields = {{"heat", values}};
    solid.cell_fields.clear();
    fluid.point_fields = {{"u_x", values}, {"u_y", values}, {"u_z", values}};
    fluid.cell_fields = {{"heat", Array::own(std::vector<float>(fluid.cells.count(), 1))}};
    written(folder, solid, "solid.vtu");
    written(folder, fluid, "fluid.vtu");
    const std::string file = folder.write(
        "two.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>"
                   "<DataSet index=\"0\" name=\"solid\" file=\"solid.vtu\"/><DataSet index=\"1\" name=\"fluid\" "
                   "file=\"fluid.vtu\"/></vtkMultiBlockDataSet></VTKFile>");
    Listener listener;
    for (const char* field : {"heat", ""}) {
        ExtractJob job;
        job.grid.file = file;
        job.grid.blocks = {"solid"};
        job.field.name = field;
        job.isovalues = {values.at(values.tuples() / 2)};
        job.out = folder.file("a.vtp");
        const auto extracted = extract_files(job, listener);
        ASSERT_TRUE(extracted) << field << ": " << extracted.error().message;
        EXPECT_EQ(extracted->cells, solid.cells.count());
        job.field.name = "u_x";
        EXPECT_EQ(extract_files(job, listener).error().message, "the field 'u_x' is in no block that was chosen");
    }
    PackJob pack;
    pack.grid.file = file;
    pack.grid.blocks = {"solid"};
    pack.out = folder.file("solid.isotet");
    ASSERT_TRUE(pack_file(pack, listener)) << "the other fields are left out";
    const PackedFile packed = PackedFile::open(pack.out).value();
    ASSERT_EQ(packed.info().fields.size(), 1u);
    EXPECT_EQ(packed.info().fields[0].report.name, "heat");
}

FieldsToRead with_blocks() { return {std::vector<std::string>{}, std::vector<std::string>{"block"}}; }

/// Corners of all cells of a number, as coordinates of x.
std::vector<double> corners_of(const Grid& grid, std::int64_t number) {
    std::vector<double> corners;
    const Field& blocks = grid.cell_fields.at(0);
    const std::size_t width = grid.cells.connectivity.size() / grid.cells.count(); // of cells of one type
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        if (blocks.values.at(cell) != static_cast<double>(number)) continue;
        const auto at = [&](std::size_t i) {
            return grid.cells.offsets.empty() ? width * i : static_cast<std::size_t>(grid.cells.offsets.at(i));
        };
        for (std::size_t i = at(cell); i < at(cell + 1); ++i)
            corners.push_back(grid.points.at(static_cast<std::size_t>(grid.cells.connectivity.at(i)), 0));
    }
    return corners;
}

TEST(BlockField, HasTheCellsThatEachBlockHasAlone) {
    const test::TemporaryFolder folder;
    Listener listener;
    GridOptions options;
    for (const std::string& file : {blocks_of(folder, {"rotor", "hub", "blade"}),
                                    test::source_folder().string() + "/data/exodus/mixed_blocks_hdf5.exo"}) {
        if (!test::is_read_here(file)) continue;
        options.file = file;
        options.keep_pieces = true; // blocks lie on one another
        options.hanging_points = HangingChoice::not_sought;
        const GridSource source = GridSource::open(options, listener).value();
        ASSERT_GT(source.info().blocks.size(), 1u) << file;
        EXPECT_EQ(source.cell_names().back(), "block");
        const Grid grid = source.read(with_blocks(), 0, listener).value();
        ASSERT_EQ(grid.cell_fields.size(), 1u);
        std::size_t all = 0;
        for (const BlockInfo& block : source.info().blocks) {
            Grid alone = source.read_block(block, 0, listener).value();
            alone.cell_fields = {{"block", Array::own(std::vector<std::int64_t>(alone.cells.count(), block.number))}};
            EXPECT_EQ(corners_of(grid, block.number), corners_of(alone, block.number)) << file << " " << block.number;
            all += alone.cells.count();
        }
        EXPECT_EQ(all, grid.cells.count());
        EXPECT_TRUE(std::ranges::none_of(source.read({}, 0, listener).value().cell_fields, [](const Field& field) {
            return field.name == "block";
        })) << "only where it is asked for";
    }
}

TEST(BlockField, ChoosesCellsAndColoursByName) {
    const test::TemporaryFolder folder;
    Listener listener;
    GridOptions options;
    options.file = blocks_of(folder, {"rotor", "hub"});
    options.keep_pieces = true;
    const std::size_t cells = GridSource::open(options, listener).value().info().blocks.at(1).cells;
    options.cells = {"!block=rotor"};
    const GridSource source = GridSource::open(options, listener).value();
    const Grid grid = source.read({}, 0, listener).value();
    const auto counts = count_cells_by_type(grid.cells);
    EXPECT_EQ(grid.cells.count() - counts.at(0), cells);
    EXPECT_EQ(grid.cell_fields.size(), 2u) << "the field that chooses is not read by it";
    GridOptions by_number = options;
    by_number.file = blocks_of(folder, {"2", "1"}); // the names of the other ones' numbers
    for (const char* name : {"1", "2"}) {
        by_number.cells = {std::string("block=") + name};
        const Grid one = GridSource::open(by_number, listener)->read({}, 0, listener).value();
        EXPECT_EQ(one.cells.types.at(0) == 0, std::string(name) == "1") << "names come before numbers";
    }
    options.cells = {"block=stator"};
    EXPECT_FALSE(GridSource::open(options, listener));
    DrawJob job;
    job.grid.file = options.file;
    job.boundary_color_by = "block";
    job.picture.width = 80;
    job.picture.height = 60;
    job.out = folder.file("a.png");
    const DrawReport drawn = draw_files(job, listener).value();
    ASSERT_TRUE(drawn.input.scene);
    options.cells = {};
    options.file = written(folder, layered("kuhn"), "one.vtu");
    EXPECT_EQ(GridSource::open(options, listener).value().cell_names(), (std::vector<std::string>{"layer", "tenth"}));
}

} // namespace
} // namespace isotet::jobs
