// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/block.hpp"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <new>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

namespace isotet::core {

namespace {

// The address sanitizer sees what lies beyond a block only when its own allocator made it.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool own_mappings = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
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

std::size_t most_to_keep() {
    static const std::size_t bytes = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) / 64 * page_size();
    return bytes;
}

bool is_large(std::size_t bytes) { return own_mappings && bytes >= large_block; }

std::byte* map_pages(std::size_t bytes) {
    void* const data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (data == MAP_FAILED) throw std::bad_alloc();
    return static_cast<std::byte*>(data);
}

/// Maps whole pages, from a huge page's size on beginning at one. What is left over behind the last huge page stays in
/// small ones, so that no more memory is used than was asked for.
Block map_block(std::size_t bytes) {
    const std::size_t size = (bytes + page_size() - 1) / page_size() * page_size();
    if (size < bytes || size + huge_page < size) throw std::bad_alloc();
    if (size < huge_page) return {map_pages(size), size};
    std::byte* const begin = map_pages(size + huge_page);
    const std::size_t before = (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
    if (before) munmap(begin, before);
    if (before < huge_page) munmap(begin + before + size, huge_page - before);
    madvise(begin + before, size, MADV_HUGEPAGE); // a wish: without huge pages everything works, slower
    return {begin + before, size};
}

/// Blocks given back, waiting for the next one who wants about as much.
class KeptBlocks {
public:
    /// The smallest block that is large enough and not more than a quarter too large.
    Block take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        auto best = blocks_.end();
        for (auto block = blocks_.begin(); block != blocks_.end(); ++block)
            if (block->bytes >= bytes && block->bytes - bytes <= bytes / 4 && (best == blocks_.end() || block->bytes < best->bytes))
                best = block;
        if (best == blocks_.end()) return {};
        const Block taken = *best;
        blocks_.erase(best);
        bytes_ -= taken.bytes;
        return taken;
    }

    /// Keeps the block, and lets the oldest go for it. False when it is larger than all that may be kept.
    bool keep(Block block) {
        if (block.bytes > most_to_keep()) return false;
        const std::lock_guard lock(mutex_);
        if (blocks_.size() == blocks_.capacity()) blocks_.reserve(2 * blocks_.size() + 16);
        std::size_t old = 0;
        for (; bytes_ + block.bytes > most_to_keep(); ++old) release(blocks_[old]);
        blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(old));
        blocks_.push_back(block);
        bytes_ += block.bytes;
        return true;
    }

    std::size_t drop() {
        const std::lock_guard lock(mutex_);
        const std::size_t dropped = bytes_;
        for (const Block& block : blocks_) release(block);
        blocks_.clear();
        return dropped;
    }

private:
    void release(const Block& block) {
        munmap(block.data, block.bytes);
        bytes_ -= block.bytes;
    }

    std::mutex mutex_;
    std::vector<Block> blocks_; ///< oldest first
    std::size_t bytes_ = 0;
};

/// Never destroyed: arrays may be given back while the process ends.
KeptBlocks& kept_blocks() {
    static auto* const blocks = new KeptBlocks;
    return *blocks;
}

} // namespace

Block take_block(std::size_t bytes) {
    if (!is_large(bytes)) return {::operator new(bytes), bytes};
    if (const Block kept = kept_blocks().take(bytes); kept.data) return kept;
    return map_block(bytes);
}

void give_back(Block block) noexcept {
    if (!is_large(block.bytes)) {
        ::operator delete(block.data);
        return;
    }
    try {
        if (kept_blocks().keep(block)) return;
    } catch (...) { // no memory for the list, or no lock
    }
    munmap(block.data, block.bytes);
}

std::size_t drop_kept_blocks() noexcept {
    try {
        return kept_blocks().drop();
    } catch (...) {
        return 0;
    }
}

} // namespace isotet::core
