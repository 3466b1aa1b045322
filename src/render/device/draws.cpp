// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/draws.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace isotet::render {

namespace {

template <class Draw, class Item>
DrawStep step_of(const Draw& draw, const Item& item, std::vector<vulkan::Use> uses) {
    DrawStep step;
    step.uses = std::move(uses);
    step.item = std::as_bytes(std::span(&item, 1));
    step.record = [&draw](const layout::DrawPush& push, const vulkan::DeviceFunctions& call, VkCommandBuffer commands) {
        render::record(draw, push, call, commands);
    };
    return step;
}

} // namespace

std::vector<DrawStep> in_order(const Draws& draws, std::uint64_t first_item) {
    std::vector<DrawStep> steps;
    for (const LineDraw& draw : draws.lines)
        steps.push_back(step_of(draw, draw.lines, {vulkan::draws_from(draw.ends)}));
    for (const MeshDraw& draw : draws.meshes)
        steps.emplace_back(step_of(draw, draw.mesh, draw.uses)).translucent = draw.translucent;
    for (const TetDraw& draw : draws.tets) {
        DrawStep& step = steps.emplace_back(step_of(draw, draw.page, draw.uses));
        step.translucent = draw.translucent;
        step.from = draw.from;
        step.to = draw.to;
    }
    std::ranges::stable_sort(steps, {},
                             [](const DrawStep& step) { return std::tuple(step.translucent, step.from != nullptr); });
    for (DrawStep& step : steps) {
        step.at = first_item;
        first_item += step.item.size();
    }
    return steps;
}

} // namespace isotet::render
