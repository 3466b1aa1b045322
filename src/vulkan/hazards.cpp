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
    case Access::draw_read:
        return {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_VERTEX_INPUT_BIT |
                    VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_INDEX_READ_BIT | VK_ACCESS_SHADER_READ_BIT, 0};
    case Access::draw_write:
        return {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT,
                VK_ACCESS_SHADER_WRITE_BIT};
    case Access::mesh_read: return {VK_PIPELINE_STAGE_MESH_SHADER_BIT_EXT, VK_ACCESS_SHADER_READ_BIT, 0};
    case Access::arguments: break;
    }
    return {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT, 0};
}

/// Whether `flags` has all of `wanted`.
bool covers(VkFlags flags, VkFlags wanted) { return (wanted & ~flags) == 0; }

constexpr Access all_kinds[] = {Access::kernel_read, Access::kernel_write, Access::copy_read,  Access::copy_write,
                                Access::arguments,   Access::draw_read,    Access::draw_write, Access::mesh_read};

std::uint32_t bit_of(Access access) { return 1u << static_cast<unsigned>(access); }

/// The kinds of use that a barrier makes what was written visible to. A kind needs all its stages and accesses: kernels
/// and fragment shaders have accesses in common, but what is visible to the ones need not be to the others.
std::uint32_t seen_by(const Barrier& barrier) {
    std::uint32_t kinds = 0;
    for (const Access kind : all_kinds) {
        const Meaning meaning = meaning_of(kind);
        if (covers(barrier.to, meaning.stage) && covers(barrier.used, meaning.access)) kinds |= bit_of(kind);
    }
    return kinds;
}

} // namespace

Barrier Hazards::before(std::span<const BufferUse> uses) {
    Barrier barrier;
    for (const BufferUse& use : uses) {
        const auto found = buffers_.find(use.buffer);
        if (found == buffers_.end()) continue;
        const History& history = found->second;
        const Meaning now = meaning_of(use.access);
        if (history.write_stage && !(history.visible & bit_of(use.access))) {
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
        const std::uint32_t kinds = seen_by(barrier);
        for (auto& [buffer, history] : buffers_) {
            if (history.write_stage && covers(barrier.from, history.write_stage) &&
                covers(barrier.written, history.write_access))
                history.visible |= kinds;
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
