// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/logical_device.hpp"

#include <array>
#include <vector>

#include <fmt/core.h>

#include "vulkan/devices/failure.hpp"

namespace isotet::vulkan {

LogicalDevice::LogicalDevice(const Instance& instance, VkPhysicalDevice physical, const Capabilities& capabilities)
    : instance_(instance),
      physical_(physical),
      capabilities_(capabilities),
      device_name_(capabilities.properties.deviceName) {
    compute_.family = capabilities.compute_family;
    transfer_.family = capabilities.transfer_family;
}

Result<std::unique_ptr<LogicalDevice>> LogicalDevice::open(const Instance& instance, VkPhysicalDevice physical,
                                                           const Capabilities& capabilities,
                                                           const std::function<void(DeviceFunctions&)>& alter) {
    std::unique_ptr<LogicalDevice> device(new LogicalDevice(instance, physical, capabilities));
    const float priority = 1;
    std::array<VkDeviceQueueCreateInfo, 2> queues{};
    for (VkDeviceQueueCreateInfo& queue : queues) {
        queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
    }
    queues[0].queueFamilyIndex = capabilities.compute_family;
    queues[1].queueFamilyIndex = capabilities.transfer_family;

    VkPhysicalDeviceBufferDeviceAddressFeatures addresses{};
    addresses.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
    addresses.bufferDeviceAddress = VK_TRUE;
    VkPhysicalDeviceScalarBlockLayoutFeatures layout{};
    layout.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
    layout.pNext = &addresses;
    layout.scalarBlockLayout = VK_TRUE;

    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    mesh.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT;
    mesh.meshShader = VK_TRUE;
    if (capabilities.mesh_shaders) addresses.pNext = &mesh;

    VkPhysicalDeviceFeatures features{}; // of these none is needed, but for drawing, and for rays through volumes
    features.fragmentStoresAndAtomics = capabilities.features.fragmentStoresAndAtomics;
    features.shaderFloat64 = capabilities.features.shaderFloat64;

    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &layout;
    create.queueCreateInfoCount = device->has_transfer_queue() ? 2 : 1;
    create.pQueueCreateInfos = queues.data();
    create.enabledExtensionCount = static_cast<std::uint32_t>(capabilities.extensions.size());
    create.ppEnabledExtensionNames = capabilities.extensions.data();
    create.pEnabledFeatures = &features;
    const InstanceFunctions& ask = instance.call();
    if (const VkResult made = ask.vkCreateDevice(physical, &create, nullptr, &device->handle_); made != VK_SUCCESS) {
        device->handle_ = VK_NULL_HANDLE;
        return failure(fmt::format("opening the device {}", device->device_name_), made);
    }

    if (Result<void> loaded = device->load_functions(); !loaded) return loaded.error();
    DeviceFunctions& call = device->call_;
    call.vkGetDeviceQueue(device->handle_, device->compute_.family, 0, &device->compute_.handle);
    call.vkGetDeviceQueue(device->handle_, device->transfer_.family, 0, &device->transfer_.handle);
    device->name(VK_OBJECT_TYPE_QUEUE, device->compute_.handle, "compute");
    if (device->has_transfer_queue()) device->name(VK_OBJECT_TYPE_QUEUE, device->transfer_.handle, "transfer");
    if (alter) alter(call);
    return device;
}

Result<std::unique_ptr<LogicalDevice>> LogicalDevice::adopt(const Instance& instance, const VulkanHandles& handles,
                                                            const Capabilities& capabilities) {
    std::unique_ptr<LogicalDevice> device(
        new LogicalDevice(instance, static_cast<VkPhysicalDevice>(handles.physical_device), capabilities));
    device->owned_ = false;
    device->handle_ = static_cast<VkDevice>(handles.device);
    device->compute_.handle = device->transfer_.handle = static_cast<VkQueue>(handles.queue);
    if (Result<void> loaded = device->load_functions(); !loaded) return loaded.error();
    return device;
}

Result<void> LogicalDevice::load_functions() {
    const InstanceFunctions& ask = instance_.call();
    DeviceFunctions& call = call_;
    const Capabilities& capabilities = capabilities_;
#define ISOTET_LOAD(name) call.name = reinterpret_cast<PFN_##name>(ask.vkGetDeviceProcAddr(handle_, #name));
    ISOTET_VULKAN_DEVICE_FUNCTIONS(ISOTET_LOAD)
    if (!call.vkGetBufferDeviceAddress) // in Vulkan 1.1 it has the extension's name
        call.vkGetBufferDeviceAddress = reinterpret_cast<PFN_vkGetBufferDeviceAddress>(
            ask.vkGetDeviceProcAddr(handle_, "vkGetBufferDeviceAddressKHR"));
    if (capabilities.mesh_shaders) {
        ISOTET_VULKAN_MESH_FUNCTIONS(ISOTET_LOAD)
    }
    if (capabilities.external_memory) {
        ISOTET_VULKAN_SHARING_FUNCTIONS(ISOTET_LOAD)
    }
    if (ask.vkCreateDebugUtilsMessengerEXT) {
        ISOTET_VULKAN_NAMING_FUNCTIONS(ISOTET_LOAD)
    }
#undef ISOTET_LOAD
    const char* missing = nullptr;
#define ISOTET_CHECK(name)                                                                                             \
    if (!call.name) missing = #name;
    ISOTET_VULKAN_DEVICE_FUNCTIONS(ISOTET_CHECK)
    if (capabilities.mesh_shaders) {
        ISOTET_VULKAN_MESH_FUNCTIONS(ISOTET_CHECK)
    }
#undef ISOTET_CHECK
    if (missing) return Error{ErrorCode::no_device, fmt::format("the driver of {} lacks {}", device_name_, missing)};
    return {};
}

LogicalDevice::~LogicalDevice() {
    if (owned_ && handle_ && call_.vkDestroyDevice && !hung()) call_.vkDestroyDevice(handle_, nullptr);
}

std::uint64_t LogicalDevice::free_memory(std::uint32_t heap) const {
    Capabilities now = capabilities_;
    refresh_free_memory(now, instance_.call(), physical_);
    return now.heap_free[heap];
}

std::string LogicalDevice::why_unable_to_share() const {
    if (!capabilities_.external_memory || !call_.vkGetMemoryFdKHR)
        return "it lacks the extension VK_KHR_external_memory_fd";
    VkPhysicalDeviceExternalBufferInfo asked{};
    asked.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_BUFFER_INFO;
    asked.usage = buffer_usage;
    asked.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    VkExternalBufferProperties found{};
    found.sType = VK_STRUCTURE_TYPE_EXTERNAL_BUFFER_PROPERTIES;
    instance_.call().vkGetPhysicalDeviceExternalBufferProperties(physical_, &asked, &found);
    const VkExternalMemoryFeatureFlags features = found.externalMemoryProperties.externalMemoryFeatures;
    if (!(features & VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT)) return "its driver exports no buffers";
    if (features & VK_EXTERNAL_MEMORY_FEATURE_DEDICATED_ONLY_BIT)
        return "its driver exports buffers only that have memory of their own";
    return {};
}

void LogicalDevice::name_object(VkObjectType type, std::uint64_t handle, std::string_view name) const {
    if (!call_.vkSetDebugUtilsObjectNameEXT) return;
    const std::string text(name);
    VkDebugUtilsObjectNameInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = text.c_str();
    call_.vkSetDebugUtilsObjectNameEXT(handle_, &info); // a name that is not taken does no harm
}

Error LogicalDevice::lose(std::string why) {
    if (lost_.empty()) lost_ = std::move(why);
    return {ErrorCode::device_failed, lost_};
}

Result<void> LogicalDevice::submit(const Queue& queue, VkCommandBuffer commands, VkFence done, std::string_view what) {
    if (Result<void> lives = alive(); !lives) return lives;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    const VkResult submitted = call_.vkQueueSubmit(queue.handle, 1, &submit, done);
    if (submitted == VK_SUCCESS) return {};
    if (submitted == VK_ERROR_DEVICE_LOST)
        return lose(fmt::format("the device {} was lost before {}", device_name_, what));
    return failure(what, submitted);
}

Result<void> LogicalDevice::wait(VkFence done, std::chrono::milliseconds limit, std::string_view what) {
    const auto nanoseconds = static_cast<std::uint64_t>(std::chrono::nanoseconds(limit).count());
    const VkResult waited = call_.vkWaitForFences(handle_, 1, &done, VK_TRUE, nanoseconds);
    if (waited == VK_SUCCESS) return {};
    unanswered_ = done; // the work may still be running
    if (waited == VK_TIMEOUT) {
        return lose(fmt::format("the device {} did not answer within {} s while {}", device_name_,
                                static_cast<double>(limit.count()) / 1000, what));
    }
    if (waited == VK_ERROR_DEVICE_LOST) return lose(fmt::format("the device {} was lost while {}", device_name_, what));
    return lose(failure(fmt::format("waiting for the device {} while {}", device_name_, what), waited).message);
}

Result<void> LogicalDevice::alive() const {
    if (lost_.empty()) return {};
    return Error{ErrorCode::device_failed, lost_};
}

bool LogicalDevice::hung() const {
    if (!unanswered_ || left_behind_) return left_behind_;
    left_behind_ = call_.vkGetFenceStatus(handle_, unanswered_) == VK_NOT_READY;
    if (!left_behind_) unanswered_ = VK_NULL_HANDLE; // its owner destroys it now: it must not be asked again
    return left_behind_;
}

} // namespace isotet::vulkan
