// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/timestamps.hpp"

#include <algorithm>

#include "vulkan/context.hpp"
#include "vulkan/devices/failure.hpp"

namespace isotet::vulkan {

Timestamps::~Timestamps() {
    if (pool_ && !device_->hung()) device_->call().vkDestroyQueryPool(device_->handle(), pool_, nullptr);
}

Result<void> Timestamps::make(Context& context, std::size_t count) {
    const Capabilities& capabilities = context.capabilities();
    const std::uint32_t bits = capabilities.queues[capabilities.compute_family].timestamp_bits;
    if (bits == 0 || count <= room_) return {};
    device_ = &context.device();
    mask_ = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    tick_ = static_cast<double>(capabilities.properties.limits.timestampPeriod) * 1e-9;
    if (pool_) device_->call().vkDestroyQueryPool(device_->handle(), pool_, nullptr);
    room_ = 0;
    VkQueryPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    create.queryType = VK_QUERY_TYPE_TIMESTAMP;
    create.queryCount = std::max<std::uint32_t>(64, static_cast<std::uint32_t>(2 * count));
    const VkResult made = device_->call().vkCreateQueryPool(device_->handle(), &create, nullptr, &pool_);
    if (made != VK_SUCCESS) {
        pool_ = VK_NULL_HANDLE;
        return failure("making room for timestamps", made);
    }
    room_ = create.queryCount;
    return {};
}

void Timestamps::begin(VkCommandBuffer commands) {
    if (!pool_) return;
    device_->call().vkCmdResetQueryPool(commands, pool_, 0, room_);
    used_ = 0;
    mark(commands);
}

void Timestamps::mark(VkCommandBuffer commands) {
    if (pool_) device_->call().vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_, used_++);
}

Result<std::vector<double>> Timestamps::seconds() const {
    if (!pool_) return std::vector<double>();
    std::vector<std::uint64_t> ticks(used_);
    const VkResult got =
        device_->call().vkGetQueryPoolResults(device_->handle(), pool_, 0, used_, ticks.size() * sizeof(std::uint64_t),
                                              ticks.data(), sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT);
    if (got != VK_SUCCESS) return failure("reading timestamps", got);
    std::vector<double> out;
    for (const std::uint64_t tick : ticks) out.push_back(static_cast<double>((tick - ticks[0]) & mask_) * tick_);
    return out;
}

} // namespace isotet::vulkan
