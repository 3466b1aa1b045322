// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/capabilities.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include <fmt/core.h>

namespace isotet::vulkan {

namespace {

/// What kernels count on.
constexpr std::uint32_t needed_workgroup_size = 128;
constexpr std::uint32_t needed_shared_memory = 16384;
constexpr std::uint32_t needed_push_bytes = 128;

/// Older ones end loops early, silently.
constexpr int oldest_lavapipe = 25;

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

DeviceKind kind_of(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return DeviceKind::discrete;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return DeviceKind::integrated;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return DeviceKind::virtual_gpu;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return DeviceKind::software;
    default: return DeviceKind::other;
    }
}

/// The 22 of "Mesa 22.3.6 (LLVM 15.0.6)"; 0 where it does not say.
int mesa_version(std::string_view driver_info) {
    constexpr std::string_view word = "Mesa ";
    int version = 0;
    if (driver_info.starts_with(word))
        std::from_chars(driver_info.data() + word.size(), driver_info.data() + driver_info.size(), version);
    return version;
}

/// What a device has beside its version of Vulkan.
class Extensions {
public:
    /// `whole`   Vulkan 1.2 is there
    Extensions(const InstanceFunctions& call, VkPhysicalDevice device, bool whole) : whole_(whole) {
        std::uint32_t count = 0;
        if (call.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) return;
        found_.resize(count);
        if (call.vkEnumerateDeviceExtensionProperties(device, nullptr, &count, found_.data()) < VK_SUCCESS)
            found_.clear();
    }

    bool whole() const { return whole_; }

    bool has(std::string_view name) const {
        return std::any_of(found_.begin(), found_.end(), [&](const auto& one) { return one.extensionName == name; });
    }

    /// Whether the device has what became part of Vulkan 1.2: by its version, or by the extension that it was before.
    bool has_early(std::string_view name) const { return whole_ || has(name); }

    /// Notes that the extension is to be enabled, if there is such; Vulkan 1.2 needs none for its own parts.
    void use_early(const char* name, std::vector<const char*>& used) const {
        if (!whole_ && has(name)) used.push_back(name);
    }

private:
    bool whole_;
    std::vector<VkExtensionProperties> found_;
};

/// A chain of structs for a driver to fill in.
class Chain {
public:
    explicit Chain(void** first) : next_(first) {}

    template <class Struct>
    void add(Struct& one, VkStructureType type) {
        one.sType = type;
        *next_ = &one;
        next_ = &one.pNext;
    }

private:
    void** next_;
};

void ask_properties(Capabilities& found, const InstanceFunctions& call, VkPhysicalDevice device,
                    const Extensions& extensions) {
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    Chain chain(&properties.pNext);
    VkPhysicalDeviceSubgroupProperties subgroups{};
    chain.add(subgroups, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES);
    VkPhysicalDeviceMaintenance3Properties allocations{};
    chain.add(allocations, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES);
    if (extensions.has_early(VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME))
        chain.add(found.driver, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    if (extensions.has_early(VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME))
        chain.add(found.floats, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES);
    call.vkGetPhysicalDeviceProperties2(device, &properties);
    found.subgroup_size = subgroups.subgroupSize;
    found.largest_allocation = allocations.maxMemoryAllocationSize;
    found.driver.pNext = found.floats.pNext = nullptr; // they are copied from here on
    extensions.use_early(VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME, found.extensions);
}

void ask_features(Capabilities& found, const InstanceFunctions& call, VkPhysicalDevice device,
                  const Extensions& extensions) {
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    Chain chain(&features.pNext);
    VkPhysicalDeviceBufferDeviceAddressFeatures addresses{};
    if (extensions.has_early(VK_KHR_BUFFER_DEVICE_ADDRESS_EXTENSION_NAME))
        chain.add(addresses, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES);
    VkPhysicalDeviceScalarBlockLayoutFeatures layout{};
    if (extensions.has_early(VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME))
        chain.add(layout, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES);
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    // Their SPIR-V is newer than what Vulkan 1.1 takes.
    const bool may_mesh = extensions.whole() && extensions.has(VK_EXT_MESH_SHADER_EXTENSION_NAME);
    if (may_mesh) chain.add(mesh, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT);
    call.vkGetPhysicalDeviceFeatures2(device, &features);
    found.features = features.features;
    found.buffer_addresses = addresses.bufferDeviceAddress;
    found.scalar_layout = layout.scalarBlockLayout;
    found.mesh_shaders = mesh.meshShader;
    extensions.use_early(VK_KHR_BUFFER_DEVICE_ADDRESS_EXTENSION_NAME, found.extensions);
    extensions.use_early(VK_EXT_SCALAR_BLOCK_LAYOUT_EXTENSION_NAME, found.extensions);
    if (found.mesh_shaders) found.extensions.push_back(VK_EXT_MESH_SHADER_EXTENSION_NAME);
}

void ask_queues(Capabilities& found, const InstanceFunctions& call, VkPhysicalDevice device) {
    std::uint32_t count = 0;
    call.vkGetPhysicalDeviceQueueFamilyProperties2(device, &count, nullptr);
    VkQueueFamilyProperties2 empty{};
    empty.sType = VK_STRUCTURE_TYPE_QUEUE_FAMILY_PROPERTIES_2;
    std::vector<VkQueueFamilyProperties2> families(count, empty);
    call.vkGetPhysicalDeviceQueueFamilyProperties2(device, &count, families.data());
    for (const auto& family : families)
        found.queues.push_back(
            {family.queueFamilyProperties.queueFlags, family.queueFamilyProperties.timestampValidBits});
}

void choose_queues(Capabilities& found) {
    constexpr VkQueueFlags works = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < found.queues.size(); ++i) {
        const VkQueueFlags flags = found.queues[i].flags;
        // One queue that also draws, so that a surface need not change queues to be drawn.
        const bool better = found.compute_family == Capabilities::none ||
                            ((flags & works) == works && (found.queues[found.compute_family].flags & works) != works);
        if ((flags & VK_QUEUE_COMPUTE_BIT) && better) found.compute_family = i;
        // Copy engines; families for video can copy, too, and are left alone.
        constexpr VkQueueFlags copies = VK_QUEUE_TRANSFER_BIT | VK_QUEUE_SPARSE_BINDING_BIT;
        if ((flags & VK_QUEUE_TRANSFER_BIT) && !(flags & ~copies) && found.transfer_family == Capabilities::none)
            found.transfer_family = i;
    }
    if (found.transfer_family == Capabilities::none) found.transfer_family = found.compute_family;
}

bool is_unified(const Capabilities& capabilities) {
    const VkPhysicalDeviceType type = capabilities.properties.deviceType;
    return type == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU || type == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

/// Of the allowed memory types the one with the highest score; among equals the largest heap, then the first, as Vulkan
/// orders them.
template <class Score>
std::uint32_t best_memory_type(const VkPhysicalDeviceMemoryProperties& memory, MemoryTypes allowed, Score&& score) {
    std::uint32_t best = Capabilities::none;
    std::pair<int, VkDeviceSize> best_score{-1, 0};
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if (!(allowed >> i & 1)) continue;
        const std::pair<int, VkDeviceSize> here{score(memory.memoryTypes[i].propertyFlags),
                                                memory.memoryHeaps[memory.memoryTypes[i].heapIndex].size};
        if (here.first >= 0 && here > best_score) {
            best = i;
            best_score = here;
        }
    }
    return best;
}

constexpr VkMemoryPropertyFlags mappable = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags unwanted = VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT | VK_MEMORY_PROPERTY_PROTECTED_BIT |
                                           VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD |
                                           VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;

} // namespace

std::uint32_t device_memory_type(const Capabilities& capabilities, MemoryTypes allowed) {
    const bool unified = is_unified(capabilities);
    return best_memory_type(capabilities.memory, allowed, [&](VkMemoryPropertyFlags flags) {
        if (flags & unwanted) return -1;
        const bool own = flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, mapped = (flags & mappable) == mappable;
        const bool cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        // A card's memory that the processor can reach is reached over the bus: a copy engine does that better.
        return 8 * own + 4 * (mapped == unified) + 2 * (unified && cached);
    });
}

std::uint32_t upload_memory_type(const Capabilities& capabilities, MemoryTypes allowed) {
    return best_memory_type(capabilities.memory, allowed, [](VkMemoryPropertyFlags flags) {
        if ((flags & unwanted) || (flags & mappable) != mappable) return -1;
        return 2 * !(flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) + !(flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
    });
}

std::uint32_t download_memory_type(const Capabilities& capabilities, MemoryTypes allowed) {
    return best_memory_type(capabilities.memory, allowed, [](VkMemoryPropertyFlags flags) {
        if ((flags & unwanted) || (flags & mappable) != mappable) return -1;
        return 2 * !!(flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT) + !(flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    });
}

bool is_unified_type(const Capabilities& capabilities, std::uint32_t type) {
    return (capabilities.memory.memoryTypes[type].propertyFlags & mappable) == mappable && is_unified(capabilities);
}

Capabilities ask(const InstanceFunctions& call, VkPhysicalDevice device, std::uint32_t version) {
    Capabilities found;
    call.vkGetPhysicalDeviceProperties(device, &found.properties);
    // What follows came with 1.1; without it the device is unusable, and is listed with what is known so far.
    if (found.properties.apiVersion < oldest_version) return found;
    const Extensions extensions(call, device, std::min(found.properties.apiVersion, version) >= whole_version);
    ask_properties(found, call, device, extensions);
    ask_features(found, call, device, extensions);
    ask_queues(found, call, device);
    choose_queues(found);
    found.memory_budget = extensions.has(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    if (found.memory_budget) found.extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    found.external_memory = extensions.has(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
    refresh_free_memory(found, call, device);
    return found;
}

void refresh_free_memory(Capabilities& capabilities, const InstanceFunctions& call, VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{};
    budget.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT;
    VkPhysicalDeviceMemoryProperties2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2;
    if (capabilities.memory_budget) memory.pNext = &budget;
    call.vkGetPhysicalDeviceMemoryProperties2(device, &memory);
    capabilities.memory = memory.memoryProperties;
    for (std::uint32_t heap = 0; heap < capabilities.memory.memoryHeapCount; ++heap) {
        const VkDeviceSize most =
            capabilities.memory_budget ? budget.heapBudget[heap] : capabilities.memory.memoryHeaps[heap].size;
        capabilities.heap_free[heap] = most - std::min(most, budget.heapUsage[heap]);
    }
}

std::string why_unusable(const Capabilities& capabilities) {
    const VkPhysicalDeviceProperties& properties = capabilities.properties;
    if (properties.apiVersion < oldest_version)
        return fmt::format("it has Vulkan {}, but 1.1 is needed", version_text(properties.apiVersion));
    if (capabilities.driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE &&
        mesa_version(capabilities.driver.driverInfo) < oldest_lavapipe) {
        return fmt::format("it is the software device of {}, which ends long loops early; Mesa {} or later is needed",
                           capabilities.driver.driverInfo, oldest_lavapipe);
    }
    if (capabilities.compute_family == Capabilities::none) return "it cannot compute: no queue takes compute work";
    if (!capabilities.buffer_addresses) return "it lacks the feature bufferDeviceAddress";
    if (!capabilities.scalar_layout) return "it lacks the feature scalarBlockLayout";
    const VkPhysicalDeviceLimits& limits = properties.limits;
    const auto short_of = [](const char* what, std::uint32_t there, std::uint32_t needed) {
        return fmt::format("{} is {}, but {} is needed", what, there, needed);
    };
    if (const auto size = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
        size < needed_workgroup_size)
        return short_of("its largest workgroup", size, needed_workgroup_size);
    if (limits.maxComputeSharedMemorySize < needed_shared_memory)
        return short_of("its shared memory in bytes", limits.maxComputeSharedMemorySize, needed_shared_memory);
    if (limits.maxPushConstantsSize < needed_push_bytes)
        return short_of("its room for push constants in bytes", limits.maxPushConstantsSize, needed_push_bytes);
    for (const auto type :
         {device_memory_type(capabilities), upload_memory_type(capabilities), download_memory_type(capabilities)})
        if (type == Capabilities::none) return "it has no memory that the processor can reach";
    return {};
}

std::string why_unable_to_draw(const Capabilities& capabilities) {
    if (!(capabilities.queues[capabilities.compute_family].flags & VK_QUEUE_GRAPHICS_BIT))
        return "no queue takes both compute and graphics work";
    if (!capabilities.features.fragmentStoresAndAtomics) return "it lacks the feature fragmentStoresAndAtomics";
    return {};
}

DeviceInfo describe(const Capabilities& capabilities, std::size_t index) {
    const VkPhysicalDeviceProperties& properties = capabilities.properties;
    DeviceInfo info;
    info.index = index;
    info.name = properties.deviceName;
    info.kind = kind_of(properties.deviceType);
    info.api = version_text(properties.apiVersion);
    info.driver = fmt::format("{} {}", capabilities.driver.driverName, capabilities.driver.driverInfo);
    if (capabilities.driver.driverName[0] == 0) info.driver = fmt::format("version {:#x}", properties.driverVersion);
    info.unusable = why_unusable(capabilities);
    if (const std::uint32_t type = device_memory_type(capabilities); type != Capabilities::none) {
        const std::uint32_t heap = capabilities.memory.memoryTypes[type].heapIndex;
        info.memory = capabilities.memory.memoryHeaps[heap].size;
        info.memory_free = capabilities.heap_free[heap];
        info.unified_memory = is_unified_type(capabilities, type);
    }
    info.memory_free_known = capabilities.memory_budget;
    info.transfer_queue = capabilities.transfer_family != capabilities.compute_family;
    info.timestamps = capabilities.compute_family != Capabilities::none &&
                      capabilities.queues[capabilities.compute_family].timestamp_bits > 0;
    info.allocation_limit = capabilities.largest_allocation;
    for (std::size_t axis = 0; axis < 3; ++axis)
        info.workgroups[axis] = properties.limits.maxComputeWorkGroupCount[axis];
    info.workgroup_size = properties.limits.maxComputeWorkGroupInvocations;
    info.shared_memory = properties.limits.maxComputeSharedMemorySize;
    info.subgroup_size = capabilities.subgroup_size;
    return info;
}

} // namespace isotet::vulkan
