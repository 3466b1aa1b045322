// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/fields.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/pack_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/picture.hpp>
#include <isotet/text.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

DrawJob small_picture(const std::string& grid, const std::string& out) {
    DrawJob job;
    job.grid.file = grid;
    job.out = out;
    job.picture.width = 160;
    job.picture.height = 120;
    job.plain = true;
    return job;
}

TEST(DrawFiles, DrawsAGridWithItsNumbers) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:6:sphere", folder.file("a.png"));
    job.isovalues = {0.5, 0.75};
    const DrawReport report = draw_files(job, listener).value();
    EXPECT_EQ(report.input.field, "sphere");
    EXPECT_FALSE(report.device) << "the CPU draws";
    EXPECT_EQ(report.pictures.pictures, 1u);
    EXPECT_EQ(report.pictures.bytes, std::filesystem::file_size(folder.file("a.png")));
    EXPECT_EQ(isovalue_texts(*report.input.scene), (std::vector<std::string>{"0.5", "0.75"}));
    EXPECT_EQ(read_picture(folder.file("a.png"))->width, 160u);
}

TEST(DrawFiles, TheCameraToldDrawsTheSamePicture) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:6:sphere", folder.file("a.png"));
    job.isovalues = {0.5};
    const DrawReport report = draw_files(job, listener).value();
    job.camera = parse_camera(report.pictures.camera);
    ASSERT_TRUE(job.camera);
    job.out = folder.file("b.png");
    job.reference = folder.file("a.png");
    EXPECT_EQ(draw_files(job, listener).value().pictures.differs, 0);
}

/// Without boundary only the cells that the isovalues meet are read; axes that are stretched by 1 need all.
TEST(DrawFiles, DrawsThePictureOfAllCellsFromActiveOnes) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "mixed", .side = 9, .fields = {"gyroid", "plane"}}).value();
    std::vector<float> points(grid.points.as<float>().begin(), grid.points.as<float>().end());
    points.insert(points.end(), {9, 9, 9}); // which no cell has
    grid.points = Array::own(std::move(points), 3);
    for (Field& field : grid.point_fields) {
        std::vector<float> values(field.values.as<float>().begin(), field.values.as<float>().end());
        values.push_back(0);
        field.values = Array::own(std::move(values));
    }
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    for (const bool colored : {false, true}) {
        DrawJob job = small_picture(folder.file("grid.vtu"), folder.file("a.png"));
        job.field.name = "gyroid";
        job.isovalues = {0.1, -0.3};
        job.boundary = 0;
        job.outline = colored;
        if (colored) job.color_by = "plane";
        Listener active, all;
        const DrawReport report = draw_files(job, active).value();
        job.stretch = {1, 1, 1};
        job.out = folder.file("b.png");
        const DrawReport expected = draw_files(job, all).value();
        const auto told = [](const std::string& detail) { return detail.find("cells were kept") != detail.npos; };
        EXPECT_TRUE(std::ranges::any_of(active.details, told));
        EXPECT_FALSE(std::ranges::any_of(all.details, told));
        EXPECT_EQ(report.input.cells, expected.input.cells);
        EXPECT_EQ(report.pictures.camera, expected.pictures.camera);
        EXPECT_EQ(active.noted, all.noted);
        EXPECT_TRUE(test::content_of(folder.file("a.png")) == test::content_of(folder.file("b.png")));
    }
}

bool some_cells_were_kept(const Listener& listener) {
    return std::ranges::any_of(listener.details, [](const std::string& detail) {
        return detail.find("cells were kept") != std::string::npos;
    });
}

/// Axes that are stretched by 1 need all cells.
DrawJob job_of_all_cells(DrawJob job, const std::string& out) {
    job.stretch = {1, 1, 1};
    job.out = out;
    return job;
}

TEST(DrawFiles, FindsTheBoundaryOfCellsThatAreNotRead) {
    const test::TemporaryFolder folder;
    for (const char* shape :
         test::some_of<const char*>({"mixed", "kuhn", "shuffled", "layer", "hex", "wedge", "octree", "octree-tets"}))
        for (const char* ending : {".vtu", ".vtk"}) {
            SCOPED_TRACE(testing::Message() << shape << ending);
            const std::string file = folder.file("grid") + ending;
            ASSERT_TRUE(
                write_grid(make_grid({.shape = shape, .side = 9, .fields = {"gyroid", "plane"}}).value(), file));
            DrawJob job = small_picture(file, folder.file("a.png"));
            job.field.name = "gyroid";
            if (std::string_view(ending) == ".vtu") job.isovalues = {0.1, -0.3}; // else by the values
            job.color_by = "plane";
            Listener active, all;
            const DrawReport report = draw_files(job, active).value();
            const DrawReport expected = draw_files(job_of_all_cells(job, folder.file("b.png")), all).value();
            const bool hangs = std::string_view(shape).starts_with("octree");
            const bool several_types = std::string_view(shape) == "mixed" && std::string_view(ending) == ".vtk";
            EXPECT_EQ(some_cells_were_kept(active), !hangs && !several_types);
            EXPECT_FALSE(some_cells_were_kept(all));
            EXPECT_EQ(report.input.cells, expected.input.cells);
            EXPECT_EQ(report.input.scene->report().boundary_faces, expected.input.scene->report().boundary_faces);
            EXPECT_EQ(report.pictures.camera, expected.pictures.camera);
            EXPECT_EQ(active.noted, all.noted);
            EXPECT_TRUE(test::content_of(folder.file("a.png")) == test::content_of(folder.file("b.png")));
        }
}

TEST(DrawFiles, KnowsTheBoundaryOfTheStepBefore) {
    const test::TemporaryFolder folder;
    const auto made = [](const char* shape, std::uint64_t side) {
        return make_grid({.shape = shape, .side = side, .fields = {"gyroid"}}).value();
    };
    const std::vector<Grid> grids{made("kuhn", 8),   made("kuhn", 8),      made("kuhn", 9), made("octree", 6),
                                  made("octree", 6), made("perturbed", 8), made("kuhn", 8)};
    std::string entries;
    for (std::size_t step = 0; step < grids.size(); ++step) {
        const std::string name = "step" + std::to_string(step) + ".vtu";
        ASSERT_TRUE(write_grid(grids[step], folder.file(name)));
        entries += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
    }
    const std::string file =
        folder.write("series.pvd", "<VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>");
    DrawJob job = small_picture(file, folder.file("a{frame}.png"));
    job.field.name = "gyroid";
    job.isovalues = {0.1};
    job.all_steps = true;
    Listener active, all;
    ASSERT_TRUE(draw_files(job, active));
    ASSERT_TRUE(draw_files(job_of_all_cells(job, folder.file("b{frame}.png")), all));
    EXPECT_TRUE(some_cells_were_kept(active));
    for (std::size_t step = 0; step < grids.size(); ++step) {
        const std::string number = std::to_string(step + 1) + ".png";
        EXPECT_TRUE(test::content_of(folder.file("a" + number)) == test::content_of(folder.file("b" + number))) << step;
    }
}

/// Regions in layers, of which the last is no number in one of two, and a part that changes from cell to cell.
std::vector<Field> fields_of_cells(std::size_t cells) {
    std::vector<std::int32_t> region(cells);
    std::vector<float> part(cells);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        region[cell] = static_cast<std::int32_t>(cell * cell % cells * 4 / cells) - 1;
        part[cell] = cell % 50 == 3 ? NAN : static_cast<float>(cell * 7919 % 100) / 40 - 1;
    }
    return {{"region", Array::own(std::move(region))}, {"part", Array::own(std::move(part))}};
}

/// Pictures that are coloured by a cell field, or show the boundary alone.
std::vector<DrawJob> jobs_without_all_cells(const std::string& file, const std::string& out) {
    const DrawJob plain = small_picture(file, out);
    std::vector<DrawJob> jobs(9, plain);
    for (DrawJob* job : {&jobs[0], &jobs[1], &jobs[2], &jobs[3]}) {
        job->field.name = "gyroid";
        job->isovalues = {0.1};
    }
    jobs[0].color_by = "region";
    jobs[1].color_by = jobs[4].boundary_color_by = "part";
    jobs[1].scale.logarithmic = true;
    jobs[2].boundary_color_by = jobs[5].boundary_color_by = "region";
    jobs[3].isovalues.clear();
    jobs[3].shares = {{IsovalueShare::Of::points, 40}};
    jobs[5].clips = {{{1, 0, 0}, 0.1}};
    jobs[6].boundary_color_by = "plane";
    jobs[7].field.name = "part"; // averaged to the points
    jobs[8].field.name = "gyroid";
    jobs[8].shares = {{IsovalueShare::Of::volume, 60}};
    return jobs;
}

TEST(DrawFiles, ColoursByValuesOfCellsThatAreNotRead) {
    const test::TemporaryFolder folder;
    for (const char* shape : test::some_of<const char*>({"mixed", "shuffled", "octree"}))
        for (const char* ending : {".vtu", ".vtk"}) {
            const std::string file = folder.file("grid") + ending;
            Grid grid = make_grid({.shape = shape, .side = 9, .fields = {"gyroid", "plane"}}).value();
            grid.cell_fields = fields_of_cells(grid.cells.count());
            ASSERT_TRUE(write_grid(grid, file));
            const bool hangs = std::string_view(shape).starts_with("octree");
            const bool several_types = std::string_view(shape) == "mixed" && std::string_view(ending) == ".vtk";
            const auto jobs = jobs_without_all_cells(file, folder.file("a.png"));
            for (std::size_t i = 0; i < jobs.size(); ++i) {
                SCOPED_TRACE(testing::Message() << shape << ending << " " << i);
                Listener active, all;
                const DrawReport report = draw_files(jobs[i], active).value();
                const DrawReport expected = draw_files(job_of_all_cells(jobs[i], folder.file("b.png")), all).value();
                EXPECT_EQ(some_cells_were_kept(active), !hangs && !several_types);
                EXPECT_FALSE(some_cells_were_kept(all));
                EXPECT_EQ(report.input.cells, expected.input.cells);
                EXPECT_EQ(report.pictures.camera, expected.pictures.camera);
                EXPECT_EQ(active.noted, all.noted);
                EXPECT_TRUE(test::content_of(folder.file("a.png")) == test::content_of(folder.file("b.png")));
            }
        }
}

TEST(DrawFiles, DrawsRegionsOfCellsThatAreNotRead) {
    const test::TemporaryFolder folder;
    std::string entries;
    for (const int step : {0, 1, 2}) {
        Grid grid = make_grid({.shape = step == 2 ? "hex" : "shuffled", .side = 9, .fields = {}}).value();
        grid.cell_fields = fields_of_cells(grid.cells.count());
        grid.cell_fields.resize(1);
        const std::string name = "step" + std::to_string(step) + ".vtu";
        ASSERT_TRUE(write_grid(grid, folder.file(name)));
        entries += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
    }
    const std::string series =
        folder.write("series.pvd", "<VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>");
    for (const bool all_steps : {false, true}) {
        DrawJob job = small_picture(all_steps ? series : folder.file("step0.vtu"), folder.file("a{frame}.png"));
        if (!all_steps) job.out = folder.file("a1.png");
        job.all_steps = all_steps;
        Listener active, all;
        ASSERT_TRUE(draw_files(job, active));
        const std::string out = folder.file(all_steps ? "b{frame}.png" : "b1.png");
        ASSERT_TRUE(draw_files(job_of_all_cells(job, out), all));
        EXPECT_TRUE(some_cells_were_kept(active));
        EXPECT_FALSE(some_cells_were_kept(all));
        EXPECT_EQ(active.noted.size(), all.noted.size()) << "a film's command names the pictures";
        for (const char* number : {"1.png", "2.png", "3.png"})
            if (all_steps || number[0] == '1') {
                EXPECT_TRUE(test::content_of(folder.file("a") + number) == test::content_of(folder.file("b") + number));
            }
    }
}

/// Points that no cell has decide how coordinates are rounded, so extraction needs all cells, and their colours.
TEST(DrawFiles, ColoursByCellsThatAreReadAfterAll) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "shuffled", .side = 9, .fields = {"gyroid"}}).value();
    std::vector<double> points;
    for (std::size_t i = 0; i < grid.points.size(); ++i) points.push_back(grid.points.at(i / 3, i % 3) + 5e5);
    points.insert(points.end(), {1e6, 1e6, 1e6});
    std::vector<float> values(grid.point_fields[0].values.as<float>().begin(),
                              grid.point_fields[0].values.as<float>().end());
    values.push_back(0);
    grid.points = Array::own(std::move(points), 3);
    grid.point_fields = {{"gyroid", Array::own(std::move(values))}};
    grid.cell_fields = fields_of_cells(grid.cells.count());
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    for (const char* color : {"region", "part"}) {
        DrawJob job = small_picture(folder.file("grid.vtu"), folder.file("a.png"));
        job.field.name = "gyroid";
        job.isovalues = {0.1};
        job.color_by = color;
        Listener active, all;
        ASSERT_TRUE(draw_files(job, active));
        ASSERT_TRUE(draw_files(job_of_all_cells(job, folder.file("b.png")), all));
        EXPECT_TRUE(test::content_of(folder.file("a.png")) == test::content_of(folder.file("b.png")));
    }
}

std::string packed_file(const test::TemporaryFolder& folder) {
    PackJob pack;
    pack.grid.file = "make:mixed:6:gyroid,plane";
    pack.out = folder.file("grid.isotet");
    pack.pack.gradients = true;
    Listener listener;
    pack_file(pack, listener).value();
    return pack.out;
}

TEST(DrawFiles, PointsOfPackedFilesThatMoveAreWhereTheyAreAtAStep) {
    const test::TemporaryFolder folder;
    const Grid grid = make_grid({.shape = "kuhn", .side = 5, .fields = {"sphere"}}).value();
    std::vector<float> moved(3 * grid.points.tuples());
    for (std::size_t i = 0; i < moved.size(); ++i)
        moved[i] = static_cast<float>(grid.points.at(i / 3, i % 3) * (i % 3 == 0 ? 5 : 2));
    const PackedGrid packed = pack(grid, find_field(grid, "sphere").value()).value();
    PackedWriter writer = PackedWriter::create(packed, folder.file("moved.isotet")).value();
    writer.add_step(packed.with_points(Array::own(std::move(moved), 3)).value(), 1.0).value();
    writer.commit().value();
    for (const bool volume : {false, true}) {
        DrawJob job = small_picture(folder.file("moved.isotet"), folder.file("a.png"));
        job.grid.step = 1;
        job.field.name = "sphere";
        job.volume = volume;
        if (!volume) job.isovalues = {0.5};
        job.boundary = 0;
        Listener listener;
        draw_files(job, listener).value();
        job.stretch = {1, 1, 1};
        job.reference = job.out;
        job.out = folder.file("b.png");
        EXPECT_EQ(draw_files(job, listener).value().pictures.differs, 0) << volume;
    }
}

/// Axes that are stretched by 1 need the cells, so that all is unpacked.
TEST(DrawFiles, DrawsThePictureOfTheGridFromAPackedFile) {
    const test::TemporaryFolder folder;
    DrawJob plain = small_picture(packed_file(folder), folder.file("a.png"));
    plain.field.name = "gyroid";
    DrawJob one = plain, colored = plain, by_boundary = plain, clipped = plain, logarithmic = plain;
    one.isovalues = {0.1};
    one.boundary = 0;
    one.shade_by = ShadeBy::gradient;
    colored.color_by = "plane";
    colored.isovalues = {0.1, -0.3};
    by_boundary.field.name = "";
    by_boundary.boundary_color_by = "plane";
    clipped.isovalues = {0.2};
    clipped.clips = {{{1, 0, 0}, 0.5}};
    clipped.edges = true;
    logarithmic.isovalues = {0.1};
    logarithmic.color_by = "gyroid";
    logarithmic.scale.logarithmic = true;
    DrawJob ramp = plain, points = plain, rays = plain;
    for (DrawJob* const job : {&ramp, &points, &rays}) job->volume = true;
    ramp.isovalues = {0.1};
    ramp.boundary = 0.2;
    points.volume_opacity = parse_opacity("0:0,0.1:0.5,0.2:0").value();
    points.volume_shading = true;
    rays.dirac = {0.1, -0.4};
    DrawJob sliced = plain, sliced_by = plain;
    sliced.slices = {{{0, 0, 1}, 0.4}, {{1, 0, 0}, 0.3}, {{0, 0, 1}, 0.7}};
    sliced.field.name = "";
    sliced_by = sliced;
    sliced_by.color_by = "plane";
    sliced_by.field.name = "gyroid";
    sliced_by.isovalues = {0.1};
    for (DrawJob job :
         {plain, one, colored, by_boundary, clipped, logarithmic, ramp, points, rays, sliced, sliced_by}) {
        Listener from_file, from_grid;
        const DrawReport report = draw_files(job, from_file).value();
        job.stretch = {1, 1, 1};
        job.out = folder.file("b.png");
        job.reference = folder.file("a.png");
        const DrawReport expected = draw_files(job, from_grid).value();
        const auto told = [](const std::string& note) { return note.find("all of the packed file") != note.npos; };
        EXPECT_FALSE(std::ranges::any_of(from_file.noted, told));
        EXPECT_TRUE(std::ranges::any_of(from_grid.noted, told));
        EXPECT_EQ(report.input.cells, expected.input.cells);
        EXPECT_EQ(report.input.isovalues, expected.input.isovalues);
        EXPECT_EQ(report.pictures.camera, expected.pictures.camera);
        // The boundary's triangles come in another order, and so do the ends of their edges; heights of slices are float32.
        EXPECT_LE(expected.pictures.differs.value(), job.edges || !job.slices.empty() ? 0.02 : 0);
        EXPECT_EQ(report.input.scene->report().slice_triangles > 0, !job.slices.empty());
    }
}

TEST(DrawFiles, CellFieldsOfPackedFilesColourSlicesAsThoseOfTheGrid) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "mixed", .side = 6, .fields = {"gyroid"}}).value();
    std::vector<float> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i % 17);
    grid.cell_fields = {{"number", Array::own(std::move(numbers))}};
    write_grid(grid, folder.file("grid.vtu")).value();
    PackJob pack;
    pack.grid.file = folder.file("grid.vtu");
    pack.out = folder.file("grid.isotet");
    pack.cell_fields = {"number"};
    Listener listener;
    pack_file(pack, listener).value();
    DrawJob job = small_picture(pack.grid.file, folder.file("a.png"));
    job.slices = {{{1, 2, 3}, 2.1}};
    job.color_by = "number";
    draw_files(job, listener).value();
    job.grid.file = pack.out;
    job.out = folder.file("b.png");
    job.reference = folder.file("a.png");
    Listener told;
    const DrawReport report = draw_files(job, told).value();
    EXPECT_LE(report.pictures.differs.value(), 0.01);
    EXPECT_GT(report.input.scene->report().slice_triangles, 0u);
    for (const std::string& note : told.noted) EXPECT_EQ(note.find("all of the packed file"), note.npos) << note;
}

TEST(DrawFiles, TellsHowMuchMemorySolidsOfPackedFilesTake) {
    const test::TemporaryFolder folder;
    DrawJob job = small_picture(packed_file(folder), folder.file("a.png"));
    job.solid = SolidSide::above;
    job.field.name = "gyroid";
    job.isovalues = {0.1};
    Listener told;
    draw_files(job, told).value();
    const std::uint64_t bytes = PackedFile::open(job.grid.file).value().info().unpacked_bytes;
    ASSERT_FALSE(told.noted.empty());
    EXPECT_NE(told.noted[0].find("unpacked, which takes " + format_bytes(bytes) + " of memory"), std::string::npos)
        << told.noted[0];
}

TEST(DrawFiles, NumbersThePicturesOfASweep) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:4:sphere", folder.file("p{frame}.png"));
    job.field.name = "sphere";
    job.sweep = {0.25, 0.75, 10};
    const DrawReport report = draw_files(job, listener).value();
    EXPECT_EQ(report.pictures.pictures, 10u);
    for (const char* name : {"p01.png", "p10.png"}) EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_NE(listener.noted[0].find("p%02d.png"), std::string::npos) << listener.noted[0];
}

TEST(DrawFiles, SweepsBetweenShares) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:4:plane", folder.file("p{frame}.png"));
    job.sweep = {0, 0.5, 3};
    job.sweep_shares.lower = IsovalueShare{IsovalueShare::Of::volume, 50};
    const DrawReport report = draw_files(job, listener).value();
    EXPECT_NEAR(report.input.sweep[0], 0, 1e-6);
    EXPECT_EQ(report.input.sweep[1], 0.5);
}

TEST(DrawFiles, OfAllStepsChooseIsovaluesOfACellField) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "kuhn", .side = 4}).value();
    grid.point_fields.clear();
    DrawJob job = small_picture(folder.file("s0.vtu"), folder.file("p{frame}.png"));
    for (const int step : {0, 1}) {
        std::vector<double> values;
        for (std::size_t i = 0; i < grid.cells.count(); ++i) values.push_back(static_cast<double>(i / 6 % 16 + step));
        grid.cell_fields = {{"q", Array::own(std::move(values))}};
        const std::string name = folder.file("s" + std::to_string(step) + ".vtu");
        ASSERT_TRUE(write_grid(grid, name));
        if (step > 0) job.grid.more_files.push_back(name);
    }
    job.field.name = "q";
    job.all_steps = true;
    Listener listener;
    const auto drawn = draw_files(job, listener);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_EQ(drawn->pictures.pictures, 2u);
}

TEST(DrawFiles, OfASeriesOfOnePictureMayHaveANumber) {
    const test::TemporaryFolder folder;
    Listener listener;
    for (const char* out : {"p{frame}.png", "p.png", "p.webp"}) {
        DrawJob job = small_picture("make:kuhn:4:sphere", folder.file(out));
        job.all_steps = true;
        const auto drawn = draw_files(job, listener);
        EXPECT_TRUE(drawn) << drawn.error().message;
    }
    EXPECT_TRUE(std::filesystem::exists(folder.file("p1.png")));
    EXPECT_TRUE(std::filesystem::exists(folder.file("p.webp")));
}

TEST(DrawFiles, RefusesNamesThatDoNotFitThePictures) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:4:sphere", folder.file("p{frame}.png"));
    EXPECT_NE(draw_files(job, listener).error().message.find("but there is one picture: only those of"),
              std::string::npos);
    job.out = folder.file("p.png");
    job.orbit = 4;
    EXPECT_EQ(draw_files(job, listener).error().code, ErrorCode::invalid_argument);
    job.orbit = 0;
    job.other_outputs = {folder.file("p.png")};
    EXPECT_EQ(draw_files(job, listener).error().message, "two outputs are the same file, '" + job.out + "'");
}

TEST(DrawFiles, NotesIsovaluesWithoutASurface) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:4:sphere", folder.file("a.png"));
    job.field.name = "sphere";
    job.isovalues = {9};
    EXPECT_EQ(draw_files(job, listener).error().code, ErrorCode::invalid_data);
    job.allow_empty = true;
    ASSERT_TRUE(draw_files(job, listener));
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_TRUE(listener.noted[0].starts_with("there is no surface at 9: the values of 'sphere' go from 0 to"))
        << listener.noted[0];
    Listener of_rays;
    job.isovalues.clear();
    job.dirac = {0.5, 9};
    ASSERT_TRUE(draw_files(job, of_rays));
    EXPECT_EQ(of_rays.noted, listener.noted);
}

TEST(DrawFiles, RaysMeetIsosurfacesAtShares) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:6:sphere", folder.file("a.png"));
    job.field.name = "sphere";
    job.dirac_shares = {{IsovalueShare::Of::volume, 20}};
    const DrawReport report = draw_files(job, listener).value();
    ASSERT_EQ(report.input.volume->isosurfaces.size(), 1u);
    const double isovalue = report.input.volume->isosurfaces[0];
    const double radius = std::cbrt(0.2 * 8 * 3 / (4 * 3.14159265358979));
    EXPECT_NEAR(isovalue, radius, 0.05);
    job.dirac_shares.clear();
    job.dirac = {isovalue};
    job.out = folder.file("b.png");
    ASSERT_TRUE(draw_files(job, listener));
    EXPECT_TRUE(test::content_of(folder.file("a.png")) == test::content_of(folder.file("b.png")));
}

TEST(DrawFiles, NotesSlicesThatMissTheGrid) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture("make:kuhn:4:sphere", folder.file("a.png"));
    job.slices = {{{1, 0, 0}, 0}, {{1, 0, 0}, 9}};
    ASSERT_TRUE(draw_files(job, listener));
    EXPECT_EQ(listener.noted.back(), "the slice x = 9 does not meet the grid");
}

/// Two time steps: 0 everywhere, then the distance from the middle.
std::string series_from_zero(const test::TemporaryFolder& folder) {
    Grid grid = make_grid({"kuhn", 4, {"sphere"}}).value();
    EXPECT_TRUE(write_grid(grid, folder.file("1.vtu")));
    grid.point_fields[0].values = Array::own(std::vector<float>(grid.points.tuples()));
    EXPECT_TRUE(write_grid(grid, folder.file("0.vtu")));
    std::ofstream(folder.file("run.pvd")) << "<VTKFile type=\"Collection\"><Collection>"
                                          << "<DataSet timestep=\"0\" file=\"0.vtu\"/>"
                                          << "<DataSet timestep=\"1\" file=\"1.vtu\"/></Collection></VTKFile>";
    return folder.file("run.pvd");
}

TEST(DrawFiles, ChoosesIsovaluesByTheValuesOfAllSteps) {
    const test::TemporaryFolder folder;
    Listener listener;
    DrawJob job = small_picture(series_from_zero(folder), folder.file("t{frame}.png"));
    job.field.name = "sphere";
    job.all_steps = true;
    job.levels = 3;
    const auto report = draw_files(job, listener);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(some_cells_were_kept(listener));
    Listener other;
    ASSERT_TRUE(draw_files(job_of_all_cells(job, folder.file("u{frame}.png")), other));
    for (const char* number : {"1.png", "2.png"})
        EXPECT_TRUE(test::content_of(folder.file("t") + number) == test::content_of(folder.file("u") + number));
    EXPECT_EQ(report->pictures.pictures, 2u);
    EXPECT_EQ(isovalue_texts(*report->input.scene).size(), 3u);
    for (const ShownSurface& surface : report->input.scene->surfaces()) EXPECT_GT(surface.triangles, 0u);
}

} // namespace
} // namespace isotet::jobs
