// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a device can do, asked and never assumed, and whether that is enough.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <isotet/device.hpp>

#include "vulkan/devices/functions.hpp"

namespace isotet::vulkan {

/// A queue family.
struct QueueFamily {
    VkQueueFlags flags = 0;
    std::uint32_t timestamp_bits = 0;
};

/// What was asked of a physical device.
struct Capabilities {
    VkPhysicalDeviceProperties properties{};
    VkPhysicalDeviceDriverProperties driver{};
    VkPhysicalDeviceFloatControlsProperties floats{};
    VkDeviceSize largest_allocation = 0;
    std::uint32_t subgroup_size = 0;
    VkPhysicalDeviceFeatures features{};
    bool buffer_addresses = false; ///< bufferDeviceAddress
    bool scalar_layout = false;    ///< scalarBlockLayout
    VkPhysicalDeviceMemoryProperties memory{};
    std::array<VkDeviceSize, VK_MAX_MEMORY_HEAPS> heap_free{}; ///< of each heap, for this process; its size where not
                                                               ///< known
    std::vector<QueueFamily> queues;
    bool memory_budget = false; ///< VK_EXT_memory_budget: heap_free is known, and changes

    bool mesh_shaders = false;           ///< VK_EXT_mesh_shader with the feature
    bool external_memory = false;        ///< VK_KHR_external_memory_fd; enabled where it is asked for
    std::vector<const char*> extensions; ///< to be enabled: what is used and is no part of its version of Vulkan

    static constexpr std::uint32_t none = UINT32_MAX;
    std::uint32_t compute_family = none;
    std::uint32_t transfer_family = none; ///< one that only copies, if there is one; else compute_family
};

/// The version of Vulkan that has all that is needed; of older ones down to 1.1 the extensions will do.
constexpr std::uint32_t whole_version = VK_API_VERSION_1_2, oldest_version = VK_API_VERSION_1_1;

/// Asks. `version` is that of the instance: nothing newer of the device is used.
Capabilities ask(const InstanceFunctions& call, VkPhysicalDevice device, std::uint32_t version);

/// Asks again what is free.
void refresh_free_memory(Capabilities& capabilities, const InstanceFunctions& call, VkPhysicalDevice device);

/// Why isotet cannot use the device; empty: it can. A sentence with what is there and what is needed.
std::string why_unusable(const Capabilities& capabilities);

/// Why isotet cannot draw on a device that it can otherwise use; empty: it can.
ISOTET_API std::string why_unable_to_draw(const Capabilities& capabilities);

/// The public description. `index` is the device's place in the list.
DeviceInfo describe(const Capabilities& capabilities, std::size_t index);

/// Memory types as bits: VkMemoryRequirements::memoryTypeBits.
using MemoryTypes = std::uint32_t;
constexpr MemoryTypes all_memory_types = UINT32_MAX;

/// The memory type for device buffers: the device's own, in the largest heap; mapped as well where memory is unified.
///
/// `allowed`   what the driver says of such a buffer (or image); a list may begin with types for other things
std::uint32_t device_memory_type(const Capabilities& capabilities, MemoryTypes allowed = all_memory_types);

/// The machine's memory for going up (write-combined will do) or down (cached, where there is such).
std::uint32_t upload_memory_type(const Capabilities& capabilities, MemoryTypes allowed = all_memory_types);
std::uint32_t download_memory_type(const Capabilities& capabilities, MemoryTypes allowed = all_memory_types);

/// Whether the memory type is both the processor's and the device's, and the processor can reach it.
bool is_unified_type(const Capabilities& capabilities, std::uint32_t type);

} // namespace isotet::vulkan
