// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Threads for one piece of work, and what is left of them for the rest of the process.
#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/info.h>

#include "base/parallel.hpp"

namespace isotet::core {
namespace {

int cores() { return tbb::info::default_concurrency(); }

int allowed() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

TEST(WithThreads, RaisesTheLimitOfTheProcessOnlyWhileItWorks) {
    ASSERT_EQ(allowed(), cores());
    with_threads(cores() + 6, [] {
        EXPECT_EQ(allowed(), cores() + 6);
        EXPECT_EQ(threads_here(), cores() + 6);
        with_threads(cores() + 3, [] { EXPECT_EQ(allowed(), cores() + 6); });
        EXPECT_EQ(allowed(), cores() + 6);
    });
    EXPECT_EQ(allowed(), cores());
    with_threads(1, [] { EXPECT_EQ(allowed(), cores()); });
}

TEST(WithThreads, LowersTheLimitAgainWhenTheWorkThrows) {
    EXPECT_THROW(with_threads(cores() + 6, [] { throw std::runtime_error("no"); }), std::runtime_error);
    EXPECT_EQ(allowed(), cores());
}

TEST(WithThreads, KeepsTheLimitForOthersThatStillNeedIt) {
    std::promise<void> small_runs, large_ended;
    std::thread small([&] {
        with_threads(cores() + 2, [&] {
            small_runs.set_value();
            large_ended.get_future().wait();
            EXPECT_EQ(allowed(), cores() + 2);
        });
    });
    small_runs.get_future().wait();
    with_threads(cores() + 9, [] { EXPECT_EQ(allowed(), cores() + 9); });
    EXPECT_EQ(allowed(), cores() + 2);
    large_ended.set_value();
    small.join();
    EXPECT_EQ(allowed(), cores());
}

} // namespace
} // namespace isotet::core
