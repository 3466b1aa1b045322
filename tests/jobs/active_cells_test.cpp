// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A job that reads active cells only writes what it writes with all cells, and reads all where they are needed.
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;
using test::some_of;

Grid made(const std::string& shape, std::uint64_t side) {
    return make_grid({.shape = shape, .side = side, .fields = {"gyroid", "integer"}}).value();
}

ReadOptions active_options(std::vector<double> isovalues) {
    ReadOptions options;
    options.cell_fields = std::vector<std::string>{};
    options.active_cells = ReadActiveCells{"gyroid", std::move(isovalues), {}};
    return options;
}

ExtractJob active_job(const std::string& grid, const std::string& out) {
    ExtractJob job;
    job.grid.file = grid;
    job.out = out;
    job.field.name = "gyroid";
    job.isovalues = {0.1, -0.7, 0.0};
    return job;
}

bool was_read_twice(const Listener& listener) {
    return std::ranges::find(listener.details, "reading all cells of step 0") != listener.details.end();
}

bool tells_of_kept_cells(const Listener& listener) {
    return std::ranges::any_of(listener.details, [](const std::string& detail) {
        return detail.find("cells were kept") != std::string::npos;
    });
}

/// The file of the engine that always reads all cells.
std::string reference_file(ExtractJob job, const test::TemporaryFolder& folder) {
    Listener listener;
    job.out = folder.file("reference.vtp");
    job.engine = EngineChoice::reference;
    EXPECT_TRUE(extract_files(job, listener));
    return test::content_of(job.out);
}

TEST(ActiveCellsOfFiles, AreReadWhereThatCanBeDone) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "shuffled", "hex"}))
        for (const Compression compression : {Compression::none, Compression::zlib, Compression::lz4}) {
            SCOPED_TRACE(testing::Message() << shape << " " << name_of(compression));
            const Grid grid = made(shape, 40);
            ASSERT_TRUE(write_grid(grid, file, {.compression = compression}));
            const ReadResult some = read(file, active_options({0.1})).value();
            EXPECT_EQ(some.cells_in_file, grid.cells.count());
            EXPECT_LT(some.grid.cells.count(), grid.cells.count() / 3);
            EXPECT_EQ(some.grid.points.tuples(), grid.points.tuples());
            const ReadResult all = read(file).value();
            EXPECT_FALSE(all.cells_in_file);
            EXPECT_EQ(all.grid.cells.count(), grid.cells.count());
        }
}

TEST(ActiveCellsOfFiles, GiveTheFileOfAllCells) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "shuffled", "hex", "layer"}))
        for (const bool degenerate : {false, true}) {
            SCOPED_TRACE(testing::Message() << shape << " " << degenerate);
            const Grid grid = made(shape, 16);
            ASSERT_TRUE(write_grid(grid, file));
            ExtractJob job = active_job(file, folder.file("active.vtp"));
            job.keep_degenerate = degenerate;
            job.contour.edge_ends = degenerate;
            Listener listener;
            const ExtractNumbers numbers = extract_files(job, listener).value();
            EXPECT_EQ(numbers.cells, grid.cells.count());
            EXPECT_FALSE(was_read_twice(listener));
            EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
        }
}

/// A region in layers, and a part that changes from cell to cell.
std::vector<Field> cell_fields_of(std::size_t cells) {
    std::vector<std::int32_t> region(cells);
    std::vector<float> part(cells);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        region[cell] = static_cast<std::int32_t>(3 * cell / cells);
        part[cell] = static_cast<float>(cell * 7919 % 100) / 100;
    }
    return {{"region", Array::own(std::move(region))}, {"part", Array::own(std::move(part))}};
}

TEST(ActiveCellsOfFiles, MayBeThoseOfARegion) {
    const test::TemporaryFolder folder;
    using Choice = std::vector<std::string>;
    for (const char* shape : {"kuhn", "shuffled", "hex", "mixed"})
        for (const char* ending : {".vtu", ".vtk"})
            for (const Choice& choice : {Choice{"region=1"}, {"!region=0", "part=:0.4"}, {"region=0:2"}}) {
                SCOPED_TRACE(testing::Message() << shape << ending << " " << choice.back());
                const std::string file = folder.file("grid") + ending;
                Grid grid = made(shape, 16);
                grid.cell_fields = cell_fields_of(grid.cells.count());
                ASSERT_TRUE(write_grid(grid, file));
                ExtractJob job = active_job(file, folder.file("active.vtp"));
                job.grid.cells = choice;
                job.contour.source_cells = job.contour.edge_ends = true;
                job.with = std::vector<std::string>{"integer", "part"};
                job.contour.normals = choice.size() == 1 ? Normals::none : Normals::gradient;
                Listener listener, other;
                const ExtractNumbers some = extract_files(job, listener).value();
                const bool streams = shape != std::string("mixed") || ending != std::string(".vtk");
                EXPECT_EQ(tells_of_kept_cells(listener), streams);
                EXPECT_FALSE(was_read_twice(listener));
                const std::string written = test::content_of(job.out);
                job.engine = EngineChoice::reference;
                const ExtractNumbers all = extract_files(job, other).value();
                EXPECT_TRUE(written == test::content_of(job.out));
                EXPECT_EQ(listener.noted, other.noted);
                EXPECT_EQ(some.cells, all.cells);
                EXPECT_EQ(some.cells_left_out, all.cells_left_out);
                EXPECT_EQ(some.field.lower, all.field.lower);
                EXPECT_EQ(some.field.upper, all.field.upper);
            }
}

TEST(ActiveCellsOfFiles, AreOfCellFieldsThatAreAveraged) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "shuffled", "hex", "octree"}))
        for (const char* ending : {".vtu", ".vtk"})
            for (const char* field : {"part", "region", "vector:y", "vector:mag", "tensor:yy", "part+region/4"}) {
                SCOPED_TRACE(testing::Message() << shape << ending << " " << field);
                const std::string file = folder.file("grid") + ending;
                Grid grid = made(shape, 12);
                const std::size_t cells = grid.cells.count();
                grid.cell_fields = cell_fields_of(cells);
                std::vector<double> vectors(3 * cells);
                for (std::size_t i = 0; i < vectors.size(); ++i)
                    vectors[i] = i % 31 == 0 ? NAN : static_cast<double>(i * i % 1000) / 500;
                grid.cell_fields.push_back({"vector", Array::own(std::move(vectors), 3)});
                std::vector<double> tensors(6 * cells);
                for (std::size_t i = 0; i < tensors.size(); ++i) tensors[i] = static_cast<double>(i * i % 997) / 500;
                grid.cell_fields.push_back({"tensor", Array::own(std::move(tensors), 6)});
                ASSERT_TRUE(write_grid(grid, file));
                ExtractJob job = active_job(file, folder.file("active.vtp"));
                job.field.name = field;
                job.isovalues = {0.5, 0.9};
                if (std::string(ending) == ".vtk") job.contour.normals = Normals::gradient;
                if (std::string(field) == "part") job.isovalues.clear(); // by the values
                Listener listener, other;
                const ExtractNumbers some = extract_files(job, listener).value();
                EXPECT_TRUE(some.averaged);
                const bool streams =
                    std::string(shape) != "octree" && (shape != std::string("mixed") || ending != std::string(".vtk"));
                EXPECT_EQ(tells_of_kept_cells(listener), streams);
                EXPECT_FALSE(was_read_twice(listener));
                const std::string written = test::content_of(job.out);
                job.engine = EngineChoice::reference;
                const ExtractNumbers all = extract_files(job, other).value();
                EXPECT_TRUE(written == test::content_of(job.out));
                EXPECT_EQ(listener.noted, other.noted);
                EXPECT_EQ(some.cells, all.cells);
                EXPECT_EQ(some.field.lower, all.field.lower);
                EXPECT_EQ(some.field.upper, all.field.upper);
            }
}

TEST(ActiveCellsOfFiles, HaveThoseAroundThemForGradientNormals) {
    const test::TemporaryFolder folder;
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "shuffled", "hex", "layer"}))
        for (const char* ending : {".vtu", ".vtk"}) {
            SCOPED_TRACE(testing::Message() << shape << ending);
            const std::string file = folder.file("grid") + ending;
            ASSERT_TRUE(write_grid(made(shape, 16), file));
            ReadOptions options = active_options({0.1});
            options.active_cells->options.extract.normals = Normals::gradient;
            const ReadResult some = read(file, options).value();
            if (some.cells_in_file) {
                EXPECT_LT(some.grid.cells.count(), *some.cells_in_file);
            }
            ExtractJob job = active_job(file, folder.file("active.vtp"));
            job.contour.normals = Normals::gradient;
            job.contour.source_cells = true;
            Listener listener;
            EXPECT_EQ(extract_files(job, listener).value().method, Method::direct);
            EXPECT_FALSE(was_read_twice(listener));
            EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
        }
}

TEST(ActiveCellsOfFiles, AreOfAnyNumberOfIsovaluesWithTheirNumbers) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    for (const char* shape : some_of<const char*>({"mixed", "shuffled", "hex"}))
        for (const std::size_t isovalues : {1, 2, 11, 31}) {
            SCOPED_TRACE(testing::Message() << shape << " " << isovalues);
            ASSERT_TRUE(write_grid(made(shape, 12), file));
            ExtractJob job = active_job(file, folder.file("active.vtp"));
            job.isovalues.clear();
            for (std::size_t i = 0; i < isovalues; ++i)
                job.isovalues.push_back(0.05 * static_cast<double>((7 * i) % 31) - 0.7);
            job.contour.source_cells = true;
            job.contour.edge_ends = isovalues == 2;
            Listener listener;
            EXPECT_EQ(extract_files(job, listener).value().method, Method::direct);
            EXPECT_FALSE(was_read_twice(listener));
            EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
        }
}

TEST(ActiveCellsOfFiles, AreOfShares) {
    using enum IsovalueShare::Of;
    const test::TemporaryFolder folder;
    for (const char* shape : {"shuffled", "hex", "mixed", "octree"})
        for (const char* name : {"grid.vtu", "grid.vtk"})
            for (const IsovalueShare share : {IsovalueShare{points, 90}, {volume, 60}}) {
                SCOPED_TRACE(testing::Message() << shape << name << share.percent);
                const std::string file = folder.file(name);
                ASSERT_TRUE(write_grid(made(shape, 16), file));
                ExtractJob job = active_job(file, folder.file("active.vtp"));
                job.isovalues = {0.1};
                job.shares = {share};
                Listener listener;
                const ExtractNumbers numbers = extract_files(job, listener).value();
                EXPECT_EQ(numbers.surfaces.size(), 2u);
                const bool several_types = std::string_view(shape) == "mixed" && std::string_view(name) == "grid.vtk";
                EXPECT_EQ(tells_of_kept_cells(listener), !several_types && std::string_view(shape) != "octree");
                EXPECT_FALSE(was_read_twice(listener));
                EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
            }
}

TEST(ActiveCellsOfFiles, AreOfIsovaluesThatFollowFromTheValues) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    for (const char* shape : some_of<const char*>({"mixed", "shuffled", "hex"}))
        for (const char* field : {"gyroid", "integer"})
            for (const std::uint64_t levels : {0, 1, 5}) {
                SCOPED_TRACE(testing::Message() << shape << " " << field << " " << levels);
                ASSERT_TRUE(write_grid(made(shape, 12), file));
                ExtractJob job = active_job(file, folder.file("active.vtp"));
                job.field.name = field;
                job.isovalues.clear();
                job.levels = levels;
                Listener listener, other;
                EXPECT_EQ(extract_files(job, listener).value().method, Method::direct);
                EXPECT_FALSE(was_read_twice(listener));
                EXPECT_TRUE(std::ranges::any_of(listener.details, [](const std::string& detail) {
                    return detail.find("cells were kept") != std::string::npos;
                }));
                EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
                job.engine = EngineChoice::reference;
                EXPECT_TRUE(extract_files(job, other));
                EXPECT_EQ(listener.noted, other.noted) << "the range and its middle";
            }
}

/// The range is that of used points: all cells are read where others have its ends.
TEST(ActiveCellsOfFiles, AreReadAgainWhereAPointWithoutCellHasTheLargestValue) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    Grid grid = made("shuffled", 12);
    const auto places = grid.points.as<float>();
    std::vector<float> points(places.begin(), places.end()), values;
    points.insert(points.end(), {0.31F, 0.32F, 0.33F});
    for (std::size_t i = 0; i < grid.point_fields[0].values.tuples(); ++i)
        values.push_back(static_cast<float>(grid.point_fields[0].values.at(i)));
    values.push_back(100);
    grid.points = Array::own(std::move(points), 3);
    grid.point_fields = {{"gyroid", Array::own(std::move(values))}};
    ASSERT_TRUE(write_grid(grid, file));
    ExtractJob job = active_job(file, folder.file("active.vtp"));
    job.isovalues.clear();
    Listener listener;
    const ExtractNumbers numbers = extract_files(job, listener).value();
    EXPECT_TRUE(was_read_twice(listener));
    EXPECT_LT(numbers.surfaces.at(0).isovalue, 2);
    EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
}

TEST(ActiveCellsOfFiles, AreAmongCellsWithoutVolume) {
    const test::TemporaryFolder folder;
    Grid grid = made("mixed", 8);
    std::vector<std::int64_t> corners{0, 1, 2, 5}, offsets{0, 1, 4}; // a vertex and a triangle come first
    std::vector<std::uint8_t> types{1, 5};
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        for (auto i = static_cast<std::size_t>(grid.cells.offsets.at(cell)); i < grid.cells.offsets.at(cell + 1); ++i)
            corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
        types.push_back(static_cast<std::uint8_t>(grid.cells.types.at(cell)));
        offsets.push_back(static_cast<std::int64_t>(corners.size()));
        if (cell % 3 != 0) continue;
        corners.insert(corners.end(), {3, 7, 8, 4}); // a quadrilateral
        types.push_back(9);
        offsets.push_back(static_cast<std::int64_t>(corners.size()));
    }
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::move(types));
    const std::string file = folder.file("grid.vtu");
    ASSERT_TRUE(write_grid(grid, file));
    EXPECT_EQ(read(file, active_options({0.1})).value().cells_in_file, grid.cells.count());
    for (const double isovalue : {0.1, 17.0}) {
        ExtractJob job = active_job(file, folder.file("active.vtp"));
        job.isovalues = {isovalue};
        job.allow_empty = true;
        Listener listener, other;
        EXPECT_EQ(extract_files(job, listener).value().cells, grid.cells.count());
        EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
        job.engine = EngineChoice::reference;
        EXPECT_TRUE(extract_files(job, other));
        EXPECT_EQ(listener.noted, other.noted) << "cells left out are told";
    }
}

TEST(ActiveCellsOfFiles, AreOfEachStep) {
    const test::TemporaryFolder folder;
    std::string entries;
    for (const int step : {0, 1, 2}) {
        const std::string name = "step" + std::to_string(step) + ".vtu";
        ASSERT_TRUE(write_grid(made("kuhn", 8 + static_cast<std::uint64_t>(step)), folder.file(name)));
        entries += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
    }
    const std::string file =
        folder.write("series.pvd", "<VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>");
    ExtractJob job = active_job(file, folder.file("s{step}.vtp"));
    job.all_steps = true;
    Listener listener;
    const ExtractNumbers numbers = extract_files(job, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 9u);
    EXPECT_EQ(numbers.method, Method::direct);
    for (const int step : {0, 1, 2}) {
        ExtractJob one = active_job(folder.file("step" + std::to_string(step) + ".vtu"), "");
        EXPECT_TRUE(test::content_of(folder.file("s" + std::to_string(step) + ".vtp")) == reference_file(one, folder));
    }
}

TEST(ActiveCellsOfFiles, AreNotEnoughWhereUnusedPointsDecide) {
    const test::TemporaryFolder folder;
    Grid grid = made("kuhn", 8);
    std::vector<double> points{1e6, 1e6, 1e6}; // no cell has it, and rounding to float32 goes by the bounds
    for (std::size_t i = 0; i < grid.points.size(); ++i) points.push_back(grid.points.at(i / 3, i % 3) + 5e5);
    std::vector<std::int32_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        corners.push_back(static_cast<std::int32_t>(grid.cells.connectivity.at(i)) + 1);
    std::vector<float> values{0};
    for (const float value : grid.point_fields[0].values.as<float>()) values.push_back(value);
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.point_fields = {{"gyroid", Array::own(std::move(values))}};
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    const ExtractJob job = active_job(folder.file("grid.vtu"), folder.file("active.vtp"));
    Listener listener;
    const ExtractNumbers numbers = extract_files(job, listener).value();
    EXPECT_TRUE(was_read_twice(listener));
    EXPECT_EQ(numbers.cells, grid.cells.count());
    EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
}

/// Of some types; tuples of some lie in two blocks of a file. The last one is NaN here and there.
void add_cell_fields(Grid& grid) {
    std::vector<std::int64_t> numbers(grid.cells.count());
    std::vector<std::uint8_t> small(numbers.size());
    std::vector<double> odd(numbers.size());
    std::vector<float> vectors(3 * numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<std::int64_t>(i);
        small[i] = static_cast<std::uint8_t>(i % 251);
        odd[i] = i % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : 0.1 * static_cast<double>(i);
        for (std::size_t k = 0; k < 3; ++k) vectors[3 * i + k] = static_cast<float>(i) + 0.25f * static_cast<float>(k);
    }
    grid.cell_fields = {{"number", Array::own(std::move(numbers))},
                        {"small", Array::own(std::move(small))},
                        {"vector", Array::own(std::move(vectors), 3)},
                        {"odd", Array::own(std::move(odd))}};
}

TEST(ActiveCellsOfFiles, HaveTheirValuesOfCellFields) {
    const test::TemporaryFolder folder;
    for (const char* ending : {".vtu", ".vtk"})
        for (const char* shape : some_of<const char*>({"mixed", "shuffled", "hex"}))
            for (const Compression compression :
                 test::some_of({Compression::none, Compression::zlib, Compression::lz4})) {
                SCOPED_TRACE(testing::Message() << ending << " " << shape << " " << name_of(compression));
                const std::string file = folder.file("grid") + ending;
                Grid grid = made(shape, 16);
                add_cell_fields(grid);
                if (std::string(ending) == ".vtk" && compression != Compression::none) continue;
                ASSERT_TRUE(write_grid(grid, file, {.compression = compression}));
                ReadOptions options = active_options({0.1});
                options.cell_fields.reset();
                options.active_cells->options.extract.source_cells = true;
                const ReadResult some = read(file, options).value();
                const ReadResult all = read(file).value();
                EXPECT_EQ(some.notes, all.notes);
                if (std::string(ending) == ".vtk" && std::string(shape) == "mixed") {
                    EXPECT_FALSE(some.cells_in_file);
                    continue;
                }
                ASSERT_TRUE(some.cells_in_file);
                ASSERT_EQ(some.grid.cell_fields.size(), all.grid.cell_fields.size());
                const auto cells = some.cell_numbers.as<std::uint64_t>();
                for (std::size_t f = 0; f < all.grid.cell_fields.size(); ++f) {
                    const Field &found = some.grid.cell_fields[f], &whole = all.grid.cell_fields[f];
                    EXPECT_EQ(found.name, whole.name);
                    EXPECT_EQ(found.values.type(), whole.values.type());
                    ASSERT_EQ(found.values.tuples(), cells.size());
                    ASSERT_EQ(found.values.components(), whole.values.components());
                    const std::size_t bytes = whole.values.bytes() / whole.values.tuples();
                    for (std::size_t i = 0; i < cells.size(); ++i)
                        ASSERT_EQ(std::memcmp(static_cast<const char*>(found.values.data()) + i * bytes,
                                              static_cast<const char*>(whole.values.data()) + cells[i] * bytes, bytes),
                                  0);
                }
                ExtractJob job = active_job(file, folder.file("active.vtp"));
                job.with = {"number", "small", "vector", "odd", "integer"};
                job.contour.source_cells = true;
                Listener listener;
                ASSERT_TRUE(extract_files(job, listener));
                EXPECT_FALSE(was_read_twice(listener));
                EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
            }
}

TEST(ActiveCellsOfFiles, LeaveOutCellFieldsThatCannotBeRead) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    Grid grid = made("shuffled", 20);
    add_cell_fields(grid);
    grid.cell_fields.resize(1);
    ASSERT_TRUE(write_grid(grid, file, {.compression = Compression::zlib}));
    std::string text = test::content_of(file);
    const std::size_t data = text.find("<AppendedData");
    for (std::size_t at = data; (at = text.find("\x78\x01", at)) != std::string::npos; at += 2) {
        std::string broken = text;
        broken.replace(at + 40, 4, "abcd");
        folder.write("grid.vtu", broken);
        ReadOptions options;
        const auto all = read(file, options);
        if (!all || !all->grid.cell_fields.empty()) continue; // the block of something else
        options.active_cells = ReadActiveCells{"gyroid", {0.1}, {}};
        const auto some = read(file, options);
        ASSERT_TRUE(some) << some.error().message;
        if (some->cells_in_file) continue; // no cell that was kept has its value in the block
        EXPECT_EQ(some->notes, all->notes);
        EXPECT_TRUE(some->grid.cell_fields.empty());
        return;
    }
    FAIL() << "no block of the cell field was found";
}

TEST(ActiveCellsOfFiles, AreReadTwiceWithTheCellFieldsOfAll) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    Grid grid = made("kuhn", 8);
    add_cell_fields(grid);
    std::vector<float> values(grid.point_fields[0].values.as<float>().begin(),
                              grid.point_fields[0].values.as<float>().end());
    std::vector<float> points(grid.points.as<float>().begin(), grid.points.as<float>().end());
    points.insert(points.end(), {5, 5, 5}); // in no cell, with the largest value
    values.push_back(1e9f);
    grid.points = Array::own(std::move(points), 3);
    grid.point_fields = {{"gyroid", Array::own(std::move(values))}};
    ASSERT_TRUE(write_grid(grid, file));
    ExtractJob job = active_job(file, folder.file("active.vtp"));
    job.with = {"number", "vector"};
    Listener listener;
    ASSERT_TRUE(extract_files(job, listener));
    EXPECT_TRUE(was_read_twice(listener));
    EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder));
}

/// Cells by number: which a file has in another piece, too, so that they are left out.
template <class IsGhost>
void add_ghosts(Grid& grid, const IsGhost& is_ghost) {
    std::vector<std::uint8_t> ghosts(grid.cells.count());
    for (std::size_t i = 0; i < ghosts.size(); ++i) ghosts[i] = is_ghost(i) ? 1 : 0;
    grid.cell_fields.push_back({"vtkGhostType", Array::own(std::move(ghosts))});
}

/// Tets in a row that share no points; two of three are cut at 0.1.
Grid row_of_tets(bool last_is_flat) {
    constexpr std::size_t count = 200;
    std::vector<float> points, values;
    std::vector<std::int32_t> corners(4 * count);
    for (std::size_t tet = 0; tet < count; ++tet) {
        const auto x = static_cast<float>(2 * tet);
        const float top = last_is_flat && tet + 1 == count ? 0.0f : 1.0f;
        points.insert(points.end(), {x, 0, 0, x + 1, 0, 0, x, 1, 0, x + 1 - top, 1 - top, top});
        values.insert(values.end(), {tet % 3 == 0 ? 2.0f : -1.0f, 1, 1, 0.5f + 0.001f * x});
    }
    std::iota(corners.begin(), corners.end(), 0);
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.point_fields = {{"gyroid", Array::own(std::move(values))}};
    return grid;
}

TEST(ActiveCellsOfFiles, HaveTheirNumbersBehindCellsThatAreLeftOut) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    for (const bool twice : {false, true}) { // a flat tet that is cut has the direction of most
        Grid grid = row_of_tets(twice);
        add_cell_fields(grid);
        add_ghosts(grid, [](std::size_t cell) { return cell % 5 == 1; });
        ASSERT_TRUE(write_grid(grid, file));
        EXPECT_TRUE(read(file, active_options({0.1})).value().cells_in_file);
        ExtractJob job = active_job(file, folder.file("active.vtp"));
        job.isovalues = {0.1};
        job.with = {"number", "vector"};
        job.contour.source_cells = true;
        Listener listener;
        ASSERT_TRUE(extract_files(job, listener));
        EXPECT_EQ(was_read_twice(listener), twice);
        EXPECT_TRUE(test::content_of(job.out) == reference_file(job, folder)) << (twice ? "twice" : "once");
    }
}

TEST(ActiveCellsOfFiles, WithoutAnyCellSayThatNoneCanBeContoured) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    Grid grid = made("kuhn", 4);
    add_cell_fields(grid);
    add_ghosts(grid, [](std::size_t) { return true; });
    ASSERT_TRUE(write_grid(grid, file));
    ExtractJob job = active_job(file, folder.file("active.vtp"));
    job.with = {"number"};
    Listener listener;
    const auto result = extract_files(job, listener);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    EXPECT_NE(result.error().message.find("no cell that can be contoured"), std::string::npos)
        << result.error().message;
}

TEST(ActiveCellsOfFiles, AreNotReadAloneWhereOthersMatter) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    Grid grid = made("kuhn", 6);
    std::vector<float> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
    grid.cell_fields = {{"number", Array::own(std::move(numbers))}};
    ASSERT_TRUE(write_grid(grid, file));
    ReadOptions options = active_options({0.1});
    EXPECT_TRUE(read(file, options).value().cells_in_file);
    options.active_cells->field = "number";
    EXPECT_FALSE(read(file, options).value().cells_in_file);
    options.active_cells = ReadActiveCells{"gyroid", {}, {}};
    EXPECT_FALSE(read(file, options).value().cells_in_file);

    ASSERT_TRUE(write_grid(made("kelvin", 3), file));
    EXPECT_FALSE(read(file, active_options({0.1})).value().cells_in_file);

    grid = made("kuhn", 6);
    std::vector<float> twice(grid.points.as<float>().begin(), grid.points.as<float>().end());
    twice.insert(twice.end(), twice.begin(), twice.begin() + static_cast<std::ptrdiff_t>(twice.size()));
    grid.points = Array::own(std::move(twice), 3);
    for (Field& field : grid.point_fields) {
        std::vector<double> values(2 * field.values.tuples());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = field.values.at(i % field.values.tuples());
        field.values = Array::own(std::move(values));
    }
    ASSERT_TRUE(write_grid(grid, file));
    EXPECT_FALSE(read(file, active_options({0.1})).value().cells_in_file);
}

TEST(ActiveCellsOfFiles, TellWhichCellIsBroken) {
    const test::TemporaryFolder folder;
    const Grid grid = made("kuhn", 12);
    const std::string file = folder.file("grid.vtu");
    ASSERT_TRUE(write_grid(grid, file));
    const auto corners = grid.cells.connectivity.as<std::int32_t>();
    const std::string_view bytes(reinterpret_cast<const char*>(corners.data()), corners.size_bytes());
    std::string text = test::content_of(file);
    const std::size_t at = text.find(bytes);
    ASSERT_NE(at, std::string::npos);
    const std::int32_t wrong = 98765;
    text.replace(at + 4 * (4 * 1234 + 2), 4, reinterpret_cast<const char*>(&wrong), 4);
    folder.write("grid.vtu", text);
    Listener listener;
    const auto failed = extract_files(active_job(file, folder.file("active.vtp")), listener);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::invalid_data);
    EXPECT_NE(failed.error().message.find("tets[1234] has point 98765"), std::string::npos) << failed.error().message;
}

} // namespace
} // namespace isotet::jobs
