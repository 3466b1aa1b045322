// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What Vulkan says when it fails, as an Error.
#pragma once

#include <string_view>

#include <isotet/result.hpp>

#include "vulkan/devices/functions.hpp"

namespace isotet::vulkan {

/// "VK_ERROR_DEVICE_LOST" and so on.
std::string_view name_of(VkResult result) noexcept;

/// "making the pipeline of 'count' failed: VK_ERROR_DEVICE_LOST", out_of_memory where Vulkan says so, else device_failed.
Error failure(std::string_view doing, VkResult result);

} // namespace isotet::vulkan
