// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The one place where work for the device is put in order: a list of passes, run as a whole.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/groups.hpp"
#include "vulkan/hazards.hpp"
#include "vulkan/kernels.hpp"
#include "vulkan/memory.hpp"
#include "vulkan/submission.hpp"
#include "vulkan/timestamps.hpp"

namespace isotet::vulkan {

class Context;

/// What a pass does with a buffer.
struct Use {
    const Buffer& buffer;
    Access how;
};
inline Use reads(const Buffer& buffer) { return {buffer, Access::kernel_read}; }
inline Use writes(const Buffer& buffer) { return {buffer, Access::kernel_write}; } ///< or reads and writes
inline Use draws_from(const Buffer& buffer) { return {buffer, Access::draw_read}; }
inline Use draws_into(const Buffer& buffer) { return {buffer, Access::draw_write}; }
inline Use copies_into(const Buffer& buffer) { return {buffer, Access::copy_write}; }

/// How long a pass took on the device.
struct Timing {
    std::string pass;
    double seconds = 0;
};

struct Timings {
    std::vector<Timing> passes; ///< in order; empty where the device has no timestamps
    double device_seconds = 0;  ///< from the beginning of the first pass to the end of the last
    double waited_seconds = 0;  ///< from submitting to the end, on the processor
};

/// A list of passes, recorded first and then run in one submission, again and again if wanted.
///
/// Every pass says which buffers it uses, and all barriers follow from that: a pass that says less than it does is
/// wrong on real devices, and no software device will show it. Passes see everything that ran or was uploaded before
/// run(), and what they write is seen by everything after it, the processor included (mapped buffers). Recording
/// functions cannot fail: what is wrong is said by run(). Buffers and kernels must live until the last run() has
/// returned.
///
/// Threads   one recorder of a Context at a time
class ISOTET_API Recorder {
public:
    explicit Recorder(Context& context);
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Sets `bytes` from `offset` on to copies of a word. Both multiples of 4.
    void fill(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, std::uint32_t word);

    /// Copies bytes that do not overlap.
    void copy(const Buffer& from, std::uint64_t from_offset, const Buffer& to, std::uint64_t to_offset,
              std::uint64_t bytes);

    /// Writes up to 65,536 bytes, now taken from the processor: parameters. Offset and size multiples of 4.
    void write(const Buffer& buffer, std::uint64_t offset, std::span<const std::byte> bytes);

    /// Runs a kernel on `groups` workgroups, folded into three axes: the kernel finds its number by group_index() of
    /// kernels/shared/groups.glsl and must compare it with the count, which is rounded up. No groups: no pass.
    template <class Push>
    void dispatch(const Kernel& kernel, const Push& push, std::uint64_t groups, const std::vector<Use>& uses) {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= Kernels::push_bytes);
        add_dispatch(kernel, std::as_bytes(std::span(&push, 1)), groups, uses);
    }

    /// The same, with three counts that stand in `arguments` at `offset` (a multiple of 4) when the pass begins; each
    /// at most groups_per_axis(), see fold_groups() in kernels/shared/groups.glsl. `uses` need not name `arguments`.
    template <class Push>
    void dispatch_indirect(const Kernel& kernel, const Push& push, const Buffer& arguments, std::uint64_t offset,
                           const std::vector<Use>& uses) {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= Kernels::push_bytes);
        add_dispatch_indirect(kernel, std::as_bytes(std::span(&push, 1)), arguments, offset, uses);
    }

    /// A pass that `work` records by itself, whenever the list is run: draws, copies of images. What it does to images
    /// must be ordered by its own render passes; for buffers `uses` speaks. `work` and all that it refers to must live
    /// as long.
    using Work = std::function<void(const DeviceFunctions&, VkCommandBuffer)>;
    void add_work(std::string name, const std::vector<Use>& uses, Work work);

    /// Gives the passes that follow this name in timings and debuggers, until the next call; "": their own (the
    /// kernel's, or "fill", "copy", "write").
    void label(std::string name) { label_ = std::move(name); }

    /// Forgets all passes.
    void clear();

    std::size_t passes() const noexcept;

    /// Runs all passes and waits for the end; nothing to run is fine.
    ///
    /// `limit`   zero: the Context's
    /// Errors    internal when a pass goes beyond its buffer, or has too many groups; machine when the device is lost
    ///           or does not answer within the limit, named with the label of the passes; out_of_memory
    Result<Timings> run(std::chrono::milliseconds limit = {});

private:
    struct Fill {
        VkBuffer buffer;
        std::uint64_t offset, bytes;
        std::uint32_t word;
    };
    struct Copy {
        VkBuffer from, to;
        VkBufferCopy region;
    };
    struct Write {
        VkBuffer buffer;
        std::uint64_t offset;
        std::vector<std::byte> bytes;
    };
    struct Dispatch {
        const Kernel* kernel;
        std::vector<std::byte> push;
        Groups groups;
        VkBuffer arguments; ///< of an indirect one; null: `groups` count
        std::uint64_t offset;
    };
    struct Pass {
        std::string name;
        std::vector<BufferUse> uses;
        std::variant<Fill, Copy, Write, Dispatch, Work> work;
    };

    static std::vector<BufferUse> uses_of(std::span<const Use> uses);
    void add(Pass pass);
    void add_dispatch(const Kernel& kernel, std::span<const std::byte> push, std::uint64_t groups,
                      std::span<const Use> uses);
    void add_dispatch_indirect(const Kernel& kernel, std::span<const std::byte> push, const Buffer& arguments,
                               std::uint64_t offset, std::span<const Use> uses);
    void complain(std::string what);
    void record(VkCommandBuffer commands, const Pass& pass) const;
    void record_all(VkCommandBuffer commands);

    Context& context_;
    std::vector<Pass> passes_;
    std::string label_;
    std::string wrong_; ///< with the first pass that cannot be run
    Timestamps timestamps_;
    Submission submission_;
};

} // namespace isotet::vulkan
