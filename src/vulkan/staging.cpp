// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/staging.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "vulkan/context.hpp"

namespace isotet::vulkan {

namespace {

Result<void> require_inside(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, const char* what) {
    if (offset <= buffer.size() && bytes <= buffer.size() - offset) return {};
    return Error{ErrorCode::internal,
                 fmt::format("{} of bytes {} + {} of a buffer of {}", what, offset, bytes, buffer.size())};
}

} // namespace

Staging::Staging(Context& context, std::uint64_t chunk_bytes)
    : context_(context), chunk_bytes_(std::max<std::uint64_t>(chunk_bytes, 4)) {}

Staging::~Staging() = default;

Result<void> Staging::prepare(Lane& lane, Where where, std::uint64_t bytes) {
    if (Result<void> done = finish(lane); !done) return done;
    const std::uint64_t size = std::min(bytes, chunk_bytes_);
    if (lane.buffer && lane.buffer.size() >= size) return {};
    Result<Buffer> taken = context_.memory().take(size, where, where == Where::upload ? "going up" : "coming down");
    if (!taken) return taken.error();
    lane.buffer = *std::move(taken);
    return {};
}

Result<void> Staging::start_copy(Lane& lane, const Buffer& from, const Buffer& to, const VkBufferCopy& region) {
    LogicalDevice& device = context_.device();
    Result<VkCommandBuffer> commands = lane.work.begin(device, device.transfer(), "staging");
    if (!commands) return commands.error();
    device.call().vkCmdCopyBuffer(*commands, from.handle(), to.handle(), 1, &region);
    return lane.work.submit("copying");
}

Result<void> Staging::finish(Lane& lane) { return lane.work.wait(context_.settings().wait_limit, "copying"); }

Result<void> Staging::finish_all(std::array<Lane, 2>& lanes) {
    Result<void> all;
    for (Lane& lane : lanes)
        if (Result<void> done = finish(lane); !done) all = std::move(done);
    return all;
}

Result<void> Staging::upload(const Buffer& to, std::uint64_t offset, std::span<const std::byte> bytes) {
    if (Result<void> fits = require_inside(to, offset, bytes.size(), "upload"); !fits) return fits;
    if (Result<void> lives = context_.device().alive(); !lives) return lives;
    uploaded_ += bytes.size();
    if (!to.mapped().empty()) {
        std::memcpy(to.mapped().data() + offset, bytes.data(), bytes.size());
        return {};
    }
    const Result<void> sent = send(to, offset, bytes);
    const Result<void> ended = finish_all(up_);
    return sent ? ended : sent;
}

Result<void> Staging::send(const Buffer& to, std::uint64_t offset, std::span<const std::byte> bytes) {
    // While one lane's bytes travel, the other's are put in place.
    std::size_t turn = 0;
    for (std::uint64_t begin = 0; begin < bytes.size(); begin += chunk_bytes_, ++turn) {
        Lane& lane = up_[turn % 2];
        const auto chunk = bytes.subspan(begin, std::min<std::uint64_t>(chunk_bytes_, bytes.size() - begin));
        if (Result<void> ready = prepare(lane, Where::upload, bytes.size()); !ready) return ready;
        std::memcpy(lane.buffer.mapped().data(), chunk.data(), chunk.size());
        if (Result<void> started = start_copy(lane, lane.buffer, to, {0, offset + begin, chunk.size()}); !started)
            return started;
    }
    return {};
}

Result<void> Staging::download(const Buffer& from, std::uint64_t offset, std::span<std::byte> bytes) {
    if (Result<void> fits = require_inside(from, offset, bytes.size(), "download"); !fits) return fits;
    if (Result<void> lives = context_.device().alive(); !lives) return lives;
    downloaded_ += bytes.size();
    if (!from.mapped().empty() && from.cached()) {
        std::memcpy(bytes.data(), from.mapped().data() + offset, bytes.size());
        return {};
    }
    const Result<void> fetched = fetch(from, offset, bytes);
    const Result<void> ended = finish_all(down_);
    return fetched ? ended : fetched;
}

Result<void> Staging::fetch(const Buffer& from, std::uint64_t offset, std::span<std::byte> bytes) {
    const std::uint64_t chunks = (bytes.size() + chunk_bytes_ - 1) / chunk_bytes_;
    const auto chunk_at = [&](std::uint64_t i) {
        return bytes.subspan(i * chunk_bytes_, std::min<std::uint64_t>(chunk_bytes_, bytes.size() - i * chunk_bytes_));
    };
    // One chunk travels while the one before it is taken out.
    for (std::uint64_t i = 0; i <= chunks; ++i) {
        if (i < chunks) {
            Lane& lane = down_[i % 2];
            if (Result<void> ready = prepare(lane, Where::download, bytes.size()); !ready) return ready;
            if (Result<void> started =
                    start_copy(lane, from, lane.buffer, {offset + i * chunk_bytes_, 0, chunk_at(i).size()});
                !started)
                return started;
        }
        if (i > 0) {
            Lane& lane = down_[(i - 1) % 2];
            if (Result<void> done = finish(lane); !done) return done;
            std::memcpy(chunk_at(i - 1).data(), lane.buffer.mapped().data(), chunk_at(i - 1).size());
        }
    }
    return {};
}

} // namespace isotet::vulkan
