// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces where a program that draws wants them: on its own device, or in memory that another instance imports.
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <isotet/device.hpp>
#include <isotet/extract.hpp>

#include "gpu_engine/engines.hpp"
#include "support/small_grid.hpp"
#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/instance.hpp"

namespace isotet::test {
namespace {

/// A program that opens the first device by itself.
class CallersDevice {
public:
    explicit CallersDevice(std::vector<const char*> extensions = {}) {
        physical = instance->devices().value().front();
        const float priority = 1;
        VkDeviceQueueCreateInfo queues{};
        queues.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queues.queueCount = 1;
        queues.pQueuePriorities = &priority;
        VkPhysicalDeviceVulkan12Features features{};
        features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
        features.bufferDeviceAddress = features.scalarBlockLayout = VK_TRUE;
        VkDeviceCreateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
        create.pNext = &features;
        create.queueCreateInfoCount = 1;
        create.pQueueCreateInfos = &queues;
        create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
        create.ppEnabledExtensionNames = extensions.data();
        EXPECT_EQ(instance->call().vkCreateDevice(physical, &create, nullptr, &device), VK_SUCCESS);
        function<PFN_vkGetDeviceQueue>("vkGetDeviceQueue")(device, 0, 0, &queue);
    }

    ~CallersDevice() {
        function<PFN_vkDestroyDevice>("vkDestroyDevice")(device, nullptr);
        instance.reset();
        for (const std::string& complaint : watch.complaints->all()) ADD_FAILURE() << complaint;
    }

    template <class Function>
    Function function(const char* name) const {
        return reinterpret_cast<Function>(instance->call().vkGetDeviceProcAddr(device, name));
    }

    VulkanHandles handles() const {
        return {.instance = instance->handle(), .physical_device = physical, .device = device, .queue = queue};
    }

    VkBuffer buffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const {
        VkBufferCreateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        create.size = bytes;
        create.usage = usage;
        VkExternalMemoryBufferCreateInfo shared{};
        shared.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO;
        shared.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        if (usage == VK_BUFFER_USAGE_TRANSFER_SRC_BIT) create.pNext = &shared;
        VkBuffer made = VK_NULL_HANDLE;
        EXPECT_EQ(function<PFN_vkCreateBuffer>("vkCreateBuffer")(device, &create, nullptr, &made), VK_SUCCESS);
        return made;
    }

    /// A part of a buffer, by way of one that the processor reads.
    std::vector<std::byte> copied(VkBuffer from, VkBufferCopy part) const {
        const VkBuffer to = buffer(part.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        VkMemoryRequirements needs;
        function<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(device, to, &needs);
        VkMemoryAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        allocate.allocationSize = needs.size;
        const vulkan::Capabilities capabilities = vulkan::ask(instance->call(), physical, vulkan::whole_version);
        allocate.memoryTypeIndex = vulkan::download_memory_type(capabilities, needs.memoryTypeBits);
        VkDeviceMemory memory = VK_NULL_HANDLE;
        EXPECT_EQ(function<PFN_vkAllocateMemory>("vkAllocateMemory")(device, &allocate, nullptr, &memory), VK_SUCCESS);
        EXPECT_EQ(function<PFN_vkBindBufferMemory>("vkBindBufferMemory")(device, to, memory, 0), VK_SUCCESS);
        VkCommandPoolCreateInfo pools{};
        pools.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        VkCommandPool pool = VK_NULL_HANDLE;
        EXPECT_EQ(function<PFN_vkCreateCommandPool>("vkCreateCommandPool")(device, &pools, nullptr, &pool), VK_SUCCESS);
        VkCommandBufferAllocateInfo take{};
        take.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        take.commandPool = pool;
        take.commandBufferCount = 1;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        EXPECT_EQ(function<PFN_vkAllocateCommandBuffers>("vkAllocateCommandBuffers")(device, &take, &commands),
                  VK_SUCCESS);
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        function<PFN_vkBeginCommandBuffer>("vkBeginCommandBuffer")(commands, &begin);
        function<PFN_vkCmdCopyBuffer>("vkCmdCopyBuffer")(commands, from, to, 1, &part);
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
        function<PFN_vkCmdPipelineBarrier>("vkCmdPipelineBarrier")(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                                                   VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                                                                   nullptr, 0, nullptr);
        function<PFN_vkEndCommandBuffer>("vkEndCommandBuffer")(commands);
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands;
        EXPECT_EQ(function<PFN_vkQueueSubmit>("vkQueueSubmit")(queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
        EXPECT_EQ(function<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle")(device), VK_SUCCESS);
        void* mapped = nullptr;
        EXPECT_EQ(function<PFN_vkMapMemory>("vkMapMemory")(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
        std::vector<std::byte> bytes(part.size);
        if (mapped) std::memcpy(bytes.data(), mapped, bytes.size());
        function<PFN_vkDestroyCommandPool>("vkDestroyCommandPool")(device, pool, nullptr);
        function<PFN_vkDestroyBuffer>("vkDestroyBuffer")(device, to, nullptr);
        function<PFN_vkFreeMemory>("vkFreeMemory")(device, memory, nullptr);
        return bytes;
    }

private:
    vulkan::Watch watch = watched().watch;
    std::unique_ptr<vulkan::Instance> instance = vulkan::Instance::open(watch, vulkan::whole_version).value();

public:
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
};

PackedGrid packed_grid() {
    const Grid grid = made_grid("perturbed", 9, {"gyroid"});
    PackOptions options;
    options.gradients = true;
    return pack(grid, point_field(grid, 0), options).value();
}

/// Memory that another program exported, as bytes.
std::vector<std::byte> imported(const CallersDevice& program, const DeviceArray& array) {
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkImportMemoryFdInfoKHR import{};
    import.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR;
    import.pNext = &flags;
    import.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    import.fd = array.memory;
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.pNext = &import;
    allocate.allocationSize = array.memory_bytes;
    allocate.memoryTypeIndex = array.memory_type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    EXPECT_EQ(program.function<PFN_vkAllocateMemory>("vkAllocateMemory")(program.device, &allocate, nullptr, &memory),
              VK_SUCCESS);
    const VkBuffer shared = program.buffer(array.offset + array.bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    EXPECT_EQ(program.function<PFN_vkBindBufferMemory>("vkBindBufferMemory")(program.device, shared, memory, 0),
              VK_SUCCESS);
    std::vector<std::byte> bytes = program.copied(shared, {array.offset, 0, array.bytes});
    program.function<PFN_vkDestroyBuffer>("vkDestroyBuffer")(program.device, shared, nullptr);
    program.function<PFN_vkFreeMemory>("vkFreeMemory")(program.device, memory, nullptr);
    return bytes;
}

std::vector<std::byte> bytes_in(const Array& array) {
    const auto* from = static_cast<const std::byte*>(array.data());
    return {from, from + array.bytes()};
}

TEST(AdoptedDevice, GivesTheBytesOfTheCpuInBuffersOfItsOwner) {
    const CallersDevice program;
    const Device device = Device::adopt(program.handles()).value();
    const PackedGrid packed = packed_grid();
    DeviceGrid grid = DeviceGrid::upload(device, packed).value();
    ExtractOptions options;
    options.normals = Normals::gradient;
    const DeviceSurface surface = grid.extract(0.1, options).value();
    const Surface expected = extract(packed, 0.1, options).value().surface;
    EXPECT_TRUE(bytes_of(grid.download(surface).value().surface) == bytes_of(expected));

    const DeviceArrays arrays = surface.arrays();
    EXPECT_EQ(arrays.positions.bytes, expected.positions.bytes());
    EXPECT_EQ(arrays.triangles.bytes, expected.triangles.bytes());
    EXPECT_EQ(arrays.normals.bytes, expected.normals.bytes());
    for (const DeviceArray* array : {&arrays.positions, &arrays.triangles, &arrays.normals}) {
        EXPECT_EQ(array->memory, -1);
        VkBufferDeviceAddressInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
        info.buffer = (VkBuffer)array->buffer; // NOLINT
        EXPECT_EQ(program.function<PFN_vkGetBufferDeviceAddress>("vkGetBufferDeviceAddress")(program.device, &info),
                  array->address);
    }
    EXPECT_EQ(DeviceSurface().arrays().positions.bytes, 0u);
}

TEST(AdoptedDevice, IsRefusedWithWhatIsMissing) {
    const CallersDevice program;
    for (void* VulkanHandles::* member :
         {&VulkanHandles::instance, &VulkanHandles::physical_device, &VulkanHandles::device, &VulkanHandles::queue}) {
        VulkanHandles handles = program.handles();
        handles.*member = nullptr;
        EXPECT_EQ(Device::adopt(handles).error().code, ErrorCode::invalid_argument);
    }
    VulkanHandles handles = program.handles();
    handles.queue_family = 99;
    EXPECT_EQ(Device::adopt(handles).error().message.substr(0, 19), "the queue family 99");
    EXPECT_EQ(Device::adopt(program.handles(), {.choice = "software"}).error().code, ErrorCode::invalid_argument);
    const Error error = Device::adopt(program.handles(), {.choice = "", .share_memory = true}).error();
    EXPECT_EQ(error.code, ErrorCode::no_device);
    EXPECT_NE(error.message.find("VK_KHR_external_memory_fd"), std::string::npos) << error.message;
}

TEST(SharedSurface, IsReadByAnotherInstance) {
    const PackedGrid packed = packed_grid();
    const Device device = Device::open({.choice = test_device(), .share_memory = true}).value();
    DeviceGrid grid = DeviceGrid::upload(device, packed).value();
    const CallersDevice other({VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME});
    for (const Normals normals : {Normals::none, Normals::gradient, Normals::face}) {
        ExtractOptions options;
        options.normals = normals;
        const DeviceSurface surface = grid.extract(0.1, options).value();
        const Surface expected = extract(packed, 0.1, options).value().surface;
        const DeviceArrays arrays = surface.share().value();
        EXPECT_TRUE(imported(other, arrays.positions) == bytes_in(grid.download(surface).value().surface.positions));
        EXPECT_TRUE(imported(other, arrays.triangles) == bytes_in(expected.triangles));
        if (normals == Normals::none) {
            EXPECT_EQ(arrays.normals.bytes, 0u);
        } else {
            EXPECT_TRUE(imported(other, arrays.normals) == bytes_in(expected.normals));
        }
    }
}

TEST(SharedSurface, LeavesNoDescriptor) {
    const auto descriptors = [] {
        int count = 0;
        for (int i = 0; i < 1024; ++i) count += fcntl(i, F_GETFD) != -1;
        return count;
    };
    const Device device = Device::open({.choice = test_device(), .share_memory = true}).value();
    DeviceGrid grid = DeviceGrid::upload(device, packed_grid()).value();
    const DeviceSurface surface = grid.extract(0.1).value();
    const int before = descriptors();
    for (int i = 0; i < 3; ++i) {
        const DeviceArrays arrays = surface.share().value();
        close(arrays.positions.memory);
        close(arrays.triangles.memory);
    }
    EXPECT_EQ(descriptors(), before);
}

TEST(SharedSurface, TakesADeviceThatWasOpenedForIt) {
    const Device device = Device::open({.choice = test_device()}).value();
    DeviceGrid grid = DeviceGrid::upload(device, packed_grid()).value();
    EXPECT_EQ(grid.extract(0.1).value().share().error().message, "the device was not opened with `share_memory`");
    EXPECT_EQ(DeviceSurface().share().error().message, "the surface to share was never extracted");
}

} // namespace
} // namespace isotet::test
