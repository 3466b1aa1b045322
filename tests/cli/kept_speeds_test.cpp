// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Measured speeds are kept between runs, and no state of their file does any harm.
#include <cstdlib>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "kept_speeds.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::cli {
namespace {

class KeptSpeeds : public testing::Test {
protected:
    void SetUp() override {
        if (const char* cache = std::getenv("XDG_CACHE_HOME")) before = cache;
        ASSERT_EQ(setenv("XDG_CACHE_HOME", folder.file("").c_str(), 1), 0);
    }
    void TearDown() override {
        if (before) setenv("XDG_CACHE_HOME", before->c_str(), 1);
        else unsetenv("XDG_CACHE_HOME");
    }
    void put(const std::string& text) { folder.write("isotet/speeds.json", text); }

    std::optional<std::string> before;
    test::TemporaryFolder folder;
    const Speeds speeds{.pack_call = 1,
                        .pack_tet = 2,
                        .pack_gradient_tet = 9,
                        .brute_call = 3,
                        .brute_tet = 4,
                        .brute_triangle = 5,
                        .brute_gradient_tet = 10,
                        .clusters_call = 6,
                        .clusters_tet = 7,
                        .clusters_triangle = 8};
};

TEST_F(KeptSpeeds, AreFoundUnderTheirKeyOnly) {
    EXPECT_FALSE(kept_speeds("a"));
    keep("a", speeds);
    keep("card", DeviceSpeeds{.upload_tet = 1, .call = 2, .tet = 3, .triangle = 4});
    const std::optional<Speeds> found = kept_speeds("a");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->pack_call, 1);
    EXPECT_EQ(found->brute_triangle, 5);
    EXPECT_EQ(found->clusters_triangle, 8);
    EXPECT_EQ(found->brute_gradient_tet, 10);
    ASSERT_TRUE(kept_device_speeds("card"));
    EXPECT_EQ(kept_device_speeds("card")->triangle, 4);
    EXPECT_FALSE(kept_speeds("b"));
    EXPECT_FALSE(kept_speeds("card")) << "of a device, with other numbers";
}

TEST_F(KeptSpeeds, OfABrokenFileAreMeasuredAgain) {
    keep("a", speeds);
    const std::string whole = test::content_of(folder.file("isotet/speeds.json"));
    for (std::size_t length = 0; length + 2 < whole.size(); length += 7) {
        put(whole.substr(0, length));
        EXPECT_FALSE(kept_speeds("a")) << length;
    }
    std::string other = whole;
    other[other.find("\"build\": \"") + 10] = 'X'; // as another build would write it
    put(other);
    EXPECT_FALSE(kept_speeds("a"));
    for (const char* wrong : {"-1.0", "\"fast\"", "null", "1e999", "[]"}) {
        const std::size_t place = whole.find("2.0");
        put(whole.substr(0, place).append(wrong).append(whole, place + 3));
        EXPECT_FALSE(kept_speeds("a")) << wrong;
    }
    keep("a", Speeds{});
    EXPECT_FALSE(kept_speeds("a")) << "nothing takes no time";
    keep("a", speeds);
    EXPECT_TRUE(kept_speeds("a"));
}

TEST_F(KeptSpeeds, AreMeasuredAgainAfterThreeMonths) {
    constexpr long long day = 24 * 3600;
    keep("a", speeds);
    const std::string whole = test::content_of(folder.file("isotet/speeds.json"));
    const std::string before_time = "\"measured\": ";
    const std::size_t place = whole.find(before_time) + before_time.size(), end = whole.find_first_of(",\n", place);
    const long long now = std::stoll(whole.substr(place, end - place));
    const auto measured_at = [&](const std::string& time) {
        put(whole.substr(0, place).append(time).append(whole, end));
        return kept_speeds("a").has_value();
    };
    EXPECT_TRUE(measured_at(std::to_string(now - 89 * day)));
    EXPECT_FALSE(measured_at(std::to_string(now - 91 * day)));
    EXPECT_FALSE(measured_at(std::to_string(now + day))) << "the clock was set back";
    for (const char* wrong : {"\"today\"", "null", "-1", "1e300"}) EXPECT_FALSE(measured_at(wrong)) << wrong;
}

TEST_F(KeptSpeeds, AreLostWhereNothingCanBeWritten) {
    folder.write("isotet", "a file where the folder should be");
    keep("a", speeds);
    EXPECT_FALSE(kept_speeds("a"));
    unsetenv("XDG_CACHE_HOME");
    const char* const home = std::getenv("HOME");
    const std::string kept = home ? home : "";
    unsetenv("HOME");
    keep("a", speeds);
    EXPECT_FALSE(kept_speeds("a"));
    if (home) setenv("HOME", kept.c_str(), 1);
}

TEST(NameOfProcessor, IsWhatTheKernelTells) {
    const auto name = [](const char* cpuinfo) {
        std::istringstream text(cpuinfo);
        return processor_name(text);
    };
    EXPECT_EQ(name("processor\t: 0\nmodel name\t: A 9000 @ 2 GHz\n\nprocessor\t: 1\nmodel name\t: A 9000 @ 2 GHz\n"),
              "A 9000 @ 2 GHz");
    const char* const fast_and_slow =
        "processor\t: 0\nCPU implementer\t: 0x41\nCPU architecture: 8\nCPU part\t: 0xd05\n"
        "\nprocessor\t: 1\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n";
    EXPECT_EQ(name(fast_and_slow), "ARM 0x41/0xd05 and ARM 0x41/0xd0c");
    EXPECT_EQ(name("uarch\t\t: sifive,u74-mc\n"), "sifive,u74-mc");
    EXPECT_EQ(name("no colon\nmodel name\t:\n"), "a processor");
    EXPECT_EQ(name(""), "a processor");
}

TEST(KeyOfSpeeds, HasProcessorDeviceAndThreads) {
    EXPECT_NE(processor_key(3).find(", 3 threads"), std::string::npos);
    EXPECT_NE(processor_key(3), processor_key(4));
    DeviceInfo info;
    info.name = "A card";
    info.driver = "1.2";
    EXPECT_EQ(device_key(info, 2), "A card, 1.2, beside 2 threads");
}

} // namespace
} // namespace isotet::cli
