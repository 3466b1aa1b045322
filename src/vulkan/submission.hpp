// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One command buffer, recorded, submitted and waited for, again and again.
#pragma once

#include <chrono>
#include <string_view>

#include <isotet/result.hpp>

#include "vulkan/devices/logical_device.hpp"

namespace isotet::vulkan {

class Submission {
public:
    Submission() = default;
    Submission(const Submission&) = delete;
    Submission& operator=(const Submission&) = delete;
    ~Submission();

    /// A command buffer to record into, with everything that ran before made visible to it. Nothing may be under way.
    Result<VkCommandBuffer> begin(LogicalDevice& device, const Queue& queue, std::string_view name);

    /// Ends the recording, makes what it writes visible to the processor, and starts the work.
    Result<void> submit(std::string_view what);

    /// Waits for the end of what was submitted; returns at once when nothing was.
    Result<void> wait(std::chrono::milliseconds limit, std::string_view what);

private:
    Result<void> make(LogicalDevice& device, const Queue& queue, std::string_view name);

    LogicalDevice* device_ = nullptr;
    Queue queue_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;
    bool under_way_ = false;
};

} // namespace isotet::vulkan
