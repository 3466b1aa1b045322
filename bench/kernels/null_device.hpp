// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Devices without the card: Mesa's driver radv compiles for any family of AMD's, and others of its drivers start on Mesa's
// fake kernel devices (drm-shim, bench/kernels/vendors.sh). They compile, and say what came out.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

#include "bench/kernels/pipelines.hpp"
#include "vulkan/devices/capabilities.hpp"

namespace isotet::bench {

/// What the driver's compiler made of one stage of a pipeline. Some drivers make several of one, for subgroups of
/// different sizes.
struct Figures {
    const vulkan::ShaderCode* code = nullptr;
    std::uint32_t subgroup = 0;
    std::vector<std::pair<std::string, double>> all; ///< whatever the driver tells, by its own names

    // Of AMD's driver.
    std::uint64_t vector_registers = 0, scalar_registers = 0, spilled_vectors = 0, spilled_scalars = 0;
    std::uint64_t scratch_bytes = 0, shared_bytes = 0;
    std::uint64_t waves = 0; ///< that a SIMD can hold at once
    std::uint64_t instructions = 0;
    std::uint64_t latency = 0; ///< cycles of a wave from first to last, as the compiler estimates
    std::uint64_t inverse_throughput =
        0; ///< cycles that a wave costs where enough others run, as the compiler estimates
};

/// Errors   no_device when there is no such driver, or it has no device of this family
/// Threads  one thread at a time; opening changes the environment
class NullDevice {
public:
    /// `driver`   libvulkan_radeon.so of Mesa 25 or later
    /// `family`   as RADV_FORCE_FAMILY takes it: navi31
    static Result<std::unique_ptr<NullDevice>> open(const std::string& driver, const std::string& family);

    /// The only device of a driver, whatever the environment makes of it.
    static Result<std::unique_ptr<NullDevice>> open(const std::string& driver);
    ~NullDevice();

    const vulkan::Capabilities& capabilities() const noexcept { return capabilities_; }

    /// Whether the device is given the pipeline: of AMD's, those before navi21 have no mesh shaders; of others some have
    /// no double precision, and only these get the kernel that does without.
    bool takes(const Pipeline& pipeline) const;

    /// Figures of each stage, in their order.
    Result<std::vector<Figures>> compile(const Pipeline& pipeline);

private:
    struct Calls;
    NullDevice() = default;
    Result<void> make_instance(const std::string& driver);
    Result<void> find_device();
    Result<void> make_device();
    Result<void> make_layout();
    Result<VkPipeline> build(const Pipeline& pipeline, const std::vector<VkPipelineShaderStageCreateInfo>& stages);
    Result<VkPipeline> build_drawing(const Pipeline& pipeline,
                                     const std::vector<VkPipelineShaderStageCreateInfo>& stages);
    Result<std::vector<Figures>> figures_of(const Pipeline& pipeline, VkPipeline made);

    std::unique_ptr<Calls> call_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    vulkan::Capabilities capabilities_;
    VkDevice device_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

/// radv beside the software device that VK_DRIVER_FILES names: they come in one package.
Result<std::string> driver_beside_software_device();

} // namespace isotet::bench
