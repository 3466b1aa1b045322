// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/kernels/null_device.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>

#include <dlfcn.h>
#include <fmt/core.h>

#include "vulkan/devices/float_controls.hpp"

namespace isotet::bench {

#define ISOTET_NULL_CALLS(X)                                                                                           \
    X(vkDestroyInstance)                                                                                               \
    X(vkDestroyDevice)                                                                                                 \
    X(vkCreatePipelineLayout)                                                                                          \
    X(vkDestroyPipelineLayout)                                                                                         \
    X(vkCreateShaderModule)                                                                                            \
    X(vkDestroyShaderModule)                                                                                           \
    X(vkCreateComputePipelines)                                                                                        \
    X(vkCreateGraphicsPipelines)                                                                                       \
    X(vkDestroyPipeline)                                                                                               \
    X(vkGetPipelineExecutablePropertiesKHR)                                                                            \
    X(vkGetPipelineExecutableStatisticsKHR)

struct NullDevice::Calls {
    vulkan::InstanceFunctions instance;
#define ISOTET_DECLARE(name) PFN_##name name = nullptr;
    ISOTET_NULL_CALLS(ISOTET_DECLARE)
#undef ISOTET_DECLARE
};

namespace {

Error no_device(std::string what) { return {ErrorCode::no_device, std::move(what)}; }

Error failed(const std::string& doing, VkResult result) {
    return no_device(fmt::format("{}: Vulkan error {}", doing, static_cast<int>(result)));
}

struct Driver {
    PFN_vkGetInstanceProcAddr find = nullptr;
};

/// The driver by itself, without the loader: a process may have other devices from that.
Result<Driver> open_driver(const std::string& driver) {
    void* library = dlopen(driver.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) return no_device(fmt::format("no driver: {}", dlerror()));
    auto* const find = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vk_icdGetInstanceProcAddr"));
    if (!find) return no_device(fmt::format("{} is no Vulkan driver", driver));
    return Driver{find};
}

void add_figure(Figures& figures, std::string_view name, std::uint64_t value) {
    const struct {
        std::string_view name;
        std::uint64_t Figures::* member;
    } known[] = {{"VGPRs", &Figures::vector_registers},
                 {"SGPRs", &Figures::scalar_registers},
                 {"Spilled VGPRs", &Figures::spilled_vectors},
                 {"Spilled SGPRs", &Figures::spilled_scalars},
                 {"Scratch size", &Figures::scratch_bytes},
                 {"LDS size", &Figures::shared_bytes},
                 {"Subgroups per SIMD", &Figures::waves},
                 {"Instructions", &Figures::instructions},
                 {"Latency", &Figures::latency},
                 {"Inverse Throughput", &Figures::inverse_throughput}};
    for (const auto& one : known)
        if (one.name == name) figures.*one.member = value;
}

double number_of(const VkPipelineExecutableStatisticKHR& one) {
    switch (one.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR: return static_cast<double>(one.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR: return one.value.f64;
    default: return static_cast<double>(one.value.u64);
    }
}

} // namespace

Result<std::string> driver_beside_software_device() {
    const char* const files = std::getenv("VK_DRIVER_FILES");
    if (!files) return no_device("VK_DRIVER_FILES is not set: source build/test/mesa/env.sh first");
    std::ifstream file{std::string(files)};
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    constexpr std::string_view key = "\"library_path\": \"", software = "libvulkan_lvp.so";
    const std::size_t begin = text.find(key), end = text.find(software);
    if (begin == std::string::npos || end == std::string::npos)
        return no_device(fmt::format("{} does not name {}", files, software));
    return text.substr(begin + key.size(), end - begin - key.size()) + "libvulkan_radeon.so";
}

Result<std::unique_ptr<NullDevice>> NullDevice::open(const std::string& driver, const std::string& family) {
    setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
    Result<std::unique_ptr<NullDevice>> null = open(driver);
    if (!null) return no_device(fmt::format("{}: {}", family, null.error().message));
    return null;
}

Result<std::unique_ptr<NullDevice>> NullDevice::open(const std::string& driver) {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    std::unique_ptr<NullDevice> null(new NullDevice);
    null->call_ = std::make_unique<Calls>();
    if (Result<void> made = null->make_instance(driver); !made) return made.error();
    if (Result<void> found = null->find_device(); !found) return found.error();
    if (Result<void> made = null->make_device(); !made) return made.error();
    if (Result<void> made = null->make_layout(); !made) return made.error();
    return null;
}

Result<void> NullDevice::make_instance(const std::string& driver) {
    const Result<Driver> opened = open_driver(driver);
    if (!opened) return opened.error();
    const auto find = opened->find;
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pApplicationInfo = &application;
    const auto make = reinterpret_cast<PFN_vkCreateInstance>(find(VK_NULL_HANDLE, "vkCreateInstance"));
    if (const VkResult made = make(&create, nullptr, &instance_); made != VK_SUCCESS)
        return failed("starting the driver", made);
#define ISOTET_FIND(name)                                                                                              \
    call_->name = reinterpret_cast<PFN_##name>(find(instance_, #name));                                                \
    if (!call_->name) return no_device("the driver lacks " #name);
    ISOTET_NULL_CALLS(ISOTET_FIND)
#undef ISOTET_FIND
#define ISOTET_FIND(name) call_->instance.name = reinterpret_cast<PFN_##name>(find(instance_, #name));
    ISOTET_VULKAN_INSTANCE_FUNCTIONS(ISOTET_FIND)
#undef ISOTET_FIND
    return {};
}

Result<void> NullDevice::find_device() {
    std::uint32_t count = 1;
    const VkResult found = call_->instance.vkEnumeratePhysicalDevices(instance_, &count, &physical_);
    if (found != VK_SUCCESS || count != 1) return failed("looking for the device", found);
    capabilities_ = vulkan::ask(call_->instance, physical_, vulkan::whole_version);
    return {};
}

Result<void> NullDevice::make_device() {
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR figures{};
    figures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
    figures.pipelineExecutableInfo = VK_TRUE;
    VkPhysicalDeviceDynamicRenderingFeatures rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES;
    rendering.pNext = &figures;
    rendering.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceBufferDeviceAddressFeatures addresses{};
    addresses.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
    addresses.pNext = &rendering;
    addresses.bufferDeviceAddress = VK_TRUE;
    VkPhysicalDeviceScalarBlockLayoutFeatures layout{};
    layout.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES;
    layout.pNext = &addresses;
    layout.scalarBlockLayout = VK_TRUE;
    VkPhysicalDeviceMeshShaderFeaturesEXT mesh{};
    mesh.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MESH_SHADER_FEATURES_EXT;
    mesh.meshShader = VK_TRUE;
    if (capabilities_.mesh_shaders) figures.pNext = &mesh;
    VkPhysicalDeviceFeatures features{};
    features.fragmentStoresAndAtomics = capabilities_.features.fragmentStoresAndAtomics;
    features.shaderFloat64 = capabilities_.features.shaderFloat64;
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    std::vector<const char*> extensions = capabilities_.extensions;
    extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    VkDeviceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    create.pNext = &layout;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    create.pEnabledFeatures = &features;
    if (const VkResult made = call_->instance.vkCreateDevice(physical_, &create, nullptr, &device_); made != VK_SUCCESS)
        return failed("opening the device", made);
    return {};
}

Result<void> NullDevice::make_layout() {
    const VkPushConstantRange push{VK_SHADER_STAGE_ALL, 0, 128};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    if (const VkResult made = call_->vkCreatePipelineLayout(device_, &layout, nullptr, &layout_); made != VK_SUCCESS)
        return failed("making a pipeline layout", made);
    return {};
}

NullDevice::~NullDevice() {
    if (layout_) call_->vkDestroyPipelineLayout(device_, layout_, nullptr);
    if (device_) call_->vkDestroyDevice(device_, nullptr);
    if (instance_ && call_->vkDestroyInstance) call_->vkDestroyInstance(instance_, nullptr);
}

bool NullDevice::takes(const Pipeline& pipeline) const {
    if (pipeline.draws() && !vulkan::why_unable_to_draw(capabilities_).empty()) return false;
    constexpr std::uint32_t op_capability = 17, float64 = 10; // numbers of the SPIR-V specification
    const std::span<const std::uint32_t> words = pipeline.stages.front().code->words;
    for (std::size_t i = 5; i + 1 < words.size() && (words[i] & 0xffff) == op_capability; i += words[i] >> 16)
        if (words[i + 1] == float64 && !capabilities_.features.shaderFloat64) return false;
    if (pipeline.name == "volume_rays_without_doubles" && capabilities_.features.shaderFloat64) return false;
    return capabilities_.mesh_shaders || pipeline.stages.front().stage != VK_SHADER_STAGE_MESH_BIT_EXT;
}

Result<std::vector<Figures>> NullDevice::compile(const Pipeline& pipeline) {
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < pipeline.constants.size(); ++i) entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              pipeline.constants.size() * 4, pipeline.constants.data()};
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    VkResult result = VK_SUCCESS;
    const vulkan::FloatControls controls{capabilities_.floats.shaderRoundingModeRTEFloat32 == VK_TRUE,
                                         capabilities_.floats.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE};
    for (const Stage& stage : pipeline.stages) {
        const std::vector<std::uint32_t> words = pipeline.draws()
                                                     ? std::vector(stage.code->words.begin(), stage.code->words.end())
                                                     : vulkan::with_float_controls(stage.code->words, controls);
        VkShaderModuleCreateInfo create{};
        create.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        create.codeSize = words.size() * 4;
        create.pCode = words.data();
        VkPipelineShaderStageCreateInfo& one = stages.emplace_back();
        one.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        one.stage = stage.stage;
        one.pName = "main";
        one.pSpecializationInfo = &specialization;
        if (result == VK_SUCCESS) result = call_->vkCreateShaderModule(device_, &create, nullptr, &one.module);
    }
    const Result<VkPipeline> made = result == VK_SUCCESS
                                        ? build(pipeline, stages)
                                        : failed(fmt::format("making the module {}", pipeline.name), result);
    for (const auto& stage : stages) call_->vkDestroyShaderModule(device_, stage.module, nullptr);
    if (!made) return made.error();
    Result<std::vector<Figures>> figures = figures_of(pipeline, *made);
    call_->vkDestroyPipeline(device_, *made, nullptr);
    return figures;
}

Result<VkPipeline> NullDevice::build(const Pipeline& pipeline,
                                     const std::vector<VkPipelineShaderStageCreateInfo>& stages) {
    if (pipeline.draws()) return build_drawing(pipeline, stages);
    VkComputePipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    create.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    create.stage = stages.front();
    create.layout = layout_;
    VkPipeline made = VK_NULL_HANDLE;
    const VkResult result = call_->vkCreateComputePipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &made);
    if (result != VK_SUCCESS) return failed(fmt::format("compiling {} ({})", pipeline.name, pipeline.variant), result);
    return made;
}

Result<VkPipeline> NullDevice::build_drawing(const Pipeline& pipeline,
                                             const std::vector<VkPipelineShaderStageCreateInfo>& stages) {
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
    rasterization.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = pipeline.opaque;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState blend{};
    if (pipeline.opaque) blend.colorWriteMask = 15;
    VkPipelineColorBlendStateCreateInfo blending{};
    blending.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blending.attachmentCount = 1;
    blending.pAttachments = &blend;
    const VkDynamicState set_later[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = set_later;
    const VkFormat color = VK_FORMAT_R16G16B16A16_SFLOAT; // as vulkan/target.cpp
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &color;
    rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;

    VkGraphicsPipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    create.pNext = &rendering;
    create.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    create.stageCount = static_cast<std::uint32_t>(stages.size());
    create.pStages = stages.data();
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &rasterization;
    create.pMultisampleState = &samples;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blending;
    create.pDynamicState = &dynamic;
    create.layout = layout_;
    VkPipeline made = VK_NULL_HANDLE;
    const VkResult result = call_->vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &create, nullptr, &made);
    if (result != VK_SUCCESS) return failed(fmt::format("compiling {} ({})", pipeline.name, pipeline.variant), result);
    return made;
}

Result<std::vector<Figures>> NullDevice::figures_of(const Pipeline& pipeline, VkPipeline made) {
    VkPipelineInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    info.pipeline = made;
    std::uint32_t count = 0;
    call_->vkGetPipelineExecutablePropertiesKHR(device_, &info, &count, nullptr);
    VkPipelineExecutablePropertiesKHR no_properties{};
    no_properties.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    std::vector<VkPipelineExecutablePropertiesKHR> executables(count, no_properties);
    call_->vkGetPipelineExecutablePropertiesKHR(device_, &info, &count, executables.data());
    std::vector<Figures> all;
    for (std::uint32_t i = 0; i < count; ++i) {
        Figures& figures = all.emplace_back();
        for (const Stage& stage : pipeline.stages)
            if (executables[i].stages & stage.stage) figures.code = stage.code;
        VkPipelineExecutableInfoKHR which{};
        which.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
        which.pipeline = made;
        which.executableIndex = i;
        std::uint32_t found = 0;
        call_->vkGetPipelineExecutableStatisticsKHR(device_, &which, &found, nullptr);
        VkPipelineExecutableStatisticKHR nothing{};
        nothing.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
        std::vector<VkPipelineExecutableStatisticKHR> statistics(found, nothing);
        call_->vkGetPipelineExecutableStatisticsKHR(device_, &which, &found, statistics.data());
        figures.subgroup = executables[i].subgroupSize;
        for (const auto& one : statistics) {
            add_figure(figures, one.name, one.value.u64);
            figures.all.emplace_back(one.name, number_of(one));
        }
    }
    if (all.size() < pipeline.stages.size() || all.front().all.empty())
        return no_device(fmt::format("the driver tells nothing about {}", pipeline.name));
    return all;
}

} // namespace isotet::bench
