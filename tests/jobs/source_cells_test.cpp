// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Source cells have the numbers of the file, also where a grid that was read has others.
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/grid_file.hpp>
#include <isotet/jobs/clip_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

/// With the cell field "id", the number of each cell.
Grid numbered(const std::string& shape) {
    Grid grid = make_grid({.shape = shape, .side = 6, .fields = {"gyroid"}}).value();
    std::vector<std::int64_t> ids(grid.cells.count());
    std::iota(ids.begin(), ids.end(), 0);
    grid.cell_fields = {{"id", Array::own(std::move(ids))}};
    return grid;
}

const Array& field_called(const std::vector<Field>& fields, const std::string& name) {
    return std::ranges::find(fields, name, &Field::name)->values;
}

void expect_equal(const Array& a, const Array& b) {
    ASSERT_GT(a.tuples(), 0u);
    ASSERT_EQ(a.tuples(), b.tuples());
    for (std::size_t i = 0; i < a.tuples(); ++i) ASSERT_EQ(a.at(i), b.at(i)) << i;
}

/// By extraction in several ways, and by clipping.
void expect_numbers_of_file(const std::string& file, const test::TemporaryFolder& folder) {
    Listener listener;
    for (const char* field : {"gyroid", "gyroid*2", "x"})
        for (const bool solid : {false, true}) {
            SCOPED_TRACE(testing::Message() << file << " " << field << " " << solid);
            ExtractJob job;
            job.grid.file = file;
            job.out = folder.file("out.vtp");
            job.field.name = field;
            job.isovalues = {0.1};
            job.contour.source_cells = true;
            job.with = {"id"};
            if (solid) {
                job.solid.emplace();
                job.solid->kind = SolidChoice::Kind::above;
            }
            const auto done = extract_files(job, listener);
            ASSERT_TRUE(done) << done.error().message;
            const Surface surface = read_surface(job.out).value().surface;
            expect_equal(surface.source_cells, field_called(surface.cell_fields, "id"));
            job.with.emplace();
            for (const HangingChoice hanging : {HangingChoice::leave, HangingChoice::interpolate}) {
                job.grid.hanging_points = hanging;
                ASSERT_TRUE(extract_files(job, listener));
                expect_equal(read_surface(job.out).value().surface.source_cells, surface.source_cells);
            }
        }
    ClipJob clip;
    clip.grid.file = file;
    clip.out = folder.file("out.vtu");
    clip.field.name = "gyroid";
    clip.range = SolidRange::above(0.1);
    ASSERT_TRUE(clip_files(clip, listener));
    const Grid clipped = read(clip.out).value().grid;
    expect_equal(field_called(clipped.cell_fields, "source_cell"), field_called(clipped.cell_fields, "id"));
}

TEST(SourceCells, AreThoseOfAPackedGridWhateverReadsIt) {
    const test::TemporaryFolder folder;
    Listener listener;
    for (const char* shape : {"shuffled", "mixed"}) {
        ASSERT_TRUE(write_grid(numbered(shape), folder.file("grid.vtu")));
        PackJob job;
        job.grid.file = folder.file("grid.vtu");
        job.out = folder.file("grid.isotet");
        job.cell_fields = {"id"};
        ASSERT_TRUE(pack_file(job, listener));
        expect_numbers_of_file(job.out, folder);
    }
}

TEST(SourceCells, CountCellsThatTheFileHides) {
    const test::TemporaryFolder folder;
    for (const char* shape : {"kuhn", "mixed"}) {
        Grid grid = numbered(shape);
        std::vector<std::uint8_t> ghosts(grid.cells.count());
        for (std::size_t i = 0; i < ghosts.size(); ++i)
            ghosts[i] = i < ghosts.size() / 3 ? 32 : 0; // vtkDataSetAttributes::HIDDENCELL
        grid.cell_fields.push_back({"vtkGhostType", Array::own(std::move(ghosts))});
        ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
        EXPECT_LT(read(folder.file("grid.vtu")).value().grid.cells.count(), grid.cells.count());
        expect_numbers_of_file(folder.file("grid.vtu"), folder);
    }
}

/// By sessions that expect their isovalues, which read active cells, and that do not.
void expect_numbers_of_file_by_sessions(const std::string& path) {
    for (const Method method : {Method::direct, Method::clusters})
        for (const bool expected : {false, true})
            for (const std::vector<std::string>& with : {std::vector<std::string>{"id"}, {}}) {
                SCOPED_TRACE(testing::Message() << expected << " " << with.size() << " " << static_cast<int>(method));
                FileContourOptions options;
                options.with = with;
                options.contour.source_cells = true;
                options.contour.method = method;
                options.contour.surfaces = 1;
                if (expected) options.contour.expected_isovalues = {0.1};
                FileSession started = GridFile::open(path).value().session("gyroid", options).value();
                const Surface surface = started.contour.extract(0.1).value().surfaces[0].surface;
                options.with = {"id"};
                FileSession other = GridFile::open(path).value().session("gyroid", options).value();
                const Surface carrying = other.contour.extract(0.1).value().surfaces[0].surface;
                expect_equal(surface.source_cells, field_called(carrying.cell_fields, "id"));
            }
}

TEST(SourceCells, OfSessionsOfAGridFileAreThoseOfTheFile) {
    const test::TemporaryFolder folder;
    for (const char* shape : {"kuhn", "mixed", "kelvin"}) {
        Grid grid = numbered(shape);
        std::vector<std::uint8_t> ghosts(grid.cells.count());
        for (std::size_t i = 0; i < ghosts.size(); ++i) ghosts[i] = i < ghosts.size() / 3 ? 32 : 0; // HIDDENCELL
        grid.cell_fields.push_back({"vtkGhostType", Array::own(std::move(ghosts))});
        ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
        expect_numbers_of_file_by_sessions(folder.file("grid.vtu"));
    }
}

} // namespace
} // namespace isotet::jobs
