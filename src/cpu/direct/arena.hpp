// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Memory that the pass over the cells takes bit by bit, and a budget that all threads share: how much a surface will
// need is only known afterwards.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/system/block.hpp"
#include "base/buffer.hpp"
#include "base/system/memory.hpp"

namespace isotet::cpu::direct {

/// What all arenas have taken, against what was free before. It is asked how much that is when a lot is taken, and again
/// when that is all and blocks that are kept can be let go.
class Budget {
public:
    /// Thrown when there is not enough; nothing has been taken then.
    struct Exceeded {};

    void take(std::uint64_t bytes) {
        const std::uint64_t before = taken_.fetch_add(bytes, std::memory_order_relaxed);
        if (before + bytes <= unasked) return;
        std::uint64_t free = free_.load(std::memory_order_relaxed);
        if (free == unknown) free = ask(before);
        if (before + bytes > free && core::drop_kept_blocks() > 0) free = ask(before);
        if (before + bytes > free) throw Exceeded{};
    }
    void give_back(std::uint64_t bytes) { taken_.fetch_sub(bytes, std::memory_order_relaxed); }
    std::uint64_t taken() const { return taken_.load(std::memory_order_relaxed); }

    /// Bytes that were free before arenas took any; known once Exceeded was thrown.
    std::uint64_t free() const { return free_.load(std::memory_order_relaxed); }

private:
    std::uint64_t ask(std::uint64_t taken) {
        const std::uint64_t free = core::free_memory() + taken;
        free_.store(free, std::memory_order_relaxed);
        return free;
    }

    static constexpr std::uint64_t unasked = std::uint64_t{1} << 26;
    static constexpr std::uint64_t unknown = 0;
    std::atomic<std::uint64_t> taken_{0}, free_{unknown};
};

/// A huge page. Blocks that one stage gives back then fit the next (base/block.hpp).
constexpr std::size_t arena_block = std::size_t{2} << 20;

/// One thread's memory, in blocks; given back as a whole.
class BudgetedArena {
public:
    explicit BudgetedArena(Budget& budget) : budget_(&budget) {}

    /// Gives all memory back.
    void clear() {
        for (const core::Buffer<std::byte>& block : blocks_) budget_->give_back(block.size());
        blocks_.clear();
        next_ = nullptr;
        left_ = 0;
    }

    /// Uninitialized; stays where it is.
    template <class T>
    T* take(std::size_t count) {
        constexpr std::size_t alignment = 8;
        static_assert(alignof(T) <= alignment);
        const std::size_t bytes = (count * sizeof(T) + alignment - 1) / alignment * alignment;
        if (bytes > left_) add_block(bytes);
        std::byte* const piece = next_;
        next_ += bytes;
        left_ -= bytes;
        return reinterpret_cast<T*>(piece);
    }

    /// Gives the end of what was taken last back.
    template <class T>
    void keep(T* first, std::size_t count) {
        std::byte* const end = reinterpret_cast<std::byte*>(first) + (count * sizeof(T) + 7) / 8 * 8;
        left_ += static_cast<std::size_t>(next_ - end);
        next_ = end;
    }

private:
    void add_block(std::size_t bytes) {
        const std::size_t size = std::max(bytes, arena_block);
        budget_->take(size);
        blocks_.emplace_back(size);
        next_ = blocks_.back().data();
        left_ = size;
    }

    Budget* budget_;
    std::vector<core::Buffer<std::byte>> blocks_;
    std::byte* next_ = nullptr;
    std::size_t left_ = 0;
};

} // namespace isotet::cpu::direct
