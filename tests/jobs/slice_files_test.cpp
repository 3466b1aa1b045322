// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/slice_files.hpp>

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

SliceJob slice_of_file(const std::string& grid, const std::string& out, const SliceShape& shape) {
    SliceJob job;
    job.grid.file = grid;
    job.out = out;
    job.shape = shape;
    return job;
}

/// With a cell field of the cells' numbers.
Grid numbered_grid(const std::string& shape, std::uint64_t side) {
    Grid grid = make_grid({.shape = shape, .side = side, .fields = {"sphere", "gyroid"}}).value();
    std::vector<std::int64_t> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int64_t>(i);
    grid.cell_fields = {{"number", Array::own(std::move(numbers))}};
    return grid;
}

const Array& values_of(const std::vector<Field>& fields, const std::string& name) {
    return std::ranges::find(fields, name, &Field::name)->values;
}

TEST(SliceFiles, CutsWhereAShareOfTheVolumeIsBefore) {
    Listener listener;
    SliceJob job = slice_of_file("make:hex:4:gyroid", "", Plane{{0, 0, 1}, 0});
    job.shares = {{IsovalueShare::Of::volume, 25}};
    job.at = {0.75};
    const ExtractNumbers numbers = slice_files(job, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 2u);
    EXPECT_EQ(numbers.surfaces[0].isovalue, 0.75);
    EXPECT_NEAR(numbers.surfaces[1].isovalue, -0.5, 1e-9);
    job.count = 2;
    EXPECT_EQ(slice_files(job, listener).error().code, ErrorCode::invalid_argument);
}

TEST(SliceFiles, CarriesAllPointAndCellFields) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_grid(numbered_grid("mixed", 5), folder.file("grid.vtu")));
    Listener listener;
    SliceJob job = slice_of_file(folder.file("grid.vtu"), folder.file("cut.vtp"), Plane{{0, 0, 1}, 0.1});
    job.contour.source_cells = true;
    const ExtractNumbers numbers = slice_files(job, listener).value();
    EXPECT_TRUE(listener.noted.empty());
    ASSERT_EQ(numbers.surfaces.size(), 1u);
    EXPECT_EQ(numbers.surfaces[0].isovalue, 0.1);
    EXPECT_NEAR(numbers.surfaces[0].area, 4, 1e-5);
    EXPECT_EQ(numbers.field.name, "z");
    const Surface surface = read_surface(job.out).value().surface;
    ASSERT_EQ(surface.point_fields.size(), 2u);
    const Array &number = values_of(surface.cell_fields, "number"), &source = surface.source_cells;
    ASSERT_EQ(number.tuples(), surface.triangle_count());
    ASSERT_EQ(source.tuples(), surface.triangle_count());
    for (std::size_t i = 0; i < number.tuples(); ++i) ASSERT_EQ(number.at(i), source.at(i));
}

TEST(SliceFiles, CarriesWhatIsAskedForAndWhatTheFormatHolds) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_grid(numbered_grid("kuhn", 4), folder.file("grid.vtu")));
    Listener listener;
    SliceJob job = slice_of_file(folder.file("grid.vtu"), folder.file("cut.vtp"), Sphere{{0, 0, 0}, 0.5});
    job.with = {"gyroid"};
    ASSERT_TRUE(slice_files(job, listener));
    const Surface surface = read_surface(job.out).value().surface;
    ASSERT_EQ(surface.point_fields.size(), 1u);
    EXPECT_EQ(surface.point_fields[0].name, "gyroid");
    EXPECT_TRUE(surface.cell_fields.empty());
    job.with.reset();
    for (const char* name : {"cut.stl", "cut.ts", "cut.ply", "cut.obj"}) {
        job.out = folder.file(name);
        EXPECT_TRUE(slice_files(job, listener)) << name;
    }
    EXPECT_TRUE(listener.noted.empty()) << listener.noted.front();
}

TEST(SliceFiles, CountsPlanesEvenlyInsideTheExtent) {
    const test::TemporaryFolder folder;
    Listener listener;
    SliceJob job = slice_of_file("make:hex:6:sphere", folder.file("cut-{value}.vtp"), Plane{{0, 1, 0}, 0});
    job.count = 3;
    const ExtractNumbers numbers = slice_files(job, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(numbers.surfaces[i].isovalue, -0.5 + 0.5 * static_cast<double>(i));
        EXPECT_NEAR(numbers.surfaces[i].area, 4, 1e-6);
    }
    for (const char* name : {"cut--0.5.vtp", "cut-0.vtp", "cut-0.5.vtp"})
        EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
}

TEST(SliceFiles, OfSeveralPlacesAreTheSameAsAlone) {
    const test::TemporaryFolder folder;
    Listener listener;
    SliceJob job = slice_of_file("make:perturbed:6:sphere", folder.file("some-{value}.vtp"), Plane{{1, 1, 0}, 0});
    job.at = {0.1, 0.2, -0.3};
    ASSERT_EQ(slice_files(job, listener).value().surfaces.size(), 3u);
    job.at = {0.2};
    job.out = folder.file("alone.vtp");
    ASSERT_TRUE(slice_files(job, listener));
    EXPECT_EQ(test::content_of(folder.file("some-0.2.vtp")), test::content_of(folder.file("alone.vtp")));
}

TEST(SliceFiles, OfReadersThatKeepOnlyCutCellsAreThoseOfAllCells) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    for (const char* kind : {"shuffled", "hex"}) {
        const Grid grid = numbered_grid(kind, 14);
        ASSERT_TRUE(write_grid(grid, file));
        for (const SliceShape& shape :
             {SliceShape(Plane{{0.2, -0.5, 1}, 0.1}), SliceShape(Plane{{0, 0, 1}, 0}),
              SliceShape(Sphere{{0, 0, 0}, 0.4}), SliceShape(Cylinder{{0, 1, 1}, {0, 0, 0}, 0.3})}) {
            SCOPED_TRACE(testing::Message() << kind << " " << shape.index());
            ReadOptions some;
            some.active_cells = ReadActiveCells{"", {slice_isovalue(shape)}, {}, shape};
            const ReadResult read_some = read(file, some).value();
            ASSERT_EQ(read_some.cells_in_file, grid.cells.count());
            EXPECT_LT(read_some.grid.cells.count(), grid.cells.count() / 3);
            Listener listener;
            SliceJob job = slice_of_file(file, folder.file("some.vtp"), shape);
            const ExtractNumbers numbers = slice_files(job, listener).value();
            EXPECT_EQ(numbers.cells, grid.cells.count());
            EXPECT_EQ(std::ranges::count(listener.details, "reading all cells of step 0"), 0);
            job.out = folder.file("all.vtp");
            job.engine = EngineChoice::reference; // reads all cells
            ASSERT_TRUE(slice_files(job, listener));
            EXPECT_EQ(test::content_of(folder.file("some.vtp")), test::content_of(folder.file("all.vtp")));
        }
    }
}

TEST(SliceFiles, CutsEveryTimeStep) {
    const test::TemporaryFolder folder;
    for (const std::uint64_t step : {0, 1}) {
        const Grid grid = make_grid({.shape = "kuhn", .side = 3 + step, .fields = {"sphere"}}).value();
        ASSERT_TRUE(write_grid(grid, folder.file("step" + std::to_string(step) + ".vtu")));
    }
    const std::string series =
        folder.write("run.pvd", R"(<VTKFile type="Collection"><Collection><DataSet timestep="0" file="step0.vtu"/>)"
                                R"(<DataSet timestep="1" file="step1.vtu"/></Collection></VTKFile>)");
    Listener listener;
    SliceJob job = slice_of_file(series, folder.file("cut-{step}.vtp"), Plane{{0, 0, 1}, 0.1});
    job.all_steps = true;
    const ExtractNumbers numbers = slice_files(job, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 2u);
    for (const SurfaceNumbers& surface : numbers.surfaces) EXPECT_NEAR(surface.area, 4, 1e-6);
    EXPECT_GT(numbers.surfaces[1].triangles, numbers.surfaces[0].triangles);
    EXPECT_EQ(numbers.collection, folder.file("cut.pvd"));
}

TEST(SliceFiles, MakesSolidsOfBothSides) {
    Listener listener;
    SliceJob job = slice_of_file("make:hex:4:sphere", "", Plane{{0, 0, 1}, 0.5});
    job.solid = SolidChoice{SolidChoice::Kind::below, {}};
    EXPECT_NEAR(slice_files(job, listener).value().surfaces[0].solid->volume, 6, 1e-6);
    job.solid = SolidChoice{SolidChoice::Kind::between, {-0.25, 0.5}};
    EXPECT_NEAR(slice_files(job, listener).value().surfaces[0].solid->volume, 3, 1e-6);
}

TEST(SliceFiles, SaysWhereTheGridIsWhenAPlaneMissesIt) {
    const test::TemporaryFolder folder;
    Listener listener;
    SliceJob job = slice_of_file("make:kuhn:4:sphere", folder.file("cut.vtp"), Plane{{0, 0, 1}, 7});
    EXPECT_EQ(slice_files(job, listener).error().code, ErrorCode::invalid_data);
    job.allow_empty = true;
    ASSERT_TRUE(slice_files(job, listener));
    ASSERT_EQ(listener.noted.size(), 1u);
    EXPECT_EQ(listener.noted[0], "isovalue 7 is outside the range of 'z', -1 to 1: the surface is empty");
    job.allow_empty = false;
    job.fail_if_empty = true;
    EXPECT_EQ(slice_files(job, listener).error().code, ErrorCode::invalid_data);
}

TEST(SliceFiles, RefusesWhatSaysNoPlace) {
    Listener listener;
    SliceJob job = slice_of_file("make:kuhn:2:sphere", "", Sphere{{0, 0, 0}, 1});
    job.count = 3;
    EXPECT_EQ(slice_files(job, listener).error().message,
              "`count` is 3, but only planes `along` a direction are counted");
    job.count = 0;
    job.at = {1, -2};
    EXPECT_EQ(slice_files(job, listener).error().message, "the radius is -2, but must be finite and not negative");
    job.at.clear();
    job.shape = Plane{{0, 0, 0}, 1};
    EXPECT_EQ(slice_files(job, listener).error().code, ErrorCode::invalid_argument);
    job.shape.reset();
    EXPECT_EQ(slice_files(job, listener).error().message,
              "nothing says where to cut: `plane`, `along`, `sphere` or `cylinder` does");
}

} // namespace
} // namespace isotet::jobs
