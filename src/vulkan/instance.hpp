// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A Vulkan instance, and what validation layers say about our use of it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "vulkan/functions.hpp"

namespace isotet::vulkan {

enum class Validation : std::uint8_t {
    off,
    on,           ///< the rules of Vulkan, and synchronization
    gpu_assisted, ///< the rules, and every address that a kernel uses; slow
};

class Instance {
public:
    /// Errors   machine when there is no loader, no driver, or no validation layer though one is asked for
    static Result<std::unique_ptr<Instance>> open(Validation validation = Validation::off);

    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    VkInstance handle() const noexcept { return handle_; }
    const InstanceFunctions& call() const noexcept { return call_; }

    /// All devices, in the driver's order.
    Result<std::vector<VkPhysicalDevice>> devices() const;

    /// Errors and warnings of the validation layer so far. Safe from many threads.
    std::vector<std::string> complaints() const;

private:
    Instance() = default;
    static VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);

    VkInstance handle_ = VK_NULL_HANDLE;
    InstanceFunctions call_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    mutable std::mutex mutex_;
    std::vector<std::string> complaints_;
};

} // namespace isotet::vulkan
