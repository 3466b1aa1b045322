// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing one part of a picture: images, lists of translucent fragments, samples averaged to pixels, pixels read back.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <isotet/render.hpp>

#include "render/device/draws.hpp"
#include "render/device/view.hpp"
#include "vulkan/draw_pipelines.hpp"
#include "vulkan/recorder.hpp"
#include "vulkan/target.hpp"

namespace isotet::render {

/// Images and buffers, kept from one picture to the next and made anew only when they are too small.
///
/// Threads   one call at a time
class Frame {
public:
    static Result<std::unique_ptr<Frame>> make(std::shared_ptr<vulkan::Context> context);

    vulkan::Context& context() noexcept { return *context_; }
    vulkan::DrawPipelines& pipelines() noexcept { return pipelines_; }

    /// How large parts of a picture may be: as many samples as memory is meant for, no more an axis than images have.
    static constexpr std::uint64_t max_samples = std::uint64_t{1} << 24;
    std::uint32_t max_samples_per_axis() const;

    /// The index buffer that all pages of tets are drawn with, made when it is first asked for.
    Result<const vulkan::Buffer*> quad_corners();

    /// Draws a part and puts its pixels into the picture. Adds to `work`.
    ///
    /// `view`   what Space::look() and the options say; addresses are filled in here
    Result<void> draw(const Draws& draws, layout::View view, const Part& part, Picture& picture, DeviceWork& work);

private:
    Frame(std::shared_ptr<vulkan::Context> context, std::unique_ptr<vulkan::RenderPass> pass);
    Result<void> make_room(const layout::View& view, const std::vector<DrawStep>& steps);
    Result<void> make_parameters(const layout::View& view, const std::vector<DrawStep>& steps);
    void fill_addresses(layout::View& view) const;
    void record(vulkan::Recorder& recorder, const layout::View& view, const std::vector<DrawStep>& steps,
                const vulkan::Kernel& resolve);
    void record_draws(vulkan::Recorder& recorder, const layout::View& view, std::span<const DrawStep> steps,
                      vulkan::Images images);
    Result<bool> fragments_fit(std::uint32_t room);
    Result<void> fetch(const Part& part, Picture& picture);

    std::shared_ptr<vulkan::Context> context_; ///< before all that needs it
    std::unique_ptr<vulkan::RenderPass> pass_;
    vulkan::DrawPipelines pipelines_;
    std::unique_ptr<vulkan::Target> target_;
    vulkan::Buffer colors_, heads_, fragments_, pixels_, parameters_, quad_corners_;
    std::uint32_t fragment_room_ = 0;
};

} // namespace isotet::render
