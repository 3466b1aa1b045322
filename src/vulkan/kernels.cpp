// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/kernels.hpp"

#include <algorithm>

#include <fmt/core.h>

#include "vulkan/devices/failure.hpp"
#include "vulkan/devices/float_controls.hpp"

namespace isotet::vulkan {

Kernels::Kernels(LogicalDevice& device, const Capabilities& capabilities, PipelineCache& cache)
    : device_(device),
      cache_(cache),
      controls_{capabilities.floats.shaderRoundingModeRTEFloat32 == VK_TRUE,
                capabilities.floats.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE} {}

Kernels::~Kernels() {
    if (device_.hung()) return;
    for (const Made& made : made_) device_.call().vkDestroyPipeline(device_.handle(), made.kernel.pipeline, nullptr);
    if (layout_) device_.call().vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
}

Result<void> Kernels::make_layout() {
    if (layout_) return {};
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    const VkResult made = device_.call().vkCreatePipelineLayout(device_.handle(), &layout, nullptr, &layout_);
    if (made == VK_SUCCESS) return {};
    layout_ = VK_NULL_HANDLE;
    return failure("making a pipeline layout", made);
}

Result<const Kernel*> Kernels::get(const ShaderCode& code, std::span<const std::uint32_t> constants) {
    for (const Made& made : made_)
        if (made.code == code.words.data() && std::ranges::equal(made.constants, constants)) return &made.kernel;
    if (Result<void> lives = device_.alive(); !lives) return lives.error();
    if (Result<void> made = make_layout(); !made) return made.error();
    Result<VkPipeline> pipeline = build(code, constants);
    if (!pipeline) return pipeline.error();
    cache_.note_new_pipeline();
    device_.name(VK_OBJECT_TYPE_PIPELINE, *pipeline, code.name);
    made_.push_back({code.words.data(), {constants.begin(), constants.end()}, {code.name, *pipeline, layout_}});
    return &made_.back().kernel;
}

Result<VkPipeline> Kernels::build(const ShaderCode& code, std::span<const std::uint32_t> constants) {
    const DeviceFunctions& call = device_.call();
    const std::string doing = fmt::format("building the kernel '{}'", code.name);
    const std::vector<std::uint32_t> words = with_float_controls(code.words, controls_);
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = words.size() * sizeof(std::uint32_t);
    module_info.pCode = words.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    if (const VkResult made = call.vkCreateShaderModule(device_.handle(), &module_info, nullptr, &shader);
        made != VK_SUCCESS)
        return failure(doing, made);

    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data()};
    VkComputePipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    create.stage.module = shader;
    create.stage.pName = "main";
    create.stage.pSpecializationInfo = &specialization;
    create.layout = layout_;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult made =
        call.vkCreateComputePipelines(device_.handle(), cache_.handle(), 1, &create, nullptr, &pipeline);
    call.vkDestroyShaderModule(device_.handle(), shader, nullptr);
    if (made != VK_SUCCESS) return failure(doing, made);
    return pipeline;
}

} // namespace isotet::vulkan
