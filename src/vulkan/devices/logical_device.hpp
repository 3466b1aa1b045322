// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The opened device: its functions, its queues, its names for debuggers, and whether it still answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <isotet/result.hpp>

#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/functions.hpp"
#include "vulkan/devices/instance.hpp"

namespace isotet::vulkan {

/// What all buffers may be used for.
constexpr VkBufferUsageFlags buffer_usage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
    VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
    VK_BUFFER_USAGE_INDEX_BUFFER_BIT;

struct Queue {
    VkQueue handle = VK_NULL_HANDLE;
    std::uint32_t family = 0;
};

/// Everything that belongs to a device refers to this, and goes before it does.
///
/// A device that was lost, or that did not answer in time, stays so: every later call says why.
class LogicalDevice {
public:
    /// `alter`   changes the table of functions, for tests that make calls fail; may be empty
    static Result<std::unique_ptr<LogicalDevice>> open(const Instance& instance, VkPhysicalDevice physical,
                                                       const Capabilities& capabilities,
                                                       const std::function<void(DeviceFunctions&)>& alter);
    /// One that the caller opened, which stays the caller's. Its queue is for everything.
    static Result<std::unique_ptr<LogicalDevice>> adopt(const Instance& instance, const VulkanHandles& handles,
                                                        const Capabilities& capabilities);
    LogicalDevice(const LogicalDevice&) = delete;
    LogicalDevice& operator=(const LogicalDevice&) = delete;
    ~LogicalDevice();

    VkDevice handle() const noexcept { return handle_; }
    const DeviceFunctions& call() const noexcept { return call_; }
    const Queue& compute() const noexcept { return compute_; }
    const Queue& transfer() const noexcept { return transfer_; } ///< the same as compute() where there is no other
    bool has_transfer_queue() const noexcept { return transfer_.family != compute_.family; }

    /// Bytes of a heap that this process can still take, as the driver says now.
    std::uint64_t free_memory(std::uint32_t heap) const;

    /// Why memory of buffers cannot be handed out as file descriptors; empty: it can.
    std::string why_unable_to_share() const;

    /// Names an object for debuggers and validation messages. Handles are pointers or numbers.
    template <class Handle>
    void name(VkObjectType type, Handle handle, std::string_view name) const {
        name_object(type, (std::uint64_t)handle, name); // NOLINT: a pointer or a number, as Vulkan has it
    }

    /// Submits one command buffer; `done` is signalled at its end.
    Result<void> submit(const Queue& queue, VkCommandBuffer commands, VkFence done, std::string_view what);

    /// Waits for a fence.
    ///
    /// `what`    for messages: "extracting"
    /// Errors    machine when the device is lost or does not answer within `limit`
    Result<void> wait(VkFence done, std::chrono::milliseconds limit, std::string_view what);

    /// An error when the device was lost before.
    Result<void> alive() const;

    /// Work that did not end in time still goes on, perhaps for ever, and may use anything: nothing may be destroyed,
    /// and everything stays until the process ends. Asked by whatever is about to destroy something; once true, it
    /// stays so.
    bool hung() const;

private:
    LogicalDevice(const Instance& instance, VkPhysicalDevice physical, const Capabilities& capabilities);
    Result<void> load_functions();
    void name_object(VkObjectType type, std::uint64_t handle, std::string_view name) const;
    Error lose(std::string why);

    const Instance& instance_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    Capabilities capabilities_;
    bool owned_ = true;
    VkDevice handle_ = VK_NULL_HANDLE;
    DeviceFunctions call_;
    Queue compute_, transfer_;
    std::string device_name_;
    std::string lost_;                    ///< why; empty while it works
    mutable VkFence unanswered_ = VK_NULL_HANDLE; ///< of the work that did not end in time
    mutable bool left_behind_ = false;    ///< something was not destroyed because of it
};

} // namespace isotet::vulkan
