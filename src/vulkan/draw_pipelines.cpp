// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/draw_pipelines.hpp"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include "vulkan/devices/failure.hpp"

namespace isotet::vulkan {

DrawPipelines::DrawPipelines(Context& context, const RenderPass& pass)
    : context_(context),
      pass_(pass),
      stages_(VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT |
              (context.capabilities().mesh_shaders ? VK_SHADER_STAGE_MESH_BIT_EXT : 0)) {}

DrawPipelines::~DrawPipelines() {
    LogicalDevice& device = context_.device();
    if (device.hung()) return;
    for (const Made& made : made_) device.call().vkDestroyPipeline(device.handle(), made.pipeline.pipeline, nullptr);
    if (layout_) device.call().vkDestroyPipelineLayout(device.handle(), layout_, nullptr);
}

Result<void> DrawPipelines::make_layout() {
    if (layout_) return {};
    const VkPushConstantRange push{stages_, 0, push_bytes};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    LogicalDevice& device = context_.device();
    const VkResult made = device.call().vkCreatePipelineLayout(device.handle(), &layout, nullptr, &layout_);
    if (made == VK_SUCCESS) return {};
    layout_ = VK_NULL_HANDLE;
    return failure("making a pipeline layout", made);
}

Result<VkShaderModule> DrawPipelines::module_of(const ShaderCode& code) {
    VkShaderModuleCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    create.codeSize = code.words.size_bytes();
    create.pCode = code.words.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    LogicalDevice& device = context_.device();
    if (const VkResult made = device.call().vkCreateShaderModule(device.handle(), &create, nullptr, &shader);
        made != VK_SUCCESS)
        return failure(fmt::format("building the shader '{}'", code.name), made);
    return shader;
}

Result<const DrawPipeline*> DrawPipelines::get(const ShaderCode& first, const ShaderCode& fragment, Surfaces surfaces,
                                               std::span<const std::uint32_t> constants, FirstStage stage) {
    for (const Made& made : made_) {
        if (made.first == first.words.data() && made.fragment == fragment.words.data() &&
            std::ranges::equal(made.constants, constants))
            return &made.pipeline;
    }
    LogicalDevice& device = context_.device();
    if (Result<void> lives = device.alive(); !lives) return lives.error();
    if (Result<void> made = make_layout(); !made) return made.error();
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data()};
    std::array<VkPipelineShaderStageCreateInfo, 2> shaders{};
    for (VkPipelineShaderStageCreateInfo& shader : shaders) {
        shader.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        shader.pName = "main";
        shader.pSpecializationInfo = &specialization;
    }
    shaders[0].stage = stage == FirstStage::mesh ? VK_SHADER_STAGE_MESH_BIT_EXT : VK_SHADER_STAGE_VERTEX_BIT;
    shaders[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    const Result<VkShaderModule> one = module_of(first);
    if (!one) return one.error();
    const Result<VkShaderModule> other = module_of(fragment);
    shaders[0].module = *one;
    if (other) shaders[1].module = *other;
    const Result<VkPipeline> pipeline = other ? build(shaders, surfaces) : other.error();
    device.call().vkDestroyShaderModule(device.handle(), *one, nullptr);
    if (other) device.call().vkDestroyShaderModule(device.handle(), *other, nullptr);
    if (!pipeline) return pipeline.error();
    device.name(VK_OBJECT_TYPE_PIPELINE, *pipeline, fragment.name);
    made_.push_back({first.words.data(),
                     fragment.words.data(),
                     {constants.begin(), constants.end()},
                     {*pipeline, layout_, stages_}});
    return &made_.back().pipeline;
}

Result<VkPipeline> DrawPipelines::build(std::span<const VkPipelineShaderStageCreateInfo> shaders, Surfaces surfaces) {
    // Mesh shaders make their own triangles: these two then mean nothing.
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo rasterization{};
    rasterization.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    rasterization.polygonMode = VK_POLYGON_MODE_FILL;
    rasterization.cullMode = VK_CULL_MODE_NONE;
    rasterization.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const bool opaque = surfaces == Surfaces::opaque;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = opaque;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState blend{};
    if (opaque)
        blend.colorWriteMask =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blending{};
    blending.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blending.attachmentCount = 1;
    blending.pAttachments = &blend;
    const std::array<VkDynamicState, 2> set_later = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = set_later.data();

    VkGraphicsPipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    create.stageCount = static_cast<std::uint32_t>(shaders.size());
    create.pStages = shaders.data();
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &rasterization;
    create.pMultisampleState = &samples;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blending;
    create.pDynamicState = &dynamic;
    create.layout = layout_;
    create.renderPass = pass_.handle();
    VkPipeline pipeline = VK_NULL_HANDLE;
    LogicalDevice& device = context_.device();
    const VkResult made = device.call().vkCreateGraphicsPipelines(device.handle(), context_.pipeline_cache().handle(),
                                                                  1, &create, nullptr, &pipeline);
    if (made != VK_SUCCESS) return failure("building a pipeline that draws", made);
    return pipeline;
}

} // namespace isotet::vulkan
