// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/paper/measure_methods.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include "jobs/listener.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

BenchJob without_device() {
    BenchJob job;
    job.device.name = "none";
    job.rounds = 1;
    return job;
}

TEST(MeasureMethods, MeasuresWhatNeedsNoDevice) {
    Listener listener;
    BenchJob job = without_device();
    job.grid.file = "make:kuhn:4:sphere";
    const BenchNumbers numbers = measure_methods(job, listener).value();
    ASSERT_EQ(numbers.rows.size(), 2u);
    EXPECT_EQ(numbers.rows[0].pair.method, BenchMethod::direct);
    EXPECT_EQ(numbers.rows[0].outcome.triangles, numbers.rows[1].outcome.triangles);
    EXPECT_EQ(numbers.isovalues.size(), 3u);
    EXPECT_EQ(numbers.field, "sphere");
}

TEST(MeasureMethods, TakesIsovaluesByShareAfterOthers) {
    Listener listener;
    BenchJob job = without_device();
    job.grid.file = "make:kuhn:4:plane";
    job.methods = {BenchMethod::direct};
    job.isovalues = {0.5};
    job.shares = {{IsovalueShare::Of::volume, 50}, {IsovalueShare::Of::points, 100}};
    const BenchNumbers numbers = measure_methods(job, listener).value();
    ASSERT_EQ(numbers.isovalues.size(), 3u);
    EXPECT_EQ(numbers.isovalues[0], 0.5);
    EXPECT_NEAR(numbers.isovalues[1], 0, 1e-6);
    EXPECT_NEAR(numbers.isovalues[2], 6 / std::sqrt(14), 1e-6);
}

TEST(MeasureMethods, TakesThePapersGridsUpToASize) {
    Listener listener;
    BenchJob job = without_device();
    job.paper = true;
    job.max_tets = 6 * 20 * 20 * 20;
    job.methods = {BenchMethod::clusters};
    const BenchNumbers numbers = measure_methods(job, listener).value();
    ASSERT_EQ(numbers.rows.size(), 1u);
    EXPECT_EQ(numbers.rows[0].tets, job.max_tets);
}

TEST(MeasureMethods, RefusesWhatContradictsItself) {
    Listener listener;
    BenchJob job = without_device();
    EXPECT_EQ(measure_methods(job, listener).error().message, "isotet bench takes a FILE, or `paper`");
    job.paper = true;
    job.methods = {BenchMethod::clusters};
    job.indexes = {SearchIndex::interval_tree};
    EXPECT_TRUE(measure_methods(job, listener).error().message.starts_with("`indexes` was given, but none"));
    job.indexes.clear();
    job.methods = {BenchMethod::textures};
    EXPECT_TRUE(measure_methods(job, listener).error().message.starts_with("`methods` has textures, which needs"));
}

} // namespace
} // namespace isotet::jobs
