// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which of the devices is meant.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <isotet/device.hpp>
#include <isotet/result.hpp>

namespace isotet::vulkan {

/// The index of the device that DeviceOptions::choice means; the device can be used.
///
/// Errors   invalid_argument when no device fits, or more than one; machine when the device that fits cannot be used,
///          or when no GPU is there and none was named. Messages list what there is.
Result<std::size_t> choose(std::span<const DeviceInfo> devices, std::string_view choice);

} // namespace isotet::vulkan
