// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Free memory under control groups, from files as the system shows them: the smallest of all limits counts.
#include "base/system/memory.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

#include "base/buffer.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace isotet::test {
namespace {

namespace fs = std::filesystem;

class ControlGroup : public testing::Test {
protected:
    ControlGroup()
        : folder(fs::path(testing::TempDir()) / ("isotet_" + std::to_string(::getpid()) +
                                                 testing::UnitTest::GetInstance()->current_test_info()->name())) {}
    ~ControlGroup() override { fs::remove_all(folder); }
    void put(const std::string& name, const std::string& content) const {
        fs::create_directories((folder / name).parent_path());
        std::ofstream(folder / name) << content;
    }
    std::uint64_t free() const { return core::control_group_free(folder / "membership", folder / "mount"); }
    fs::path folder;
};

TEST_F(ControlGroup, OfVersionTwoLeavesItsLimitLessWhatIsUsedAndNotCached) {
    put("membership", "0::/jobs/one\n");
    put("mount/jobs/one/memory.max", "1000000\n");
    put("mount/jobs/one/memory.current", "700000\n");
    put("mount/jobs/one/memory.stat", "anon 400000\ninactive_file 200000\nactive_file 100000\n");
    EXPECT_EQ(free(), 600000u);
}

TEST_F(ControlGroup, AboveItCountsWhenItLeavesLess) {
    put("membership", "0::/jobs/one\n");
    put("mount/jobs/one/memory.max", "max\n");
    put("mount/jobs/one/memory.current", "700\n");
    put("mount/jobs/memory.max", "5000\n");
    put("mount/jobs/memory.current", "4000\n");
    EXPECT_EQ(free(), 1000u);
}

TEST_F(ControlGroup, OfVersionOneIsReadFromItsMemoryController) {
    put("membership", "5:cpu:/elsewhere\n4:memory:/one\n");
    put("mount/memory/one/memory.limit_in_bytes", "3000\n");
    put("mount/memory/one/memory.usage_in_bytes", "3500\n");
    EXPECT_EQ(free(), 0u);
}

TEST_F(ControlGroup, OfVersionOneGivesFilesThatGroupsBelowItHaveCachedAway) {
    put("membership", "4:memory:/one\n");
    put("mount/memory/one/memory.limit_in_bytes", "3000\n");
    put("mount/memory/one/memory.usage_in_bytes", "2500\n");
    put("mount/memory/one/memory.stat",
        "inactive_file 100\nactive_file 0\ntotal_inactive_file 900\ntotal_active_file 600\n");
    EXPECT_EQ(free(), 2000u);
}

#if !defined(__SANITIZE_ADDRESS__) // whose allocator maps blocks itself
TEST(FreeMemory, IsLessByWhatWasTakenAndNotWrittenToYet) {
    constexpr std::size_t bytes = std::size_t{512} << 20;
    const std::uint64_t before = core::free_memory();
    const core::Buffer<std::byte> taken(bytes);
    EXPECT_LT(core::free_memory(), before - bytes / 2) << "the system counts it only when it is written to";
}
#endif

TEST_F(ControlGroup, WithoutALimitLeavesEverything) {
    put("membership", "0::/\n");
    EXPECT_EQ(free(), std::numeric_limits<std::uint64_t>::max());
}

} // namespace
} // namespace isotet::test
