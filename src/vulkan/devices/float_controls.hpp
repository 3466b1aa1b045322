// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Asking the device for the arithmetic of the contract.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace isotet::vulkan {

/// What a device can promise of float32 (VkPhysicalDeviceVulkan12Properties).
struct FloatControls {
    bool rounds_to_nearest_even = false;
    bool keeps_signed_zero = false; ///< and infinities and NaN
};

/// The SPIR-V of a shader with these promises asked for. Not every device reports them, and a module that asks for what
/// is not reported is invalid: so they are added here, not by the shader compiler.
std::vector<std::uint32_t> with_float_controls(std::span<const std::uint32_t> words, FloatControls controls);

} // namespace isotet::vulkan
