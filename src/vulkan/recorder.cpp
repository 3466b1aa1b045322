// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/recorder.hpp"

#include <utility>

#include <fmt/core.h>

#include "vulkan/context.hpp"
#include "vulkan/devices/failure.hpp"
#include "vulkan/groups.hpp"

namespace isotet::vulkan {

namespace {

std::uint64_t number_of(const Buffer& buffer) { return (std::uint64_t)buffer.handle(); } // NOLINT: as Vulkan has it

bool inside(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes) {
    return offset <= buffer.size() && bytes <= buffer.size() - offset;
}

constexpr std::uint64_t max_written = 65536; // of vkCmdUpdateBuffer

} // namespace

Recorder::Recorder(Context& context) : context_(context) {}
Recorder::~Recorder() = default;

std::size_t Recorder::passes() const noexcept { return passes_.size(); }

void Recorder::clear() {
    passes_.clear();
    label_.clear();
    wrong_.clear();
}

void Recorder::add(Pass pass) {
    if (!label_.empty()) pass.name = label_;
    passes_.push_back(std::move(pass));
}

void Recorder::complain(std::string what) {
    if (wrong_.empty()) wrong_ = std::move(what);
}

void Recorder::fill(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word) {
    if (!inside(buffer, offset, bytes) || offset % 4 || bytes % 4)
        return complain(fmt::format("fill of bytes {} + {} in a buffer of {}", offset, bytes, buffer.size()));
    if (bytes == 0) return;
    add({"fill", {{number_of(buffer), Access::copy_write}}, Fill{buffer.handle(), offset, bytes, word}});
}

void Recorder::copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
                    std::uint64_t bytes) {
    if (!inside(from, from_offset, bytes) || !inside(to, to_offset, bytes))
        return complain(fmt::format("copy of {} bytes from {} in a buffer of {} to {} in a buffer of {}", bytes,
                                    from_offset, from.size(), to_offset, to.size()));
    if (bytes == 0) return;
    add({"copy",
         {{number_of(from), Access::copy_read}, {number_of(to), Access::copy_write}},
         Copy{from.handle(), to.handle(), {from_offset, to_offset, bytes}}});
}

void Recorder::write(const Buffer& buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
    if (!inside(buffer, offset, bytes.size()) || offset % 4 || bytes.size() % 4 || bytes.size() > max_written)
        return complain(fmt::format("write of bytes {} + {} in a buffer of {}", offset, bytes.size(), buffer.size()));
    if (bytes.empty()) return;
    add({"write",
         {{number_of(buffer), Access::copy_write}},
         Write{buffer.handle(), offset, {bytes.begin(), bytes.end()}}});
}

std::vector<BufferUse> Recorder::uses_of(std::span<const Use> uses) {
    std::vector<BufferUse> out;
    for (const Use& use : uses) out.push_back({number_of(use.buffer), use.how});
    return out;
}

void Recorder::add_dispatch(const Kernel& kernel, std::span<const std::byte> push, std::uint64_t groups,
                            std::span<const Use> uses) {
    if (groups == 0) return;
    const auto folded = fold_groups(groups, context_.groups_per_axis());
    if (!folded)
        return complain(fmt::format("{} workgroups of '{}', but the device takes {} in each of three axes", groups,
                                    kernel.name, context_.groups_per_axis()));
    add({kernel.name, uses_of(uses), Dispatch{&kernel, {push.begin(), push.end()}, *folded, VK_NULL_HANDLE, 0}});
}

void Recorder::add_dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push, const Buffer& arguments,
                                     std::uint64_t offset, std::span<const Use> uses) {
    if (!inside(arguments, offset, sizeof(VkDispatchIndirectCommand)) || offset % 4)
        return complain(
            fmt::format("arguments of '{}' at byte {} of a buffer of {}", kernel.name, offset, arguments.size()));
    std::vector<BufferUse> all = uses_of(uses);
    all.push_back({number_of(arguments), Access::arguments});
    add({kernel.name, std::move(all), Dispatch{&kernel, {push.begin(), push.end()}, {}, arguments.handle(), offset}});
}

void Recorder::add_work(std::string name, const std::vector<Use>& uses, Work work) {
    add({std::move(name), uses_of(uses), std::move(work)});
}

void Recorder::record(VkCommandBuffer commands, const Pass& pass) const {
    const DeviceFunctions& call = context_.device().call();
    struct Visitor {
        const DeviceFunctions& call;
        VkCommandBuffer commands;
        void operator()(const Fill& fill) const {
            call.vkCmdFillBuffer(commands, fill.buffer, fill.offset, fill.bytes, fill.word);
        }
        void operator()(const Copy& copy) const { call.vkCmdCopyBuffer(commands, copy.from, copy.to, 1, &copy.region); }
        void operator()(const Write& write) const {
            call.vkCmdUpdateBuffer(commands, write.buffer, write.offset, write.bytes.size(), write.bytes.data());
        }
        void operator()(const Dispatch& dispatch) const {
            call.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, dispatch.kernel->pipeline);
            call.vkCmdPushConstants(commands, dispatch.kernel->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                    static_cast<std::uint32_t>(dispatch.push.size()), dispatch.push.data());
            if (dispatch.arguments) call.vkCmdDispatchIndirect(commands, dispatch.arguments, dispatch.offset);
            else call.vkCmdDispatch(commands, dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
        }
        void operator()(const Work& work) const { work(call, commands); }
    };
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
    label.pLabelName = pass.name.c_str();
    if (call.vkCmdBeginDebugUtilsLabelEXT) call.vkCmdBeginDebugUtilsLabelEXT(commands, &label);
    std::visit(Visitor{call, commands}, pass.work);
    if (call.vkCmdEndDebugUtilsLabelEXT) call.vkCmdEndDebugUtilsLabelEXT(commands);
}

void Recorder::record_all(VkCommandBuffer commands) {
    const DeviceFunctions& call = context_.device().call();
    Hazards hazards;
    timestamps_.begin(commands);
    for (const Pass& pass : passes_) {
        if (const Barrier barrier = hazards.before(pass.uses); barrier.from) {
            VkMemoryBarrier memory{};
            memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
            memory.srcAccessMask = barrier.written;
            memory.dstAccessMask = barrier.used;
            call.vkCmdPipelineBarrier(commands, barrier.from, barrier.to, 0, 1, &memory, 0, nullptr, 0, nullptr);
        }
        record(commands, pass);
        timestamps_.mark(commands);
    }
}

Result<Timings> Recorder::run(std::chrono::milliseconds limit) {
    if (!wrong_.empty()) return Error{ErrorCode::internal, "a pass that cannot be run: " + wrong_};
    if (passes_.empty()) return Timings{};
    LogicalDevice& device = context_.device();
    if (Result<void> made = timestamps_.make(context_, passes_.size() + 1); !made) return made.error();
    const std::string what = fmt::format("running '{}'", passes_.front().name);
    Result<VkCommandBuffer> commands = submission_.begin(device, device.compute(), "recorder");
    if (!commands) return commands.error();
    record_all(*commands);

    const auto start = std::chrono::steady_clock::now();
    if (Result<void> submitted = submission_.submit(what); !submitted) return submitted.error();
    if (limit == limit.zero()) limit = context_.settings().wait_limit;
    if (Result<void> waited = submission_.wait(limit, what); !waited) return waited.error();
    Timings timings;
    timings.waited_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

    const Result<std::vector<double>> marks = timestamps_.seconds();
    if (!marks) return marks.error();
    for (std::size_t i = 0; i + 1 < marks->size(); ++i)
        timings.passes.push_back({passes_[i].name, (*marks)[i + 1] - (*marks)[i]});
    if (!marks->empty()) timings.device_seconds = marks->back();
    return timings;
}

} // namespace isotet::vulkan
