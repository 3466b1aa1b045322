// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Kernels: compute pipelines, each made once.
#pragma once

#include <cstdint>
#include <list>
#include <span>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/float_controls.hpp"
#include "vulkan/devices/logical_device.hpp"
#include "vulkan/pipeline_cache.hpp"
#include "vulkan/shader_code.hpp"

namespace isotet::vulkan {

/// A kernel that is ready to be dispatched. Lives as long as its Kernels.
struct Kernel {
    std::string name;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
};

/// All kernels of a device. They take at most 128 bytes of push constants, and reach buffers by address; there are no
/// descriptor sets.
///
/// Threads   one thread at a time
class ISOTET_API Kernels {
public:
    static constexpr std::uint32_t push_bytes = 128; ///< what every Vulkan device allows

    Kernels(LogicalDevice& device, const Capabilities& capabilities, PipelineCache& cache);
    ~Kernels();

    /// The kernel of a shader with these specialization constants (constant_id 0, 1, ...), made when it is first asked
    /// for.
    ///
    /// Cost     5 to 500 ms the first time, a millisecond from the cache on disk
    /// Errors   machine when the driver cannot build it; out_of_memory
    Result<const Kernel*> get(const ShaderCode& code, std::span<const std::uint32_t> constants = {});

    std::size_t count() const noexcept { return made_.size(); } ///< made so far

private:
    struct Made {
        const std::uint32_t* code;
        std::vector<std::uint32_t> constants;
        Kernel kernel;
    };

    Result<void> make_layout();
    Result<VkPipeline> build(const ShaderCode& code, std::span<const std::uint32_t> constants);

    LogicalDevice& device_;
    PipelineCache& cache_;
    FloatControls controls_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::list<Made> made_;
};

} // namespace isotet::vulkan
