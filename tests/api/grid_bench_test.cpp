// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What follows from rows of measurements.
#include <array>
#include <atomic>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/paper/grid_bench.hpp>
#include <isotet/make.hpp>

namespace isotet::test {
namespace {

BenchRow row(double prepare, double each, BenchPair pair = {}, std::string grid = "g") {
    BenchRow out;
    out.grid = std::move(grid);
    out.pair = pair;
    out.costs.prepare_seconds = prepare;
    out.best.extract = each;
    out.median.extract = 2 * each;
    return out;
}

TEST(BenchAdvice, GoesFromCheapToPrepareToCheapToRepeat) {
    // 1 + 0.1 n is below n from 1.11 on; 11 + 0.01 n is below 1 + 0.1 n from 111.1 on; 5 + 0.1 n never is the least.
    const std::vector<BenchAdvice> advice = advice_of({row(11, 0.01), row(5, 0.1), row(1, 0.1), row(0, 1)});
    ASSERT_EQ(advice.size(), 3u);
    EXPECT_EQ(advice[0].row, 3u);
    EXPECT_EQ(advice[0].upto, 1);
    EXPECT_EQ(advice[1].row, 2u);
    EXPECT_EQ(advice[1].upto, 111);
    EXPECT_EQ(advice[2].row, 0u);
    EXPECT_TRUE(std::isinf(advice[2].upto));
}

TEST(BenchAdvice, LeavesOutWhatIsMissing) {
    BenchRow missing = row(0, 0);
    missing.missing = "no memory";
    const std::vector<BenchAdvice> advice = advice_of({missing, row(1, 1)});
    ASSERT_EQ(advice.size(), 1u);
    EXPECT_EQ(advice[0].row, 1u);
    EXPECT_TRUE(advice_of({missing}).empty());
    EXPECT_TRUE(advice_of({}).empty());
}

TEST(BenchAdvice, GainsAreMeansOverTheGridsThatHaveBoth) {
    const BenchPair all{BenchMethod::textures, SearchIndex::none},
        tree{BenchMethod::textures, SearchIndex::interval_tree};
    const std::vector<BenchRow> rows{row(0, 6, all, "a"), row(0, 2, tree, "a"), row(0, 5, all, "b"),
                                     row(0, 1, tree, "b"), row(0, 1, tree, "c")};
    EXPECT_DOUBLE_EQ(gain_of_interval_tree(rows, BenchMethod::textures).value(), 4);
    EXPECT_FALSE(gain_of_interval_tree(rows, BenchMethod::registers));
}

TEST(GridBench, MeasuresWithoutADeviceAndRefusesWhatItCannot) {
    const Grid grid = make_grid({.shape = "kuhn", .side = 4, .fields = {"sphere"}}).value();
    GridBench bench = GridBench::create(grid, find_field(grid, "sphere").value(), {}).value();
    const BenchRow measured = bench.measure({BenchMethod::clusters}, std::array{0.5, 0.7}, 2).value();
    EXPECT_EQ(measured.missing, "");
    EXPECT_EQ(measured.tets, 384u);
    EXPECT_GT(measured.median.total(), 0);
    EXPECT_LE(measured.best.total(), measured.median.total());
    EXPECT_GT(measured.outcome.triangles.value(), 0u);
    EXPECT_EQ(bench.measure({BenchMethod::textures}, std::array{0.5}, 1).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(bench.measure({BenchMethod::direct}, {}, 1).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(bench.measure({BenchMethod::direct}, std::array{0.5}, 0).error().code, ErrorCode::invalid_argument);
    const std::atomic<bool> cancel = true;
    EXPECT_EQ(bench.measure({BenchMethod::direct}, std::array{0.5}, 1, {.progress = {.report = {}, .cancel = &cancel}})
                  .error()
                  .code,
              ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::test
