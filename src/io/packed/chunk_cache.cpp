// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/chunk_cache.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <utility>

#include "base/guard.hpp"
#include "base/parallel.hpp"

namespace isotet::io {

namespace {

std::size_t system_page() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

std::uint64_t whole_pages(std::uint64_t bytes, std::size_t page) { return (bytes + page - 1) / page * page; }

std::atomic<bool> guards_reserved{false};

} // namespace

void guard_address_space(bool guard) { guards_reserved = guard; }

std::shared_ptr<std::byte> reserve_address_space(std::size_t bytes) {
    const std::size_t size = whole_pages(std::max<std::size_t>(bytes, 1), system_page());
    const int use = guards_reserved ? PROT_NONE : PROT_READ | PROT_WRITE;
    void* const data = ::mmap(nullptr, size, use, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (data == MAP_FAILED) throw std::bad_alloc();
#ifdef MADV_NOHUGEPAGE
    ::madvise(data, size, MADV_NOHUGEPAGE); // a huge page would hold many chunks
#endif
    return {static_cast<std::byte*>(data), [size](std::byte* at) { ::munmap(at, size); }};
}

ChunkCache::ChunkCache(std::shared_ptr<const PackedSource> source, std::uint64_t limit)
    : source_(std::move(source)),
      page_(std::max<std::size_t>(system_page(), 4096)),
      places_(ChunkPlaces::on_pages(source_->directory, page_)),
      limit_(limit),
      guards_(guards_reserved) {
    report_.limit = limit;
}

void ChunkCache::add(CachedPieces& pieces) {
    const std::lock_guard lock(mutex_);
    all_.push_back(&pieces);
}

void ChunkCache::remove(CachedPieces& pieces) {
    const std::lock_guard lock(mutex_);
    for (std::size_t chunk = 0; chunk < pieces.states_.size(); ++chunk)
        if (pieces.states_[chunk].is == CachedPieces::Is::present) drop(pieces, chunk);
    std::erase(all_, &pieces);
}

std::uint64_t ChunkCache::bytes_in_memory(const CachedPieces& pieces, std::size_t chunk) const {
    std::uint64_t bytes = 0;
    const auto& arrays = pieces.kind().arrays;
    for (std::size_t a = 0; a < arrays.size(); ++a)
        bytes += whole_pages(pieces.kind().part(source_->directory, places_, a, chunk).size(), page_);
    return bytes;
}

/// With guarded address space: the pages of a piece, and of what may be read behind it.
void ChunkCache::let_use(const CachedPieces& pieces, std::size_t chunk, bool use) {
    if (!guards_) return;
    const auto& arrays = pieces.kind().arrays;
    for (std::size_t a = 0; a < arrays.size(); ++a) {
        const auto part = pieces.kind().part(source_->directory, places_, a, chunk);
        const std::uint64_t size = part.size() + core::slack_words * arrays[a].bytes_each;
        if (part.empty() ||
            ::mprotect(part.data(), whole_pages(size, page_), use ? PROT_READ | PROT_WRITE : PROT_NONE) == 0)
            continue;
        throw std::bad_alloc();
    }
}

void ChunkCache::drop(CachedPieces& pieces, std::size_t chunk) {
    const auto& arrays = pieces.kind().arrays;
    for (std::size_t a = 0; a < arrays.size(); ++a) {
        const auto part = pieces.kind().part(source_->directory, places_, a, chunk);
        if (!part.empty()) ::madvise(part.data(), whole_pages(part.size(), page_), MADV_DONTNEED);
    }
    let_use(pieces, chunk, false);
    pieces.states_[chunk].is = CachedPieces::Is::absent;
    report_.bytes -= bytes_in_memory(pieces, chunk);
    ++report_.pieces_dropped;
}

/// Gives pieces back that nothing works on, until `bytes` more are within the limit, or none is left.
void ChunkCache::make_room(std::uint64_t bytes) try {
    if (report_.bytes + bytes <= limit_) return;
    struct Candidate {
        std::uint64_t last_use;
        CachedPieces* pieces;
        std::size_t chunk;
    };
    std::vector<Candidate> candidates;
    for (CachedPieces* const pieces : all_)
        for (std::size_t chunk = 0; chunk < pieces->states_.size(); ++chunk) {
            const auto& state = pieces->states_[chunk];
            if (state.is == CachedPieces::Is::present && state.pins == 0)
                candidates.push_back({state.last_use, pieces, chunk});
        }
    std::ranges::stable_sort(candidates, {}, &Candidate::last_use);
    for (const Candidate& candidate : candidates) {
        if (report_.bytes + bytes <= limit_) return;
        drop(*candidate.pieces, candidate.chunk);
    }
} catch (const std::bad_alloc&) { // no memory for the list: nothing is given back now
}

/// Pins all; those to be read by this thread come back, marked so, and are counted.
std::vector<PieceWanted> ChunkCache::begin_loading(std::span<const PieceWanted> wanted) {
    std::vector<PieceWanted> missing;
    missing.reserve(wanted.size());
    std::uint64_t bytes = 0;
    ++clock_;
    for (const PieceWanted& one : wanted) {
        CachedPieces::State& state = one.pieces->states_[one.chunk];
        ++state.pins;
        state.last_use = clock_;
        if (state.is != CachedPieces::Is::absent) continue;
        let_use(*one.pieces, one.chunk, true);
        state.is = CachedPieces::Is::loading;
        missing.push_back(one);
        bytes += bytes_in_memory(*one.pieces, one.chunk);
    }
    make_room(bytes);
    report_.bytes += bytes;
    report_.peak_bytes = std::max(report_.peak_bytes, report_.bytes);
    return missing;
}

Result<void> ChunkCache::pin(std::span<const PieceWanted> wanted, const Progress& progress) {
    const auto is_read = [](const PieceWanted& one) { return !one.pieces->kind().fill; };
    std::unique_lock lock(mutex_);
    const std::vector<PieceWanted> mine = begin_loading(wanted);
    lock.unlock();
    const Result<void> read = core::guarded("reading", [&]() -> Result<void> { // else others would wait for ever
        std::vector<PieceWish> wishes, made;
        for (const PieceWanted& one : mine)
            (one.pieces->kind().fill ? made : wishes).push_back({&one.pieces->kind(), one.chunk});
        core::parallel_each(made.size(), 1, [&](std::size_t i) { made[i].kind->fill(made[i].chunk); });
        return wishes.empty() ? Result<void>() : read_pieces(*source_, places_, std::move(wishes), progress);
    });
    lock.lock();
    for (const PieceWanted& one : mine) {
        one.pieces->states_[one.chunk].is = CachedPieces::Is::present;
        if (!read) drop(*one.pieces, one.chunk);
    }
    if (read) report_.pieces_read += static_cast<std::uint64_t>(std::ranges::count_if(mine, is_read));
    if (!mine.empty()) loaded_.notify_all();
    if (!read) {
        unpin_locked(wanted);
        return read;
    }
    const auto is = [&](CachedPieces::Is what) {
        return std::ranges::any_of(wanted, [&](const PieceWanted& one) {
            return one.pieces->states_[one.chunk].is == what;
        });
    };
    // Not wait(): its symbol is one of g++ 12's library, which manylinux_2_34 does not have.
    while (is(CachedPieces::Is::loading)) loaded_.wait_for(lock, std::chrono::seconds(1));
    if (!is(CachedPieces::Is::absent)) return {};
    // Another thread failed to read it, or was cancelled: this one tries itself.
    unpin_locked(wanted);
    lock.unlock();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    return pin(wanted, progress);
}

void ChunkCache::unpin_locked(std::span<const PieceWanted> wanted) {
    for (const PieceWanted& one : wanted) --one.pieces->states_[one.chunk].pins;
    make_room(0);
}

void ChunkCache::unpin(std::span<const PieceWanted> wanted) {
    const std::lock_guard lock(mutex_);
    unpin_locked(wanted);
}

std::vector<std::size_t> ChunkCache::present(const CachedPieces& pieces) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::size_t> chunks;
    for (std::size_t chunk = 0; chunk < pieces.states_.size(); ++chunk)
        if (pieces.states_[chunk].is == CachedPieces::Is::present) chunks.push_back(chunk);
    return chunks;
}

ResidencyReport ChunkCache::report() const {
    const std::lock_guard lock(mutex_);
    ResidencyReport report = report_;
    report.bytes_read = source_->bytes_read.load(std::memory_order_relaxed);
    report.reads = source_->reads.load(std::memory_order_relaxed);
    return report;
}

} // namespace isotet::io
