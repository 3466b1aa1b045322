// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/hazards.hpp"

namespace isotet::vulkan {

namespace {

struct Meaning {
    VkPipelineStageFlags stage;
    VkAccessFlags access;
    VkAccessFlags write; ///< the part of `access` that writes
};

Meaning meaning_of(Access access) {
    switch (access) {
    case Access::kernel_read: return {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT, 0};
    case Access::kernel_write:
        return {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT,
                VK_ACCESS_SHADER_WRITE_BIT};
    case Access::copy_read: return {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT, 0};
    case Access::copy_write:
        return {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};
    case Access::arguments: break;
    }
    return {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT, 0};
}

/// Whether `flags` has all of `wanted`.
bool covers(VkFlags flags, VkFlags wanted) { return (wanted & ~flags) == 0; }

} // namespace

Barrier Hazards::before(std::span<const BufferUse> uses) {
    Barrier barrier;
    for (const BufferUse& use : uses) {
        const auto found = buffers_.find(use.buffer);
        if (found == buffers_.end()) continue;
        const History& history = found->second;
        const Meaning now = meaning_of(use.access);
        if (history.write_stage && !covers(history.visible, now.access)) {
            barrier.from |= history.write_stage;
            barrier.to |= now.stage;
            barrier.written |= history.write_access;
            barrier.used |= now.access;
        }
        // A write after reads waits for them to end; nothing has to be made visible.
        if (now.write && history.read_stages && !covers(history.after_reads, now.stage)) {
            barrier.from |= history.read_stages;
            barrier.to |= now.stage;
        }
    }

    // Barriers are global: this one stands between earlier and later uses of every buffer.
    if (barrier.from) {
        for (auto& [buffer, history] : buffers_) {
            if (history.write_stage && covers(barrier.from, history.write_stage) && covers(barrier.written, history.write_access))
                history.visible |= barrier.used;
            if (covers(barrier.from, history.read_stages)) history.after_reads |= barrier.to;
        }
    }

    for (const BufferUse& use : uses) {
        const Meaning now = meaning_of(use.access);
        if (!now.write) continue;
        History& history = buffers_[use.buffer];
        history = History{};
        history.write_stage = now.stage;
        history.write_access = now.write;
    }
    for (const BufferUse& use : uses) {
        const Meaning now = meaning_of(use.access);
        if (now.write) continue;
        History& history = buffers_[use.buffer];
        history.read_stages |= now.stage;
        history.after_reads = 0;
    }
    return barrier;
}

} // namespace isotet::vulkan
