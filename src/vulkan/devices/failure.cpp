// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/failure.hpp"

#include <fmt/core.h>

namespace isotet::vulkan {

std::string_view name_of(VkResult result) noexcept {
    switch (result) {
#define ISOTET_NAME(name)                                                                                              \
    case name: return #name;
        ISOTET_NAME(VK_SUCCESS)
        ISOTET_NAME(VK_NOT_READY)
        ISOTET_NAME(VK_TIMEOUT)
        ISOTET_NAME(VK_INCOMPLETE)
        ISOTET_NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        ISOTET_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        ISOTET_NAME(VK_ERROR_INITIALIZATION_FAILED)
        ISOTET_NAME(VK_ERROR_DEVICE_LOST)
        ISOTET_NAME(VK_ERROR_MEMORY_MAP_FAILED)
        ISOTET_NAME(VK_ERROR_LAYER_NOT_PRESENT)
        ISOTET_NAME(VK_ERROR_EXTENSION_NOT_PRESENT)
        ISOTET_NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        ISOTET_NAME(VK_ERROR_INCOMPATIBLE_DRIVER)
        ISOTET_NAME(VK_ERROR_TOO_MANY_OBJECTS)
        ISOTET_NAME(VK_ERROR_FRAGMENTATION)
        ISOTET_NAME(VK_ERROR_INVALID_SHADER_NV)
        ISOTET_NAME(VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS)
#undef ISOTET_NAME
    default: return "an unknown VkResult";
    }
}

Error failure(std::string_view doing, VkResult result) {
    const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return {memory ? ErrorCode::out_of_memory : ErrorCode::device_failed,
            fmt::format("{} failed: {} ({})", doing, name_of(result), static_cast<int>(result))};
}

} // namespace isotet::vulkan
