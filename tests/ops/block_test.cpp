// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "base/system/block.hpp"
#include "base/system/block_reuse.hpp"
#include "base/buffer.hpp"
#include "base/system/fresh_memory.hpp"

namespace isotet::core {
namespace {

constexpr std::size_t megabyte = std::size_t{1} << 20;

TEST(FreshMemory, IsRefusedBeforeMoreIsTakenThanThereIs) {
    static std::uint64_t left = 0;
    static int asked = 0;
    FreshMemory fresh([] { return ++asked, left; });
    left = 300 * megabyte;
    EXPECT_TRUE(fresh.take(200 * megabyte));
    EXPECT_EQ(asked, 1);
    left = 100 * megabyte; // what was taken is in use
    for (int i = 0; i < 6; ++i) EXPECT_TRUE(fresh.take(10 * megabyte));
    EXPECT_EQ(asked, 1) << "small blocks are not worth asking for each";
    left = 40 * megabyte;
    EXPECT_FALSE(fresh.take(30 * megabyte)) << "the heap needs some, too";
    EXPECT_FALSE(fresh.take(std::numeric_limits<std::size_t>::max()));
    EXPECT_TRUE(fresh.take(20 * megabyte));
    left = 0;
    EXPECT_TRUE(fresh.take(4 * megabyte)) << "known to be there";
    EXPECT_FALSE(fresh.take(8 * megabyte));
    left = 300 * megabyte;
    EXPECT_TRUE(fresh.take(8 * megabyte));
    left = 0;
    fresh.forget();
    EXPECT_FALSE(fresh.take(8 * megabyte)) << "another process took it";
    EXPECT_EQ(fresh.take_refusal().bytes, 8 * megabyte);
    EXPECT_EQ(fresh.take_refusal().bytes, 0u) << "told once";
}

TEST(Block, OfAnySizeCanBeWrittenToItsEnd) {
    for (const std::size_t bytes :
         {std::size_t{0}, std::size_t{1}, large_block - 1, large_block, large_block + 1, 9 * megabyte + 123}) {
        const Block block = take_block(bytes);
        ASSERT_NE(block.data, nullptr);
        EXPECT_GE(block.bytes, bytes);
        std::memset(block.data, 1, bytes);
        give_back(block);
    }
}

TEST(Block, GivenBackIsUsedAgainByTheNextOfAboutItsSize) {
    drop_kept_blocks();
    const Block first = take_block(8 * megabyte);
    std::memset(first.data, 1, first.bytes);
    give_back(first);
    const Block small = take_block(5 * megabyte); // over a quarter would be wasted
    const Block next = take_block(7 * megabyte);
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_NE(small.data, first.data);
    EXPECT_EQ(next.data, first.data);
    EXPECT_EQ(next.bytes, first.bytes);
#endif
    give_back(small);
    give_back(next);
    drop_kept_blocks();
    EXPECT_EQ(drop_kept_blocks(), 0u);
}

TEST(Block, ThatCannotBeHadThrowsBadAlloc) {
#if !defined(__SANITIZE_ADDRESS__) // whose allocator ends the process instead
    EXPECT_THROW(give_back(take_block(std::numeric_limits<std::size_t>::max() - 100)), std::bad_alloc);
    EXPECT_THROW(give_back(take_block(std::size_t{1} << 60)), std::bad_alloc);
#endif
    EXPECT_THROW(Buffer<std::uint64_t>(std::numeric_limits<std::size_t>::max() / 4), std::bad_alloc);
}

TEST(Block, ManyGivenBackAreKeptOnlyUpToALimit) {
    drop_kept_blocks();
    std::size_t given = 0;
    for (int i = 0; i < 400; ++i) { // never touched, so they cost nothing
        Block block = take_block((64 + static_cast<std::size_t>(i)) * megabyte);
        given += block.bytes;
        give_back(block);
    }
    EXPECT_LT(drop_kept_blocks(), given);
}

#if !defined(__SANITIZE_ADDRESS__) // whose allocator keeps nothing
TEST(Block, MuchLargerThanWhatIsWantedIsCutUp) {
    constexpr std::size_t huge_page = 2 * megabyte, quarter_megabyte = megabyte / 4;
    drop_kept_blocks();
    const Block first = take_block(64 * megabyte);
    auto* const begin = static_cast<std::byte*>(first.data);
    std::memset(begin, 1, first.bytes);
    give_back(first);
    std::vector<Block> pieces;
    for (const std::size_t bytes : {300 * megabyte / 1024, 5 * megabyte / 2, 9 * megabyte + 1, megabyte}) {
        const Block piece = take_block(bytes);
        EXPECT_GE(static_cast<std::byte*>(piece.data), begin);
        EXPECT_LE(static_cast<std::byte*>(piece.data) + piece.bytes, begin + first.bytes);
        EXPECT_GE(piece.bytes, bytes);
        EXPECT_LE(piece.bytes, bytes + quarter_megabyte);
        if (bytes >= huge_page) {
            EXPECT_EQ(reinterpret_cast<std::uintptr_t>(piece.data) % huge_page, 0u);
        }
        std::memset(piece.data, 2, piece.bytes);
        pieces.push_back(piece);
    }
    give_back(pieces[1]);
    EXPECT_EQ(take_block(5 * megabyte / 2).data, pieces[1].data) << "a piece given back fits the next of its size";
    for (const Block& piece : pieces) give_back(piece);
    EXPECT_EQ(drop_kept_blocks(), first.bytes);
}

TEST(BlockReuse, CutsUpWhatWasGivenBack) {
    drop_kept_blocks();
    const BlockReuse reuse;
    const Block first = take_block(64 * megabyte);
    auto* const begin = static_cast<std::byte*>(first.data);
    std::memset(begin, 1, first.bytes);
    give_back(first);
    std::vector<Block> pieces;
    for (const std::size_t bytes : {20 * megabyte, 300 * megabyte / 1024, 30 * megabyte, 5 * megabyte}) {
        const Block piece = take_block(bytes);
        EXPECT_GE(piece.bytes, bytes);
        EXPECT_GE(static_cast<std::byte*>(piece.data), begin);
        EXPECT_LE(static_cast<std::byte*>(piece.data) + piece.bytes, begin + first.bytes);
        for (const Block& other : pieces)
            EXPECT_TRUE(static_cast<std::byte*>(piece.data) >= static_cast<std::byte*>(other.data) + other.bytes ||
                        static_cast<std::byte*>(other.data) >= static_cast<std::byte*>(piece.data) + piece.bytes);
        std::memset(piece.data, 2, piece.bytes);
        pieces.push_back(piece);
    }
    for (const Block& piece : pieces) give_back(piece);
    EXPECT_EQ(drop_kept_blocks(), first.bytes);
}

/// Takes 40 MB where 32 are kept and there is room for 16 more.
void take_the_place_of_kept_blocks() {
    give_back(take_block(32 * megabyte));
    std::ifstream pages("/proc/self/statm");
    std::size_t mapped = 0;
    pages >> mapped;
    const rlimit limit{mapped * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + 16 * megabyte, RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0) std::exit(9);
    give_back(take_block(40 * megabyte));
    std::exit(0);
}

TEST(BlockDeathTest, WithoutRoomTakesThePlaceOfKeptOnes) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(take_the_place_of_kept_blocks(), testing::ExitedWithCode(0), "");
}

TEST(BlockReuse, KeepsNothingThatWouldRaiseThePeak) {
    drop_kept_blocks();
    const BlockReuse reuse;
    const Block first = take_block(40 * megabyte);
    give_back(first);
    const Block second =
        take_block(60 * megabyte); // the first is not large enough: both together were more than either
    EXPECT_EQ(drop_kept_blocks(), 0u);
    const Block third = take_block(20 * megabyte); // 80 MB is the peak from now on
    give_back(second);
    const Block fourth = take_block(40 * megabyte);
    const Block fifth = take_block(8 * megabyte);
    EXPECT_EQ(drop_kept_blocks(), 12 * megabyte);
    for (const Block& block : {third, fourth, fifth}) give_back(block);
    EXPECT_EQ(drop_kept_blocks(), 68 * megabyte);
}

TEST(BlockReuse, LeavesNoMoreThanIsKeptWithoutIt) {
    drop_kept_blocks();
    std::size_t given = 0;
    {
        const BlockReuse outer;
        const BlockReuse inner;
        std::vector<Block> blocks;
        const std::size_t kept_at_most =
            static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) / 64;
        for (int i = 0; i < 100; ++i) blocks.push_back(take_block(kept_at_most / 25)); // never touched
        for (const Block& block : blocks) {
            given += block.bytes;
            give_back(block);
        }
    }
    EXPECT_LT(drop_kept_blocks(), given);
}
#endif

} // namespace
} // namespace isotet::core
