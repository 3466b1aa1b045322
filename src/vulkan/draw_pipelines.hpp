// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pipelines that draw triangles, each made once.
#pragma once

#include <cstdint>
#include <list>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/context.hpp"
#include "vulkan/target.hpp"

namespace isotet::vulkan {

/// A pipeline that is ready to draw. Lives as long as its DrawPipelines.
struct DrawPipeline {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkShaderStageFlags stages = 0; ///< that see push constants
};

/// What puts triangles in front of a fragment shader.
enum class FirstStage : std::uint8_t {
    vertex,
    mesh, ///< of devices that have Capabilities::mesh_shaders
};

/// What becomes of a fragment that is nearer than what has been drawn so far.
enum class Surfaces : std::uint8_t {
    opaque,      ///< it takes the place of what is there
    translucent, ///< the fragment shader keeps it where it likes; colour and depth stay
};

/// All pipelines of a device. No vertex inputs, no descriptor sets: shaders take up to 128 bytes of push constants,
/// seen by all stages, and reach buffers by address. Triangles are seen from both sides.
///
/// Threads   one thread at a time
class ISOTET_API DrawPipelines {
public:
    static constexpr std::uint32_t push_bytes = 128;

    DrawPipelines(Context& context, const RenderPass& pass);
    ~DrawPipelines();
    DrawPipelines(const DrawPipelines&) = delete;
    DrawPipelines& operator=(const DrawPipelines&) = delete;

    /// The pipeline of two shaders with these specialization constants (constant_id 0, 1, ..., the same for both), made
    /// when it is first asked for.
    ///
    /// Cost     5 to 500 ms the first time
    /// Errors   machine when the driver cannot build it; out_of_memory
    Result<const DrawPipeline*> get(const ShaderCode& first, const ShaderCode& fragment, Surfaces surfaces,
                                    std::span<const std::uint32_t> constants = {},
                                    FirstStage stage = FirstStage::vertex);

private:
    struct Made {
        const std::uint32_t *first, *fragment;
        std::vector<std::uint32_t> constants;
        DrawPipeline pipeline;
    };
    Result<void> make_layout();
    Result<VkShaderModule> module_of(const ShaderCode& code);
    Result<VkPipeline> build(std::span<const VkPipelineShaderStageCreateInfo> shaders, Surfaces surfaces);

    Context& context_;
    const RenderPass& pass_;
    const VkShaderStageFlags stages_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::list<Made> made_;
};

} // namespace isotet::vulkan
