// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "jobs/step_choice.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

GridSource open(const GridOptions& options, Listener& listener) { return GridSource::open(options, listener).value(); }

GridOptions made(const std::string& what) {
    GridOptions options;
    options.file = "make:" + what;
    return options;
}

TEST(GridSource, TellsFieldsBeforeAnythingIsRead) {
    Listener listener;
    const GridSource source = open(made("kuhn:4:sphere,integer"), listener);
    EXPECT_EQ(source.names(Association::point), (std::vector<std::string>{"sphere", "integer"}));
    EXPECT_TRUE(source.names(Association::cell).empty());
    const Error error = source.no_such_field("spere");
    EXPECT_EQ(error.message, "there is no field 'spere': the grid has 'sphere', 'integer'") << "the nearest first";
}

TEST(GridSource, ReadsOnlyTheFieldsAskedFor) {
    Listener listener;
    const GridSource source = open(made("kuhn:4:sphere,gyroid"), listener);
    const Grid grid = source.read({{{"gyroid"}}, {}}, 0, listener).value();
    ASSERT_EQ(grid.point_fields.size(), 1u);
    EXPECT_EQ(grid.point_fields[0].name, "gyroid");
    EXPECT_EQ(source.read({}, 0, listener).value().point_fields.size(), 2u);
}

/// Two steps of blocks, of which the second has one more.
std::string growing(const test::TemporaryFolder& folder) {
    for (const char* name : {"solid", "fluid"})
        write_grid(make_grid({.shape = "kuhn", .side = 3, .fields = {"sphere"}}).value(),
                   folder.file(std::string(name) + ".vtu"))
            .value();
    const auto blocks = [&](const char* file, const std::string& sets) {
        folder.write(file, "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>" + sets +
                               "</vtkMultiBlockDataSet></VTKFile>");
    };
    const std::string solid = "<DataSet index=\"0\" name=\"solid\" file=\"solid.vtu\"/>";
    blocks("0.vtm", solid);
    blocks("1.vtm", solid + "<DataSet index=\"1\" name=\"fluid\" file=\"fluid.vtu\"/>");
    return folder.write("run.pvd", R"(<VTKFile type="Collection"><Collection>
<DataSet timestep="0" file="0.vtm"/><DataSet timestep="0.5" file="1.vtm"/></Collection></VTKFile>)");
}

TEST(GridSource, FindsABlockInTheStepOfATime) {
    const test::TemporaryFolder folder;
    GridOptions options;
    options.file = growing(folder);
    options.blocks = {"fluid"};
    options.time = 0.5;
    Listener listener;
    EXPECT_EQ(open(options, listener).read({}, 1, listener).value().cells.count(), 162u);
}

/// Two tets with a face in common, whose points are there twice.
std::string torn(const test::TemporaryFolder& folder) {
    return folder.write("torn.vtk", R"(# vtk DataFile Version 3.0
two tets
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 8 float
0 0 0 1 0 0 0 1 0 0 0 1
0 0 0 1 0 0 0 1 0 0 0 -1
CELLS 2 10
4 0 1 2 3
4 4 5 6 7
CELL_TYPES 2
10
10
POINT_DATA 8
SCALARS t float 1
LOOKUP_TABLE default
0 1 2 3 0.5 1 2 4
)");
}

TEST(GridSource, NotesPointsThatCoincideAndMergesThem) {
    const test::TemporaryFolder folder;
    GridOptions options;
    options.file = torn(folder);
    Listener apart;
    EXPECT_EQ(open(options, apart).read({}, 0, apart)->points.tuples(), 8u);
    ASSERT_EQ(apart.noted.size(), 1u);
    EXPECT_NE(apart.noted[0].find("3 points coincide with other points"), std::string::npos) << apart.noted[0];
    EXPECT_NE(apart.noted[0].find("`merge_points` 1e-6 joins them"), std::string::npos) << apart.noted[0];

    Listener joined;
    options.merge_points = 0;
    const Grid grid = open(options, joined).read({}, 0, joined).value();
    EXPECT_EQ(grid.cells.connectivity.visit([](auto numbers) { return static_cast<int>(numbers[4]); }), 0);
    ASSERT_EQ(joined.noted.size(), 2u);
    EXPECT_EQ(joined.noted[0], "3 points were merged with others");
    EXPECT_EQ(joined.noted[1], "values of merged points differ: 't' by up to 0.5; they have that of the lowest "
                               "number, `merge_values` mean takes means");
}

/// As discontinuous elements are written, each computed by itself.
TEST(GridSource, NotesPointsApartByRoundingWhereCellsStayInTheFile) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "kuhn", .side = 6}).value();
    std::vector<double> points, values;
    std::vector<std::int32_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.tuples(); ++i) {
        const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(i));
        corners.push_back(static_cast<std::int32_t>(i));
        values.push_back(grid.points.at(point, 0));
        for (std::size_t axis = 0; axis < 3; ++axis)
            points.push_back(grid.points.at(point, axis) + 1e-9 * std::sin(static_cast<double>(3 * i + axis)));
    }
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.point_fields = {{"u", Array::own(std::move(values))}};
    GridOptions options;
    options.file = folder.file("a.vtu");
    ASSERT_TRUE(write_grid(grid, options.file));
    Listener listener;
    const GridSource source = open(options, listener);
    ReadActiveCells active;
    active.field = "u";
    active.isovalues = {0.1};
    const auto read =
        source.read_active({std::vector<std::string>{"u"}, std::vector<std::string>{}}, 0, active, listener);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_EQ(
        listener.noted[0].substr(listener.noted[0].find("points lie")),
        "points lie up to 2.5e-09 beside other points: the surface has seams there; `merge_points` 1e-8 joins them");
}

TEST(GridSource, RefusesWhatTheGridDoesNotHave) {
    const test::TemporaryFolder folder;
    Listener listener;
    GridOptions options = made("kuhn:2");
    options.blocks = {"a"};
    EXPECT_EQ(GridSource::open(options, listener).error().message, "`block` a: a made grid has no blocks");
    options = {};
    options.file = torn(folder);
    options.displace = "u";
    EXPECT_NE(GridSource::open(options, listener).error().message.find("`displace` takes a point field"),
              std::string::npos);
    options.file = folder.file("none.vtu");
    EXPECT_EQ(GridSource::open(options, listener).error().code, ErrorCode::file);
}

TEST(ChooseSteps, TakesOneByTimeOrNumberOrAll) {
    FileInfo info;
    info.times = {0, 0.5, 2};
    Listener listener;
    GridOptions options;
    EXPECT_EQ(choose_steps(info, options, Steps::all, listener).value(), (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_TRUE(listener.noted.empty());
    EXPECT_EQ(choose_steps(info, options, Steps::one, listener).value(), std::vector<std::size_t>{0});
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_NE(listener.noted[0].find("3 time steps: step 0, time 0, was taken"), std::string::npos);
    options.time = 0.5;
    EXPECT_EQ(choose_steps(info, options, Steps::one, listener).value(), std::vector<std::size_t>{1});
    options.time = 0.6;
    EXPECT_NE(choose_steps(info, options, Steps::one, listener).error().message.find("the nearest is 0.5"),
              std::string::npos);
    info.times = {0.0999, static_cast<double>(0.1F), 2};
    options.time = 0.1;
    EXPECT_EQ(choose_steps(info, options, Steps::one, listener).value(), std::vector<std::size_t>{1})
        << "a file of single precision";
    info.times = {0, 1, 2, 1, 2};
    options.time = 1;
    EXPECT_EQ(choose_steps(info, options, Steps::one, listener).value(), std::vector<std::size_t>{3})
        << "a run that was restarted";
    info.times = {0, 0.5, 2};
    options = {};
    options.step = 2;
    EXPECT_EQ(choose_steps(info, options, Steps::one, listener).value(), std::vector<std::size_t>{2});
    options.step = 3;
    EXPECT_FALSE(choose_steps(info, options, Steps::one, listener));
    EXPECT_EQ(choose_steps(FileInfo{}, {}, Steps::all, listener).value(), std::vector<std::size_t>{0});
}

TEST(ChooseField, NeedsANameWhereThereAreSeveral) {
    Listener listener;
    const GridSource two = open(made("kuhn:2:sphere,gyroid"), listener);
    EXPECT_EQ(choose_field(two, {"gyroid", false})->point, std::vector<std::string>{"gyroid"});
    EXPECT_EQ(choose_field(two, {"y", false})->name, "y");
    EXPECT_EQ(choose_field(two, {}).error().message,
              "no field was named, and the grid has 2: 'sphere', 'gyroid'; `field` chooses one");
    EXPECT_FALSE(choose_field(two, {"gyroid", true})) << "no cell field";
    const GridSource one = open(made("kuhn:2:sphere"), listener);
    EXPECT_EQ(choose_field(one, {})->name, "sphere");
}

TEST(ChooseCarried, TakesWholeFieldsComponentsAndLists) {
    Listener listener;
    const GridSource source = open(made("kuhn:2:sphere,gyroid"), listener);
    const CarriedFields carried = choose_carried(source, {"sphere,x", "gyroid", ""}).value();
    EXPECT_EQ(carried.point, (std::vector<std::string>{"sphere", "gyroid"}));
    ASSERT_EQ(carried.components.size(), 1u);
    EXPECT_EQ(carried.components[0].name, "x");
    EXPECT_FALSE(choose_carried(source, {"sphere,nothing"}));
}

TEST(ReadField, TakesTheFieldThatIsShownFirst) {
    Listener listener;
    const GridSource source = open(made("kuhn:4:sphere,plane"), listener);
    Grid grid;
    const PointField field = read_field(source, 0, {}, {}, listener, grid).value();
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_EQ(listener.noted[0], "no field was named: '" + field.name + "' was taken; `field` names another");
}

} // namespace
} // namespace isotet::jobs
