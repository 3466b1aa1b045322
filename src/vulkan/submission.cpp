// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/submission.hpp"

#include "vulkan/devices/failure.hpp"

namespace isotet::vulkan {

namespace {

constexpr std::chrono::seconds last_wait{10};

void barrier(const DeviceFunctions& call, VkCommandBuffer commands, VkPipelineStageFlags to, VkAccessFlags used) {
    VkMemoryBarrier memory{};
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    memory.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    memory.dstAccessMask = used;
    call.vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

} // namespace

Submission::~Submission() {
    if (!device_) return;
    // Work is under way here only after something else failed: then it still has to end before anything of it goes.
    if (under_way_ && device_->alive()) static_cast<void>(device_->wait(done_, last_wait, "ending"));
    if (device_->hung()) return;
    const DeviceFunctions& call = device_->call();
    if (done_) call.vkDestroyFence(device_->handle(), done_, nullptr);
    if (pool_) call.vkDestroyCommandPool(device_->handle(), pool_, nullptr);
}

Result<void> Submission::make(LogicalDevice& device, const Queue& queue, std::string_view name) {
    device_ = &device;
    queue_ = queue;
    const DeviceFunctions& call = device.call();
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = queue.family;
    VkResult made = call.vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_);
    if (made != VK_SUCCESS) {
        pool_ = VK_NULL_HANDLE;
        return failure("making a command pool", made);
    }
    VkCommandBufferAllocateInfo commands{};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commands.commandPool = pool_;
    commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands.commandBufferCount = 1;
    made = call.vkAllocateCommandBuffers(device.handle(), &commands, &commands_);
    if (made != VK_SUCCESS) return failure("making a command buffer", made);
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    made = call.vkCreateFence(device.handle(), &fence, nullptr, &done_);
    if (made != VK_SUCCESS) {
        done_ = VK_NULL_HANDLE;
        return failure("making a fence", made);
    }
    device.name(VK_OBJECT_TYPE_COMMAND_BUFFER, commands_, name);
    return {};
}

Result<VkCommandBuffer> Submission::begin(LogicalDevice& device, const Queue& queue, std::string_view name) {
    if (Result<void> lives = device.alive(); !lives) return lives.error();
    if (!done_) {
        if (pool_)
            device.call().vkDestroyCommandPool(device.handle(), pool_, nullptr); // of a making that failed half-way
        pool_ = VK_NULL_HANDLE;
        if (Result<void> made = make(device, queue, name); !made) return made.error();
    }
    const DeviceFunctions& call = device.call();
    if (const VkResult reset = call.vkResetCommandPool(device.handle(), pool_, 0); reset != VK_SUCCESS)
        return failure("clearing a command buffer", reset);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult begun = call.vkBeginCommandBuffer(commands_, &begin); begun != VK_SUCCESS)
        return failure("beginning a command buffer", begun);
    barrier(call, commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
            VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
    return commands_;
}

Result<void> Submission::submit(std::string_view what) {
    const DeviceFunctions& call = device_->call();
    barrier(call, commands_, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    if (const VkResult ended = call.vkEndCommandBuffer(commands_); ended != VK_SUCCESS)
        return failure("ending a command buffer", ended);
    if (Result<void> submitted = device_->submit(queue_, commands_, done_, what); !submitted) return submitted;
    under_way_ = true;
    return {};
}

Result<void> Submission::wait(std::chrono::milliseconds limit, std::string_view what) {
    if (!under_way_) return {};
    if (Result<void> waited = device_->wait(done_, limit, what); !waited) return waited;
    under_way_ = false;
    if (const VkResult reset = device_->call().vkResetFences(device_->handle(), 1, &done_); reset != VK_SUCCESS)
        return failure("resetting a fence", reset);
    return {};
}

} // namespace isotet::vulkan
