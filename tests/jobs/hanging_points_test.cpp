// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids with hanging points through the jobs: closed by default, also where only some cells are read.
#include <algorithm>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/jobs/check_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/quadratic_grid.hpp"
#include "support/small_grid.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

bool has_note(const test::Listener& heard, const std::string& part) {
    return std::ranges::any_of(heard.noted,
                               [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

ExtractJob job_for(const std::string& grid, const std::string& out, HangingChoice choice) {
    ExtractJob job;
    job.grid.file = grid;
    job.grid.hanging_points = choice;
    job.field.name = "sphere";
    job.isovalues = {0.5};
    job.out = out;
    return job;
}

bool is_closed(const std::string& surface) {
    CheckJob job;
    job.surface = surface;
    job.closed = true;
    test::Listener quiet;
    return check_files(job, quiet).value().report.closed;
}

TEST(HangingPointJobs, CloseWhatIsReadWholeAndWhatIsReadInPart) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("octree.vtu");
    ASSERT_TRUE(write_grid(test::made_grid("octree-random", 5, {"sphere"}), file));
    for (const std::string& grid : {file, std::string("make:octree-random:5:sphere")})
        for (const HangingChoice choice : {HangingChoice::close, HangingChoice::interpolate, HangingChoice::leave}) {
            test::Listener heard;
            const std::string out = folder.file("surface.vtp");
            ASSERT_TRUE(extract_files(job_for(grid, out, choice), heard));
            EXPECT_EQ(has_note(heard, "`hanging_points` close joins the cells"),
                      choice == HangingChoice::leave && grid != file) << "a file is read in part, and not looked through";
            EXPECT_EQ(is_closed(out), choice != HangingChoice::leave) << grid;
            EXPECT_EQ(has_note(heard, "list them as polyhedra"), choice != HangingChoice::leave);
            EXPECT_EQ(has_note(heard, "they have those of the larger cells"), choice == HangingChoice::interpolate);
            EXPECT_EQ(has_note(heard, "they have their own"), choice == HangingChoice::close);
        }
}

/// Each cell with points of its own, as deal.II, MFEM and t8code write VTK's files.
Grid with_points_for_each_cell(const Grid& grid) {
    const auto corners = grid.cells.connectivity.as<std::int32_t>();
    std::vector<float> points, values;
    std::vector<std::int64_t> connectivity;
    for (const std::int32_t corner : corners) {
        const auto point = static_cast<std::size_t>(corner);
        connectivity.push_back(static_cast<std::int64_t>(connectivity.size()));
        for (std::size_t axis = 0; axis < 3; ++axis)
            points.push_back(static_cast<float>(grid.points.at(point, axis)));
        values.push_back(static_cast<float>(grid.point_fields[0].values.at(point)));
    }
    Grid out;
    out.points = Array::own(std::move(points), 3);
    out.cells.connectivity = Array::own(std::move(connectivity));
    out.cells.uniform_type = grid.cells.uniform_type;
    out.point_fields = {{grid.point_fields[0].name, Array::own(std::move(values))}};
    return out;
}

TEST(HangingPointJobs, JoinPointsFirstWhereEachCellHasItsOwn) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("apart.vtu"), out = folder.file("surface.vtp");
    ASSERT_TRUE(write_grid(with_points_for_each_cell(test::made_grid("octree-bent", 4, {"sphere"})), file));
    test::Listener apart, joined;
    ExtractJob job = job_for(file, out, HangingChoice::close);
    ASSERT_TRUE(extract_files(job, apart));
    EXPECT_FALSE(is_closed(out));
    EXPECT_TRUE(has_note(apart, "`merge_points`")) << "how they are joined";
    job.grid.merge_points = 0;
    ASSERT_TRUE(extract_files(job, joined));
    EXPECT_TRUE(is_closed(out));
    EXPECT_TRUE(has_note(joined, "hang on faces or edges of larger cells"));
}

TEST(HangingPointJobs, ChecksTakeTheGridAsExtractionDid) {
    const test::TemporaryFolder folder;
    const std::string out = folder.file("surface.vtp");
    for (const HangingChoice choice : {HangingChoice::close, HangingChoice::leave}) {
        ExtractJob job = job_for("make:octree-random:3:gyroid", out, choice);
        job.field.name = "gyroid";
        job.edge_ends = true;
        test::Listener quiet;
        ASSERT_TRUE(extract_files(job, quiet));
        CheckJob check;
        check.surface = out;
        check.grid = job.grid;
        const CheckedFiles found = check_files(check, quiet).value();
        EXPECT_TRUE(found.passed);
        EXPECT_EQ(found.report.hanging_edges > 0, choice == HangingChoice::leave);
    }
}

TEST(HangingPointJobs, CloseQuadraticCellsAndJudgeThemOpenWhereTheyAreLeft) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("quadratic.vtu"), out = folder.file("surface.vtp");
    ASSERT_TRUE(write_grid(test::quadratic_hexahedra(test::made_grid("octree-random", 2, {})), file));
    for (const HangingChoice choice : {HangingChoice::close, HangingChoice::leave}) {
        ExtractJob job = job_for(file, out, choice);
        job.field.name = "square";
        job.edge_ends = true;
        test::Listener heard;
        ASSERT_TRUE(extract_files(job, heard));
        EXPECT_EQ(has_note(heard, "above degree 1: they are linear between"), choice == HangingChoice::close);
        CheckJob check;
        check.surface = out;
        check.grid = job.grid;
        check.field = job.field;
        const CheckedFiles found = check_files(check, heard).value();
        EXPECT_EQ(found.report.boundary_edges > 0, choice == HangingChoice::leave);
        EXPECT_TRUE(found.passed);
    }
}

TEST(HangingPointJobs, ChartTheAreaOfTheClosedSurface) {
    InfoJob job;
    job.grid.file = "make:octree-random:4:sphere";
    job.chart = 2;
    job.field.name = "sphere";
    std::vector<double> areas;
    for (const HangingChoice choice : {HangingChoice::close, HangingChoice::leave}) {
        job.grid.hanging_points = choice;
        test::Listener heard;
        const ContourSpectrum chart = look_into(job, heard).value().chart.value().spectrum;
        EXPECT_NEAR(chart.volume, 8, 1e-6);
        areas.push_back(chart.area.at(1));
        if (choice == HangingChoice::leave) continue;
        const Grid grid = close_hanging_points(test::made_grid("octree-random", 4, {"sphere"})).value().grid;
        const Surface surface = Contour::create({grid, test::point_field(grid), {}, {}}, {.split_cells = true})
                                    .value()
                                    .extract(chart.isovalues.at(1))
                                    .value()
                                    .surfaces[0]
                                    .surface;
        EXPECT_NEAR(check(surface).value().area, chart.area.at(1), 1e-4);
    }
    EXPECT_NE(areas[0], areas[1]);
}

TEST(HangingPointJobs, SaysNothingOfGridsWithoutThem) {
    const test::TemporaryFolder folder;
    test::Listener heard;
    const std::string out = folder.file("surface.vtp");
    ASSERT_TRUE(extract_files(job_for("make:mixed:4:sphere", out, HangingChoice::close), heard));
    EXPECT_FALSE(has_note(heard, "hang"));
}

TEST(HangingPointJobs, CountPointsOnEdgesAndFacesOfLargerCellsOnly) {
    InfoJob job;
    job.grid.file = test::source_folder().string() + "/data/vtk/mfem_levels_tet.vtk";
    job.grid.merge_points = 0;
    job.survey = true;
    test::Listener heard;
    EXPECT_EQ(look_into(job, heard).value().hanging_points, 116u) << "by a test of all points against all edges and faces";
}

TEST(HangingPointJobs, TellWhatIsClosed) {
    InfoJob job;
    job.grid.file = "make:octree:4:sphere";
    job.survey = true;
    test::Listener heard;
    const GridSummary found = look_into(job, heard).value();
    EXPECT_EQ(found.hanging_points, found.hanging.points);
    EXPECT_GT(found.hanging.cells, 0u);
    EXPECT_EQ(found.hanging.open_faces, 0u);
    EXPECT_GT(found.hanging.levels, 0u);
    EXPECT_FALSE(found.report.cells_by_type.contains(42)) << "cells are counted as the file has them";
}

} // namespace
} // namespace isotet::jobs
