// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/pack_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/slice_files.hpp>
#include <isotet/make.hpp>
#include <isotet/memory.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

/// Scalars, a vector and a tensor of points, and a cell field.
std::string grid_with_all_kinds(const test::TemporaryFolder& folder) {
    Grid grid = make_grid({.shape = "mixed", .side = 4, .fields = {"gyroid"}}).value();
    std::vector<float> velocity, stress;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        const double x = grid.points.at(i, 0), y = grid.points.at(i, 1), z = grid.points.at(i, 2);
        for (const double v : {y - z, x * x, 0.5 - x}) velocity.push_back(static_cast<float>(v));
        for (int k = 0; k < 9; ++k) stress.push_back(static_cast<float>(k));
    }
    grid.point_fields.push_back({"U", Array::own(std::move(velocity), 3)});
    grid.point_fields.push_back({"stress", Array::own(std::move(stress), 9)});
    std::vector<std::int32_t> region(grid.cells.count());
    for (std::size_t i = 0; i < region.size(); ++i) region[i] = static_cast<std::int32_t>(3 * i / region.size());
    grid.cell_fields = {{"region", Array::own(std::move(region))}};
    std::string path = folder.file("grid.vtu");
    write_grid(grid, path).value();
    return path;
}

std::string packed(const std::string& grid, const test::TemporaryFolder& folder, Listener& listener,
                   std::vector<std::string> cell_fields = {}) {
    PackJob job;
    job.cell_fields = std::move(cell_fields);
    job.grid.file = grid;
    job.out = folder.file("grid.isotet");
    pack_file(job, listener).value();
    return job.out;
}

TEST(PackFile, PacksVectorsAsComponentsAndNamesWhatIsNotPacked) {
    const test::TemporaryFolder folder;
    Listener listener;
    const std::string grid = grid_with_all_kinds(folder), path = packed(grid, folder, listener);
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_EQ(listener.noted[0], "not packed: 'stress' (9 components), 'region' (of cells); `fields` takes components, "
                                 "`cell_fields` fields of cells");
    std::vector<std::string> names;
    const PackedFile file = PackedFile::open(path).value();
    for (const PackedFieldInfo& field : file.info().fields) names.push_back(field.report.name);
    EXPECT_EQ(names, (std::vector<std::string>{"gyroid", "U:x", "U:y", "U:z", "U:mag"}));
    const ReadResult read = isotet::read(path).value(), original = isotet::read(grid).value();
    ASSERT_EQ(read.info.fields.size(), 2u);
    EXPECT_EQ(read.info.fields[1].name, "U");
    EXPECT_EQ(read.info.fields[1].components, 3u);
    const Array &values = read.grid.point_fields[1].values, &expected = original.grid.point_fields[1].values;
    ASSERT_EQ(values.size(), expected.size());
    EXPECT_TRUE(std::ranges::equal(values.as<float>(), expected.as<float>()));
}

TEST(PackFile, SurfacesCarryVectorsAsThoseOfTheGrid) {
    const test::TemporaryFolder folder;
    Listener listener;
    const std::string grid = grid_with_all_kinds(folder), path = packed(grid, folder, listener);
    const auto surface_of = [&](const std::string& file, std::vector<std::string> with, const std::string& out) {
        ExtractJob job;
        job.grid.file = file;
        job.out = folder.file(out);
        job.field.name = "U:mag";
        job.isovalues = {0.7};
        job.with = std::move(with);
        if (file == grid) job.contour.method = Method::clusters;
        Listener told;
        extract_files(job, told).value();
        for (const std::string& note : told.noted) EXPECT_EQ(note.find("all of the packed file"), note.npos) << note;
        return test::content_of(job.out);
    };
    for (const std::vector<std::string>& with :
         {std::vector<std::string>{"U", "gyroid"}, {"U:mag", "gyroid"}, {"U,U:y"}, {}}) {
        const std::string expected = surface_of(grid, with, "a.vtp");
        EXPECT_TRUE(surface_of(path, with, "b.vtp") == expected) << testing::PrintToString(with);
    }
}

TEST(PackFile, ValuesAreRoundedToBitsOfTheirRange) {
    const test::TemporaryFolder folder;
    Listener listener;
    PackJob job;
    job.grid.file = grid_with_all_kinds(folder);
    job.fields = {"gyroid"};
    job.out = folder.file("rounded.isotet");
    job.value_bits = 16;
    const PackNumbers numbers = pack_file(job, listener).value();
    const Grid original = isotet::read(job.grid.file).value().grid, grid = isotet::read(job.out).value().grid;
    const Array& values = original.point_fields[0].values;
    double lower = values.at(0), upper = lower, change = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        lower = std::min(lower, values.at(i));
        upper = std::max(upper, values.at(i));
        change = std::max(change, std::abs(values.at(i) - grid.point_fields[0].values.at(i)));
    }
    ASSERT_EQ(numbers.rounded_by.size(), 1U);
    EXPECT_GT(change, 0);
    EXPECT_EQ(numbers.rounded_by[0], change);
    EXPECT_LE(change, (upper - lower) / (1 << 16));
}

TEST(PackFile, RefusesBitsThatFloat32DoesNotHave) {
    const test::TemporaryFolder folder;
    for (const int bits : {-1, 0, 25}) {
        PackJob job;
        job.grid.file = "make:kuhn:2:gyroid";
        job.out = folder.file("a.isotet");
        job.value_bits = bits;
        Listener listener;
        const auto packed = pack_file(job, listener);
        ASSERT_FALSE(packed) << bits;
        EXPECT_EQ(packed.error().code, ErrorCode::invalid_argument);
    }
}

TEST(PackFile, RoundedValuesKeepTheirOffset) {
    const test::TemporaryFolder folder;
    Listener listener;
    Grid grid = make_grid({.shape = "kuhn", .side = 5, .fields = {"gyroid"}}).value();
    Array& values = grid.point_fields[0].values;
    std::vector<double> pressure(values.size());
    for (std::size_t i = 0; i < pressure.size(); ++i) pressure[i] = 101325 + 1e-3 * values.at(i);
    values = Array::own(std::move(pressure));
    PackJob job;
    job.grid.file = folder.file("pressure.vtu");
    write_grid(grid, job.grid.file).value();
    job.fields = {"gyroid"};
    job.out = folder.file("rounded.isotet");
    job.value_bits = 16;
    const PackNumbers numbers = pack_file(job, listener).value();
    EXPECT_LT(numbers.rounded_by.at(0), 4e-8);
    const Array rounded = isotet::read(job.out).value().grid.point_fields[0].values;
    for (std::size_t i = 0; i < rounded.size(); ++i) ASSERT_NEAR(rounded.at(i), values.at(i), 1e-7);
}

/// Of which the step is what a file says it is, and not the first file's.
TEST(PackFile, SeveralFilesAreTimeSteps) {
    const test::TemporaryFolder folder;
    Listener listener;
    std::vector<std::string> files;
    std::vector<double> areas;
    for (const char* fields : {"gyroid", "sphere"}) {
        Grid grid = make_grid({.shape = "hex", .side = 6, .fields = {fields}}).value();
        grid.point_fields[0].name = "f";
        const std::string plain = folder.file(std::string(fields) + ".vtu");
        write_grid(grid, plain).value();
        PackJob pack;
        pack.grid.file = plain;
        pack.out = files.emplace_back(folder.file("step" + std::to_string(files.size()) + ".isotet"));
        pack_file(pack, listener).value();
        ExtractJob one;
        one.grid.file = plain;
        one.isovalues = {0.1};
        areas.push_back(extract_files(one, listener).value().surfaces.front().area);
    }
    EXPECT_GT(std::abs(areas[0] - areas[1]), 1e-3);
    ExtractJob all;
    all.grid.file = files[0];
    all.grid.more_files = {files[1]};
    all.field.name = "f";
    all.isovalues = {0.1};
    all.all_steps = true;
    const ExtractNumbers numbers = extract_files(all, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 2U);
    for (const std::size_t step : {0U, 1U}) EXPECT_NEAR(numbers.surfaces[step].area, areas[step], 1e-9 * areas[step]);
    DrawJob draw;
    draw.grid = all.grid;
    draw.out = folder.file("p-{frame}.png");
    draw.picture.width = draw.picture.height = 64;
    draw.all_steps = true;
    EXPECT_EQ(draw_files(draw, listener).value().pictures.pictures, 2U);
}

/// Files of the same cells, whose values change, and whose points move; the last of them.
std::vector<std::string> moving_files(const test::TemporaryFolder& folder) {
    std::vector<std::string> files;
    for (const float factor : {1.0F, 1.0F, 1.25F}) {
        Grid grid = make_grid({.shape = "mixed", .side = 6, .fields = {"gyroid", "sphere"}}).value();
        std::vector<float> points(grid.points.as<float>().begin(), grid.points.as<float>().end());
        for (float& x : points) x *= factor;
        std::vector<float> values(grid.point_fields[0].values.as<float>().begin(),
                                  grid.point_fields[0].values.as<float>().end());
        for (float& value : values) value += 0.125F * static_cast<float>(files.size());
        grid.points = Array::own(std::move(points), 3);
        grid.point_fields[0].values = Array::own(std::move(values));
        files.push_back(folder.file("step" + std::to_string(files.size()) + ".vtu"));
        write_grid(grid, files.back()).value();
    }
    return files;
}

TEST(PackFile, KeepsPointsThatMove) {
    const test::TemporaryFolder folder;
    const std::vector<std::string> files = moving_files(folder);
    Listener listener;
    PackJob together;
    together.grid.file = files[0];
    together.grid.more_files = {files[1], files[2]};
    together.all_steps = true;
    together.out = folder.file("together.isotet");
    EXPECT_EQ(pack_file(together, listener).value().steps, 3U);
    for (const std::string& file : files) {
        PackJob one;
        one.grid.file = file;
        one.append = file != files[0];
        one.out = folder.file("added.isotet");
        pack_file(one, listener).value();
    }
    for (const std::string out : {"together.isotet", "added.isotet"}) {
        const PackedFile file = PackedFile::open(folder.file(out)).value();
        file.check().value();
        ASSERT_EQ(file.info().moved_points.size(), 1U) << out;
        EXPECT_EQ(file.info().moved_points[0].step, 2U) << out;
        for (std::size_t step = 0; step < files.size(); ++step) {
            ExtractJob plain;
            plain.grid.file = files[step];
            plain.field.name = "gyroid";
            plain.isovalues = {0.1};
            plain.contour.method = Method::clusters;
            plain.out = folder.file("a.vtp");
            ExtractJob packed_job = plain;
            packed_job.grid.file = folder.file(out);
            packed_job.grid.step = step;
            packed_job.contour.method.reset();
            packed_job.out = folder.file("b.vtp");
            extract_files(plain, listener).value();
            extract_files(packed_job, listener).value();
            EXPECT_TRUE(test::content_of(plain.out) == test::content_of(packed_job.out)) << out << ", step " << step;
        }
    }
}

TEST(PackFile, RefusesToAddOtherCells) {
    const test::TemporaryFolder folder;
    Listener listener;
    PackJob job;
    job.grid.file = "make:kuhn:4:gyroid";
    job.out = folder.file("grid.isotet");
    pack_file(job, listener).value();
    const std::string before = test::content_of(job.out);
    job.grid.file = "make:kuhn:5:gyroid";
    job.append = true;
    EXPECT_EQ(pack_file(job, listener).error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(test::content_of(job.out) == before);
}

/// Surfaces of a packed file with so many between two steps.
ExtractJob job_between(const std::string& file, const std::string& out, std::uint64_t between) {
    ExtractJob job;
    job.grid.file = file;
    job.field.name = "gyroid";
    job.isovalues = {0.1};
    job.all_steps = true;
    job.interpolate = between;
    job.out = out;
    return job;
}

TEST(PackFile, GivesSurfacesBetweenSteps) {
    const test::TemporaryFolder folder;
    const std::vector<std::string> files = moving_files(folder);
    Listener listener;
    PackJob pack;
    pack.grid.file = files[0];
    pack.grid.more_files = {files[1], files[2]};
    pack.all_steps = true;
    pack.out = folder.file("run.isotet");
    pack_file(pack, listener).value();
    const ExtractNumbers numbers =
        extract_files(job_between(pack.out, folder.file("s{step}.vtp"), 3), listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 9U);
    const ExtractNumbers steps = extract_files(job_between(pack.out, folder.file("t{step}.vtp"), 0), listener).value();
    ASSERT_EQ(steps.surfaces.size(), 3U);
    for (const std::size_t step : {0U, 1U, 2U})
        EXPECT_TRUE(test::content_of(numbers.surfaces[4 * step].file) == test::content_of(steps.surfaces[step].file));
    EXPECT_TRUE(numbers.surfaces[1].file.ends_with("s1.vtp"));
    EXPECT_TRUE(numbers.surfaces[8].file.ends_with("s8.vtp"));
    for (std::size_t i = 1; i < 4; ++i) EXPECT_GT(numbers.surfaces[4 + i].area, numbers.surfaces[3 + i].area);

    DrawJob draw;
    draw.grid.file = pack.out;
    draw.field.name = "gyroid";
    draw.isovalues = {0.1};
    draw.out = folder.file("p-{frame}.png");
    draw.picture.width = draw.picture.height = 64;
    draw.all_steps = true;
    draw.interpolate = 1;
    EXPECT_EQ(draw_files(draw, listener).value().pictures.pictures, 5U);

    ExtractJob refused = job_between(files[0], folder.file("u{step}.vtp"), 1);
    EXPECT_EQ(extract_files(refused, listener).error().code, ErrorCode::invalid_argument) << "no packed file";
    refused = job_between(pack.out, folder.file("u{step}.vtp"), 1);
    refused.contour.normals = Normals::gradient;
    EXPECT_EQ(extract_files(refused, listener).error().code, ErrorCode::invalid_argument) << "no gradients";
    draw.solid = SolidSide::above;
    EXPECT_EQ(draw_files(draw, listener).error().code, ErrorCode::invalid_argument);
}

TEST(PackFile, IsSlicedWithoutItsGrid) {
    const test::TemporaryFolder folder;
    Listener listener;
    const std::string grid = grid_with_all_kinds(folder), path = packed(grid, folder, listener, {"region"});
    SliceJob job;
    job.grid.file = path;
    job.shape = Plane{{0, 0, 1}, 0.3};
    job.out = folder.file("cut.vtp");
    job.memory = 50'000;
    listener.noted.clear();
    const ExtractNumbers numbers = slice_files(job, listener).value();
    for (const std::string& note : listener.noted) EXPECT_EQ(note.find("all of the packed file"), note.npos) << note;
    EXPECT_EQ(numbers.why, "the file is packed");
    const Surface surface = read_surface(job.out).value().surface;
    EXPECT_NEAR(area(surface), 4, 1e-5);
    ASSERT_EQ(surface.point_fields.size(), 2U);
    EXPECT_EQ(surface.point_fields[1].name, "U");
    ASSERT_EQ(surface.cell_fields.size(), 1U);
    EXPECT_EQ(surface.cell_fields[0].name, "region");
    SliceJob whole = job;
    whole.grid.file = grid;
    whole.contour.method = Method::clusters;
    whole.with = {"U", "region"};
    job.with = whole.with;
    whole.out = folder.file("whole.vtp");
    slice_files(job, listener).value();
    slice_files(whole, listener).value();
    EXPECT_TRUE(test::content_of(job.out) == test::content_of(whole.out));
}

TEST(PackFile, SurfacesCarryCellFieldsAsThoseOfTheGrid) {
    const test::TemporaryFolder folder;
    Listener listener;
    const std::string grid = grid_with_all_kinds(folder), path = packed(grid, folder, listener, {"region"});
    EXPECT_EQ(listener.noted.front(),
              "not packed: 'stress' (9 components); `fields` takes components, `cell_fields` fields "
              "of cells");
    std::string contents[2], pictures[2];
    for (const bool from_file : {false, true}) {
        ExtractJob extract;
        extract.grid.file = from_file ? path : grid;
        extract.out = folder.file("a.vtp");
        extract.field.name = "U:mag";
        extract.isovalues = {0.7};
        extract.with = std::vector<std::string>{"region"};
        if (!from_file) extract.contour.method = Method::clusters;
        Listener told;
        extract_files(extract, told).value();
        contents[from_file] = test::content_of(extract.out);
        DrawJob draw;
        draw.grid.file = extract.grid.file;
        draw.out = folder.file("a.png");
        draw.field.name = "U:mag";
        draw.isovalues = {0.7};
        draw.boundary = 0;
        draw.color_by = "region";
        draw.picture.width = 160;
        draw.picture.height = 120;
        draw_files(draw, told).value();
        pictures[from_file] = test::content_of(draw.out);
        for (const std::string& note : told.noted) EXPECT_EQ(note.find("all of the packed file"), note.npos) << note;
    }
    EXPECT_TRUE(contents[0] == contents[1]);
    EXPECT_TRUE(pictures[0] == pictures[1]);
    PackJob missing;
    missing.grid.file = grid;
    missing.out = folder.file("b.isotet");
    missing.cell_fields = {"gyroid"};
    EXPECT_FALSE(pack_file(missing, listener)) << "it is no cell field";
}

TEST(PackFile, NamesNoFieldAsLeftOutThatItPacks) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "hex", .side = 4, .fields = {"sphere"}}).value();
    grid.point_fields.clear();
    for (const char* name : {"p", "T"}) {
        std::vector<float> values;
        for (std::size_t i = 0; i < grid.cells.count(); ++i) values.push_back(static_cast<float>(i));
        grid.cell_fields.push_back({name, Array::own(std::move(values))});
    }
    const std::string plain = folder.file("cells.vtu");
    write_grid(grid, plain).value();
    Listener listener;
    const PackedFile file = PackedFile::open(packed(plain, folder, listener)).value();
    ASSERT_EQ(file.info().fields.size(), 1U);
    const std::string taken = file.info().fields[0].report.name, left_out = taken == "p" ? "T" : "p";
    ASSERT_EQ(listener.noted.size(), 2U);
    EXPECT_EQ(listener.noted[1],
              "not packed: '" + left_out + "' (of cells); `fields` takes components, `cell_fields` fields of cells");
}

TEST(PackFile, LeavesOutBrokenFieldsThatWereNotNamed) {
    const test::TemporaryFolder folder;
    const std::string grid = folder.write(
        "grid.vtu",
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
        "NumberOfCells=\"1\"><PointData>"
        "<DataArray type=\"Float32\" Name=\"T\" format=\"ascii\">0 1 2 3</DataArray>"
        "<DataArray type=\"Float32\" Name=\"bad\" format=\"ascii\">0 1</DataArray></PointData><Points>"
        "<DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>"
        "<DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3</DataArray>"
        "<DataArray type=\"Int32\" Name=\"offsets\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\">10"
        "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>");
    PackJob job;
    job.grid.file = grid;
    job.out = folder.file("grid.isotet");
    Listener listener;
    const auto numbers = pack_file(job, listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    ASSERT_EQ(numbers->fields.size(), 1u);
    EXPECT_EQ(numbers->fields[0].name, "T");
    EXPECT_NE(std::ranges::find(listener.noted, "not packed: 'bad', which the grid that was read lacks"),
              listener.noted.end());
    job.fields = {"T", "bad"};
    EXPECT_FALSE(pack_file(job, listener));
}

TEST(PackFile, GivesTheSameFileWithItsArraysInScratchFiles) {
    const test::TemporaryFolder folder;
    Listener listener(2);
    const std::string kinds = grid_with_all_kinds(folder);
    for (const std::string& grid : {std::string("make:kelvin:4:gyroid,sphere"), kinds}) {
        PackJob job;
        job.grid.file = grid;
        job.out = folder.file("plain.isotet");
        job.pack.precision = Precision::float64;
        job.pack.gradients = true;
        if (grid == kinds) job.cell_fields = {"region"};
        EXPECT_EQ(pack_file(job, listener).value().scratch_bytes, 0U);
        const std::string expected = test::content_of(job.out);
        const ScratchMemory scratch = ScratchMemory::begin({folder.file(""), 1}).value(); // less than a job may ask for
        job.out = folder.file("scratch.isotet");
        pack_file(job, listener).value();
        EXPECT_TRUE(test::content_of(job.out) == expected) << grid;
        EXPECT_GT(scratch.report().peak_bytes, 0U) << grid;
    }
}

TEST(PackFile, PutsIntoFilesWhatIsMoreThanTheMemoryThatIsWanted) {
    const test::TemporaryFolder folder;
    Listener listener;
    PackJob job;
    job.grid.file = "make:kuhn:40:gyroid"; // of whose arrays one is larger than a sixteenth of that
    job.out = folder.file("a.isotet");
    job.memory = 84'000'000;
    job.scratch = folder.file("");
    EXPECT_GT(pack_file(job, listener).value().scratch_bytes, 0U);
    const std::string content = test::content_of(job.out);
    job.memory.reset();
    job.scratch.clear();
    EXPECT_EQ(pack_file(job, listener).value().scratch_bytes, 0U);
    EXPECT_TRUE(test::content_of(job.out) == content);
}

TEST(PackFile, RefusesLessMemoryThanItNeeds) {
    const test::TemporaryFolder folder;
    Listener listener;
    PackJob job;
    job.grid.file = "make:kuhn:20:gyroid";
    job.out = folder.file("a.isotet");
    const auto refusal_of = [&](std::uint64_t memory) {
        job.memory = memory;
        const auto refused = pack_file(job, listener);
        EXPECT_FALSE(refused);
        if (refused) return std::string();
        EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
        return refused.error().message;
    };
    EXPECT_EQ(refusal_of(50'000'000), "packing needs at least 80.0 MB of memory, but `memory` is 50.0 MB"); // not read
    EXPECT_EQ(refusal_of(80'100'000), "packing needs at least 80.4 MB of memory, but `memory` is 80.1 MB");
    job.memory = 100'000'000;
    job.scratch = folder.file("nowhere");
    const auto nowhere = pack_file(job, listener);
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().code, ErrorCode::cannot_write);
    EXPECT_FALSE(std::filesystem::exists(job.out));
}

} // namespace
} // namespace isotet::jobs
