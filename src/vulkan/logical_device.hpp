// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The opened device: its functions, its queues, its names for debuggers, and whether it still answers.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <isotet/result.hpp>

#include "vulkan/capabilities.hpp"
#include "vulkan/functions.hpp"
#include "vulkan/instance.hpp"

namespace isotet::vulkan {

struct Queue {
    VkQueue handle = VK_NULL_HANDLE;
    std::uint32_t family = 0;
};

/// Everything that belongs to a device refers to this, and goes before it does.
///
/// A device that is lost, or that did not answer in time, stays `lost`: every later call says why. Work that never ended
/// may still use its objects, so after a hang none of them is destroyed: they are left to the end of the process.
class LogicalDevice {
public:
    /// `alter`   changes the table of functions, for tests that make calls fail; may be empty
    static Result<std::unique_ptr<LogicalDevice>> open(const Instance& instance, VkPhysicalDevice physical,
                                                       const Capabilities& capabilities,
                                                       const std::function<void(DeviceFunctions&)>& alter);
    LogicalDevice(const LogicalDevice&) = delete;
    LogicalDevice& operator=(const LogicalDevice&) = delete;
    ~LogicalDevice();

    VkDevice handle() const noexcept { return handle_; }
    const DeviceFunctions& call() const noexcept { return call_; }
    const Queue& compute() const noexcept { return compute_; }
    const Queue& transfer() const noexcept { return transfer_; } ///< the same as compute() where there is no other
    bool has_transfer_queue() const noexcept { return transfer_.family != compute_.family; }

    /// Names an object for debuggers and validation messages.
    void name(VkObjectType type, std::uint64_t handle, std::string_view name) const;

    /// Submits one command buffer and waits for it.
    ///
    /// `what`    for messages: "extracting"
    /// Errors    machine when the device is or gets lost, or does not answer within `limit`
    Result<void> run(const Queue& queue, VkCommandBuffer commands, std::chrono::milliseconds limit, std::string_view what);

    /// An error when the device was lost before.
    Result<void> alive() const;

    /// Work did not end in time, and may go on for ever.
    bool hung() const noexcept { return hung_; }

private:
    explicit LogicalDevice(const Instance& instance) : instance_(instance) {}

    const Instance& instance_;
    VkDevice handle_ = VK_NULL_HANDLE;
    DeviceFunctions call_;
    Queue compute_, transfer_;
    std::string device_name_;
    std::string lost_; ///< why; empty while it works
    bool hung_ = false;
};

} // namespace isotet::vulkan
