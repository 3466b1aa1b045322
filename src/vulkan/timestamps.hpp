// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// When the passes of a command buffer end, on the device's own clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/result.hpp>

#include "vulkan/devices/logical_device.hpp"

namespace isotet::vulkan {

class Context;

class Timestamps {
public:
    Timestamps() = default;
    Timestamps(const Timestamps&) = delete;
    Timestamps& operator=(const Timestamps&) = delete;
    ~Timestamps();

    /// Makes room for `count` marks; does nothing on a device without timestamps, nor do the other functions then.
    Result<void> make(Context& context, std::size_t count);

    /// Clears the marks, and sets the first.
    void begin(VkCommandBuffer commands);

    /// Marks the end of everything recorded so far.
    void mark(VkCommandBuffer commands);

    /// The marks, in seconds after the first, when the work has ended; empty without timestamps.
    Result<std::vector<double>> seconds() const;

private:
    LogicalDevice* device_ = nullptr;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::uint32_t room_ = 0, used_ = 0;
    std::uint64_t mask_ = 0; ///< bits of the clock that count
    double tick_ = 0;        ///< seconds
};

} // namespace isotet::vulkan
