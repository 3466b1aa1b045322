// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/free_ranges.hpp"

#include <iterator>

namespace isotet::vulkan {

std::optional<std::uint64_t> FreeRanges::take(std::uint64_t bytes, std::uint64_t alignment) {
    for (auto range = free_.begin(); range != free_.end(); ++range) {
        const auto [begin, length] = *range;
        const std::uint64_t aligned = (begin + alignment - 1) / alignment * alignment;
        const std::uint64_t gap = aligned - begin;
        if (length < gap || length - gap < bytes) continue;
        free_.erase(range);
        if (gap > 0) free_.emplace(begin, gap);
        if (length - gap > bytes) free_.emplace(aligned + bytes, length - gap - bytes);
        return aligned;
    }
    return {};
}

void FreeRanges::give_back(std::uint64_t begin, std::uint64_t bytes) {
    auto after = free_.lower_bound(begin);
    if (after != free_.end() && after->first == begin + bytes) {
        bytes += after->second;
        after = free_.erase(after);
    }
    if (after != free_.begin()) {
        const auto before = std::prev(after);
        if (before->first + before->second == begin) {
            before->second += bytes;
            return;
        }
    }
    free_.emplace(begin, bytes);
}

} // namespace isotet::vulkan
