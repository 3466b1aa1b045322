// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/rising_progress.hpp"

namespace isotet::core {
namespace {

TEST(RisingProgress, PassesOnWhatRisesWithinAStep) {
    std::vector<std::pair<std::string, double>> seen;
    Progress user;
    user.report = [&](std::string_view step, double fraction) { seen.emplace_back(step, fraction); };
    const Progress progress = rising(user);
    for (const double fraction : {0.1, 0.5, 0.3, 0.5, 0.2}) progress("upload", fraction);
    progress("extract", 0.2);
    progress("upload", 0.4);
    progress("extract", 1);
    EXPECT_EQ(seen, (std::vector<std::pair<std::string, double>>{
                        {"upload", 0.1}, {"upload", 0.5}, {"upload", 0.5}, {"extract", 0.2}, {"extract", 1}}));
}

TEST(RisingProgress, BeginsAnewWithEachOperation) {
    std::vector<double> seen;
    Progress user;
    user.report = [&](std::string_view, double fraction) { seen.push_back(fraction); };
    for (int operation = 0; operation < 2; ++operation) rising(user)("pack", 0.5);
    EXPECT_EQ(seen, (std::vector<double>{0.5, 0.5}));
}

TEST(RisingProgress, HearsACancel) {
    std::atomic<bool> cancel{false};
    Progress user;
    user.cancel = &cancel;
    const Progress progress = rising(user);
    progress("pack", 0.5); // nobody listens
    EXPECT_FALSE(progress.cancelled());
    cancel = true;
    EXPECT_TRUE(progress.cancelled());
}

TEST(RisingProgress, NeverFallsAndNeverOverlapsWithManyThreads) {
    constexpr int threads = 16, steps = 2000;
    double last = 0;
    std::atomic<int> inside{0}, overlaps{0}, falls{0};
    Progress user;
    user.report = [&](std::string_view, double fraction) {
        overlaps += inside++ != 0;
        falls += fraction < last;
        last = fraction;
        --inside;
    };
    const Progress progress = rising(user);
    std::atomic<int> finished{0};
    std::vector<std::thread> all;
    for (int t = 0; t < threads; ++t)
        all.emplace_back([&] {
            for (int i = 0; i < steps; ++i) {
                const double done = ++finished;
                if (i % 16 == 0) std::this_thread::yield(); // an older count is reported later
                progress("pack", done / (threads * steps));
            }
        });
    for (std::thread& thread : all) thread.join();
    EXPECT_EQ(overlaps, 0);
    EXPECT_EQ(falls, 0);
    EXPECT_GT(last, 0);
}

} // namespace
} // namespace isotet::core
