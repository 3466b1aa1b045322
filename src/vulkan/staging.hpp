// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Bytes between the processor and the device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/memory.hpp"
#include "vulkan/submission.hpp"

namespace isotet::vulkan {

class Context;

/// Copies directly where the processor reaches the buffer, else through two staging buffers in turn, on the queue that
/// only copies where there is one.
///
/// Guarantees   nothing is under way when a call returns, be it with an error
/// Threads      one call at a time
class ISOTET_API Staging {
public:
    Staging(Context& context, std::uint64_t chunk_bytes);
    ~Staging();

    /// Returns when the bytes are on the device.
    /// Errors   internal when they do not fit; out_of_memory; machine
    Result<void> upload(const Buffer& to, std::uint64_t offset, std::span<const std::byte> bytes);

    /// Returns when the bytes are here. Everything that ran before is seen.
    Result<void> download(const Buffer& from, std::uint64_t offset, std::span<std::byte> bytes);

    /// Bytes that went up and down since the beginning, copied directly or not: the traffic that extraction reports.
    std::uint64_t uploaded() const noexcept { return uploaded_; }
    std::uint64_t downloaded() const noexcept { return downloaded_; }

private:
    /// A staging buffer and the copy that is under way with it.
    struct Lane {
        Buffer buffer;
        Submission work; // goes first
    };
    /// Waits for what is under way, and has room for up to `bytes`.
    Result<void> prepare(Lane& lane, Where where, std::uint64_t bytes);
    Result<void> start_copy(Lane& lane, const Buffer& from, const Buffer& to, const VkBufferCopy& region);
    Result<void> finish(Lane& lane);
    Result<void> finish_all(std::array<Lane, 2>& lanes);
    Result<void> send(const Buffer& to, std::uint64_t offset, std::span<const std::byte> bytes);
    Result<void> fetch(const Buffer& from, std::uint64_t offset, std::span<std::byte> bytes);

    Context& context_;
    std::uint64_t chunk_bytes_;
    std::array<Lane, 2> up_, down_;
    std::uint64_t uploaded_ = 0, downloaded_ = 0;
};

} // namespace isotet::vulkan
