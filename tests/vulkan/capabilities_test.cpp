// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which devices are refused, with what reason, and which of their memory is used for what.
#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "vulkan/devices/capabilities.hpp"

namespace isotet::test {
namespace {

using vulkan::Capabilities;

constexpr VkMemoryPropertyFlags own = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT,
                                coherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkDeviceSize gigabyte = 1'000'000'000;

struct Type {
    VkMemoryPropertyFlags flags;
    std::uint32_t heap;
};

void set_memory(Capabilities& device, const std::vector<VkDeviceSize>& heaps, const std::vector<Type>& types) {
    device.memory = {};
    device.memory.memoryHeapCount = static_cast<std::uint32_t>(heaps.size());
    for (std::size_t i = 0; i < heaps.size(); ++i) device.memory.memoryHeaps[i].size = device.heap_free[i] = heaps[i];
    device.memory.memoryTypeCount = static_cast<std::uint32_t>(types.size());
    for (std::size_t i = 0; i < types.size(); ++i) device.memory.memoryTypes[i] = {types[i].flags, types[i].heap};
}

/// An ordinary card with memory of its own, a window on it, and the machine's memory.
Capabilities card() {
    Capabilities device;
    device.properties.apiVersion = VK_API_VERSION_1_3;
    device.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    std::strcpy(device.properties.deviceName, "Card");
    auto& limits = device.properties.limits;
    limits.maxComputeWorkGroupInvocations = 1024;
    for (auto& count : limits.maxComputeWorkGroupCount) count = 65535;
    for (auto& size : limits.maxComputeWorkGroupSize) size = 1024;
    limits.maxComputeSharedMemorySize = 49152;
    limits.maxPushConstantsSize = 256;
    device.largest_allocation = 4 * gigabyte;
    device.buffer_addresses = device.scalar_layout = true;
    device.queues = {{VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 64},
                     {VK_QUEUE_TRANSFER_BIT, 64}};
    device.compute_family = 0;
    device.transfer_family = 1;
    set_memory(
        device, {24 * gigabyte, 64 * gigabyte, gigabyte / 4},
        {{0, 1}, {own, 0}, {visible | coherent, 1}, {visible | coherent | cached, 1}, {own | visible | coherent, 2}});
    return device;
}

TEST(Capabilities, OfAnOrdinaryCardAreEnough) {
    const DeviceInfo info = vulkan::describe(card(), 3);
    EXPECT_EQ(info.unusable, "");
    EXPECT_EQ(info.index, 3u);
    EXPECT_EQ(info.name, "Card");
    EXPECT_EQ(info.kind, DeviceKind::discrete);
    EXPECT_EQ(info.api, "1.3.0");
    EXPECT_EQ(info.memory, 24 * gigabyte);
    EXPECT_TRUE(info.transfer_queue);
    EXPECT_TRUE(info.timestamps);
    EXPECT_FALSE(info.unified_memory);
    EXPECT_EQ(info.shared_memory, 49152u);
}

TEST(Capabilities, ThatAreMissingAreNamed) {
    const auto why = [](const std::function<void(Capabilities&)>& alter) {
        Capabilities device = card();
        alter(device);
        return vulkan::why_unusable(device);
    };
    EXPECT_EQ(why([](auto& d) { d.properties.apiVersion = VK_MAKE_API_VERSION(0, 1, 0, 177); }),
              "it has Vulkan 1.0.177, but 1.1 is needed");
    EXPECT_EQ(why([](auto& d) { d.buffer_addresses = false; }), "it lacks the feature bufferDeviceAddress");
    EXPECT_EQ(why([](auto& d) { d.scalar_layout = false; }), "it lacks the feature scalarBlockLayout");
    EXPECT_EQ(why([](auto& d) { d.compute_family = Capabilities::none; }),
              "it cannot compute: no queue takes compute work");
    EXPECT_EQ(why([](auto& d) { d.properties.limits.maxComputeSharedMemorySize = 8192; }),
              "its shared memory in bytes is 8192, but 16384 is needed");
    EXPECT_EQ(why([](auto& d) { d.properties.limits.maxComputeWorkGroupInvocations = 64; }),
              "its largest workgroup is 64, but 128 is needed");
    EXPECT_EQ(why([](auto& d) { d.properties.limits.maxComputeWorkGroupSize[0] = 32; }),
              "its largest workgroup is 32, but 128 is needed");
    EXPECT_EQ(why([](auto& d) { d.properties.limits.maxPushConstantsSize = 64; }),
              "its room for push constants in bytes is 64, but 128 is needed");
    EXPECT_EQ(why([](auto& d) { set_memory(d, {gigabyte}, {{own, 0}}); }),
              "it has no memory that the processor can reach");
}

TEST(Capabilities, OfAnOldSoftwareDeviceAreNotTrusted) {
    Capabilities device = card();
    device.driver.driverID = VK_DRIVER_ID_MESA_LLVMPIPE;
    const auto with_driver = [&](const char* info) {
        std::strcpy(device.driver.driverInfo, info);
        return vulkan::why_unusable(device);
    };
    EXPECT_EQ(with_driver("Mesa 22.3.6 (LLVM 15.0.6)"), "it is the software device of Mesa 22.3.6 (LLVM 15.0.6), which "
                                                        "ends long loops early; Mesa 25 or later is needed");
    EXPECT_NE(with_driver("Mesa 24.99.0"), "");
    EXPECT_NE(with_driver("something else"), "");
    EXPECT_EQ(with_driver("Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)"), "");
    EXPECT_EQ(with_driver("Mesa 26.1.0"), "");
    device.driver.driverID = VK_DRIVER_ID_MESA_RADV;
    EXPECT_EQ(with_driver("Mesa 22.3.6"), "") << "only the software device";
}

TEST(Capabilities, OfACardGiveItsOwnMemoryToBuffers) {
    const Capabilities device = card();
    EXPECT_EQ(vulkan::device_memory_type(device), 1u) << "not the window";
    EXPECT_EQ(vulkan::upload_memory_type(device), 2u);
    EXPECT_EQ(vulkan::download_memory_type(device), 3u);
}

TEST(Capabilities, OfACardWhoseMemoryIsAllVisibleStillStage) {
    Capabilities device = card();
    set_memory(device, {24 * gigabyte, 64 * gigabyte},
               {{own, 0}, {visible | coherent, 1}, {own | visible | coherent, 0}, {visible | coherent | cached, 1}});
    EXPECT_EQ(vulkan::device_memory_type(device), 0u);
    EXPECT_EQ(vulkan::upload_memory_type(device), 1u);
    EXPECT_EQ(vulkan::download_memory_type(device), 3u);
    EXPECT_FALSE(vulkan::describe(device, 0).unified_memory);
}

TEST(Capabilities, OfAProcessorWithGraphicsMapTheMemoryOfBoth) {
    Capabilities device = card();
    device.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
    set_memory(device, {16 * gigabyte},
               {{own, 0}, {own | visible | coherent, 0}, {own | visible | coherent | cached, 0}});
    EXPECT_EQ(vulkan::device_memory_type(device), 2u) << "cached: read fast";
    EXPECT_EQ(vulkan::upload_memory_type(device), 1u) << "not cached: written fast";
    EXPECT_EQ(vulkan::download_memory_type(device), 2u);
    EXPECT_TRUE(vulkan::describe(device, 0).unified_memory);
}

/// As Mesa lists them for Intel's Xe2 cards: compressed memory first, which ordinary buffers may not use.
Capabilities card_with_compressed_memory() {
    Capabilities device = card();
    set_memory(device, {12 * gigabyte, 32 * gigabyte},
               {{own, 0}, {own, 0}, {visible | coherent | cached, 1}, {own | visible | coherent, 0}});
    return device;
}

TEST(Capabilities, OfMemoryTypesThatLookAlikeGiveOneThatIsAllowed) {
    const Capabilities device = card_with_compressed_memory();
    constexpr vulkan::MemoryTypes all_but_compressed = 0b1110;
    EXPECT_EQ(vulkan::device_memory_type(device, all_but_compressed), 1u);
    EXPECT_EQ(vulkan::upload_memory_type(device, all_but_compressed), 2u);
    EXPECT_EQ(vulkan::download_memory_type(device, all_but_compressed), 2u);
}

TEST(Capabilities, NeverGiveAMemoryTypeThatIsNotAllowed) {
    const Capabilities device = card_with_compressed_memory();
    for (vulkan::MemoryTypes allowed = 0; allowed < 16; ++allowed)
        for (const std::uint32_t type :
             {vulkan::device_memory_type(device, allowed), vulkan::upload_memory_type(device, allowed),
              vulkan::download_memory_type(device, allowed)}) {
            EXPECT_TRUE(type == Capabilities::none || allowed >> type & 1) << allowed << " gave " << type;
        }
    EXPECT_EQ(vulkan::device_memory_type(device, 0), Capabilities::none);
    EXPECT_EQ(vulkan::upload_memory_type(device, 0b0011), Capabilities::none);
}

TEST(Capabilities, LeaveAloneMemoryThatOnlyLooksUseful) {
    Capabilities device = card();
    set_memory(device, {24 * gigabyte, 64 * gigabyte},
               {{own | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT, 0},
                {own | VK_MEMORY_PROPERTY_PROTECTED_BIT, 0},
                {own | VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD, 0},
                {own, 0},
                {visible | coherent, 1}});
    EXPECT_EQ(vulkan::device_memory_type(device), 3u);
}

} // namespace
} // namespace isotet::test
