// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/frame.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "render_shaders.hpp"

namespace isotet::render {

namespace {

using vulkan::Buffer;
using vulkan::Recorder;
using vulkan::Use;

constexpr std::uint64_t color_bytes = vulkan::Target::texel_bytes, word = 4;

std::uint64_t pixels_of(const layout::View& view) { return std::uint64_t{view.width} * view.height; }
std::uint64_t samples_of(const layout::View& view) { return pixels_of(view) * view.samples * view.samples; }

/// Where the structs of a picture stand in one buffer: the view, then lines, opaque and translucent meshes.
struct Places {
    static std::uint64_t lines(std::size_t i) { return sizeof(layout::View) + i * sizeof(layout::Lines); }
    static std::uint64_t meshes(const Draws& draws, std::size_t i) { return lines(draws.lines.size()) + i * sizeof(layout::Mesh); }
    static std::uint64_t bytes(const Draws& draws) { return meshes(draws, draws.opaque.size() + draws.translucent.size()); }
};

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
        return Error{ErrorCode::machine, fmt::format("the device {} cannot draw: {}", context->info().name, why)};
    Result<std::unique_ptr<vulkan::RenderPass>> pass = vulkan::RenderPass::make(*context);
    if (!pass) return pass.error();
    return std::unique_ptr<Frame>(new Frame(std::move(context), *std::move(pass)));
}

std::uint32_t Frame::most_samples_an_axis() const {
    const VkPhysicalDeviceLimits& limits = context_->capabilities().properties.limits;
    return std::min({limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxViewportDimensions[0],
                     limits.maxViewportDimensions[1]});
}

Result<void> Frame::make_room(const layout::View& view, const Draws& draws) {
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
    if (made) made = room_for(parameters_, Places::bytes(draws), "what is drawn");
    if (!made || draws.translucent.empty()) return made;
    // One fragment a sample is a guess: where there are more, they are counted, and drawn again.
    if (fragment_room_ == 0) fragment_room_ = static_cast<std::uint32_t>(samples_of(view));
    made = room_for(heads_, samples_of(view) * word, "lists of translucent fragments");
    if (made)
        made = room_for(fragments_, sizeof(layout::FragmentList) + sizeof(layout::Fragment) * std::uint64_t{fragment_room_},
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

Result<void> Frame::make_parameters(const layout::View& view, const Draws& draws) {
    std::vector<std::byte> bytes(Places::bytes(draws));
    const auto put = [&](std::uint64_t at, const auto& item) { std::memcpy(bytes.data() + at, &item, sizeof item); };
    put(0, view);
    for (std::size_t i = 0; i < draws.lines.size(); ++i) put(Places::lines(i), draws.lines[i].lines);
    std::size_t mesh = 0;
    for (const auto* list : {&draws.opaque, &draws.translucent})
        for (const MeshDraw& draw : *list) put(Places::meshes(draws, mesh++), draw.mesh);
    return context_->staging().upload(parameters_, 0, bytes);
}

void Frame::record(Recorder& recorder, const layout::View& view, const Draws& draws, const vulkan::Kernel& resolve) {
    const bool translucent = view.fragment_room > 0;
    if (translucent) {
        recorder.fill(heads_, 0, samples_of(view) * word, 0);
        recorder.fill(fragments_, 0, sizeof(layout::FragmentList), 0);
    }
    std::vector<Use> uses{vulkan::draws_from(parameters_)};
    for (const LineDraw& draw : draws.lines) uses.push_back(vulkan::draws_from(draw.ends));
    for (const auto* list : {&draws.opaque, &draws.translucent})
        for (const MeshDraw& draw : *list)
            for (const Use& use : draw.uses) uses.push_back(use);
    if (translucent) {
        uses.push_back(vulkan::draws_into(heads_));
        uses.push_back(vulkan::draws_into(fragments_));
    }
    const std::uint32_t width = view.width * view.samples, height = view.height * view.samples;
    target_->draw(recorder, width, height, uses, [this, &draws](const vulkan::DeviceFunctions& call, VkCommandBuffer commands) {
        const auto push = [&](std::uint64_t at) {
            return layout::DrawPush{vulkan::address_of(parameters_), vulkan::address_of(parameters_, at)};
        };
        for (std::size_t i = 0; i < draws.lines.size(); ++i) render::record(draws.lines[i], push(Places::lines(i)), call, commands);
        std::size_t mesh = 0;
        for (const auto* list : {&draws.opaque, &draws.translucent})
            for (const MeshDraw& draw : *list) render::record(draw, push(Places::meshes(draws, mesh++)), call, commands);
    });
    target_->copy_color(recorder, width, height, colors_);
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
    if (Result<void> done = context_->staging().download(fragments_, 0, std::as_writable_bytes(std::span(&list, 1))); !done)
        return done.error();
    if (list.count <= room) return true;
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() - 1;
    fragment_room_ = static_cast<std::uint32_t>(std::min(std::uint64_t{list.count} + list.count / 8, most));
    return false;
}

Result<void> Frame::fetch(const Part& part, Picture& picture) {
    std::vector<std::array<std::uint8_t, 4>> pixels(std::size_t{part.width} * part.height);
    if (Result<void> done = context_->staging().download(pixels_, 0, std::as_writable_bytes(std::span(pixels))); !done) return done;
    for (std::uint32_t row = 0; row < part.height; ++row) {
        const auto from = pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * part.width);
        std::copy(from, from + part.width,
                  picture.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{part.y + row} * picture.width + part.x));
    }
    return {};
}

Result<void> Frame::draw(const Draws& draws, layout::View view, const Part& part, Picture& picture, DeviceWork& work) {
    const Result<const vulkan::Kernel*> resolve = context_->kernels().get(vulkan::drawing::resolve);
    if (!resolve) return resolve.error();
    for (;;) {
        if (Result<void> made = make_room(view, draws); !made) return made;
        fill_addresses(view);
        if (draws.translucent.empty()) view.fragment_room = 0;
        if (Result<void> sent = make_parameters(view, draws); !sent) return sent;
        Recorder recorder(*context_);
        record(recorder, view, draws, **resolve);
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
