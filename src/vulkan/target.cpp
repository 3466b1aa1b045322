// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/target.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

#include "base/system/memory.hpp"
#include "vulkan/devices/failure.hpp"

namespace isotet::vulkan {

namespace {

// Every device can draw into the one, and every known device into the other.
constexpr VkFormat color_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

constexpr VkPipelineStageFlags depth_stages =
    VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags attachment_writes =
    VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

VkAttachmentDescription attachment(VkFormat format, Images images, VkImageLayout final) {
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = images == Images::kept ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    description.initialLayout = images == Images::kept ? final : VK_IMAGE_LAYOUT_UNDEFINED;
    description.finalLayout = final;
    return description;
}

} // namespace

Result<std::unique_ptr<RenderPass>> RenderPass::make(Context& context) {
    std::unique_ptr<RenderPass> pass(new RenderPass(context.device()));
    if (Result<void> lives = context.device().alive(); !lives) return lives.error();
    for (const Images images : {Images::cleared, Images::kept})
        if (Result<void> made = pass->make(images); !made) return made.error();
    return pass;
}

Result<void> RenderPass::make(Images images) {
    const std::array<VkAttachmentDescription, 2> attachments = {
        attachment(color_format, images, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
        attachment(depth_format, images, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color;
    subpass.pDepthStencilAttachment = &depth;
    const VkPipelineStageFlags attachment_stages = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | depth_stages;
    std::array<VkSubpassDependency, 2> dependencies{};
    // What was drawn before has been copied, and its depth is done with.
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT | attachment_stages;
    dependencies[0].dstStageMask = attachment_stages;
    dependencies[0].srcAccessMask = attachment_writes;
    dependencies[0].dstAccessMask =
        attachment_writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    // What is drawn can be copied.
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    create.attachmentCount = 2;
    create.pAttachments = attachments.data();
    create.subpassCount = 1;
    create.pSubpasses = &subpass;
    create.dependencyCount = 2;
    create.pDependencies = dependencies.data();

    VkRenderPass& handle = handles_[static_cast<std::size_t>(images)];
    if (const VkResult made = device_.call().vkCreateRenderPass(device_.handle(), &create, nullptr, &handle);
        made != VK_SUCCESS) {
        handle = VK_NULL_HANDLE;
        return failure("making a render pass", made);
    }
    return {};
}

RenderPass::~RenderPass() {
    for (const VkRenderPass handle : handles_)
        if (handle && !device_.hung()) device_.call().vkDestroyRenderPass(device_.handle(), handle, nullptr);
}

Result<std::unique_ptr<Target>> Target::make(Context& context, const RenderPass& pass, std::uint32_t width,
                                             std::uint32_t height) {
    const VkPhysicalDeviceLimits& limits = context.capabilities().properties.limits;
    const std::uint32_t widest = std::min(limits.maxImageDimension2D, limits.maxFramebufferWidth);
    const std::uint32_t highest = std::min(limits.maxImageDimension2D, limits.maxFramebufferHeight);
    if (width == 0 || height == 0 || width > widest || height > highest) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("an image of {} x {}, but the device has images of 1 x 1 to {} x {}", width, height,
                                 widest, highest)};
    }
    if (Result<void> lives = context.device().alive(); !lives) return lives.error();
    std::unique_ptr<Target> target(new Target(context, pass, width, height));
    Result<void> made = target->make_image(target->color_, color_format,
                                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                           VK_IMAGE_ASPECT_COLOR_BIT);
    if (made)
        made = target->make_image(target->depth_, depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                                  VK_IMAGE_ASPECT_DEPTH_BIT);
    if (made) made = target->make_framebuffer();
    if (!made) return made.error();
    return target;
}

Result<void> Target::make_image(Image& image, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
    LogicalDevice& device = context_.device();
    const DeviceFunctions& call = device.call();
    const std::string doing = fmt::format("making an image of {} x {}", width_, height_);
    VkImageCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = format;
    create.extent = {width_, height_, 1};
    create.mipLevels = 1;
    create.arrayLayers = 1;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.tiling = VK_IMAGE_TILING_OPTIMAL;
    create.usage = usage;
    if (const VkResult made = call.vkCreateImage(device.handle(), &create, nullptr, &image.handle);
        made != VK_SUCCESS) {
        image.handle = VK_NULL_HANDLE;
        return failure(doing, made);
    }
    VkMemoryRequirements needs{};
    call.vkGetImageMemoryRequirements(device.handle(), image.handle, &needs);
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = device_memory_type(context_.capabilities(), needs.memoryTypeBits);
    if (allocate.memoryTypeIndex == Capabilities::none)
        return Error{ErrorCode::no_device,
                     fmt::format("the driver allows images in the memory types {:#b} alone, and none of them is plain "
                                 "memory",
                                 needs.memoryTypeBits)};
    if (const VkResult made = call.vkAllocateMemory(device.handle(), &allocate, nullptr, &image.memory);
        made != VK_SUCCESS) {
        image.memory = VK_NULL_HANDLE;
        return failure(fmt::format("allocating {} on the device for an image", core::format_bytes(needs.size)), made);
    }
    if (const VkResult bound = call.vkBindImageMemory(device.handle(), image.handle, image.memory, 0);
        bound != VK_SUCCESS)
        return failure(doing, bound);
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image.handle;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    if (const VkResult made = call.vkCreateImageView(device.handle(), &view, nullptr, &image.view);
        made != VK_SUCCESS) {
        image.view = VK_NULL_HANDLE;
        return failure(doing, made);
    }
    return {};
}

Result<void> Target::make_framebuffer() {
    LogicalDevice& device = context_.device();
    const std::array<VkImageView, 2> views = {color_.view, depth_.view};
    VkFramebufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    create.renderPass = pass_.handle();
    create.attachmentCount = 2;
    create.pAttachments = views.data();
    create.width = width_;
    create.height = height_;
    create.layers = 1;
    if (const VkResult made = device.call().vkCreateFramebuffer(device.handle(), &create, nullptr, &framebuffer_);
        made != VK_SUCCESS) {
        framebuffer_ = VK_NULL_HANDLE;
        return failure("making a framebuffer", made);
    }
    return {};
}

Target::~Target() {
    LogicalDevice& device = context_.device();
    if (device.hung()) return;
    const DeviceFunctions& call = device.call();
    if (framebuffer_) call.vkDestroyFramebuffer(device.handle(), framebuffer_, nullptr);
    for (const Image& image : {color_, depth_}) {
        if (image.view) call.vkDestroyImageView(device.handle(), image.view, nullptr);
        if (image.handle) call.vkDestroyImage(device.handle(), image.handle, nullptr);
        if (image.memory) call.vkFreeMemory(device.handle(), image.memory, nullptr);
    }
}

void Target::draw(Recorder& recorder, Images images, std::uint32_t width, std::uint32_t height,
                  const std::vector<Use>& uses, Recorder::Work draws) {
    recorder.add_work(
        "draw", uses,
        [this, images, width, height, draws = std::move(draws)](const DeviceFunctions& call, VkCommandBuffer commands) {
            std::array<VkClearValue, 2> clear{};
            clear[1].depthStencil.depth = 1;
            VkRenderPassBeginInfo begin{};
            begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
            begin.renderPass = pass_.handle(images);
            begin.framebuffer = framebuffer_;
            begin.renderArea = {{0, 0}, {width, height}};
            begin.clearValueCount = 2;
            begin.pClearValues = clear.data();
            call.vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
            const VkViewport viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
            call.vkCmdSetViewport(commands, 0, 1, &viewport);
            call.vkCmdSetScissor(commands, 0, 1, &begin.renderArea);
            draws(call, commands);
            call.vkCmdEndRenderPass(commands);
        });
}

void Target::copy_color(Recorder& recorder, std::uint32_t width, std::uint32_t height, const Buffer& to) const {
    recorder.add_work("copy", {copies_into(to)},
                      [this, width, height, to = to.handle()](const DeviceFunctions& call, VkCommandBuffer commands) {
                          VkBufferImageCopy region{};
                          region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
                          region.imageExtent = {width, height, 1};
                          call.vkCmdCopyImageToBuffer(commands, color_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                                                      1, &region);
                      });
}

} // namespace isotet::vulkan
