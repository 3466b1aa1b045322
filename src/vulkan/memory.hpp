// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Buffers on the device, cut from large blocks of its memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <utility>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/logical_device.hpp"
#include "vulkan/free_ranges.hpp"

namespace isotet::vulkan {

/// What a buffer is for, and so which memory it lies in.
enum class Where : std::uint8_t {
    device,   ///< the device's own memory; mapped only where that is the machine's memory
    upload,   ///< the machine's memory, always mapped: written by the processor, read by the device once
    download, ///< the machine's memory, always mapped and cached: written by the device, read by the processor
};

class Memory;

/// One allocation of the driver's, from which buffers are cut.
struct Block {
    explicit Block(std::uint64_t bytes) : free(bytes) {}
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::byte* mapped = nullptr;
    FreeRanges free;
};

/// The blocks of one memory type for one purpose.
struct Pool {
    std::uint32_t type = 0;
    bool mapped = false, cached = false;
    std::list<Block> blocks;
};

/// A buffer with an address on the device. Gives its memory back when it goes; must not outlive its Context, nor be
/// given back while the device works on it (Recorder::run and Staging wait, so nothing can be under way between calls).
class ISOTET_API Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        Buffer(std::move(other)).swap(*this);
        return *this;
    }
    ~Buffer();

    VkBuffer handle() const noexcept { return handle_; }
    VkDeviceAddress address() const noexcept {
        return address_;
    }                                                     ///< a multiple of 256 where memory begins at one, as
                                                          ///< it does on every known driver; at least of 16
    std::uint64_t size() const noexcept { return size_; } ///< bytes, as asked for
    explicit operator bool() const noexcept { return handle_ != VK_NULL_HANDLE; }

    /// The bytes, for the processor; empty where it cannot reach them.
    std::span<std::byte> mapped() const noexcept { return {static_cast<std::byte*>(mapped_), mapped_ ? size_ : 0}; }

    /// Whether the processor also reads them fast.
    bool cached() const noexcept { return cached_; }

private:
    friend class Memory;
    void swap(Buffer& other) noexcept;

    Memory* memory_ = nullptr;
    Pool* pool_ = nullptr;
    Block* block_ = nullptr;
    std::uint64_t begin_ = 0, taken_ = 0; ///< in the block
    VkBuffer handle_ = VK_NULL_HANDLE;
    VkDeviceAddress address_ = 0;
    std::uint64_t size_ = 0;
    void* mapped_ = nullptr;
    bool cached_ = false;
};

/// The memory of one device.
///
/// Threads   safe from many threads
class ISOTET_API Memory {
public:
    struct Options {
        std::uint64_t limit = 0;   ///< bytes that buffers in Where::device may take in all; 0: what is free
        bool hide_unified = false; ///< never map Where::device, so that everything is staged
        bool share = false;        ///< Where::device can be handed out
    };

    /// Asks the driver with a probe buffer which memory types buffers may have, and chooses among these.
    ///
    /// Errors   out_of_memory; machine, also when buffers may lie in no memory that the processor can reach
    static Result<std::unique_ptr<Memory>> open(LogicalDevice& device, const Capabilities& capabilities,
                                                const Options& options);
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    /// A buffer of `bytes` (at least one is taken), not cleared. It can be copied from and to, filled, read and written
    /// by kernels, and hold arguments of indirect dispatches. Four more bytes than asked for may be read behind its
    /// end.
    ///
    /// `name`    for messages and debuggers: "triangles"
    /// Cost      in Where::device memory comes in blocks of 64 MiB (less under a small limit), larger buffers alone
    /// Errors    out_of_memory with the amount needed, the amount free, and the limit; machine
    Result<Buffer> take(std::uint64_t bytes, Where where, std::string_view name);

    /// What a buffer of `bytes` counts against the limit: a few bytes more (some drivers add more still).
    static std::uint64_t cost(std::uint64_t bytes) noexcept;

    /// Where a buffer lies, with a file descriptor of the block if it can be handed out.
    struct Place {
        int descriptor = -1; ///< the caller's, to be imported or closed
        std::uint64_t block_bytes = 0, offset = 0;
        std::uint32_t type = 0;
    };
    /// A buffer of Where::device, of memory that was opened to be shared.
    /// Errors   device_failed
    Result<Place> share(const Buffer& buffer) const;
    bool can_share() const noexcept { return share_; }

    std::uint64_t used() const; ///< bytes of buffers in Where::device
    std::uint64_t peak() const; ///< the most that used() has been
    std::uint64_t free() const; ///< bytes that take() can still give in Where::device, apart from fragmentation

private:
    friend class Buffer;

    /// Bytes behind the end of each buffer that may be read.
    static constexpr std::uint64_t slack = 4;

    Memory(LogicalDevice& device, const Capabilities& capabilities, std::uint64_t limit);
    Result<MemoryTypes> allowed_types(Where where);
    Result<void> choose_types(const Capabilities& capabilities, const Options& options);
    Pool& pool_of(Where where) noexcept { return pools_[static_cast<std::size_t>(where)]; }
    std::uint64_t free_locked() const;
    Result<void> make_buffer(Buffer& buffer, std::uint64_t bytes, Where where, std::string_view name);
    Result<void> place(Buffer& buffer, Pool& pool);
    Result<Block*> new_block(Pool& pool, std::uint64_t bytes);
    void give_back_range(const Buffer& buffer) noexcept;
    void give_back(Buffer& buffer) noexcept;

    LogicalDevice& device_;
    std::uint64_t limit_;
    std::uint64_t largest_; ///< buffer that the driver allows
    std::uint32_t heap_ = 0;
    std::uint64_t heap_bytes_ = 0;
    bool budget_ = false, share_ = false;
    std::uint64_t block_bytes_ = 0;
    mutable std::mutex mutex_;
    std::array<Pool, 3> pools_;
    std::uint64_t used_ = 0, peak_ = 0;
    std::uint64_t reserved_ = 0; ///< bytes of blocks in Where::device
};

} // namespace isotet::vulkan
