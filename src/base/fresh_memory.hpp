// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Linux ends a process that touches more memory than its control group has, without a word. So what is left is looked at
// before memory is mapped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>

#include <isotet/export.hpp>

namespace isotet::core {

/// Whether more memory may be mapped. What is left is asked for once for many small blocks.
///
/// Threads   safe from many threads
class ISOTET_API FreshMemory {
public:
    /// `left`   tells how many bytes there are
    explicit FreshMemory(std::uint64_t (*left)()) : left_(left) {}

    /// False where so many bytes, and what the heap may need beside them, are not there.
    bool take(std::size_t bytes);

private:
    std::uint64_t (*left_)();
    std::mutex mutex_;
    std::uint64_t known_ = 0; ///< to be there
};

} // namespace isotet::core
