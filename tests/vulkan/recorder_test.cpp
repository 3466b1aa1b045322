// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lists of passes: what they leave in memory, how they are folded, timed, and refused.
#include <algorithm>
#include <array>
#include <numeric>

#include <gtest/gtest.h>

#include "test_shaders.hpp"
#include "vulkan/add_push.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;
using vulkan::Kernel;
using vulkan::reads;
using vulkan::Recorder;
using vulkan::Timings;
using vulkan::writes;

constexpr std::uint64_t add_size = 32;

class Recording : public OnDevice {
protected:
    const Kernel& add(std::uint32_t factor = 1) {
        return **context().kernels().get(vulkan::test_shaders::add, std::array{factor});
    }
    void dispatch_add(Recorder& recorder, const Buffer& words, std::uint32_t term, std::uint32_t factor = 1) {
        const auto count = static_cast<std::uint32_t>(words.size() / 4);
        recorder.dispatch(add(factor), AddPush{words.address(), count, term}, (count + add_size - 1) / add_size,
                          {writes(words)});
    }
};

TEST_F(Recording, RunsPassesInTheirOrder) {
    const Buffer first = take(4000), second = take(4000);
    Recorder recorder(context());
    recorder.fill(first, 0, 4000, 7);
    dispatch_add(recorder, first, 3);
    recorder.copy(first, 0, second, 0, 4000);
    dispatch_add(recorder, first, 100);
    dispatch_add(recorder, second, 1);
    dispatch_add(recorder, second, 2);
    recorder.copy(second, 0, first, 0, 2000);
    ASSERT_TRUE(recorder.run());
    std::vector<std::uint32_t> expected(1000, 110);
    std::fill_n(expected.begin(), 500, 13);
    EXPECT_EQ(download(first), expected);
    EXPECT_EQ(download(second), std::vector<std::uint32_t>(1000, 13));
}

TEST_F(Recording, RunsTheSameListAgain) {
    const Buffer words = upload(ramp(100));
    Recorder recorder(context());
    dispatch_add(recorder, words, 5);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(recorder.run());
    std::vector<std::uint32_t> expected = ramp(100);
    for (auto& word : expected) word += 15;
    EXPECT_EQ(download(words), expected);
    recorder.clear();
    EXPECT_EQ(recorder.passes(), 0u);
    EXPECT_TRUE(recorder.run()) << "nothing to run";
}

TEST_F(Recording, WritesParameters) {
    const Buffer words = upload(ramp(8));
    const std::vector<std::uint32_t> two = {70, 80};
    Recorder recorder(context());
    recorder.write(words, 8, std::as_bytes(std::span(two)));
    ASSERT_TRUE(recorder.run());
    EXPECT_EQ(download(words), (std::vector<std::uint32_t>{0, 1, 70, 80, 4, 5, 6, 7}));
}

TEST_F(Recording, TakesConstantsOfKernels) {
    const Buffer words = upload(ramp(10));
    Recorder recorder(context());
    dispatch_add(recorder, words, 1, 1000);
    dispatch_add(recorder, words, 1, 20);
    ASSERT_TRUE(recorder.run());
    std::vector<std::uint32_t> expected = ramp(10);
    for (auto& word : expected) word += 1020;
    EXPECT_EQ(download(words), expected);
    EXPECT_EQ(&add(20), &add(20)) << "a kernel is made once";
    EXPECT_NE(&add(20), &add(21));
}

TEST_F(Recording, FoldsManyWorkgroupsIntoShortAxes) {
    vulkan::Settings settings = watched();
    settings.groups_per_axis = 7;
    reopen(settings);
    for (const std::uint32_t count :
         {1u, 6 * 32u, 7 * 32u, 7 * 32u + 1, 49 * 32u, 49 * 32u + 1, 50 * 32u, 342 * 32u, 343 * 32u}) {
        const Buffer words = upload(ramp(count));
        Recorder recorder(context());
        dispatch_add(recorder, words, 1);
        ASSERT_TRUE(recorder.run()) << count;
        std::vector<std::uint32_t> expected = ramp(count);
        for (auto& word : expected) word += 1;
        EXPECT_EQ(download(words), expected) << count;
    }
    const Buffer words = upload(ramp(343 * 32 + 1));
    Recorder recorder(context());
    dispatch_add(recorder, words, 1);
    const auto ran = recorder.run();
    ASSERT_FALSE(ran);
    EXPECT_NE(ran.error().message.find("344 workgroups of 'add', but the device takes 7"), std::string::npos)
        << ran.error().message;
}

TEST_F(Recording, DispatchesAsManyGroupsAsThePassBeforeSaid) {
    const Buffer words = upload(std::vector<std::uint32_t>(1000, 0));
    const Buffer arguments = upload(std::vector<std::uint32_t>{9, 9, 9, 3, 2, 1});
    Recorder recorder(context());
    recorder.fill(arguments, 12, 4, 2); // 2 x 2 x 1 groups
    recorder.dispatch_indirect(add(), AddPush{words.address(), 1000, 4}, arguments, 12, {writes(words)});
    ASSERT_TRUE(recorder.run());
    std::vector<std::uint32_t> expected(1000, 0);
    std::fill_n(expected.begin(), 4 * add_size, 4);
    EXPECT_EQ(download(words), expected);
}

TEST_F(Recording, LeavesOutPassesWithoutWork) {
    const Buffer words = upload(ramp(4));
    Recorder recorder(context());
    recorder.dispatch(add(), AddPush{words.address(), 4, 1}, 0, {writes(words)});
    recorder.fill(words, 0, 0, 9);
    recorder.copy(words, 0, words, 8, 0);
    EXPECT_EQ(recorder.passes(), 0u);
}

TEST_F(Recording, TellsTheTimeOfEveryPass) {
    ASSERT_TRUE(context().info().timestamps);
    const Buffer words = upload(ramp(100000));
    Recorder recorder(context());
    recorder.fill(words, 0, 400, 1);
    dispatch_add(recorder, words, 1);
    recorder.label("another name");
    dispatch_add(recorder, words, 1);
    const vulkan::Timings timings = recorder.run().value();
    ASSERT_EQ(timings.passes.size(), 3u);
    EXPECT_EQ(timings.passes[0].pass, "fill");
    EXPECT_EQ(timings.passes[1].pass, "add");
    EXPECT_EQ(timings.passes[2].pass, "another name");
    double sum = 0;
    for (const auto& timing : timings.passes) {
        EXPECT_GE(timing.seconds, 0);
        sum += timing.seconds;
    }
    EXPECT_NEAR(sum, timings.device_seconds, 1e-9);
    EXPECT_GT(timings.device_seconds, 0);
    EXPECT_GE(timings.waited_seconds, timings.device_seconds);
}

TEST_F(Recording, SeesMoreMarksThanItHadRoomForAtFirst) {
    const Buffer words = upload(ramp(10));
    Recorder recorder(context());
    dispatch_add(recorder, words, 1);
    EXPECT_EQ(recorder.run().value().passes.size(), 1u);
    for (int i = 0; i < 199; ++i) dispatch_add(recorder, words, 1);
    EXPECT_EQ(recorder.run().value().passes.size(), 200u);
    EXPECT_EQ(download(words)[0], 201u);
}

TEST_F(Recording, RefusesWhatLiesOutsideOfBuffers) {
    const Buffer words = take(100), more = take(40);
    const std::vector<std::byte> bytes(100000);
    const auto message = [&](auto&& record) {
        Recorder recorder(context());
        record(recorder);
        const auto ran = recorder.run();
        return ran ? std::string() : ran.error().message;
    };
    EXPECT_NE(message([&](Recorder& r) { r.fill(words, 96, 8, 0); }), "");
    EXPECT_NE(message([&](Recorder& r) { r.fill(words, 2, 8, 0); }), "");
    EXPECT_NE(message([&](Recorder& r) { r.fill(words, ~std::uint64_t{3}, 8, 0); }), "");
    EXPECT_NE(message([&](Recorder& r) { r.copy(words, 0, more, 0, 44); }), "");
    EXPECT_NE(message([&](Recorder& r) { r.copy(more, 0, words, 64, 40); }), "");
    EXPECT_NE(message([&](Recorder& r) { r.write(words, 0, std::span(bytes).first(104)); }), "");
    EXPECT_NE(message([&](Recorder& r) { r.dispatch_indirect(add(), AddPush{}, words, 92, {}); }), "");
    EXPECT_EQ(message([&](Recorder& r) { r.fill(words, 96, 4, 0); }), "");
    const Buffer large = take(100000);
    EXPECT_NE(message([&](Recorder& r) { r.write(large, 0, bytes); }), "") << "more than a command takes";
}

} // namespace
} // namespace isotet::test
