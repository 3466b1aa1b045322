// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids with hanging points through the jobs: closed by default, also where only some cells are read.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
#include "pieces/partition.hpp"
#include "support/quadratic_grid.hpp"
#include "support/seeds.hpp"
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
            EXPECT_EQ(has_note(heard, "`hanging_points` close joins the cells"), choice == HangingChoice::leave);
            EXPECT_EQ(is_closed(out), choice != HangingChoice::leave) << grid;
            EXPECT_EQ(has_note(heard, "list them as polyhedra"), choice != HangingChoice::leave);
            EXPECT_EQ(has_note(heard, "they have those of the larger cells"), choice == HangingChoice::interpolate);
            EXPECT_EQ(has_note(heard, "they have their own"), choice == HangingChoice::close);
        }
}

/// "noise": whole numbers at random, "bumps": 0 but at some hanging points, of which the larger cells' corners tell nothing,
/// "missing": the same, and some of these have no value.
Grid with_rough_fields(Grid grid, unsigned seed) {
    std::mt19937 random(seed);
    const std::size_t points = grid.points.tuples();
    std::vector<float> noise(points), bumps(points), missing(points);
    for (float& value : noise) value = static_cast<float>(random() % 4);
    const Array hanging = close_hanging_points(grid).value().points;
    for (std::size_t i = 0; i < hanging.size(); ++i) {
        const auto point = static_cast<std::size_t>(hanging.at(i));
        if (random() % 10 == 0) bumps[point] = static_cast<float>(1 + random() % 2);
        missing[point] = random() % 20 == 0 ? NAN : bumps[point];
    }
    grid.cell_fields.clear();
    grid.point_fields = {{"noise", Array::own(std::move(noise))},
                         {"bumps", Array::own(std::move(bumps))},
                         {"missing", Array::own(std::move(missing))}};
    return grid;
}

std::array<double, 3> turned(const std::array<double, 3>& p) {
    return {(2 * p[0] - 2 * p[1] + p[2]) / 3, (2 * p[0] + p[1] - 2 * p[2]) / 3, (p[0] + 2 * p[1] + 2 * p[2]) / 3};
}
std::array<double, 3> turned_back(const std::array<double, 3>& p) {
    return {(2 * p[0] + 2 * p[1] + p[2]) / 3, (-2 * p[0] + p[1] + 2 * p[2]) / 3, (p[0] - 2 * p[1] + 2 * p[2]) / 3};
}

Grid turned_grid(Grid grid) {
    std::vector<float> points;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (const double x : turned({grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2)}))
            points.push_back(static_cast<float>(x));
    grid.points = Array::own(std::move(points), 3);
    return grid;
}

/// Edges of one triangle that are not on one side of the cube.
std::size_t open_edges_inside(const Surface& surface, double edge_of_cube, bool is_turned) {
    std::map<std::pair<std::uint64_t, std::uint64_t>, int> triangles;
    for (std::size_t i = 0; i < surface.triangles.tuples(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = static_cast<std::uint64_t>(surface.triangles.at(i, k)),
                       b = static_cast<std::uint64_t>(surface.triangles.at(i, (k + 1) % 3));
            ++triangles[std::minmax(a, b)];
        }
    const auto sides_of = [&](std::uint64_t vertex) {
        std::array<double, 3> at;
        for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = surface.positions.at(vertex, axis);
        if (is_turned) at = turned_back(at);
        unsigned sides = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (std::abs(std::abs(at[axis]) - edge_of_cube / 2) < 1e-5) sides |= (at[axis] > 0 ? 8U : 1U) << axis;
        return sides;
    };
    std::size_t open = 0;
    for (const auto& [edge, count] : triangles)
        open += count == 1 && (sides_of(edge.first) & sides_of(edge.second)) == 0;
    return open;
}

/// The surface of a file of which only active cells are read where they do: it is closed, and where all are read the same as
/// by an engine that reads all. Returns whether all were read.
bool expect_closed_file(const std::string& file, const test::TemporaryFolder& folder, const std::string& field,
                        double isovalue, HangingChoice choice, bool is_turned = false) {
    SCOPED_TRACE(testing::Message() << field << " " << isovalue);
    ExtractJob job = job_for(file, folder.file("active.vtp"), choice);
    job.field.name = field;
    job.isovalues = {isovalue};
    job.allow_empty = true;
    test::Listener heard;
    EXPECT_TRUE(extract_files(job, heard));
    EXPECT_EQ(open_edges_inside(read_surface(job.out).value().surface, 2, is_turned), 0u);
    const bool all = has_note(heard, "list them as polyhedra");
    if (!all) return false;
    const std::string active = test::content_of(job.out);
    job.engine = EngineChoice::reference; // reads all cells
    EXPECT_TRUE(extract_files(job, heard));
    EXPECT_TRUE(active == test::content_of(job.out));
    return true;
}

/// In how many cases all cells were read.
int expect_closed_files(const std::string& file, const test::TemporaryFolder& folder, bool is_turned = false) {
    int all = 0;
    for (const auto& [field, isovalue] :
         {std::pair{"noise", 1.5}, {"noise", 3.0}, {"bumps", 0.5}, {"bumps", 1.0}, {"bumps", 2.0}})
        for (const HangingChoice choice : {HangingChoice::close, HangingChoice::interpolate})
            all += expect_closed_file(file, folder, field, isovalue, choice, is_turned);
    return all;
}

TEST(HangingPointJobs, CloseSurfacesOfActiveCellsWhateverTheValuesAtHangingPoints) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    int all = 0;
    for (const char* shape : {"octree", "octree-random", "octree-tets"})
        for (const unsigned seed : test::some_of({1U, 2U, 3U, 4U})) {
            SCOPED_TRACE(testing::Message() << shape << ", seed " << seed);
            const Grid grid = with_rough_fields(test::made_grid(shape, 3, {}, seed), seed);
            for (const bool is_turned : {false, true}) {
                ASSERT_TRUE(write_grid(is_turned ? turned_grid(grid) : grid, file));
                all += expect_closed_files(file, folder, is_turned);
            }
        }
    EXPECT_GT(all, 100 / static_cast<int>(test::seed_share));
}

TEST(HangingPointJobs, CloseSurfacesOfActiveCellsOfPieces) {
    const test::TemporaryFolder folder;
    for (const char* shape : {"octree-random", "octree-tets"}) {
        SCOPED_TRACE(shape);
        const Grid grid = with_rough_fields(test::made_grid(shape, 3, {}), 1);
        std::string index = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n";
        int number = 0;
        for (const test::GridPiece& piece : test::partition(grid, test::point_field(grid), 3, 1)) {
            Grid part = piece.grid;
            part.point_fields.clear();
            for (const Field& field : grid.point_fields)
                part.point_fields.push_back({field.name, test::taken(field.values, piece.points)});
            part.point_numbers = {};
            const std::string name = "piece-" + std::to_string(number++) + ".vtu";
            ASSERT_TRUE(write_grid(part, folder.file(name)));
            index += "<Piece Source=\"" + name + "\"/>\n";
        }
        EXPECT_GT(expect_closed_files(folder.write("a.pvtu", index + "</PUnstructuredGrid></VTKFile>\n"), folder), 0);
    }
}

TEST(HangingPointJobs, ReadAllCellsWherePointsWithoutAValueHang) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    const Grid grid = with_rough_fields(test::made_grid("octree-random", 3, {}), 1);
    ASSERT_TRUE(write_grid(grid, file));
    ExtractJob job = job_for(file, folder.file("active.vtp"), HangingChoice::close);
    job.field.name = "missing";
    test::Listener heard;
    ASSERT_TRUE(extract_files(job, heard));
    EXPECT_TRUE(has_note(heard, "list them as polyhedra"));
    const std::string active = test::content_of(job.out);
    job.engine = EngineChoice::reference; // reads all cells
    ASSERT_TRUE(extract_files(job, heard));
    EXPECT_TRUE(active == test::content_of(job.out));
}

TEST(HangingPointJobs, ReadAllCellsOnlyWhereSurfacesReachHangingPoints) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    const Grid octree = test::made_grid("octree", 10, {});
    int whole = 0, part = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) { // small spheres, some of them away from levels
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        std::array<double, 3> centre;
        for (double& x : centre) x = 2 * std::generate_canonical<double, 32>(random) - 1;
        std::vector<float> distance;
        for (std::size_t i = 0; i < octree.points.tuples(); ++i) {
            double sum = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) sum += std::abs(octree.points.at(i, axis) - centre[axis]);
            distance.push_back(static_cast<float>(sum));
        }
        Grid grid = octree;
        grid.cell_fields.clear();
        grid.point_fields = {{"distance", Array::own(std::move(distance))}};
        ASSERT_TRUE(write_grid(grid, file));
        ReadOptions options;
        options.cell_fields = std::vector<std::string>{};
        options.active_cells = ReadActiveCells{"distance", {0.3}, {}};
        const bool in_part = read(file, options).value().cells_in_file.has_value();
        ++(in_part ? part : whole);
        EXPECT_EQ(expect_closed_file(file, folder, "distance", 0.3, HangingChoice::close), !in_part);
    }
    EXPECT_GT(whole, 2);
    EXPECT_GT(part, 0);
}

/// Each cell with points of its own, as deal.II, MFEM and t8code write VTK's files.
Grid with_points_for_each_cell(const Grid& grid) {
    const auto corners = grid.cells.connectivity.as<std::int32_t>();
    std::vector<float> points, values;
    std::vector<std::int64_t> connectivity;
    for (const std::int32_t corner : corners) {
        const auto point = static_cast<std::size_t>(corner);
        connectivity.push_back(static_cast<std::int64_t>(connectivity.size()));
        for (std::size_t axis = 0; axis < 3; ++axis) points.push_back(static_cast<float>(grid.points.at(point, axis)));
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
        job.contour.edge_ends = true;
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
        job.contour.edge_ends = true;
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
    EXPECT_EQ(look_into(job, heard).value().hanging_points, 116u)
        << "by a test of all points against all edges and faces";
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
