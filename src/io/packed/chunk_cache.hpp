// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which pieces of a packed file are in memory: brought when they are wanted, kept while they are worked on, given back least
// recently used first.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <isotet/packed_file.hpp>

#include "io/packed/piece_reader.hpp"

namespace isotet::io {

/// Zero-filled address space, of which only pages that are written to take memory.
/// Errors   throws std::bad_alloc
std::shared_ptr<std::byte> reserve_address_space(std::size_t bytes);

/// For tests: what is reserved from now on can be read and written only where pieces are in memory, and ends the process elsewhere.
void guard_address_space(bool guard);

/// Pieces of a kind, and what is known of each.
class CachedPieces {
public:
    CachedPieces(PieceKind kind, std::size_t chunks) : kind_(std::move(kind)), states_(chunks) {}

    const PieceKind& kind() const { return kind_; }

private:
    friend class ChunkCache;
    enum class Is : std::uint8_t { absent, loading, present };
    struct State {
        std::uint64_t last_use = 0;
        std::uint32_t pins = 0;
        Is is = Is::absent;
    };

    PieceKind kind_;
    std::vector<State> states_; ///< a chunk; guarded by the cache
};

struct PieceWanted {
    CachedPieces* pieces;
    std::size_t chunk;
};

/// Threads   safe from many threads: a piece is read by one of them, the others wait for it
class ChunkCache {
public:
    ChunkCache(std::shared_ptr<const PackedSource> source, std::uint64_t limit);

    const PackedSource& source() const { return *source_; }
    const ChunkPlaces& places() const { return places_; }

    void add(CachedPieces& pieces);
    /// Its memory is not counted any more.
    void remove(CachedPieces& pieces);

    /// Brings pieces and pins each once; nothing is pinned after an error. What pieces are made of (PieceKind::fill) must have been
    /// pinned before.
    /// Errors   as read_pieces()
    Result<void> pin(std::span<const PieceWanted> wanted, const Progress& progress);
    void unpin(std::span<const PieceWanted> wanted);

    /// In memory, whole pages.
    std::uint64_t bytes_in_memory(const CachedPieces& pieces, std::size_t chunk) const;
    std::uint64_t limit() const { return limit_; }
    ResidencyReport report() const;
    /// Chunks whose pieces are in memory, ascending.
    std::vector<std::size_t> present(const CachedPieces& pieces) const;

private:
    void make_room(std::uint64_t bytes);
    void drop(CachedPieces& pieces, std::size_t chunk);
    void let_use(const CachedPieces& pieces, std::size_t chunk, bool use);
    void unpin_locked(std::span<const PieceWanted> wanted);
    std::vector<PieceWanted> begin_loading(std::span<const PieceWanted> wanted);

    std::shared_ptr<const PackedSource> source_;
    std::size_t page_;
    ChunkPlaces places_;
    std::uint64_t limit_;
    bool guards_; ///< guard_address_space()

    mutable std::mutex mutex_;
    std::condition_variable loaded_;
    std::vector<CachedPieces*> all_;
    std::uint64_t clock_ = 0;
    ResidencyReport report_;
};

} // namespace isotet::io
