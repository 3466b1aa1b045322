// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drivers that allow buffers and images in some of their memory types alone.
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/software_device.hpp"
#include "vulkan/target.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;
using vulkan::Context;
using vulkan::MemoryTypes;
using vulkan::Where;

/// The software device with its memory type listed three times; what each request may use, the test says.
struct OddDriver {
    MemoryTypes buffers = 0, images = 0;
    std::vector<std::uint32_t> allocated; ///< memory types, in the order of the calls
    vulkan::DeviceFunctions real;
};
OddDriver* driver = nullptr;

VKAPI_ATTR void VKAPI_CALL buffer_requirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* needs) {
    driver->real.vkGetBufferMemoryRequirements(device, buffer, needs);
    needs->memoryTypeBits = driver->buffers;
}

VKAPI_ATTR void VKAPI_CALL image_requirements(VkDevice device, VkImage image, VkMemoryRequirements* needs) {
    driver->real.vkGetImageMemoryRequirements(device, image, needs);
    needs->memoryTypeBits = driver->images;
}

VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                                        const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
    driver->allocated.push_back(info->memoryTypeIndex);
    VkMemoryAllocateInfo real = *info;
    real.memoryTypeIndex = 0;
    return driver->real.vkAllocateMemory(device, &real, callbacks, memory);
}

class MemoryTypesOfADriver : public OnDevice {
protected:
    void SetUp() override { driver = &odd_; }
    void TearDown() override {
        OnDevice::TearDown();
        driver = nullptr;
    }

    vulkan::Settings odd() {
        vulkan::Settings settings = watched();
        settings.alter_capabilities = [](vulkan::Capabilities& device) {
            auto& memory = device.memory;
            memory.memoryTypeCount = 3;
            memory.memoryTypes[1] = memory.memoryTypes[2] = memory.memoryTypes[0];
        };
        settings.alter_functions = [this](vulkan::DeviceFunctions& functions) {
            odd_.real = functions;
            functions.vkGetBufferMemoryRequirements = &buffer_requirements;
            functions.vkGetImageMemoryRequirements = &image_requirements;
            functions.vkAllocateMemory = &allocate;
        };
        return settings;
    }

    OddDriver odd_;
};

TEST_F(MemoryTypesOfADriver, AreUsedOnlyWhereTheyAreAllowed) {
    odd_.buffers = 0b010;
    odd_.images = 0b100;
    reopen(odd());
    {
        const Buffer words = upload(ramp(1000));
        const Buffer up = take(100, Where::upload), down = take(100, Where::download);
        EXPECT_EQ(download(words), ramp(1000));
    }
    EXPECT_FALSE(odd_.allocated.empty());
    for (const std::uint32_t type : odd_.allocated) EXPECT_EQ(type, 1u);

    odd_.allocated.clear();
    const auto pass = vulkan::RenderPass::make(context());
    ASSERT_TRUE(pass) << pass.error().message;
    const auto target = vulkan::Target::make(context(), **pass, 64, 64);
    ASSERT_TRUE(target) << target.error().message;
    EXPECT_EQ(odd_.allocated, (std::vector<std::uint32_t>{2, 2}));
}

TEST_F(MemoryTypesOfADriver, NoneOfWhichBuffersMayHaveAreAnError) {
    odd_.images = 0b111;
    const auto refused = Context::open({test_device(), 0}, odd());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::no_device);
    EXPECT_NE(refused.error().message.find("the driver allows buffers in the memory types 0b0 alone"),
              std::string::npos)
        << refused.error().message;
}

TEST_F(MemoryTypesOfADriver, NoneOfWhichImagesMayHaveAreAnError) {
    odd_.buffers = 0b111;
    reopen(odd());
    const auto pass = vulkan::RenderPass::make(context());
    ASSERT_TRUE(pass) << pass.error().message;
    const auto refused = vulkan::Target::make(context(), **pass, 64, 64);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::no_device);
    EXPECT_NE(refused.error().message.find("the driver allows images in the memory types 0b0 alone"), std::string::npos)
        << refused.error().message;
}

} // namespace
} // namespace isotet::test
