// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/fresh_memory.hpp"

#include <algorithm>

namespace isotet::core {

bool FreshMemory::take(std::size_t bytes) {
    constexpr std::uint64_t of_heap = std::uint64_t{16} << 20;       // stays free
    constexpr std::uint64_t known_at_most = std::uint64_t{64} << 20; // then it is asked for again
    const std::lock_guard lock(mutex_);
    if (bytes > known_) {
        const std::uint64_t left = left_();
        known_ = 0;
        if (left < of_heap || left - of_heap < bytes) return false;
        known_ = std::min<std::uint64_t>(left - of_heap, bytes + known_at_most);
    }
    known_ -= bytes;
    return true;
}

} // namespace isotet::core
