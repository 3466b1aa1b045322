// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Linux ends a process that touches more memory than its control group has, without a word. So what is left is looked
// at before memory is mapped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// Whether more memory may be mapped. What is left is asked for once for many small blocks.
///
/// Threads   safe from many threads
class ISOTET_API FreshMemory {
public:
    static constexpr std::uint64_t of_heap = std::uint64_t{16} << 20; ///< stays free, for small objects

    /// `left`   tells how many bytes there are
    explicit FreshMemory(std::uint64_t (*left)()) : left_(left) {}

    /// False where so many bytes, and what the heap may need beside them, are not there.
    bool take(std::size_t bytes);

    /// Asks anew next time: another process of the control group has taken some.
    void forget();

    /// What take() refused last: bytes, and how many were left. Each is told once.
    struct Refusal {
        std::uint64_t bytes = 0, left = 0;
    };
    Refusal take_refusal();

private:
    std::uint64_t (*left_)();
    std::mutex mutex_;
    std::uint64_t known_ = 0; ///< to be there
    Refusal refusal_;
};

/// What the system, its swap and the control group have, less what this process has taken and not written to yet.
ISOTET_API std::uint64_t unclaimed_memory();

/// free_memory(), with swap.
ISOTET_API std::uint64_t free_memory_and_swap();

/// Of the process.
ISOTET_API FreshMemory& fresh_memory();

/// Bytes of large blocks (block.hpp) that are mapped, in use or kept, whether they were written to or not.
ISOTET_API std::size_t mapped_blocks();

/// As require_memory() says it: "packing needs 12.3 GB, but 4.5 GB are free".
ISOTET_API Error too_little_memory(std::string_view what, std::uint64_t bytes);

/// After an allocation has failed: "extraction ran out of memory: beside 120 MB ..., 2 MB more are needed, but ...".
ISOTET_API Error ran_out_of_memory(std::string_view what);

} // namespace isotet::core
