// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Too little memory is found out before it is taken, and said with the amount needed: limits are those of a child
// process. What is kept for later can be given back.
#include <fstream>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <isotet/extract.hpp>
#include <isotet/memory.hpp>
#include <isotet/pack.hpp>

#include "base/system/block.hpp"
#include "base/system/memory.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// Leaves this process so many bytes of address space beyond what it has and uses.
void leave_memory(std::uint64_t bytes) {
    core::drop_kept_blocks();
    std::ifstream status("/proc/self/status");
    std::uint64_t kib = 0;
    for (std::string word; status >> word;)
        if (word == "VmSize:") status >> kib;
    const rlimit limit{1024 * kib + bytes, RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0) std::exit(9);
}

/// Prints the error and ends with 0 for out_of_memory, 1 for success, 2 for another error.
template <class T>
[[noreturn]] void end_with(const Result<T>& result) {
    if (result) std::exit(1);
    std::cerr << result.error().message << std::endl;
    std::exit(result.error().code == ErrorCode::out_of_memory ? 0 : 2);
}

class OutOfMemory : public testing::Test {
protected:
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

void pack_with_little_memory() {
    const Grid grid = made_grid("kuhn", 80, {"plane"}); // 3,072,000 tets
    leave_memory(50 << 20);
    end_with(pack(grid, point_field(grid), {}, {.threads = 1}));
}

TEST_F(OutOfMemory, IsToldByPackWithTheAmountNeeded) {
    EXPECT_EXIT(pack_with_little_memory(), testing::ExitedWithCode(0),
                "^packing the grid needs (8|9)[0-9]\\.[0-9] MB, but [0-9.]+ MB are free");
}

/// A surface of 80 MB; and, from the tets of its clusters, a bound of some 300 MB.
void extract_with_memory_left(std::uint64_t bytes) {
    const Grid grid = made_grid("kuhn", 72, {"integer"});
    ExtractOptions options;
    options.ties = Ties::keep;
    options.edge_ends = true;
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    if (!extract(packed, 4, options, {.threads = 1})) std::exit(3); // what can be loaded lazily is loaded now
    leave_memory(bytes);
    end_with(extract(packed, 2, options, {.threads = 1}));
}

TEST_F(OutOfMemory, IsToldByExtractWithTheAmountNeeded) {
    EXPECT_EXIT(extract_with_memory_left(16 << 20), testing::ExitedWithCode(0),
                "^extraction needs (9[0-9]|1[0-3][0-9])\\.[0-9] MB, but [0-9.]+ MB are free");
}

TEST_F(OutOfMemory, IsNotToldByExtractWhenOnlyABoundWouldNotFit) {
    EXPECT_EXIT(extract_with_memory_left(200 << 20), testing::ExitedWithCode(1), "");
}

void extract_many_with_little_memory() {
    const Grid grid = made_grid("kuhn", 40, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    if (!extract(packed, 0, {}, {.threads = 1})) std::exit(3);
    leave_memory(32 << 20); // for one of them it is enough
    end_with(extract(packed, std::vector<double>(40, 0.1), {}, {.threads = 1}));
}

TEST_F(OutOfMemory, IsToldByExtractForAllIsovaluesTogether) {
    EXPECT_EXIT(extract_many_with_little_memory(), testing::ExitedWithCode(0),
                "^extraction needs (9[0-9]|1[0-3][0-9])\\.[0-9] MB, but [0-9.]+ MB are free");
}

TEST_F(OutOfMemory, IsToldByMakeGridBeforeAHugeGrid) {
    MakeOptions options;
    options.side = 4096; // 412 thousand million tets
    const auto refused = make_grid(options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
}

#if !defined(__SANITIZE_ADDRESS__) // whose allocator keeps nothing
TEST(ReleaseMemory, GivesBackWhatOperationsLeftBehind) {
    const Grid grid = made_grid("kuhn", 48, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const Surface kept = extract(packed, 0.3).value().surface;
    { const auto dropped = extract(packed, 0).value(); }
    const std::uint64_t before = core::resident_memory().value();
    const std::size_t released = release_memory();
    EXPECT_GT(released, std::size_t{1} << 20);
    EXPECT_LT(core::resident_memory().value(), before);
    EXPECT_EQ(release_memory(), 0u) << "nothing is left to give back";
    EXPECT_EQ(bytes_of(extract(packed, 0.3).value().surface), bytes_of(kept)) << "and everything still works";
}
#endif

} // namespace
} // namespace isotet::test
