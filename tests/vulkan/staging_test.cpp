// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Bytes go up and come down unchanged, whatever their number, place and way.
#include <cstring>
#include <ostream>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;

struct Way {
    const char* name;
    bool force_staging;
    std::uint64_t chunk;
};

std::ostream& operator<<(std::ostream& out, const Way& way) { return out << way.name; }

class StagingBy : public OnDevice, public testing::WithParamInterface<Way> {
protected:
    void SetUp() override {
        vulkan::Settings settings = watched();
        settings.force_staging = GetParam().force_staging;
        settings.staging_bytes = GetParam().chunk;
        reopen(settings);
    }
    vulkan::Staging& staging() { return context().staging(); }
};

std::vector<std::byte> random_bytes(std::size_t count) {
    std::mt19937 random(static_cast<unsigned>(count));
    std::vector<std::byte> bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    return bytes;
}

TEST_P(StagingBy, BringsBackWhatItTookUp) {
    for (const std::size_t count : {0u, 1u, 4u, 255u, 256u, 257u, 511u, 512u, 513u, 1024u, 5000u}) {
        const Buffer buffer = take(count);
        const std::vector<std::byte> bytes = random_bytes(count);
        std::vector<std::byte> back(count);
        ASSERT_TRUE(staging().upload(buffer, 0, bytes)) << count;
        ASSERT_TRUE(staging().download(buffer, 0, back)) << count;
        EXPECT_EQ(back, bytes) << count;
    }
}

TEST_P(StagingBy, TouchesOnlyTheRangeThatIsMeant) {
    const Buffer buffer = take(3000);
    std::vector<std::byte> expected = random_bytes(3000);
    ASSERT_TRUE(staging().upload(buffer, 0, expected));
    const std::vector<std::byte> part = random_bytes(1001);
    ASSERT_TRUE(staging().upload(buffer, 777, part));
    std::memcpy(expected.data() + 777, part.data(), part.size());
    std::vector<std::byte> back(3000);
    ASSERT_TRUE(staging().download(buffer, 0, back));
    EXPECT_EQ(back, expected);
    std::vector<std::byte> middle(1003);
    ASSERT_TRUE(staging().download(buffer, 776, middle));
    EXPECT_EQ(std::memcmp(middle.data(), expected.data() + 776, middle.size()), 0);
}

TEST_P(StagingBy, SeesWhatPassesWroteAndIsSeenByThem) {
    const Buffer up = upload(ramp(1000)), down = take(4000);
    vulkan::Recorder recorder(context());
    recorder.copy(up, 0, down, 0, 4000);
    recorder.fill(down, 0, 8, 5);
    ASSERT_TRUE(recorder.run());
    std::vector<std::uint32_t> expected = ramp(1000);
    expected[0] = expected[1] = 5;
    EXPECT_EQ(download(down), expected);
}

TEST_P(StagingBy, CountsTheTraffic) {
    const std::uint64_t up = staging().uploaded(), down = staging().downloaded();
    const Buffer buffer = take(5000);
    std::vector<std::byte> bytes(5000);
    ASSERT_TRUE(staging().upload(buffer, 0, bytes));
    ASSERT_TRUE(staging().download(buffer, 100, std::span(bytes).first(1234)));
    EXPECT_EQ(staging().uploaded() - up, 5000u);
    EXPECT_EQ(staging().downloaded() - down, 1234u);
}

TEST_P(StagingBy, RefusesWhatDoesNotFit) {
    const Buffer buffer = take(100);
    std::vector<std::byte> bytes(60);
    EXPECT_TRUE(staging().upload(buffer, 40, bytes));
    EXPECT_FALSE(staging().upload(buffer, 41, bytes));
    EXPECT_FALSE(staging().download(buffer, 41, bytes));
    EXPECT_FALSE(staging().upload(buffer, ~std::uint64_t{0}, bytes));
}

INSTANTIATE_TEST_SUITE_P(Ways, StagingBy,
                         testing::Values(Way{"Mapping", false, 1 << 20}, Way{"Copies", true, 1 << 20},
                                         Way{"ManySmallCopies", true, 256}),
                         [](const auto& way) { return way.param.name; });

} // namespace
} // namespace isotet::test
