// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which field and step are shown first: a table of files with what a person would choose, and the rule for steps.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "jobs/read_here.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;
using Names = std::vector<std::string>;
using enum FirstDraw;

/// What a person would look at: any of these fields; none: the grid itself.
struct Wanted {
    Names fields;
    FirstDraw draw;
};

struct RealFile {
    const char* path; ///< below data/
    Wanted wanted;
};

const std::vector<RealFile>& real_files() {
    static const std::vector<RealFile> files = {
        {"vtu/artery_flow_tet_wedge.vtu", {{"Umag"}, isosurfaces}},
        {"vtu/wall_distance_point.vtu", {{"wallDistance"}, isosurfaces}},
        {"vtu/two_phase_box_tets_dup_points.vtu", {{"S_aq"}, isosurfaces}},
        {"vtu/patch_antenna_efield.vtu", {{"ElectricField"}, field_on_boundary}},
        {"vtu/stokes_channel_tets.vtu", {{"p"}, isosurfaces}},
        {"vtu/quadratic_tets_96.vtu", {{"Polynomial", "DistanceToCenter"}, isosurfaces}},
        {"vtu/all_dims_tets_lzma.vtu", {{}, boundary}},
        {"vtu/polyhedron_two_pieces.vtu", {{}, boundary}},
        {"pvtu/monodomain/monodomain3d.pvtu", {{"V_*"}, isosurfaces}},
        {"vtk/lox_post_pressure.vtk", {{"Pressure"}, isosurfaces}},
        {"vtk/lox_post_no_data.vtk", {{"Pressure"}, isosurfaces}},
        {"vtk/tetra_mixed_orientation_int.vtk", {{"scalars"}, isosurfaces}},
        {"vtk/ugridex_all_kinds.vtk", {{"scalars", "vectors:mag"}, isosurfaces}},
        {"msh/inclusions_v22_ascii.msh", {{"gmsh:physical"}, regions_on_boundary}},
        {"msh/inclusions_v41_ascii.msh", {{"gmsh:physical"}, regions_on_boundary}},
        {"msh/inclusions_v41_binary.msh", {{"gmsh:physical"}, regions_on_boundary}},
        {"medit/cube_sphere_26k.meshb", {{"medit:ref"}, regions_on_boundary}},
        {"tetgen/ellipsoid_16k.node", {{}, boundary}},
        {"gocad/geomodel3d_tsolid.so", {{"tvolume"}, regions_on_boundary}},
        {"exodus/tension_tets_stress_3steps.e", {{"disp_:mag", "nodal_Cauchy_Stress_1"}, isosurfaces}},
        {"exodus/mixed_blocks_hdf5.exo", {{}, boundary}},
        {"cgns/wall_distance_adf.cgns", {{"wallDistance"}, isosurfaces}},
        {"cgns/wall_distance_hdf5.cgns", {{"wallDistance"}, isosurfaces}},
        {"vtkhdf/can_hex.hdf", {{"VEL:mag", "EQPS", "DISPL:mag"}, isosurfaces}},
        {"avs_ucd/tet_attributes.inp", {{"imt1"}, regions_on_boundary}},
        {"xdmf/no_checkpoint.xdmf", {{"f_5"}, isosurfaces}},
        {"xdmf/tet4_vertex.xmf", {{"pressure", "displacement:mag"}, isosurfaces}},
    };
    return files;
}

enum class Values : std::uint8_t { smooth, other, constant, noise, counting, halves };

struct MadeField {
    const char* name;
    Values values = Values::smooth;
    std::size_t components = 1;
    Association association = Association::point;
};

/// What programs write, by the names that they give.
struct MadeFile {
    const char* what;
    std::vector<MadeField> fields;
    Wanted wanted;
};

constexpr Association cell = Association::cell;

const std::vector<MadeFile>& made_files() {
    using enum Values;
    static const std::vector<MadeFile> files = {
        {"interFoam",
         {{"p"}, {"p_rgh", other}, {"U", smooth, 3}, {"alpha.water", other}, {"cellID", counting, 1, cell}},
         {{"alpha.water"}, isosurfaces}},
        {"buoyantFoam", {{"U", smooth, 3}, {"T"}, {"p"}, {"k"}, {"epsilon"}, {"nut"}}, {{"T"}, isosurfaces}},
        {"simpleFoam", {{"p"}, {"nut", noise}, {"U", smooth, 3}}, {{"U:mag"}, isosurfaces}},
        {"a CGNS flow",
         {{"Density"}, {"VelocityX"}, {"VelocityY"}, {"VelocityZ", other}, {"Pressure"}},
         {{"Velocity:mag"}, isosurfaces}},
        {"an Exodus solid",
         {{"nodal_weights", noise}, {"disp_x"}, {"disp_y"}, {"disp_z", other}, {"vonmises", other}},
         {{"vonmises"}, isosurfaces}},
        {"heat over ids",
         {{"GLOBAL_IDS_POINTS", counting}, {"vtkOriginalCellIds", counting, 1, cell}, {"temp"}},
         {{"temp"}, isosurfaces}},
        {"errors beside",
         {{"flux-err"}, {"element_size", other}, {"barycenter", smooth, 3}, {"diffused"}},
         {{"diffused"}, isosurfaces}},
        {"pressure in cells",
         {{"elementCenter", smooth, 3, cell}, {"pressure", smooth, 1, cell}},
         {{"pressure"}, isosurfaces}},
        {"a mesh with materials",
         {{"material", halves, 1, cell}, {"elem", counting, 1, cell}},
         {{"material"}, regions_on_boundary}},
        {"a partitioned mesh", {{"ProcRank", halves, 1, cell}, {"GlobalNodeId", counting}}, {{}, boundary}},
        {"porosity by cells", {{"PORO", noise, 1, cell}, {"ACTNUM", constant, 1, cell}}, {{"PORO"}, field_on_boundary}},
        {"unnamed noise", {{"random", noise}, {"phi2", smooth}}, {{"phi2"}, isosurfaces}},
        {"all constant", {{"T", constant}, {"p", constant}}, {{}, boundary}},
        {"constant temperature", {{"T", constant}, {"c", smooth}, {"rate", other}}, {{"c"}, isosurfaces}},
        {"a level set", {{"gradient", smooth, 3}, {"levelset"}, {"curvature", noise}}, {{"levelset"}, isosurfaces}},
        {"a reservoir",
         {{"FIPNUM", halves, 1, cell},
          {"PRESSURE", smooth, 1, cell},
          {"SWAT", smooth, 1, cell},
          {"PERMX", noise, 1, cell}},
         {{"SWAT", "PRESSURE"}, isosurfaces}},
        {"a scan", {{"labels", halves, 1, cell}, {"HU", smooth}}, {{"HU"}, isosurfaces}},
    };
    return files;
}

Array made_values(const MadeField& field, const Grid& grid) {
    const std::size_t tuples = field.association == Association::point ? grid.points.tuples() : grid.cells.count();
    const auto place = [&](std::size_t tuple, std::size_t axis) {
        if (field.association == Association::point) return grid.points.at(tuple, axis);
        return grid.points.at(static_cast<std::size_t>(grid.cells.connectivity.at(4 * tuple)), axis);
    };
    std::vector<double> values;
    std::uint64_t state = 7;
    for (std::size_t i = 0; i < tuples; ++i)
        for (std::size_t c = 0; c < field.components; ++c) {
            const double x = place(i, c), y = place(i, (c + 1) % 3);
            state = state * 6364136223846793005U + 1442695040888963407U;
            switch (field.values) {
            case Values::smooth: values.push_back(300 + 7 * x + 2 * y * y); break;
            case Values::other: values.push_back(x * y + 0.01 * x); break;
            case Values::constant: values.push_back(101325); break;
            case Values::noise: values.push_back(static_cast<double>(state >> 40U) / 3); break;
            case Values::counting: values.push_back(static_cast<double>(i + 1)); break;
            case Values::halves: values.push_back(i < tuples / 2 ? 1 : 4); break;
            }
        }
    return Array::own(std::move(values), field.components);
}

std::string write_made(const MadeFile& file, const std::string& path) {
    Grid grid = make_grid({.shape = "kuhn", .side = 7}).value();
    grid.point_fields.clear();
    for (const MadeField& field : file.fields)
        (field.association == Association::point ? grid.point_fields : grid.cell_fields)
            .push_back({field.name, made_values(field, grid)});
    EXPECT_TRUE(write_grid(grid, path));
    return path;
}

FirstView shown_first(const std::string& path) {
    Listener listener;
    GridOptions options;
    options.file = path;
    Result<GridSource> source = GridSource::open(options, listener);
    EXPECT_TRUE(source) << source.error().message;
    const FirstView view = choose_first(*source, options, {}, listener, listener.run()).value().view;
    ChoiceWish all_at_once;
    all_at_once.also = {};
    GridSource again = GridSource::open(options, listener).value();
    const FirstView same = choose_first(again, options, all_at_once, listener, listener.run()).value().view;
    EXPECT_EQ(view.field, same.field) << path << ": whatever is read at once";
    EXPECT_EQ(view.draw, same.draw) << path;
    return view;
}

bool is_right(const FirstView& view, const Wanted& wanted) {
    const auto is_it = [&](const std::string& name) {
        return name.ends_with('*') ? view.field.starts_with(name.substr(0, name.size() - 1)) : view.field == name;
    };
    return wanted.fields.empty() ? view.field.empty() : std::ranges::any_of(wanted.fields, is_it);
}

TEST(FirstChoice, IsThatOfAPersonForNearlyAllFiles) {
    const test::TemporaryFolder folder;
    std::size_t right = 0, all = 0;
    Names wrong;
    const auto look = [&](const std::string& what, const std::string& path, const Wanted& wanted) {
        const FirstView view = shown_first(path);
        ++all;
        if (is_right(view, wanted) && view.draw == wanted.draw) ++right;
        else
            wrong.push_back(fmt::format("{}: '{}' drawn as {}, a person would take {}", what, view.field,
                                        static_cast<int>(view.draw), fmt::join(wanted.fields, " or ")));
    };
    for (const RealFile& file : real_files())
        if (test::is_read_here(file.path))
            look(file.path, test::source_folder().string() + "/data/" + file.path, file.wanted);
    for (const MadeFile& file : made_files()) look(file.what, write_made(file, folder.file("made.vtu")), file.wanted);
    EXPECT_GE(20 * right, 19 * all) << right << " of " << all << " are right:\n"
                                    << fmt::to_string(fmt::join(wrong, "\n"));
    if (test::is_read_here("a.e")) {
        EXPECT_GE(all, 40u);
    }
}

std::string vtu_with(const std::string& name, const std::string& values) {
    return fmt::format(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">"
        "<PointData><DataArray type=\"Float32\" Name=\"{}\" format=\"ascii\">{}</DataArray></PointData>"
        "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>"
        "<Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int32\" "
        "Name=\"offsets\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\">10</DataArray></Cells></Piece>"
        "</UnstructuredGrid></VTKFile>",
        name, values);
}

class FirstStep : public testing::Test {
protected:
    /// A series with these values of T at its steps.
    std::string series(const Names& values) {
        std::string entries;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::string name = fmt::format("s{}.vtu", i);
            folder.write(name, vtu_with("T", values[i]));
            entries += fmt::format("<DataSet timestep='{}' file='{}'/>", 0.5 * static_cast<double>(i), name);
        }
        return folder.write("s.pvd", "<VTKFile type='Collection'><Collection>" + entries + "</Collection></VTKFile>");
    }
    FirstChoice choice_of(const std::string& path, const std::string& field = "") {
        GridOptions options;
        options.file = path;
        GridSource source = GridSource::open(options, listener).value();
        return choose_first(source, options, {Steps::one, {field}, {}}, listener, listener.run()).value();
    }
    test::TemporaryFolder folder;
    Listener listener;
};

const char* const nothing = "0 0 0 0";
const char* const something = "0 1.5 2 3";

TEST_F(FirstStep, IsTheFirstOneTheSecondOrTheLastWhereAFieldVaries) {
    EXPECT_EQ(choice_of(series({something, something, something})).steps, std::vector<std::size_t>{0});
    EXPECT_EQ(choice_of(series({nothing, something, something})).steps, std::vector<std::size_t>{1});
    EXPECT_EQ(choice_of(series({nothing, nothing, nothing, something})).steps, std::vector<std::size_t>{3});
    EXPECT_EQ(choice_of(series({nothing, nothing, nothing})).steps, std::vector<std::size_t>{0});
}

TEST_F(FirstStep, IsSaid) {
    const std::string path = series({nothing, something, something});
    for (const std::string field : {"", "T"}) {
        listener.noted.clear();
        EXPECT_EQ(choice_of(path, field).steps, std::vector<std::size_t>{1}) << field;
        ASSERT_EQ(listener.noted.size(), 1u);
        EXPECT_EQ(listener.noted[0], fmt::format("the file has 3 time steps, and {} at step 0: step 1, time 0.5, was "
                                                 "taken; `time` and `step` choose another",
                                                 field.empty() ? "no field varies" : "'T' does not vary"));
    }
}

TEST_F(FirstStep, OfOptionsCounts) {
    GridOptions options;
    options.file = series({nothing, something});
    options.step = 0;
    GridSource source = GridSource::open(options, listener).value();
    EXPECT_EQ(choose_first(source, options, {}, listener, listener.run())->steps, std::vector<std::size_t>{0});
    EXPECT_TRUE(listener.noted.empty());
}

TEST_F(FirstStep, IsTheSameForExtractAndInfo) {
    ExtractJob job;
    job.grid.file = series({nothing, something});
    const ExtractNumbers numbers = extract_files(job, listener).value();
    EXPECT_EQ(numbers.field.name, "T");
    EXPECT_EQ(numbers.surfaces.at(0).time, 0.5);
    EXPECT_GT(numbers.surfaces.at(0).triangles, 0u);
    InfoJob info;
    info.grid.file = job.grid.file;
    const GridSummary summary = look_into(info, listener).value();
    EXPECT_EQ(summary.step, 1u);
    EXPECT_EQ(summary.fields.at(0).components.at(0).upper, 3);
    EXPECT_EQ(summary.first.field, "T");
}

/// A constant field, then one that varies, each with other fields beside it.
std::vector<std::string> files_of_steps(const test::TemporaryFolder& folder, const std::string& shape,
                                        const char* ending) {
    std::vector<std::string> files;
    for (int step = 0; step < 3; ++step) {
        Grid grid = make_grid({.shape = shape, .side = 20, .fields = {"gyroid", "sphere"}}).value();
        const std::vector<float> same(grid.points.tuples(), 1);
        grid.point_fields.push_back({"late", step == 0 ? Array::own(same) : grid.point_fields[0].values});
        files.push_back(folder.file(fmt::format("{}{}{}", shape, step, ending)));
        EXPECT_TRUE(write_grid(grid, files.back()));
    }
    return files;
}

TEST_F(FirstStep, IsFoundWhileCellsStayInTheirFiles) {
    const ReadActiveCells active{"gyroid", {0.2}, {}};
    for (const char* shape : {"kuhn", "mixed"})
        for (const std::string field : {"", "gyroid", "late", "gyroid + sphere"}) {
            SCOPED_TRACE(testing::Message() << shape << " '" << field << "'");
            std::vector<std::string> files = files_of_steps(folder, shape, ".vtu");
            GridOptions options;
            options.file = files[0];
            options.more_files = {files[1], files[2]};
            std::vector<FirstChoice> choices;
            for (const bool streams : {true, false}) {
                GridSource source = GridSource::open(options, listener).value();
                ChoiceWish wish{Steps::one, {field}, {}};
                wish.streams = streams;
                choices.push_back(choose_first(source, options, wish, listener, listener.run()).value());
                const auto read = source.read_active({}, choices.back().steps[0], active, listener);
                ASSERT_TRUE(read) << read.error().message;
                EXPECT_EQ(read->cells_in_file.has_value(), streams) << "else the first look has kept them";
            }
            EXPECT_EQ(choices[0].steps, choices[1].steps);
            EXPECT_EQ(choices[0].steps[0], field == "late" ? 1u : 0u);
            EXPECT_EQ(choices[0].view.field, choices[1].view.field);
            EXPECT_EQ(choices[0].view.draw, choices[1].view.draw);
            EXPECT_EQ(choices[0].view.reason, choices[1].view.reason);
        }
}

TEST_F(FirstStep, OfASeriesWhoseLastFileIsBrokenIsTheFirst) {
    const std::string path = series({nothing, nothing, nothing});
    folder.write("s2.vtu", "<VTKFile type=\"UnstructuredGrid\">");
    EXPECT_EQ(choice_of(path).steps, std::vector<std::size_t>{0});
}

TEST_F(FirstStep, OfSeveralFilesIsThatOfASeries) {
    series({nothing, something});
    GridOptions options;
    options.file = folder.file("s0.vtu");
    options.more_files = {folder.file("s1.vtu")};
    GridSource source = GridSource::open(options, listener).value();
    EXPECT_EQ(source.info().times, (std::vector<double>{0, 1}));
    EXPECT_EQ(source.info().files.size(), 2u);
    EXPECT_EQ(choose_first(source, options, {}, listener, listener.run())->steps, std::vector<std::size_t>{1});
    options.step = 2;
    GridSource beyond = GridSource::open(options, listener).value();
    EXPECT_FALSE(choose_first(beyond, options, {}, listener, listener.run()));
    options.more_files = {series({something, something})};
    options.step.reset();
    const Result<Grid> grid = GridSource::open(options, listener)->read({}, 1, listener);
    ASSERT_FALSE(grid);
    EXPECT_NE(grid.error().message.find("several files are a time step each, but"), std::string::npos);
}

TEST_F(FirstStep, OfFilesWithNothingInCommonIsNone) {
    GridOptions options;
    options.file = folder.write("box.vtu", vtu_with("T", something));
    options.more_files = {folder.write("pipe.vtu", vtu_with("U", something))};
    const Result<GridSource> source = GridSource::open(options, listener);
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message.find("have no field in common"), std::string::npos) << source.error().message;
    options.more_files = {folder.write("other.vtu", vtu_with("T", something))};
    EXPECT_EQ(GridSource::open(options, listener)->info().times.size(), 2u);
}

TEST(ExtractWithoutAField, TakesTheOneThatIsShownFirst) {
    Listener listener;
    ExtractJob job;
    job.grid.file = "make:kuhn:4:plane,sphere,integer";
    const ExtractNumbers numbers = extract_files(job, listener).value();
    InfoJob info;
    info.grid.file = job.grid.file;
    EXPECT_EQ(numbers.field.name, look_into(info, listener)->first.field);
    EXPECT_TRUE(std::ranges::any_of(listener.noted, [&](const std::string& note) {
        return note == fmt::format("no field was named: '{}' was taken (it varies most); `field` names another",
                                   numbers.field.name);
    }));
}

TEST(ExtractWithoutAField, RefusesNumbersOfRegionsAlone) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job;
    job.grid.file = write_made({"", {{"material", Values::halves, 1, cell}, {"elem", Values::counting, 1, cell}}, {}},
                               folder.file("m.vtu"));
    EXPECT_NE(extract_files(job, listener).error().message.find("only numbers of regions vary, such as 'material'"),
              std::string::npos);
    job.grid.file = write_made({"", {{"material", Values::halves, 1, cell}}, {}}, folder.file("only.vtu"));
    EXPECT_EQ(extract_files(job, listener).error().code, ErrorCode::invalid_argument);
    job.isovalues = {2};
    EXPECT_EQ(extract_files(job, listener).value().field.name, "material") << "its values are asked for";
    job.isovalues.clear();
    job.field.name = "material";
    EXPECT_TRUE(extract_files(job, listener));
    job.field.name.clear();
    job.grid.file = write_made({"", {{"T", Values::constant}, {"p", Values::constant}}, {}}, folder.file("c.vtu"));
    EXPECT_EQ(extract_files(job, listener).error().code, ErrorCode::invalid_data);
}

} // namespace
} // namespace isotet::jobs
