// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/check_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/make.hpp>
#include <isotet/write.hpp>

#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

std::string extracted(const test::TemporaryFolder& folder, double isovalue, bool edge_ends) {
    Listener listener;
    ExtractJob job;
    job.grid.file = "make:kuhn:6:sphere";
    job.out = folder.file("surface.vtp");
    job.isovalues = {isovalue};
    job.contour.edge_ends = edge_ends;
    return extract_files(job, listener).value().surfaces[0].file;
}

TEST(CheckFiles, DerivesThePointsOfRefinedCellsAgain) {
    const test::TemporaryFolder folder;
    for (const char* shape : {"make:tet10:2:sphere", "make:hex27:2:sphere"}) {
        Listener listener;
        ExtractJob extract;
        extract.grid.file = shape;
        extract.out = folder.file("refined.vtp");
        extract.isovalues = {0.5, 0.7};
        extract.contour.refine->relative_tolerance = 0.01;
        extract.contour.edge_ends = true;
        CheckJob job;
        job.surface = extract_files(extract, listener).value().surfaces[0].file;
        job.grid.file = shape;
        job.contour.refine = extract.contour.refine;
        const CheckedFiles checked = check_files(job, listener).value(); // the file has its isovalues
        EXPECT_TRUE(checked.passed) << shape;
        EXPECT_EQ(checked.report.blamed_edges, 0u);
        EXPECT_GT(checked.report.triangles, 100u);
        job.contour.refine.reset();
        const auto at_nodes = check_files(job, listener);
        ASSERT_FALSE(at_nodes) << "other points";
        EXPECT_NE(at_nodes.error().message.find("derived again"), std::string::npos) << at_nodes.error().message;
    }
}

TEST(CheckFiles, TheFileSaysHowCurvedCellsWereRefined) {
    const test::TemporaryFolder folder;
    for (const char* name : {"refined.vtp", "refined.vtk"}) {
        Listener listener;
        ExtractJob extract;
        extract.grid.file = "make:tet10:3:sphere";
        extract.out = folder.file(name);
        extract.isovalues = {0.6};
        extract.contour.edge_ends = true;
        CheckJob job;
        job.surface = extract_files(extract, listener).value().surfaces[0].file;
        job.grid.file = extract.grid.file;
        const auto checked = check_files(job, listener);
        ASSERT_TRUE(checked) << name << ": " << checked.error().message;
        EXPECT_TRUE(checked->passed) << name;
        EXPECT_GT(checked->report.triangles, 100u);
        job.contour.refine->relative_tolerance = 0.02;
        const auto other = check_files(job, listener);
        EXPECT_FALSE(other && other->passed) << "what is asked for counts";
    }
}

TEST(CheckFiles, TakesIsovaluesByShareAsExtractDoes) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob extract;
    extract.grid.file = "make:tet10:3:sphere";
    extract.out = folder.file("half.vtp");
    extract.shares = {{IsovalueShare::Of::volume, 50}};
    extract.contour.edge_ends = true;
    CheckJob job;
    job.surface = extract_files(extract, listener).value().surfaces[0].file;
    job.grid.file = extract.grid.file;
    job.shares = extract.shares;
    EXPECT_TRUE(check_files(job, listener).value().passed);
    job.shares[0].percent = 20;
    const auto other = check_files(job, listener);
    EXPECT_FALSE(other && other->passed);
}

TEST(CheckFiles, FindsWallsAlsoWhereTheirTrianglesHavePointsOfTheirOwn) {
    const test::TemporaryFolder folder;
    Surface walls; // two tetrahedra with a face back to back, on points of their own
    walls.positions =
        Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1}, 3);
    walls.triangles = Array::own(
        std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 5, 6, 5, 4, 7, 6, 5, 7, 4, 6, 7}, 3);
    ASSERT_TRUE(write_surface(walls, folder.file("walls.ply")));
    Listener listener;
    CheckJob job;
    job.surface = folder.file("walls.ply");
    job.closed = true;
    const CheckedFiles checked = check_files(job, listener).value();
    EXPECT_TRUE(checked.report.closed);
    EXPECT_EQ(checked.report.double_sheets, 1u);
}

TEST(CheckFiles, JudgesAgainstTheGrid) {
    const test::TemporaryFolder folder;
    Listener listener;
    CheckJob job;
    job.surface = extracted(folder, 1.2, true); // leaves the cube
    EXPECT_TRUE(check_files(job, listener)->passed) << "open edges are only counted";
    job.closed = true;
    EXPECT_FALSE(check_files(job, listener)->passed);
    job.closed = false;
    job.grid.file = "make:kuhn:6:sphere";
    const CheckedFiles checked = check_files(job, listener).value();
    EXPECT_TRUE(checked.passed);
    EXPECT_EQ(checked.format, "vtp");
    EXPECT_GT(checked.report.boundary_edges, 0u);
    EXPECT_EQ(checked.report.blamed_edges, 0u);
}

/// A series whose first step is another grid.
std::string series_of(const test::TemporaryFolder& folder) {
    std::string list;
    for (const auto& [shape, side, time] :
         {std::tuple{"kuhn", 4u, 0.0}, {"kuhn", 6u, 0.1}, {"kuhn", 8u, 0.30000000000000004}}) {
        const std::string name = fmt::format("g{}.vtu", side);
        EXPECT_TRUE(
            write_grid(make_grid({.shape = shape, .side = side, .fields = {"sphere"}}).value(), folder.file(name)));
        list += fmt::format("<DataSet timestep='{}' file='{}'/>", time, name);
    }
    return folder.write("s.pvd", "<VTKFile type='Collection'><Collection>" + list + "</Collection></VTKFile>");
}

TEST(CheckFiles, TakesTheStepOfTheSurface) {
    const test::TemporaryFolder folder;
    const std::string series = series_of(folder);
    for (const char* name : {"s.vtp", "s.vtk"})
        for (const std::size_t step : {0, 1, 2}) {
            SCOPED_TRACE(fmt::format("{} of step {}", name, step));
            Listener listener;
            ExtractJob extract;
            extract.grid.file = series;
            extract.grid.step = step;
            extract.isovalues = {0.7};
            extract.contour.edge_ends = true;
            extract.out = folder.file(name);
            ASSERT_TRUE(extract_files(extract, listener));
            CheckJob job;
            job.surface = extract.out;
            job.grid.file = series;
            const auto checked = check_files(job, listener);
            ASSERT_TRUE(checked) << checked.error().message;
            EXPECT_TRUE(checked->passed);
            EXPECT_NE(listener.noted.back().find(fmt::format("step {}, ", step)), std::string::npos);
            job.grid.step = 0;
            EXPECT_EQ(static_cast<bool>(check_files(job, listener)), step == 0)
                << "what is asked for counts: fewer points";
        }
}

TEST(CheckFiles, TakesTheTimeOfTheSurfaceWhereStepsHaveOtherNumbers) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob extract;
    extract.grid.file = series_of(folder);
    extract.grid.step = 2;
    extract.isovalues = {0.7};
    extract.contour.edge_ends = true;
    extract.out = folder.file("s.vtp");
    ASSERT_TRUE(extract_files(extract, listener));
    CheckJob job;
    job.surface = extract.out;
    const auto with_times = [&](const char* first, const char* second) {
        job.grid.file =
            folder.write("t.pvd", fmt::format("<VTKFile type='Collection'><Collection>"
                                              "<DataSet timestep='{}' file='g8.vtu'/>"
                                              "<DataSet timestep='{}' file='g4.vtu'/></Collection></VTKFile>",
                                              first, second));
        return check_files(job, listener);
    };
    EXPECT_TRUE(with_times("0.3", "0.4").value().passed) << "as it is printed";
    EXPECT_EQ(with_times("0.1", "0.2").error().message,
              job.surface + " is of time 0.30000000000000004, but " + job.grid.file +
                  " has 2 times: 0.1, 0.2; `time` and `step` choose one of them");
}

/// As extract does.
TEST(CheckFiles, TakesTheStepInWhichTheFieldVariesWhereTheSurfaceHasNoTime) {
    const test::TemporaryFolder folder;
    Listener listener;
    Grid same = make_grid({.shape = "kuhn", .side = 4, .fields = {"sphere"}}).value();
    same.point_fields[0].values = Array::own(std::vector<float>(same.points.tuples(), 1));
    ASSERT_TRUE(write_grid(same, folder.file("same.vtu")));
    ASSERT_TRUE(
        write_grid(make_grid({.shape = "kuhn", .side = 6, .fields = {"sphere"}}).value(), folder.file("g6.vtu")));
    CheckJob job;
    job.surface = extracted(folder, 0.7, true); // of a grid without steps
    job.grid.file = folder.write("t.pvd", "<VTKFile type='Collection'><Collection>"
                                          "<DataSet timestep='0' file='same.vtu'/>"
                                          "<DataSet timestep='1' file='g6.vtu'/></Collection></VTKFile>");
    const auto checked = check_files(job, listener);
    ASSERT_TRUE(checked) << checked.error().message;
    EXPECT_TRUE(checked->passed);
}

TEST(CheckFiles, NeedsTheEdgeEndsForAGrid) {
    const test::TemporaryFolder folder;
    Listener listener;
    CheckJob job;
    job.surface = extracted(folder, 0.5, false);
    job.grid.file = "make:kuhn:6:sphere";
    EXPECT_EQ(check_files(job, listener).error().message,
              job.surface + " has no point array edge_ends, but `grid` needs it: isotet extract `edge_ends` writes it "
                            "into .vtp and .vtk");
}

} // namespace
} // namespace isotet::jobs
