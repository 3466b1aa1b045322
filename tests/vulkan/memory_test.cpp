// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Buffers: where they lie, what they count, when they are refused.
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;
using vulkan::Memory;
using vulkan::Where;

constexpr std::uint64_t mebi = 1 << 20;

class DeviceMemory : public OnDevice {};

TEST_F(DeviceMemory, GivesAlignedBuffersThatDoNotOverlap) {
    std::vector<Buffer> buffers;
    for (const std::uint64_t bytes : {0u, 1u, 4u, 255u, 256u, 257u, 1000000u, 40000000u})
        buffers.push_back(take(bytes));
    for (const Buffer& a : buffers) {
        EXPECT_NE(a.address(), 0u);
        EXPECT_EQ(a.address() % 16, 0u);
        for (const Buffer& b : buffers) {
            if (&a == &b) continue;
            EXPECT_TRUE(a.address() + a.size() + 4 <= b.address() || b.address() + b.size() + 4 <= a.address());
        }
    }
}

TEST_F(DeviceMemory, IsCountedAndGivenBack) {
    Memory& memory = context().memory();
    const std::uint64_t before = memory.used();
    {
        const Buffer one = take(mebi), two = take(3 * mebi);
        EXPECT_EQ(memory.used(), before + Memory::cost(mebi) + Memory::cost(3 * mebi));
        const Buffer away = take(mebi, Where::upload);
        EXPECT_EQ(memory.used(), before + Memory::cost(mebi) + Memory::cost(3 * mebi))
            << "the machine's memory does not count";
    }
    EXPECT_EQ(memory.used(), before);
    EXPECT_GE(memory.peak(), before + 4 * mebi);
}

TEST_F(DeviceMemory, MovesWithItsBuffer) {
    Memory& memory = context().memory();
    Buffer one = take(mebi);
    const auto address = one.address();
    Buffer two = std::move(one);
    EXPECT_EQ(two.address(), address);
    EXPECT_FALSE(one) << "moved from";
    two = take(16);
    EXPECT_EQ(memory.used(), Memory::cost(16)) << "what it held before is given back";
}

TEST_F(DeviceMemory, StaysWithinItsLimit) {
    reopen(watched(), 8 * mebi);
    Memory& memory = context().memory();
    EXPECT_LE(memory.free(), 8 * mebi);
    const Buffer five = take(5 * mebi);
    EXPECT_EQ(memory.free(), 8 * mebi - Memory::cost(5 * mebi));
    const auto refused = memory.take(4 * mebi, Where::device, "triangles");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    EXPECT_EQ(refused.error().message,
              "the device buffer 'triangles' needs 4.2 MB, but 3.1 MB are free of the 8.4 MB allowed");
    EXPECT_TRUE(memory.take(memory.free() - 4, Where::device, "the rest")) << "up to the last bytes";
    EXPECT_TRUE(memory.take(9 * mebi, Where::download, "not on the device"));
}

TEST_F(DeviceMemory, RefusesMoreThanOneBufferCanHold) {
    const auto refused = context().memory().take(~std::uint64_t{0}, Where::device, "everything");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    EXPECT_NE(refused.error().message.find("the largest that the device allows is 2.1 GB"), std::string::npos)
        << refused.error().message;
}

TEST_F(DeviceMemory, IsMappedWhereItIsTheMachines) {
    EXPECT_EQ(take(100).mapped().size(), 100u);
    for (const Where where : {Where::upload, Where::download}) EXPECT_EQ(take(100, where).mapped().size(), 100u);
    vulkan::Settings settings = watched();
    settings.force_staging = true;
    reopen(settings);
    EXPECT_TRUE(take(100).mapped().empty()) << "as on a card";
    for (const Where where : {Where::upload, Where::download}) EXPECT_EQ(take(100, where).mapped().size(), 100u);
}

TEST_F(DeviceMemory, KeepsItsContentThroughThousandsOfBuffers) {
    std::mt19937 random(7);
    std::vector<std::pair<Buffer, std::uint8_t>> buffers;
    const auto check = [](const std::pair<Buffer, std::uint8_t>& one) {
        for (const std::byte byte : one.first.mapped()) ASSERT_EQ(static_cast<std::uint8_t>(byte), one.second);
    };
    for (int step = 0; step < 3000; ++step) {
        if (!buffers.empty() && random() % 2) {
            auto& one = buffers[random() % buffers.size()];
            check(one);
            std::swap(one, buffers.back());
            buffers.pop_back();
            continue;
        }
        Buffer buffer = take(1 + random() % 5000);
        const auto mark = static_cast<std::uint8_t>(random());
        std::ranges::fill(buffer.mapped(), std::byte{mark});
        buffers.emplace_back(std::move(buffer), mark);
    }
    for (const auto& one : buffers) check(one);
    buffers.clear();
    EXPECT_EQ(context().memory().used(), 0u);
}

} // namespace
} // namespace isotet::test
