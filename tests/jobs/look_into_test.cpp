// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/look_into.hpp>

#include <gtest/gtest.h>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

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

} // namespace
} // namespace isotet::jobs
