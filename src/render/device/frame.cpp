// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/frame.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "render_shaders.hpp"

namespace isotet::render {

namespace {

using vulkan::Buffer;
using vulkan::Recorder;
using vulkan::Use;

constexpr std::uint64_t color_bytes = vulkan::Target::texel_bytes, word = 4;

std::uint64_t pixels_of(const layout::View& view) { return std::uint64_t{view.width} * view.height; }
std::uint64_t samples_of(const layout::View& view) { return pixels_of(view) * view.samples * view.samples; }

/// Of the view and all items, which stand one after another in one buffer.
std::uint64_t parameter_bytes(const std::vector<DrawStep>& steps) {
    return steps.empty() ? sizeof(layout::View) : steps.back().at + steps.back().item.size();
}

bool any_translucent(const std::vector<DrawStep>& steps) { return std::ranges::any_of(steps, &DrawStep::translucent); }

/// Adds what a run took: passes of one name together.
void add_timings(DeviceWork& work, const vulkan::Timings& timings) {
    for (const vulkan::Timing& timing : timings.passes) {
        const auto found = std::ranges::find(work.passes, timing.pass, &DevicePass::name);
        if (found != work.passes.end()) found->seconds += timing.seconds;
        else work.passes.push_back({timing.pass, timing.seconds});
    }
    work.device_seconds += timings.device_seconds;
    work.waited_seconds += timings.waited_seconds;
    ++work.submissions;
}

} // namespace

Frame::Frame(std::shared_ptr<vulkan::Context> context, std::unique_ptr<vulkan::RenderPass> pass)
    : context_(std::move(context)), pass_(std::move(pass)), pipelines_(*context_, *pass_) {}

Result<std::unique_ptr<Frame>> Frame::make(std::shared_ptr<vulkan::Context> context) {
    if (const std::string why = vulkan::why_unable_to_draw(context->capabilities()); !why.empty())
        return Error{ErrorCode::no_device, fmt::format("the device {} cannot draw: {}", context->info().name, why)};
    Result<std::unique_ptr<vulkan::RenderPass>> pass = vulkan::RenderPass::make(*context);
    if (!pass) return pass.error();
    return std::unique_ptr<Frame>(new Frame(std::move(context), *std::move(pass)));
}

std::uint32_t Frame::max_samples_per_axis() const {
    const VkPhysicalDeviceLimits& limits = context_->capabilities().properties.limits;
    return std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxFramebufferHeight,
                     limits.maxViewportDimensions[0], limits.maxViewportDimensions[1]});
}

Result<const Buffer*> Frame::quad_corners() {
    if (!quad_corners_) {
        Result<Buffer> made = make_quad_corners(*context_);
        if (!made) return made.error();
        quad_corners_ = *std::move(made);
    }
    return &quad_corners_;
}

Result<void> Frame::make_room(const layout::View& view, const std::vector<DrawStep>& steps) {
    const std::uint32_t width = view.width * view.samples, height = view.height * view.samples;
    if (!target_ || target_->width() < width || target_->height() < height) {
        target_.reset();
        auto target = vulkan::Target::make(*context_, *pass_, width, height);
        if (!target) return target.error();
        target_ = *std::move(target);
    }
    const auto room_for = [&](Buffer& buffer, std::uint64_t bytes, const char* name) -> Result<void> {
        if (buffer && buffer.size() >= bytes) return {};
        buffer = {};
        Result<Buffer> taken = context_->memory().take(bytes, vulkan::Where::device, name);
        if (!taken) return taken.error();
        buffer = *std::move(taken);
        return {};
    };
    Result<void> made = room_for(colors_, samples_of(view) * color_bytes, "samples of the picture");
    if (made) made = room_for(pixels_, pixels_of(view) * word, "pixels of the picture");
    if (made) made = room_for(parameters_, parameter_bytes(steps), "what is drawn");
    if (!made || !any_translucent(steps)) return made;
    // One fragment a sample is a guess: where there are more, they are counted, and drawn again.
    if (fragment_room_ == 0) fragment_room_ = static_cast<std::uint32_t>(samples_of(view));
    made = room_for(heads_, samples_of(view) * word, "lists of translucent fragments");
    if (made)
        made = room_for(fragments_,
                        sizeof(layout::FragmentList) + sizeof(layout::Fragment) * std::uint64_t{fragment_room_},
                        "translucent fragments");
    return made;
}

void Frame::fill_addresses(layout::View& view) const {
    view.fragment_room = heads_ ? fragment_room_ : 0;
    view.colors = vulkan::address_of(colors_);
    view.heads = vulkan::address_of(heads_);
    view.fragments = vulkan::address_of(fragments_);
    view.pixels = vulkan::address_of(pixels_);
}

Result<void> Frame::make_parameters(const layout::View& view, const std::vector<DrawStep>& steps) {
    std::vector<std::byte> bytes(parameter_bytes(steps));
    std::memcpy(bytes.data(), &view, sizeof view);
    for (const DrawStep& step : steps)
        std::ranges::copy(step.item, bytes.begin() + static_cast<std::ptrdiff_t>(step.at));
    return context_->staging().upload(parameters_, 0, bytes);
}

/// Adds one pass of draws.
void Frame::record_draws(Recorder& recorder, const layout::View& view, std::span<const DrawStep> steps,
                         vulkan::Images images) {
    std::vector<Use> uses{vulkan::draws_from(parameters_)};
    for (const DrawStep& step : steps)
        for (const Use& use : step.uses) uses.push_back(use);
    if (view.fragment_room > 0) {
        uses.push_back(vulkan::draws_into(heads_));
        uses.push_back(vulkan::draws_into(fragments_));
    }
    const auto draw = [this, steps](const vulkan::DeviceFunctions& call, VkCommandBuffer commands) {
        for (const DrawStep& step : steps)
            step.record({vulkan::address_of(parameters_), vulkan::address_of(parameters_, step.at)}, call, commands);
    };
    target_->draw(recorder, images, view.width * view.samples, view.height * view.samples, uses, draw);
}

void Frame::record(Recorder& recorder, const layout::View& view, const std::vector<DrawStep>& steps,
                   const vulkan::Kernel& resolve) {
    const bool translucent = view.fragment_room > 0;
    if (translucent) {
        recorder.fill(heads_, 0, samples_of(view) * word, 0);
        recorder.fill(fragments_, 0, sizeof(layout::FragmentList), 0);
    }
    // Nothing can be copied within a pass of draws: one ends, and another begins, where a page has to be sent.
    vulkan::Images images = vulkan::Images::cleared;
    std::size_t begin = 0;
    do {
        if (begin < steps.size() && steps[begin].from) {
            recorder.label("send");
            recorder.copy(*steps[begin].from, 0, *steps[begin].to, 0, steps[begin].from->size());
            recorder.label("");
        }
        std::size_t end = std::min(begin + 1, steps.size());
        while (end < steps.size() && !steps[end].from) ++end;
        record_draws(recorder, view, std::span(steps).subspan(begin, end - begin), images);
        images = vulkan::Images::kept;
        begin = end;
    } while (begin < steps.size());
    target_->copy_color(recorder, view.width * view.samples, view.height * view.samples, colors_);
    std::vector<Use> resolved{vulkan::reads(parameters_), vulkan::reads(colors_), vulkan::writes(pixels_)};
    if (translucent) {
        resolved.push_back(vulkan::reads(heads_));
        resolved.push_back(vulkan::reads(fragments_));
    }
    const std::uint64_t groups = (pixels_of(view) + layout::resolve_size - 1) / layout::resolve_size;
    recorder.dispatch(resolve, layout::ResolvePush{vulkan::address_of(parameters_)}, groups, resolved);
}

/// Whether there was room for all fragments; if not, there is next time.
Result<bool> Frame::fragments_fit(std::uint32_t room) {
    layout::FragmentList list{};
    if (Result<void> done = context_->staging().download(fragments_, 0, std::as_writable_bytes(std::span(&list, 1)));
        !done)
        return done.error();
    if (list.count <= room) return true;
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() - 1;
    fragment_room_ = static_cast<std::uint32_t>(std::min(std::uint64_t{list.count} + list.count / 8, most));
    return false;
}

Result<void> Frame::fetch(const Part& part, Picture& picture) {
    std::vector<std::array<std::uint8_t, 4>> pixels(std::size_t{part.width} * part.height);
    if (Result<void> done = context_->staging().download(pixels_, 0, std::as_writable_bytes(std::span(pixels))); !done)
        return done;
    for (std::uint32_t row = 0; row < part.height; ++row) {
        const auto from = pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * part.width);
        std::copy(from, from + part.width,
                  picture.pixels.begin() +
                      static_cast<std::ptrdiff_t>(std::size_t{part.y + row} * picture.width + part.x));
    }
    return {};
}

Result<void> Frame::draw(const Draws& draws, layout::View view, const Part& part, Picture& picture, DeviceWork& work) {
    const Result<const vulkan::Kernel*> resolve = context_->kernels().get(vulkan::drawing::resolve);
    if (!resolve) return resolve.error();
    const std::vector<DrawStep> steps = in_order(draws, sizeof(layout::View));
    for (;;) {
        if (Result<void> made = make_room(view, steps); !made) return made;
        fill_addresses(view);
        if (!any_translucent(steps)) view.fragment_room = 0;
        if (Result<void> sent = make_parameters(view, steps); !sent) return sent;
        Recorder recorder(*context_);
        record(recorder, view, steps, **resolve);
        for (const DrawStep& step : steps) work.uploaded_bytes += step.from ? step.from->size() : 0;
        const Result<vulkan::Timings> timings = recorder.run();
        if (!timings) return timings.error();
        add_timings(work, *timings);
        if (view.fragment_room == 0) break;
        const Result<bool> fit = fragments_fit(view.fragment_room);
        if (!fit) return fit.error();
        if (*fit) break;
    }
    return fetch(part, picture);
}

} // namespace isotet::render
