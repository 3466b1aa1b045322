// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which bytes of a block are free.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace isotet::vulkan {

class FreeRanges {
public:
    explicit FreeRanges(std::uint64_t size) : size_(size), free_{{0, size}} {}

    /// The lowest free range of `bytes` that begins at a multiple of `alignment`; nothing when none is left.
    std::optional<std::uint64_t> take(std::uint64_t bytes, std::uint64_t alignment);

    /// Gives back a range that take() gave.
    void give_back(std::uint64_t begin, std::uint64_t bytes);

    std::uint64_t size() const noexcept { return size_; }
    bool all_free() const noexcept { return free_.size() == 1 && free_.begin()->second == size_; }

private:
    std::uint64_t size_;
    std::map<std::uint64_t, std::uint64_t> free_; ///< begin to length; neighbours are joined
};

} // namespace isotet::vulkan
