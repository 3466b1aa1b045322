// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Calls of Vulkan that fail when a test says so.
#pragma once

#include <string>
#include <vector>

#include "vulkan/devices/functions.hpp"

namespace isotet::test {

/// What happens to the calls that a device makes, while it lives. One device at a time.
struct CallPlan {
    int fail_at = 0; ///< the number, from 1, of the call that fails; 0: none
    VkResult with = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    std::string only;               ///< only calls of this function are counted; empty: all that can fail
    std::vector<std::string> calls; ///< counted so far
};

/// Replaces every function that can fail by one that follows the plan, which must outlive the device.
void make_calls_follow(CallPlan& plan, vulkan::DeviceFunctions& functions);

} // namespace isotet::test
