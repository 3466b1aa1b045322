// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Push constants of kernels/add.comp.
#pragma once

#include <cstdint>

#include "vulkan/devices/functions.hpp"

namespace isotet::test {

struct AddPush {
    VkDeviceAddress words;
    std::uint32_t count, term;
};

} // namespace isotet::test
