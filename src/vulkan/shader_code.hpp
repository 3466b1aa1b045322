// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A compiled shader inside the program; vulkan/shaders.hpp, written by the build, lists them: shaders::self_test and so
// on.
#pragma once

#include <cstdint>
#include <span>

namespace isotet::vulkan {

struct ShaderCode {
    const char* name;                     ///< the file's, without its ending
    std::span<const std::uint32_t> words; ///< SPIR-V
};

} // namespace isotet::vulkan
