// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/block.hpp"
#include "base/system/block_place.hpp"
#include "base/system/block_reuse.hpp"
#include "base/system/fresh_memory.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

namespace isotet::core {

namespace {

// The address sanitizer sees what lies beyond a block only when its own allocator made it; WebAssembly maps no pages.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool own_mappings = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || defined(__wasm__)
constexpr bool own_mappings = false;
#else
constexpr bool own_mappings = true;
#endif
#else
constexpr bool own_mappings = true;
#endif

constexpr std::size_t huge_page = std::size_t{2} << 20;

std::size_t page_size() {
    static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return size;
}

std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

std::size_t max_to_keep() {
    static const std::size_t bytes = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) / 64 * page_size();
    return bytes;
}

bool is_large(std::size_t bytes) { return own_mappings && bytes >= large_block; }

/// Null when there is no room.
std::byte* map_pages(std::size_t bytes) {
    void* const data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return data == MAP_FAILED ? nullptr : static_cast<std::byte*>(data);
}

/// Pages that begin at a huge one, of which as many as fit are asked for; null when there is no room.
std::byte* map_huge_pages(std::size_t bytes) {
    std::byte* const begin = map_pages(bytes + huge_page);
    if (!begin) return nullptr;
    const std::size_t before = (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
    if (before) munmap(begin, before);
    if (before < huge_page) munmap(begin + before + bytes, huge_page - before);
    madvise(begin + before, bytes, MADV_HUGEPAGE); // a wish: without huge pages everything works, slower
    return begin + before;
}

/// Maps whole pages, from a huge page's size on beginning at one where there is room for that. What is left over behind
/// the last huge page stays in small ones, so that no more memory is used than was asked for. No data when there is
/// none.
Block map_block(std::size_t bytes) {
    const std::size_t size = round_up(bytes, page_size());
    if (size < bytes || size + huge_page < size) return {};
    std::byte* data = size < huge_page ? nullptr : map_huge_pages(size);
    if (!data) data = map_pages(size);
    return {data, size};
}

/// No data also where the pages could not all be used.
Block map_fresh(std::size_t bytes) { return fresh_memory().take(bytes) ? map_block(bytes) : Block{}; }

/// Memory of malloc(): a list that grows under a lock must not come back to it by an operator new that asks how much
/// memory is left (checked_new.cpp).
template <class T>
struct PlainHeap {
    using value_type = T;

    T* allocate(std::size_t count) {
        if (void* const memory = std::malloc(count * sizeof(T))) return static_cast<T*>(memory);
        throw std::bad_alloc();
    }
    void deallocate(T* memory, std::size_t) noexcept { std::free(memory); }
    friend bool operator==(PlainHeap, PlainHeap) { return true; }
};

/// Blocks given back, waiting for the next one who wants about as much; and what is in use.
class KeptBlocks {
    using Blocks = std::vector<Block, PlainHeap<Block>>;

public:
    /// The smallest block that is large enough and not more than a quarter too large, else a piece of one that is so
    /// much larger that it was made for something else; with reuse, a piece of any.
    Block take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        make_room_for_one();
        const auto fits = [&](std::size_t size) {
            return size >= bytes && (reuses_ || size - bytes <= bytes / 4 || size / 4 >= bytes);
        };
        auto best = blocks_.end();
        for (auto block = blocks_.begin(); block != blocks_.end(); ++block)
            if (fits(block->bytes) && (best == blocks_.end() || block->bytes < best->bytes)) best = block;
        if (best == blocks_.end()) return {};
        const Block taken = cut_off(best, bytes);
        bytes_ -= taken.bytes;
        in_use_ += taken.bytes;
        return taken;
    }

    /// A new block. With reuse, the oldest kept ones go where both together would raise the peak; all go for lack of
    /// room.
    Block map(std::size_t bytes) {
        {
            const std::lock_guard lock(mutex_);
            std::size_t old = 0;
            while (reuses_ && old < blocks_.size() && in_use_ + bytes_ + bytes > peak_) release(blocks_[old++]);
            forget(old);
        }
        Block block = map_fresh(bytes);
        if (!block.data && drop() > 0) block = map_fresh(bytes);
        if (!block.data) throw std::bad_alloc();
        const std::lock_guard lock(mutex_);
        in_use_ += block.bytes;
        peak_ = std::max(peak_, in_use_ + bytes_);
        return block;
    }

    /// Keeps the block, and lets the oldest go for it. False when it is larger than all that may be kept, or not
    /// wanted.
    bool keep(Block block, bool wanted) {
        const std::lock_guard lock(mutex_);
        in_use_ -= block.bytes;
        if (!wanted) return false;
        if (!reuses_ && block.bytes > max_to_keep()) return false;
        make_room_for_one();
        blocks_.push_back(block);
        bytes_ += block.bytes;
        let_go_of_too_many();
        return true;
    }

    void prepare(std::size_t bytes) {
        if (is_in_use()) return;
        const Block block = map_fresh(bytes);
        if (!block.data) return;
        const std::lock_guard lock(mutex_);
        make_room_for_one();
        blocks_.push_back(block);
        bytes_ += block.bytes;
    }

    std::size_t drop() {
        const std::lock_guard lock(mutex_);
        const std::size_t dropped = bytes_;
        for (const Block& block : blocks_) release(block);
        blocks_.clear();
        return dropped;
    }

    std::size_t in_use() {
        const std::lock_guard lock(mutex_);
        return in_use_;
    }
    std::size_t mapped() {
        const std::lock_guard lock(mutex_);
        return in_use_ + bytes_;
    }

    void begin_reuse() {
        const std::lock_guard lock(mutex_);
        if (++reuses_ == 1) peak_ = in_use_ + bytes_;
    }
    void end_reuse() {
        const std::lock_guard lock(mutex_);
        --reuses_;
        let_go_of_too_many();
    }

private:
    bool is_in_use() {
        const std::lock_guard lock(mutex_);
        return reuses_ || bytes_ > 0;
    }

    void make_room_for_one() {
        if (blocks_.size() == blocks_.capacity()) blocks_.reserve(2 * blocks_.size() + 16);
    }

    /// Takes `bytes` and little more off a kept block. What is left begins at a huge page if the block does, but for
    /// what lies between the piece and the next huge page.
    Block cut_off(Blocks::iterator block, std::size_t bytes) {
        const Block whole = *block;
        std::size_t piece = round_up(bytes, page_size());
        if (whole.bytes <= piece + std::max(large_block, bytes / 4)) {
            blocks_.erase(block);
            return whole;
        }
        auto* const begin = static_cast<std::byte*>(whole.data);
        if (piece < huge_page) { // off the end
            block->bytes -= piece;
            return {begin + block->bytes, piece};
        }
        const std::size_t end = std::min(round_up(piece, huge_page), whole.bytes);
        if (end - piece < large_block) piece = end;
        if (end < whole.bytes) {
            *block = {begin + end, whole.bytes - end};
            if (piece < end) blocks_.insert(block, {begin + piece, end - piece});
        } else {
            *block = {begin + piece, end - piece};
        }
        return {begin, piece};
    }

    void release(const Block& block) {
        munmap(block.data, block.bytes);
        bytes_ -= block.bytes;
    }
    void forget(std::size_t oldest) {
        blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(oldest));
    }

    void let_go_of_too_many() {
        if (reuses_) return;
        std::size_t old = 0;
        while (bytes_ > max_to_keep()) release(blocks_[old++]);
        forget(old);
    }

    std::mutex mutex_;
    Blocks blocks_;         ///< oldest first
    std::size_t bytes_ = 0; ///< of them
    std::size_t in_use_ = 0;
    std::size_t peak_ = 0; ///< of both, since reuse began
    int reuses_ = 0;       ///< BlockReuse that live
};

/// Never destroyed: arrays may be given back while the process ends.
KeptBlocks& kept_blocks() {
    static auto* const blocks = new KeptBlocks;
    return *blocks;
}

std::atomic<BlockPlace*> other_place{nullptr};

} // namespace

void use_block_place(BlockPlace& place) noexcept { other_place = &place; }

BlockReuse::BlockReuse() { kept_blocks().begin_reuse(); }
BlockReuse::~BlockReuse() { kept_blocks().end_reuse(); }

Block take_block(std::size_t bytes) {
    if (BlockPlace* const place = other_place; place && bytes >= large_block)
        if (const Block block = place->take(bytes, kept_blocks().in_use()); block.data) return block;
    if (!is_large(bytes)) return {::operator new(bytes), bytes};
    KeptBlocks& kept = kept_blocks();
    if (const Block block = kept.take(bytes); block.data) return block;
    return kept.map(bytes);
}

void give_back(Block block) noexcept {
    BlockPlace* const place = block.bytes >= large_block ? other_place.load() : nullptr;
    if (place && place->give_back(block)) return;
    if (!is_large(block.bytes)) {
        ::operator delete(block.data);
        return;
    }
    try {
        if (kept_blocks().keep(block, !place || place->lets_keep())) return;
    } catch (...) { // no memory for the list, or no lock
    }
    munmap(block.data, block.bytes);
}

void prepare_blocks(std::size_t bytes) noexcept {
    bytes = std::min(bytes / huge_page * huge_page, max_to_keep() / 4);
    if (!is_large(bytes) || other_place.load()) return;
    try {
        kept_blocks().prepare(bytes);
    } catch (...) { // no memory for the list, or no lock
    }
}

std::size_t mapped_blocks() { return kept_blocks().mapped(); }

std::size_t drop_kept_blocks() noexcept {
    try {
        return kept_blocks().drop();
    } catch (...) {
        return 0;
    }
}

} // namespace isotet::core
