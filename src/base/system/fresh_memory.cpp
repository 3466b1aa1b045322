// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/fresh_memory.hpp"

#include <algorithm>
#include <utility>

#include "base/system/memory.hpp"

namespace isotet::core {

bool FreshMemory::take(std::size_t bytes) {
    constexpr std::uint64_t known_at_most = std::uint64_t{64} << 20; // then it is asked for again
    const std::lock_guard lock(mutex_);
    if (bytes > known_) {
        const std::uint64_t left = left_();
        known_ = 0;
        const std::uint64_t room = left - std::min(left, of_heap);
        if (room < bytes) {
            refusal_ = {bytes, room};
            return false;
        }
        known_ = std::min<std::uint64_t>(room, bytes + known_at_most);
    }
    known_ -= bytes;
    refusal_ = {}; // what was refused was not needed, or has been found
    return true;
}

void FreshMemory::forget() {
    const std::lock_guard lock(mutex_);
    known_ = 0;
}

FreshMemory::Refusal FreshMemory::take_refusal() {
    const std::lock_guard lock(mutex_);
    return std::exchange(refusal_, {});
}

FreshMemory& fresh_memory() {
    static auto* const memory = new FreshMemory(unclaimed_memory); // arrays may be given back while the process ends
    return *memory;
}

} // namespace isotet::core
