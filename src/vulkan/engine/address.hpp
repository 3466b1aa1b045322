// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Addresses of buffers, as kernels take them.
#pragma once

#include <cstdint>

#include "vulkan/kernels/shared/layout.h"
#include "vulkan/memory.hpp"

namespace isotet::vulkan {

inline layout::Address address_at(std::uint64_t address) {
    return {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32)};
}
inline layout::Address address_of(const Buffer& buffer, std::uint64_t offset = 0) {
    return address_at(buffer ? buffer.address() + offset : 0);
}

} // namespace isotet::vulkan
