// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Small numbers for the points of a block, while clusters are grown.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/buffer.hpp"

namespace isotet::core {

inline constexpr std::uint32_t no_number = std::numeric_limits<std::uint32_t>::max();

/// Numbers the points of a block 0, 1, 2, ... in the order in which they are first seen. Tets and cells of a block come
/// by their lowest rank, so most of its points are within a short stretch of ranks, and have their numbers in a table; a
/// hash table has those of the others.
class PointNumbers {
public:
    explicit PointNumbers(std::uint32_t lowest) : lowest_(lowest), near_(1 << 16) {
        std::fill(near_.begin(), near_.end(), no_number);
        rehash(1 << 12);
    }

    std::uint32_t number(std::uint32_t point) {
        if (const std::uint32_t at = point - lowest_; at < near_.size()) {
            if (near_[at] == no_number) near_[at] = add(point);
            return near_[at];
        }
        std::size_t slot = hash(point);
        for (; slots_[slot].number != no_number; slot = (slot + 1) & mask_)
            if (slots_[slot].point == point) return slots_[slot].number;
        slots_[slot] = {point, add(point)};
        const std::uint32_t number = slots_[slot].number;
        if (2 * ++far_ > slots_.size()) rehash(2 * slots_.size());
        return number;
    }
    const std::vector<std::uint32_t>& points() const { return points_; }

private:
    struct Slot {
        std::uint32_t point, number;
    };

    std::uint32_t add(std::uint32_t point) {
        points_.push_back(point);
        return static_cast<std::uint32_t>(points_.size() - 1);
    }
    std::size_t hash(std::uint32_t point) const { return (point * 0x9e3779b97f4a7c15u >> 32) & mask_; }
    void rehash(std::size_t size) {
        const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(size, {0, no_number}));
        mask_ = size - 1;
        for (const Slot& taken : old) {
            if (taken.number == no_number) continue;
            std::size_t slot = hash(taken.point);
            while (slots_[slot].number != no_number) slot = (slot + 1) & mask_;
            slots_[slot] = taken;
        }
    }

    std::uint32_t lowest_;
    Buffer<std::uint32_t> near_; ///< by rank from the lowest on: the number, or no_number
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> points_;
    std::size_t mask_ = 0, far_ = 0;
};

} // namespace isotet::core
