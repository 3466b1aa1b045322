// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every pipeline that isotet can ask a driver for, to be compiled without a device to run on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "vulkan/shader_code.hpp"

namespace isotet::bench {

struct Stage {
    const vulkan::ShaderCode* code = nullptr;
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
};

struct Pipeline {
    std::string name;    ///< of its first shader
    std::string variant; ///< what its constants mean; empty where there is one only
    std::vector<Stage> stages;
    std::vector<std::uint32_t> constants; ///< constant_id 0, 1, ...
    bool opaque = true;

    bool draws() const { return stages.front().stage != VK_SHADER_STAGE_COMPUTE_BIT; }
};

/// All pipelines, with every set of constants.
std::vector<Pipeline> all_pipelines();

/// The SPIR-V of a stage with its constants put in as ordinary ones.
std::vector<std::uint32_t> specialized(const vulkan::ShaderCode& code, const std::vector<std::uint32_t>& constants);

} // namespace isotet::bench
