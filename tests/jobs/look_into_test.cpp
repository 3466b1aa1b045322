// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/look_into.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/first_view.hpp>
#include <isotet/grid.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

void expect_same(const GridReport& one, const GridReport& other) {
    EXPECT_EQ(one.points, other.points);
    EXPECT_EQ(one.cells, other.cells);
    EXPECT_EQ(one.cells_by_type, other.cells_by_type);
    EXPECT_EQ(one.cells_left_out, other.cells_left_out);
    EXPECT_EQ(one.tets, other.tets);
    EXPECT_EQ(one.collapsed_tets, other.collapsed_tets);
    EXPECT_EQ(one.negative_tets, other.negative_tets);
    EXPECT_EQ(one.inverted_tets, other.inverted_tets);
    EXPECT_EQ(one.flat_tets, other.flat_tets);
    EXPECT_EQ(one.unused_points, other.unused_points);
    EXPECT_EQ(one.lower, other.lower);
    EXPECT_EQ(one.upper, other.upper);
}

/// Some cells inside out, some with a corner twice, points that no cell has, a field that is noise, and one of cells.
Grid awkward_grid(const std::string& shape) {
    Grid grid = make_grid({.shape = shape, .side = 22, .fields = {"gyroid", "integer"}}).value();
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.tuples(); ++i)
        corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    for (std::size_t i = 0; i + 4 < corners.size(); i += 400) std::swap(corners[i], corners[i + 1]);
    for (std::size_t i = 200; i + 4 < corners.size(); i += 4000) corners[i] = corners[i + 1];
    grid.cells.connectivity = Array::own(std::move(corners));
    std::vector<float> points, noise, of_cells;
    for (std::size_t i = 0; i < grid.points.size(); ++i)
        points.push_back(static_cast<float>(grid.points.at(i / 3, i % 3)));
    points.insert(points.end(), {7, 8, 9, 17, 18, 19});
    grid.points = Array::own(std::move(points), 3);
    for (Field& field : grid.point_fields) {
        std::vector<float> values;
        for (std::size_t i = 0; i < field.values.tuples(); ++i)
            values.push_back(static_cast<float>(field.values.at(i)));
        values.insert(values.end(), {3, -3});
        field.values = Array::own(std::move(values));
    }
    for (std::uint32_t i = 0; i < grid.points.tuples(); ++i) noise.push_back(static_cast<float>(i * 2654435761U >> 8U));
    grid.point_fields.insert(grid.point_fields.begin(), {"temperature", Array::own(std::move(noise))});
    for (std::uint32_t i = 0; i < grid.cells.count(); ++i)
        of_cells.push_back(static_cast<float>(i * 2654435761U >> 8U));
    grid.cell_fields = {{"pressure", Array::own(std::move(of_cells))}};
    return grid;
}

TEST(LookInto, CountsCellsThatStayInTheirFile) {
    const test::TemporaryFolder folder;
    for (const char* shape : test::some_of<const char*>({"mixed", "kuhn", "shuffled", "hex"}))
        for (const char* name : {"raw.vtu", "packed.vtu", "binary.vtk"})
            for (const bool cell_fields : {true, false}) {
                const bool legacy = std::string(name) == "binary.vtk";
                const bool stays = !legacy || std::string(shape) != "mixed";
                if (legacy && cell_fields) continue;
                SCOPED_TRACE(testing::Message() << shape << " " << name << " " << cell_fields);
                Grid grid = awkward_grid(shape);
                if (!cell_fields) grid.cell_fields.clear();
                const std::string file = folder.file(name);
                const Compression compression =
                    std::string(name) == "packed.vtu" ? Compression::zlib : Compression::none;
                ASSERT_TRUE(write_grid(grid, file, {.compression = compression}));
                const SurveyedGrid counted = read_surveyed(file).value();
                EXPECT_EQ(counted.report.has_value(), stays);
                if (stays) {
                    EXPECT_LE(counted.read.grid.cells.count(), 16384u);
                }
                const ReadResult all = read(file).value();
                Listener listener;
                InfoJob job;
                job.grid.file = file;
                const GridSummary summary = look_into(job, listener).value();
                const GridReport expected = survey(all.grid, {.faces = false}).value();
                EXPECT_GT(expected.inverted_tets, 0u);
                EXPECT_GT(expected.collapsed_tets, 0u);
                EXPECT_EQ(expected.unused_points, 2u);
                expect_same(summary.report, expected);
                const FirstView view = first_view(all.grid, all.info.fields);
                EXPECT_EQ(summary.first.field, view.field);
                EXPECT_EQ(summary.first.reason, view.reason);
                EXPECT_EQ(summary.first.rough, view.rough);
                EXPECT_EQ(summary.first.draw, view.draw);
                ASSERT_EQ(summary.fields.size(), all.grid.point_fields.size() + all.grid.cell_fields.size());
                const auto last =
                    statistics_of(cell_fields ? all.grid.cell_fields[0].values : all.grid.point_fields.back().values);
                EXPECT_EQ(summary.fields.back().components[0].upper, last.value()[0].upper);
            }
}

TEST(LookInto, ReadsAllCellsToTellWhichIsBroken) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "kuhn", .side = 8, .fields = {"gyroid"}}).value();
    std::vector<std::int32_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.tuples(); ++i)
        corners.push_back(static_cast<std::int32_t>(grid.cells.connectivity.at(i)));
    const auto bytes_of = [&] {
        return std::string(reinterpret_cast<const char*>(corners.data()), 4 * corners.size());
    };
    const std::string sound = bytes_of();
    grid.cells.connectivity = Array::own(std::vector(corners));
    InfoJob job;
    job.grid.file = folder.file("a.vtu");
    ASSERT_TRUE(write_grid(grid, job.grid.file));
    std::string content = test::content_of(job.grid.file);
    const std::size_t place = content.find(sound);
    ASSERT_NE(place, std::string::npos);
    corners[4 * 1234 + 2] = 729;
    folder.write("a.vtu", content.replace(place, sound.size(), bytes_of()));
    Listener listener;
    const auto summary = look_into(job, listener);
    ASSERT_FALSE(summary);
    EXPECT_NE(summary.error().message.find("tets[1234] has point 729"), std::string::npos) << summary.error().message;
}

TEST(LookInto, CountsCellsAndSummarizesFields) {
    Listener listener;
    InfoJob job;
    job.grid.file = "make:kuhn:4:sphere,integer";
    job.survey = true;
    const GridSummary summary = look_into(job, listener).value();
    EXPECT_EQ(summary.report.tets, 6u * 4 * 4 * 4);
    EXPECT_EQ(summary.report.boundary_faces, 6u * 2 * 4 * 4);
    ASSERT_EQ(summary.fields.size(), 2u);
    EXPECT_EQ(summary.fields[1].name, "integer");
    EXPECT_EQ(summary.fields[1].type, ScalarType::int32);
    EXPECT_EQ(summary.fields[0].components.size(), 1u);
    EXPECT_EQ(summary.curved.cells, 0u);
    EXPECT_FALSE(summary.chart);
}

TEST(LookInto, BoundsTheErrorOfCurvedCellsThatAreNotRefined) {
    Listener listener;
    InfoJob job;
    job.grid.file = "make:tet10:3:sphere";
    const GridSummary summary = look_into(job, listener).value();
    EXPECT_EQ(summary.curved.cells, summary.report.cells);
    ASSERT_EQ(summary.curved.costs.size(), 1u);
    EXPECT_GT(summary.curved.costs[0].share, 0);
    EXPECT_LT(summary.curved.costs[0].share, 1);
}

TEST(LookInto, SummarizesCellFieldsOverCellsWithAVolume) {
    const test::TemporaryFolder folder;
    InfoJob job;
    job.grid.file =
        folder.write("a.vtk", "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n"
                              "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 4 17\n3 0 1 2\n4 0 1 2 3\n2 0 1\n4 1 2 3 4\n"
                              "CELL_TYPES 4\n5 10 3 10\nCELL_DATA 4\nVECTORS v float\n7 8 9 1 2 3 nan nan nan 4 5 6\n"
                              "SCALARS c int 1\nLOOKUP_TABLE default\n-9 2 99 3\n");
    Listener listener;
    const auto summary = look_into(job, listener);
    ASSERT_TRUE(summary) << summary.error().message;
    ASSERT_EQ(summary->fields.size(), 2u);
    for (const FieldSummary& field : summary->fields) {
        const bool vector = field.name == "v";
        for (const ComponentStatistics& component : field.components) EXPECT_EQ(component.not_a_number, 0u);
        EXPECT_EQ(field.components.back().lower, vector ? 3 : 2);
        EXPECT_EQ(field.components.back().upper, vector ? 6 : 3);
    }
}

TEST(LookInto, ChartsAreaAndVolume) {
    Listener listener;
    InfoJob job;
    job.grid.file = "make:kuhn:4:plane";
    job.chart = 4;
    job.field.name = "plane";
    const GridSummary summary = look_into(job, listener).value();
    ASSERT_TRUE(summary.chart);
    EXPECT_EQ(summary.chart->spectrum.isovalues.size(), 5u);
    EXPECT_NEAR(summary.chart->spectrum.volume, 8, 1e-5) << "the cube from -1 to 1";
    job.field.name = "none";
    EXPECT_FALSE(look_into(job, listener));
}

TEST(LookInto, TellsOfNumbersThatStandForNoValueAndChartsTheOthers) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "kuhn", .side = 4, .fields = {"sphere", "plane"}}).value();
    const auto values = grid.point_fields[0].values.as<float>();
    std::vector<float> filled(values.begin(), values.end());
    filled.back() = 9.96921e36F;
    grid.point_fields[0].values = Array::own(std::move(filled));
    std::vector<double> cells(grid.cells.count(), 3);
    cells[0] = 4;
    cells[5] = cells[6] = -9999;
    grid.cell_fields.push_back({"k", Array::own(std::move(cells))});
    ASSERT_TRUE(write_grid(grid, folder.file("g.vtu")));
    test::Listener listener;
    InfoJob job;
    job.grid.file = folder.file("g.vtu");
    job.field.name = "sphere";
    job.chart = 4;
    const GridSummary found = look_into(job, listener).value();
    ASSERT_EQ(listener.noted.size(), 2u) << testing::PrintToString(listener.noted);
    EXPECT_EQ(listener.noted[0].find("of the 125 points of 'sphere' 1 has 9.96921e+36, far"), 0u) << listener.noted[0];
    EXPECT_EQ(listener.noted[1].find("of the 384 cells of 'k' 2 have -9999, far from all others (3 to 4)"), 0u)
        << listener.noted[1];
    ASSERT_EQ(found.chart->spectrum.isovalues.size(), 5u);
    EXPECT_EQ(found.chart->spectrum.isovalues.front(), 0);
    EXPECT_LT(found.chart->spectrum.isovalues.back(), 1.8);
    EXPECT_GT(found.fields.at(0).components.at(0).upper, 1e36) << "the range is that of the file";
}

TEST(LookInto, TellsOfGroupsWhereAFileHasNoBlocks) {
    const test::TemporaryFolder folder;
    test::Listener listener;
    InfoJob job;
    job.each_block = true;
    job.grid.file = folder.write(
        "a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"rock\"\n$EndPhysicalNames\n"
                 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
                 "$Elements\n1\n1 4 2 7 1 1 2 3 4\n$EndElements\n");
    EXPECT_EQ(look_into(job, listener).error().message, "`each_block`: the file has no blocks, only numbers of "
                                                        "'gmsh:physical', which `block` chooses, as 'rock'");
    job.grid.file = "make:kuhn:2";
    EXPECT_EQ(look_into(job, listener).error().message, "`each_block`: the file has no blocks");
}

} // namespace
} // namespace isotet::jobs
