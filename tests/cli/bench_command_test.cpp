// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet bench without a device; tests/render has it with one.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"

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
    EXPECT_EQ(report["schema"], 2);
    EXPECT_EQ(report["field"], "sphere");
    EXPECT_EQ(report["isovalues"], json({0.5, 0.7}));
    EXPECT_TRUE(report["device"].is_null());
    ASSERT_EQ(report["rows"].size(), 2u);
    const char* const methods[] = {"direct", "clusters"};
    for (std::size_t i = 0; i < 2; ++i) {
        const json& row = report["rows"][i];
        EXPECT_EQ(row["method"], methods[i]);
        EXPECT_EQ(row["tets"], 6 * 8 * 8 * 8);
        EXPECT_TRUE(row["filter"].is_null());
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

TEST_F(Program, BenchWritesRowsAndCharts) {
    const RunResult run =
        isotet(bench({"--paper", "--max-tets", "3000", "--csv", path("rows.csv"), "--svg", path("chart.svg")}));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("2,058 direct"), std::string::npos) << run.out;
    const std::string rows = content_of(path("rows.csv")), chart = content_of(path("chart.svg"));
    EXPECT_EQ(std::ranges::count(rows, '\n'), 3);
    for (std::size_t begin = 0; begin < rows.size();) { // every line has the columns of the first
        const std::string line = rows.substr(begin, rows.find('\n', begin) - begin);
        EXPECT_EQ(std::ranges::count(line, ','), 18) << line;
        begin += line.size() + 1;
    }
    for (const char* part : {"<svg", ">direct<", ">clusters<", ">GPU(R) in the paper, 2006<", "</svg>"})
        EXPECT_NE(chart.find(part), std::string::npos) << part;
    ASSERT_EQ(isotet(bench({"make:kuhn:4:sphere", "--svg", path("one.svg")})).status, 0);
    EXPECT_NE(content_of(path("one.svg")).find("make:kuhn:4:sphere: sphere"), std::string::npos);
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
        is_one_error(isotet(bench({"make:kuhn:4", "--filters", "octree"})), "none of the methods takes lists of tets"));
    const RunResult twice = isotet(bench({"make:kuhn:4:sphere", "--csv", path("a"), "--svg", path("a")}));
    EXPECT_EQ(twice.status, 2) << twice.err;
    EXPECT_TRUE(is_one_error(isotet(bench({"make:kuhn:4:sphere", "--csv", "-"})), "--csv got '-'"));
    EXPECT_TRUE(is_one_error(isotet(bench({"make:kuhn:4:sphere", "--device-memory", "1GB"})), "--device is none"));
    EXPECT_EQ(isotet(bench({"--paper", "--merge-points", "0"})).status, 2);
    EXPECT_EQ(isotet(bench({path("missing.vtu")})).status, 3);
}

} // namespace
} // namespace isotet::test
