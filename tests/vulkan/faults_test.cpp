// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whatever fails, and whenever: an error that says what, nothing lost, nothing left over, and the next device works.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <string_view>
#include <thread>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "test_shaders.hpp"
#include "vulkan/add_push.hpp"
#include "vulkan/devices/found_devices.hpp"
#include "vulkan/failing_calls.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using namespace std::chrono_literals;
using vulkan::Buffer;
using vulkan::Context;
using vulkan::Settings;

/// Push constants of spin.comp.
struct SpinPush {
    VkDeviceAddress words;
    std::uint32_t rounds, unused;
};

/// Opens a device, uses every part of it once, and closes it. The words that came out, or the first error.
Result<std::vector<std::uint32_t>> work_through(const Settings& settings) {
    auto opened = Context::open({test_device(), 0}, settings);
    if (!opened) return opened.error();
    Context& context = **opened;
    auto one = context.memory().take(4000, vulkan::Where::device, "one");
    if (!one) return one.error();
    auto two = context.memory().take(4000, vulkan::Where::device, "two");
    if (!two) return two.error();
    std::vector<std::uint32_t> words = ramp(1000);
    if (auto up = context.staging().upload(*one, 0, std::as_bytes(std::span(words))); !up) return up.error();
    const auto kernel = context.kernels().get(vulkan::test_shaders::add, std::array{2u});
    if (!kernel) return kernel.error();
    vulkan::Recorder recorder(context);
    recorder.dispatch(**kernel, AddPush{one->address(), 1000, 3}, 32, {vulkan::writes(*one)});
    recorder.copy(*one, 0, *two, 0, 4000);
    for (int i = 0; i < 2; ++i)
        if (auto ran = recorder.run(); !ran) return ran.error();
    if (auto down = context.staging().download(*two, 0, std::as_writable_bytes(std::span(words))); !down)
        return down.error();
    return words;
}

std::vector<std::uint32_t> right_words() {
    std::vector<std::uint32_t> words = ramp(1000);
    for (auto& word : words) word += 12;
    return words;
}

/// With forced staging and short chunks, so that every way of copying is taken, and a folder for compiled pipelines.
Settings thorough(CallPlan& plan) {
    Settings settings = watched();
    settings.force_staging = true;
    settings.staging_bytes = 1024;
    settings.alter_functions = [&plan](vulkan::DeviceFunctions& functions) { make_calls_follow(plan, functions); };
    return settings;
}

void expect_no_complaints(const Settings& settings, const std::string& when) {
    for (const std::string& complaint : settings.watch.complaints->all()) ADD_FAILURE() << when << ": " << complaint;
}

class FailingCall : public testing::TestWithParam<VkResult> {};

TEST_P(FailingCall, OfAnyNumberIsAnErrorAndLeavesNothingBehind) {
    CallPlan all;
    const Settings settings = thorough(all);
    const auto right = work_through(settings);
    ASSERT_TRUE(right) << right.error().message;
    ASSERT_EQ(*right, right_words());
    ASSERT_GT(all.calls.size(), 60u);

    // Every function at its first, second and last call: later calls of a function take the same way as the second.
    for (std::size_t i = 0; i < all.calls.size(); ++i) {
        const std::string& name = all.calls[i];
        const auto before = std::count(all.calls.begin(), all.calls.begin() + static_cast<std::ptrdiff_t>(i), name);
        const auto total = std::count(all.calls.begin(), all.calls.end(), name);
        if (before > 1 && before + 1 < total) continue;
        const std::string when = name + ", call " + std::to_string(before + 1) + " of " + std::to_string(total);
        CallPlan plan;
        plan.fail_at = static_cast<int>(i) + 1;
        plan.with = GetParam();
        const Settings failing = thorough(plan);
        const auto result = work_through(failing);
        if (result) {
            EXPECT_EQ(*result, right_words()) << when;
            const bool spared = name.find("PipelineCache") != std::string::npos;
            const bool replaced =
                GetParam() == VK_ERROR_OUT_OF_DEVICE_MEMORY && (name == "vkAllocateMemory" || name == "vkMapMemory");
            EXPECT_TRUE(spared || replaced)
                << when << ": only the cache is done without, only large blocks become smaller ones";
        } else {
            const bool memory = GetParam() == VK_ERROR_OUT_OF_DEVICE_MEMORY && name != "vkWaitForFences";
            EXPECT_EQ(result.error().code, memory ? ErrorCode::out_of_memory : ErrorCode::device_failed) << when;
            EXPECT_GT(result.error().message.size(), 20u) << when;
        }
        expect_no_complaints(failing, when);
    }
}

INSTANTIATE_TEST_SUITE_P(Results, FailingCall, testing::Values(VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST),
                         [](const auto& result) {
                             return result.param == VK_ERROR_DEVICE_LOST ? "DeviceLost" : "OutOfMemory";
                         });

class Faults : public OnDevice {
protected:
    void SetUp() override {}
    CallPlan plan;
};

TEST_F(Faults, ALostDeviceSaysSoFromThenOn) {
    Settings settings = thorough(plan);
    reopen(settings);
    {
        const Buffer words = upload(ramp(100));
        plan.only = "vkQueueSubmit";
        plan.calls.clear();
        plan.fail_at = 1;
        plan.with = VK_ERROR_DEVICE_LOST;
        vulkan::Recorder recorder(context());
        recorder.fill(words, 0, 4, 1);
        const auto lost = recorder.run();
        ASSERT_FALSE(lost);
        EXPECT_EQ(lost.error().code, ErrorCode::device_failed);
        EXPECT_NE(lost.error().message.find("was lost before running 'fill'"), std::string::npos)
            << lost.error().message;
        std::vector<std::byte> bytes(4);
        const std::vector<std::string> later = {
            recorder.run().error().message,
            context().staging().upload(words, 0, bytes).error().message,
            context().staging().download(words, 0, bytes).error().message,
            context().memory().take(10, vulkan::Where::device, "more").error().message,
            context().kernels().get(vulkan::test_shaders::spin).error().message,
        };
        for (const std::string& message : later) EXPECT_EQ(message, lost.error().message);
    }
}

TEST_F(Faults, AFailedAllocationSaysWhatWasWanted) {
    reopen(thorough(plan));
    plan.only = "vkAllocateMemory";
    plan.calls.clear();
    plan.fail_at = 1;
    const auto refused = context().memory().take(100'000'000, vulkan::Where::device, "vertices");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    EXPECT_NE(refused.error().message.find("the device buffer 'vertices' of 100.0 MB: allocating 100.0 MB"),
              std::string::npos)
        << refused.error().message;
    EXPECT_TRUE(context().memory().take(100'000'000, vulkan::Where::device, "vertices")) << "the next call works";
}

TEST_F(Faults, ABlockThatCannotBeHadIsReplacedByASmallerOne) {
    reopen(thorough(plan));
    plan.only = "vkAllocateMemory";
    plan.calls.clear();
    plan.fail_at = 1;
    // The blocks that there are have no room for it, and it is too small for a block of its own.
    std::vector<Buffer> buffers;
    while (plan.calls.empty()) buffers.push_back(take(20'000'000));
    EXPECT_EQ(plan.calls.size(), 2u) << "a whole block first, then one of the buffer's size";
    EXPECT_TRUE(buffers.back());
}

TEST_F(Faults, AKernelThatCannotBeBuiltIsNamed) {
    reopen(thorough(plan));
    std::uint32_t factor = 1;
    for (const char* function : {"vkCreateShaderModule", "vkCreateComputePipelines"}) {
        plan = {.fail_at = 1, .with = VK_ERROR_INITIALIZATION_FAILED, .only = function, .calls = {}};
        const std::array constants = {++factor};
        const auto refused = context().kernels().get(vulkan::test_shaders::add, constants);
        ASSERT_FALSE(refused) << function;
        EXPECT_EQ(refused.error().message, "building the kernel 'add' failed: VK_ERROR_INITIALIZATION_FAILED (-3)");
        EXPECT_TRUE(context().kernels().get(vulkan::test_shaders::add, constants)) << "the next attempt works";
    }
}

class VersionsOfVulkan : public OnDevice {};

TEST_F(VersionsOfVulkan, BringTheirExtensionsAlong) {
    const auto has = [&](std::string_view name) {
        const std::vector<const char*>& used = context().capabilities().extensions;
        return std::ranges::count(used, name, [](const char* one) { return std::string_view(one); });
    };
    Settings settings = watched();
    for (const std::uint32_t version : {VK_API_VERSION_1_1, VK_API_VERSION_1_2}) {
        settings.vulkan_version = version;
        reopen(settings);
        const std::ptrdiff_t expected = version == VK_API_VERSION_1_1; // they are part of 1.2
        EXPECT_EQ(has(VK_KHR_BUFFER_DEVICE_ADDRESS_EXTENSION_NAME), expected);
        EXPECT_EQ(has(VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME), expected);
        EXPECT_EQ(has(VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME), expected);
    }
}

TEST_F(VersionsOfVulkan, GiveTheSameDescription) {
    const auto described = [](std::uint32_t version) {
        const vulkan::FoundDevices found = vulkan::find_devices({}, version, {}).value();
        const auto software = std::ranges::find(found.infos, DeviceKind::software, &DeviceInfo::kind);
        const vulkan::Capabilities& can = found.capabilities[software->index];
        return std::tuple(software->unusable, software->driver, software->allocation_limit, software->subgroup_size,
                          software->memory, can.floats.shaderRoundingModeRTEFloat32, can.driver.driverID);
    };
    EXPECT_EQ(described(VK_API_VERSION_1_1), described(VK_API_VERSION_1_2));
    EXPECT_EQ(std::get<0>(described(VK_API_VERSION_1_1)), "");
}

TEST(FaultsOfDevices, AMissingFeatureIsNamed) {
    Settings settings = watched();
    settings.alter_capabilities = [](vulkan::Capabilities& device) { device.scalar_layout = false; };
    const auto refused = Context::open({test_device(), 0}, settings);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::no_device);
    EXPECT_NE(refused.error().message.find("cannot be used: it lacks the feature scalarBlockLayout"), std::string::npos)
        << refused.error().message;
}

/// Lets a test ask whether the work of a device that was given up has ended.
struct GivenUp {
    VkDevice device = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    PFN_vkWaitForFences wait = nullptr;
    PFN_vkGetFenceStatus status = nullptr;
};
GivenUp given_up;

VKAPI_ATTR VkResult VKAPI_CALL remember_wait(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                             std::uint64_t limit) {
    given_up.device = device;
    given_up.fence = fences[0];
    return given_up.wait(device, count, fences, all, limit);
}

Settings that_remember_waits() {
    Settings settings = watched();
    settings.alter_functions = [](vulkan::DeviceFunctions& functions) {
        given_up.wait = functions.vkWaitForFences;
        given_up.status = functions.vkGetFenceStatus;
        functions.vkWaitForFences = &remember_wait;
    };
    return settings;
}

/// Runs work that takes seconds, and waits for it only for a moment.
std::string give_up(Context& context, const Buffer& words) {
    const vulkan::Kernel& kernel = **context.kernels().get(vulkan::test_shaders::spin);
    vulkan::Recorder recorder(context);
    recorder.dispatch(kernel, SpinPush{words.address(), 1'000'000'000, 0}, 1, {vulkan::writes(words)});
    const auto ran = recorder.run(20ms);
    // The recorder goes while its work is still under way: it must leave it alone.
    return ran ? "" : ran.error().message;
}

void wait_for_the_end() {
    while (given_up.status(given_up.device, given_up.fence) == VK_NOT_READY) std::this_thread::sleep_for(10ms);
}

TEST(FaultsOfDevices, AHangIsGivenUpAfterTheLimit) {
    const Settings settings = that_remember_waits();
    auto context = open_software(settings);
    {
        const Buffer words = context->memory().take(32, vulkan::Where::device, "words").value();
        const std::string message = give_up(*context, words);
        EXPECT_NE(message.find("did not answer within 0.02 s while running 'spin'"), std::string::npos) << message;
        EXPECT_EQ(context->device().alive().error().message, message);
        EXPECT_EQ(context->memory().take(4, vulkan::Where::device, "more").error().message, message);
    }
    context.reset(); // the work goes on: nothing of it may be destroyed
    wait_for_the_end();
    expect_no_complaints(settings, "after a hang");
}

} // namespace
} // namespace isotet::test
