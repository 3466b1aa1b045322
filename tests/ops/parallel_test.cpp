// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Threads for one piece of work, and what is left of them for the rest of the process.
#include <unistd.h>

#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <stdexcept>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

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

TEST(WithThreads, TakesThoseOfTheCallersArena) {
    tbb::task_arena two(2);
    two.execute([] { with_threads(0, [] { EXPECT_EQ(threads_here(), 2); }); });
    with_threads(0, [] { EXPECT_EQ(threads_here(), cores()); });
    with_threads(1, [] { with_threads(0, [] { EXPECT_EQ(threads_here(), 1); }); });
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

/// Bytes of the process that are in memory.
std::size_t resident() {
    std::size_t all = 0, in_memory = 0;
    std::ifstream("/proc/self/statm") >> all >> in_memory;
    return in_memory * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

TEST(WithThreads, TakesNoMemoryForEachCall) {
    const auto call = [](int times) {
        for (int i = 0; i < times; ++i)
            with_threads(2, [] { parallel_ranges(8, 1, [](std::size_t, std::size_t) { std::this_thread::yield(); }); });
    };
    call(500);
    const std::size_t before = resident();
    call(5000); // 48 MB, when each has an arena of its own
    EXPECT_LT(resident(), before + (std::size_t{16} << 20));
}

} // namespace
} // namespace isotet::core
