// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A Vulkan instance, and what validation layers say about our use of it.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/result.hpp>

#include "vulkan/devices/functions.hpp"

namespace isotet::vulkan {

enum class Validation : std::uint8_t {
    off,
    on,           ///< the rules of Vulkan, and synchronization
    gpu_assisted, ///< the rules, and every address that a kernel uses; slow
};

/// What the validation layer has to say. Outlives the instance, so that it can tell of what was not given back.
///
/// Threads   safe from many threads
class Complaints {
public:
    void add(std::string complaint) {
        const std::lock_guard lock(mutex_);
        all_.push_back(std::move(complaint));
    }
    std::vector<std::string> all() const {
        const std::lock_guard lock(mutex_);
        return all_;
    }

private:
    mutable std::mutex mutex_;
    std::vector<std::string> all_;
};

struct Watch {
    Validation validation = Validation::off;
    std::shared_ptr<Complaints> complaints; ///< not null, unless validation is off
};

class Instance {
public:
    /// Errors   machine when there is no loader, no driver, or no validation layer though one is asked for
    /// `version`   the newest version of Vulkan that is used; devices may have less
    static Result<std::unique_ptr<Instance>> open(const Watch& watch, std::uint32_t version);

    /// One that the caller made, which stays the caller's.
    static Result<std::unique_ptr<Instance>> adopt(const VulkanHandles& handles);

    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    VkInstance handle() const noexcept { return handle_; }
    const InstanceFunctions& call() const noexcept { return call_; }

    /// All devices, in the driver's order.
    Result<std::vector<VkPhysicalDevice>> devices() const;

private:
    Instance() = default;
    Result<void> load(PFN_vkGetInstanceProcAddr get, bool naming);

    Watch watch_;
    bool owned_ = true;
    VkInstance handle_ = VK_NULL_HANDLE;
    InstanceFunctions call_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

} // namespace isotet::vulkan
