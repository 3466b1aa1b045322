// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet bench without a device; tests/render has it with one.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "small_grid.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

std::vector<std::string> bench(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bench", "--device", "none", "--rounds", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

TEST_F(Program, BenchMeasuresWhatNeedsNoDeviceAndSaysWhichToTake) {
    const json report = json_of(bench({"make:kuhn:8:sphere", "-i", "0.5,0.7"}));
    EXPECT_EQ(report["schema"], 4);
    EXPECT_EQ(report["field"], "sphere");
    EXPECT_EQ(report["isovalues"], json({0.5, 0.7}));
    EXPECT_TRUE(report["device"].is_null());
    ASSERT_EQ(report["rows"].size(), 2u);
    const char* const methods[] = {"direct", "clusters"};
    for (std::size_t i = 0; i < 2; ++i) {
        const json& row = report["rows"][i];
        EXPECT_EQ(row["method"], methods[i]);
        EXPECT_EQ(row["tets"], 6 * 8 * 8 * 8);
        EXPECT_TRUE(row["index"].is_null());
        EXPECT_GT(row["triangles"], 100);
        EXPECT_EQ(row["seconds"]["draw"], 0);
        EXPECT_GT(row["seconds"]["all"], 0);
        EXPECT_TRUE(row["tets_looked_at"].is_null());
    }
    EXPECT_EQ(report["rows"][0]["triangles"], report["rows"][1]["triangles"]);
    EXPECT_EQ(report["rows"][0]["prepare_seconds"], 0);
    EXPECT_GT(report["rows"][1]["bytes"]["host"], 0);
}

/// What is recommended for a number of surfaces is what the rows add up to.
TEST_F(Program, BenchRecommendsWhatItMeasured) {
    const json report = json_of(bench({"make:kuhn:16:gyroid"}));
    const auto seconds = [&](std::size_t row, double surfaces) {
        return report["rows"][row]["prepare_seconds"].get<double>() +
               surfaces * report["rows"][row]["best_seconds"]["all"].get<double>();
    };
    ASSERT_FALSE(report["advice"].empty());
    EXPECT_TRUE(report["advice"].back()["up_to_surfaces"].is_null());
    double from = 1;
    for (const json& advice : report["advice"]) {
        const double upto = advice["up_to_surfaces"].is_null() ? 1e9 : advice["up_to_surfaces"].get<double>();
        for (const double surfaces : {from, upto})
            for (std::size_t other = 0; other < report["rows"].size(); ++other)
                EXPECT_LE(seconds(advice["row"].get<std::size_t>(), surfaces), seconds(other, surfaces) * 1.000001)
                    << surfaces;
        from = upto + 1;
    }
}

TEST_F(Program, BenchOfThePaperMeasuresGridsOfGrowingSize) {
    const RunResult run = isotet(bench({"--paper", "--max-tets", "3000", "--json", path("rows.json")}));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("2,058 direct"), std::string::npos) << run.out;
    const json report = json::parse(content_of(path("rows.json")));
    EXPECT_EQ(report["rows"].size(), 2u);
    EXPECT_EQ(report["rows"][0]["grid"], "make:kuhn:7:gyroid");
}

TEST_F(Program, BenchTellsOfRepeatedTets) {
    std::string grid = small_grid({{"p", {0, 1, 1, 1, 2}}});
    const std::string cells = "2\n1 4 2 1 1 1 2 3 4\n";
    grid.replace(grid.find(cells), cells.size(), "3\n1 4 2 1 1 1 2 3 4\n3 4 2 1 1 1 2 3 4\n");
    put_content(path("g.msh"), grid);
    const RunResult run = isotet(bench({path("g.msh"), "-i", "0.5", "--methods", "clusters"}));
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("2, 1 repeated or collapsed ones dropped"), std::string::npos) << run.out;
}

TEST_F(Program, BenchSaysWhenThereIsNoSurface) {
    const RunResult run = isotet(bench({"make:kuhn:4:sphere", "-i", "99"}));
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("there is no surface"), std::string::npos) << run.err;
}

TEST_F(Program, BenchRefusesWhatItCannotMeasure) {
    EXPECT_TRUE(is_one_error(isotet({"bench"}), "takes a FILE, or --paper"));
    EXPECT_TRUE(is_one_error(isotet(bench({"make:kuhn:4", "--paper"})), "--paper"));
    EXPECT_TRUE(is_one_error(isotet(bench({"make:kuhn:4", "--methods", "direct,texture"})), "--methods got 'texture'"));
    EXPECT_TRUE(is_one_error(isotet(bench({"make:kuhn:4", "--methods", "textures"})),
                             "--methods has textures, which needs a device"));
    EXPECT_TRUE(
        is_one_error(isotet(bench({"make:kuhn:4", "--indexes", "octree"})), "none of the methods takes lists of tets"));
    EXPECT_TRUE(is_one_error(isotet(bench({"make:kuhn:4:sphere", "--device-memory", "1GB"})), "--device is none"));
    EXPECT_EQ(isotet(bench({"--paper", "--merge-points", "0"})).status, 2);
    EXPECT_EQ(isotet(bench({path("missing.vtu")})).status, 3);
}

} // namespace
} // namespace isotet::test
