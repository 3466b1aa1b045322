// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The watch itself: it sees broken rules, and with assistance on the device kernels that leave their buffers.
#include <array>

#include <gtest/gtest.h>

#include "test_shaders.hpp"
#include "vulkan/add_push.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;
using vulkan::Context;
using vulkan::Settings;

Settings assisted() {
    Settings settings = watched();
    settings.watch.validation = vulkan::Validation::gpu_assisted;
    return settings;
}

/// Adds to the words of a buffer of 100, and to what lies behind if there are more.
std::vector<std::string> complaints_about_adding_to(std::uint32_t count) {
    const Settings settings = assisted();
    {
        const auto context = open_software(settings);
        const Buffer words = context->memory().take(400, vulkan::Where::device, "words").value();
        const auto& kernel = **context->kernels().get(vulkan::test_shaders::add, std::array{1u});
        vulkan::Recorder recorder(*context);
        recorder.dispatch(kernel, AddPush{words.address(), count, 1}, (count + 31) / 32, {vulkan::writes(words)});
        recorder.run().value();
    }
    return settings.watch.complaints->all();
}

TEST(Validation, SeesAKernelThatLeavesItsBuffer) {
    // Word 100 may still be touched: Memory::take leaves four bytes behind each buffer.
    const std::vector<std::string> complaints = complaints_about_adding_to(102);
    ASSERT_FALSE(complaints.empty());
    EXPECT_NE(complaints[0].find("Device address out of bounds"), std::string::npos) << complaints[0];
}

TEST(Validation, HasNothingToSayOfAKernelThatStaysInIt) {
    EXPECT_EQ(complaints_about_adding_to(100), std::vector<std::string>());
}

TEST(Validation, SeesWhatIsNotGivenBack) {
    const Settings settings = watched();
    {
        const auto context = open_software(settings);
        VkFenceCreateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        VkFence fence = VK_NULL_HANDLE;
        ASSERT_EQ(context->device().call().vkCreateFence(context->device().handle(), &create, nullptr, &fence),
                  VK_SUCCESS);
    }
    EXPECT_FALSE(settings.watch.complaints->all().empty());
}

} // namespace
} // namespace isotet::test
