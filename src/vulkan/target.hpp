// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Images on the device that are drawn into: colour in linear light, four half floats, and depth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/context.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::vulkan {

/// What a pass of draws finds in the images.
enum class Images : std::uint8_t {
    cleared, ///< colour transparent black, depth 1
    kept,    ///< what the pass before drew
};

/// The formats of a target, and what becomes of its images in a pass of draws: both are cleared or kept at the
/// beginning, and the colour can be copied afterwards. Its dependencies order one use of the images after the other, so
/// that are needed here alone.
class ISOTET_API RenderPass {
public:
    static Result<std::unique_ptr<RenderPass>> make(Context& context);
    ~RenderPass();
    RenderPass(const RenderPass&) = delete;
    RenderPass& operator=(const RenderPass&) = delete;

    /// Pipelines and framebuffers of one fit the other.
    VkRenderPass handle(Images images = Images::cleared) const noexcept {
        return handles_[static_cast<std::size_t>(images)];
    }

private:
    explicit RenderPass(LogicalDevice& device) : device_(device) {}
    Result<void> make(Images images);
    LogicalDevice& device_;
    std::array<VkRenderPass, 2> handles_{};
};

/// Threads   one thread at a time; not while the device draws into it
class ISOTET_API Target {
public:
    static constexpr std::uint64_t texel_bytes = 8; ///< of the colour
    static constexpr std::uint64_t bytes_of(std::uint64_t texels) { return texels * (texel_bytes + 4); }

    /// Its memory does not count against the limit on buffers.
    ///
    /// Errors   invalid_argument when the device has no images of that size; out_of_memory; machine
    static Result<std::unique_ptr<Target>> make(Context& context, const RenderPass& pass, std::uint32_t width,
                                                std::uint32_t height);
    ~Target();
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    std::uint32_t width() const noexcept { return width_; }
    std::uint32_t height() const noexcept { return height_; }

    /// Adds a pass that runs `draws` in the render pass, with the lower left `width` x `height` texels as the viewport.
    void draw(Recorder& recorder, Images images, std::uint32_t width, std::uint32_t height,
              const std::vector<Use>& uses, Recorder::Work draws);

    /// Adds a pass that copies these texels, row by row, to the beginning of a buffer.
    void copy_color(Recorder& recorder, std::uint32_t width, std::uint32_t height, const Buffer& to) const;

private:
    struct Image {
        VkImage handle = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
    };
    Target(Context& context, const RenderPass& pass, std::uint32_t width, std::uint32_t height)
        : context_(context), pass_(pass), width_(width), height_(height) {}
    Result<void> make_image(Image& image, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect);
    Result<void> make_framebuffer();

    Context& context_;
    const RenderPass& pass_;
    std::uint32_t width_, height_;
    Image color_, depth_;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

} // namespace isotet::vulkan
