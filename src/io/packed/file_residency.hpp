// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What brings the chunks of a field of an open packed file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "io/packed/file_grid.hpp"
#include "packed/residency.hpp"

namespace isotet::io {

/// Pieces that are pinned while it lives.
class Pins {
public:
    explicit Pins(std::shared_ptr<PackedStore> store) : store_(std::move(store)) {}
    Pins(const Pins&) = delete;
    Pins& operator=(const Pins&) = delete;
    ~Pins() { store_->cache().unpin(pinned_); }

    /// One of each kind for each chunk.
    /// Errors   as ChunkCache::pin()
    Result<void> add(std::span<CachedPieces* const> kinds, std::span<const std::size_t> chunks,
                     const Progress& progress);

private:
    std::shared_ptr<PackedStore> store_;
    std::vector<PieceWanted> pinned_;
};

/// Chunks that clusters need.
struct BroughtChunks {
    std::size_t count = 0;                ///< of the clusters, the first ones
    std::vector<std::size_t> own, beside; ///< that hold them; with points that they borrow, where cells were wanted
    std::shared_ptr<Pins> pins;

    std::vector<std::size_t> all() const;
};

class FileResidency final : public core::Residency {
public:
    static Result<std::shared_ptr<FileResidency>> make(std::shared_ptr<PackedStore> store, const FieldEntry& field,
                                                       const Progress& progress);
    ~FileResidency() override;

    /// Without residency.
    const core::Packed& packed() const { return packed_; }
    const FieldEntry& field() const { return field_; }
    const std::shared_ptr<PackedStore>& store() const { return store_; }
    /// The points of the step where they are not those of the chunks, and values.
    std::vector<CachedPieces*> kinds_of_step() const;

    /// Points of the step and, with Parts::all, topology: what the grids of all fields need.
    /// `more`   kinds that are to be pinned for the same chunks, and count where these must fit
    Result<BroughtChunks> bring_cells(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                      std::span<CachedPieces* const> more, const Progress& progress) const;

    /// Ranges of clusters, whose values and those of their neighbours are in memory, against these.
    Result<void> check_hits(std::span<const std::uint32_t> clusters) const;

    Result<core::Brought> bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                const Progress& progress) const override;
    Result<std::optional<Surface>> boundary() const override;
    Result<Array> boundary_values() const override;
    Use use() const override;
    Result<std::shared_ptr<const core::Packed>> whole(const Progress& progress) const override;

private:
    FileResidency(std::shared_ptr<PackedStore> store, const FieldEntry& field);

    std::uint64_t bytes_of(std::span<const std::size_t> chunks, std::span<CachedPieces* const> kinds) const;
    std::vector<std::size_t> chunks_of(std::span<const std::uint32_t> clusters) const;
    std::vector<std::size_t> chunks_beside(std::span<const std::uint32_t> clusters,
                                           std::span<const std::size_t> own) const;

    std::shared_ptr<PackedStore> store_;
    const FieldEntry& field_;                  ///< of the source's directory
    std::shared_ptr<const MovedPoints> moved_; ///< null where the points are those of the chunks
    core::Packed packed_;
    std::unique_ptr<CachedPieces> values_;
    mutable std::vector<std::uint8_t> checked_; ///< clusters whose ranges were compared: other bytes would have other
                                                ///< checksums
};

} // namespace isotet::io
