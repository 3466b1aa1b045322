// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The next step is read once, by another thread, and given up where another one is wanted.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "base/threads/read_ahead.hpp"

namespace isotet::core {
namespace {

class Ahead : public testing::Test {
protected:
    ReadAhead<int>::Read read(bool waits = false) {
        return [this, waits](std::size_t step, const isotet::Run& run) -> Result<int> {
            {
                const std::lock_guard lock(mutex);
                steps.push_back(step);
                by.push_back(std::this_thread::get_id());
            }
            while (waits && by_another() && !run.progress.cancelled()) std::this_thread::yield();
            if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "cancelled"};
            return static_cast<int>(step);
        };
    }
    bool by_another() const { return std::this_thread::get_id() != own; }

    std::thread::id own = std::this_thread::get_id();
    std::mutex mutex;
    std::vector<std::size_t> steps;
    std::vector<std::thread::id> by;
};

TEST_F(Ahead, ReadsAStepOnce) {
    ReadAhead<int> reader(read(), 1);
    EXPECT_EQ(reader.take(0, {}).value(), 0);
    reader.read_ahead(1);
    reader.read_ahead(1);
    EXPECT_EQ(reader.take(1, {}).value(), 1);
    EXPECT_EQ(steps, (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(by[0], own);
    EXPECT_NE(by[1], own);
}

TEST_F(Ahead, GivesUpAStepThatIsNotWanted) {
    ReadAhead<int> reader(read(true), 1);
    reader.read_ahead(1); // which does not end by itself
    EXPECT_EQ(reader.take(2, {}).value(), 2);
    reader.read_ahead(3);
}

TEST_F(Ahead, IsCancelledWhileItWaits) {
    ReadAhead<int> reader(read(true), 1);
    reader.read_ahead(1);
    const std::atomic<bool> cancel = true;
    const auto taken = reader.take(1, {1, {{}, &cancel}});
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::core
