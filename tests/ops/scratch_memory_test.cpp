// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays in files: what is in them, what stays of them, and where there is no room.
#include <isotet/memory.hpp>

#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <new>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using core::Buffer;

constexpr std::size_t megabyte = std::size_t{1} << 20;

ScratchMemory scratch_in(const std::string& folder, std::uint64_t memory = 1) {
    return ScratchMemory::begin({folder, memory}).value();
}

Buffer<std::uint64_t> counted(std::size_t bytes) {
    Buffer<std::uint64_t> buffer(bytes / sizeof(std::uint64_t));
    std::iota(buffer.begin(), buffer.end(), std::uint64_t{7});
    return buffer;
}

bool is_counted(const Buffer<std::uint64_t>& buffer) {
    for (std::size_t i = 0; i < buffer.size(); ++i)
        if (buffer[i] != 7 + i) return false;
    return true;
}

TEST(ScratchMemory, HoldsLargeArraysInFilesWithoutNames) {
    const TemporaryFolder folder;
    Buffer<std::uint64_t> later;
    {
        const ScratchMemory scratch = scratch_in(folder.file(""));
        const Buffer<std::uint64_t> small(100), large = counted(3 * megabyte);
        EXPECT_EQ(scratch.report().bytes, 3 * megabyte);
        later = counted(megabyte + 8); // a page is begun
        EXPECT_GT(scratch.report().bytes, 4 * megabyte);
        EXPECT_TRUE(std::filesystem::is_empty(folder.file("")));
        EXPECT_TRUE(is_counted(large));
    }
    EXPECT_TRUE(is_counted(later)); // outlives what made it
    later.release();
    const ScratchMemory next = scratch_in(folder.file(""));
    EXPECT_EQ(next.report().bytes, 0u);
}

TEST(ScratchMemory, LeavesInMemoryWhatFits) {
    const TemporaryFolder folder;
    const ScratchMemory scratch = scratch_in(folder.file(""), std::uint64_t{1} << 40);
    const Buffer<std::uint64_t> large = counted(3 * megabyte);
    EXPECT_EQ(scratch.report().peak_bytes, 0u);
}

TEST(ScratchMemory, LetsGoOfPagesNotOfWhatIsInThem) {
    const std::optional<std::uint64_t> before = resident_memory();
    if (!before) GTEST_SKIP() << "the system does not tell how much is resident";
    const TemporaryFolder folder;
    const std::uint64_t size = std::max<std::uint64_t>(24, *before / (8 * megabyte)) * megabyte; // too large to stay
    const ScratchMemory scratch = scratch_in(folder.file(""), *before + 16 * megabyte);
    const Buffer<std::uint64_t> first = counted(size), second = counted(size);
    EXPECT_EQ(scratch.report().bytes, 2 * size);
    for (int i = 0; i < 10'000 && resident_memory().value() > *before + 16 * megabyte; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    EXPECT_LE(resident_memory().value(), *before + 16 * megabyte);
    EXPECT_TRUE(is_counted(first));
    EXPECT_TRUE(is_counted(second));
}

TEST(ScratchMemory, IsUsedByManyThreadsAtOnce) {
    const TemporaryFolder folder;
    const ScratchMemory scratch = scratch_in(folder.file(""), 8 * megabyte);
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (std::size_t which = 0; which < 6; ++which)
        threads.emplace_back([&, which] {
            std::vector<Buffer<std::uint64_t>> kept;
            for (std::size_t i = 0; i < 12; ++i) {
                kept.push_back(counted((1 + (i + which) % 4) * megabyte));
                if (kept.size() > 3) kept.erase(kept.begin() + static_cast<std::ptrdiff_t>((i + which) % 3));
                for (const Buffer<std::uint64_t>& buffer : kept) wrong += !is_counted(buffer);
                if (scratch.report().bytes > scratch.report().peak_bytes) ++wrong;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST(ScratchMemory, LeavesNothingBehindAfterAKill) {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const ScratchMemory scratch = scratch_in(folder.file(""));
        const Buffer<std::uint64_t> large = counted(megabyte);
        ::raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
    EXPECT_TRUE(std::filesystem::is_empty(folder.file("")));
}

TEST(ScratchMemory, IsOneAtATimeInAFolderThatIsThere) {
    const TemporaryFolder folder;
    EXPECT_EQ(ScratchMemory::begin({folder.file(""), 0}).error().code, ErrorCode::invalid_argument);
    const auto nowhere = ScratchMemory::begin({folder.file("none"), 1});
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().code, ErrorCode::cannot_write);
    EXPECT_NE(nowhere.error().message.find("none'"), std::string::npos);
    const ScratchMemory scratch = scratch_in(folder.file(""));
    EXPECT_EQ(ScratchMemory::begin({folder.file(""), 1}).error().code, ErrorCode::invalid_argument);
}

TEST(ScratchMemory, SaysWhatTheFolderHasNoRoomFor) {
    const TemporaryFolder folder;
    std::signal(SIGXFSZ, SIG_IGN);
    const ScratchMemory scratch = scratch_in(folder.file(""));
    EXPECT_TRUE(scratch.require("packing", megabyte));
    EXPECT_TRUE(core::require_memory("packing", megabyte));
    const auto refused = core::require_memory("packing", std::uint64_t{1} << 62);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::cannot_write);
    EXPECT_EQ(refused.error().message.find("packing needs 4611686.0 TB in the scratch folder"), 0u)
        << refused.error().message;

    EXPECT_FALSE(scratch.failure());
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit limit{megabyte, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0); // as a full disk
    EXPECT_THROW(counted(2 * megabyte), std::bad_alloc);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    ASSERT_TRUE(scratch.failure());
    EXPECT_EQ(scratch.failure()->code, ErrorCode::cannot_write);
    EXPECT_NE(scratch.failure()->message.find("an array needs 2.1 MB"), std::string::npos)
        << scratch.failure()->message;
    EXPECT_EQ(scratch.report().bytes, 0u);
}

} // namespace
} // namespace isotet::test
