// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pipelines that draw triangles, each made once.
#pragma once

#include <cstdint>
#include <list>
#include <span>
#include <vector>

#include <isotet/result.hpp>

#include "vulkan/context.hpp"
#include "vulkan/target.hpp"

namespace isotet::vulkan {

/// A pipeline that is ready to draw. Lives as long as its DrawPipelines.
struct DrawPipeline {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
};

/// What becomes of a fragment that is nearer than what has been drawn so far.
enum class Surfaces : std::uint8_t {
    opaque,      ///< it takes the place of what is there
    translucent, ///< the fragment shader keeps it where it likes; colour and depth stay
};

/// All pipelines of a device. No vertex inputs, no descriptor sets: shaders take up to 128 bytes of push constants, seen by
/// both stages, and reach buffers by address. Triangles are seen from both sides.
///
/// Threads   one thread at a time
class DrawPipelines {
public:
    static constexpr std::uint32_t push_bytes = 128;
    static constexpr VkShaderStageFlags stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

    DrawPipelines(Context& context, const RenderPass& pass) : context_(context), pass_(pass) {}
    ~DrawPipelines();
    DrawPipelines(const DrawPipelines&) = delete;
    DrawPipelines& operator=(const DrawPipelines&) = delete;

    /// The pipeline of two shaders with these specialization constants (constant_id 0, 1, ..., the same for both), made when
    /// it is first asked for.
    ///
    /// Cost     5 to 500 ms the first time
    /// Errors   machine when the driver cannot build it; out_of_memory
    Result<const DrawPipeline*> get(const ShaderCode& vertex, const ShaderCode& fragment, Surfaces surfaces,
                                    std::span<const std::uint32_t> constants = {});

private:
    struct Made {
        const std::uint32_t *vertex, *fragment;
        std::vector<std::uint32_t> constants;
        DrawPipeline pipeline;
    };
    Result<void> make_layout();
    Result<VkShaderModule> module_of(const ShaderCode& code);
    Result<VkPipeline> build(VkShaderModule vertex, VkShaderModule fragment, Surfaces surfaces, std::span<const std::uint32_t> constants);

    Context& context_;
    const RenderPass& pass_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::list<Made> made_;
};

} // namespace isotet::vulkan
