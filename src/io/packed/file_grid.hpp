// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed grids made of an open packed file: on address space that is filled as it is needed, or whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include <isotet/slice.hpp>

#include "io/packed/chunk_cache.hpp"
#include "packed/packed.hpp"

namespace isotet::io {

/// Positions of points from a step on, which fields of several steps share.
struct MovedPoints {
    MovedPoints(ChunkCache& cache, const PointsEntry& entry, const core::Packed& packed);
    MovedPoints(const MovedPoints&) = delete;
    MovedPoints& operator=(const MovedPoints&) = delete;
    ~MovedPoints() { cache.remove(*pieces); }

    /// In place of those of the chunks.
    void give_to(core::Packed& other) const;

    ChunkCache& cache;
    const PointsEntry& entry;
    core::Packed packed; ///< only its positions count
    std::unique_ptr<CachedPieces> pieces;
};

/// What all grids of a file share: headers, points and topology.
class PackedStore {
public:
    /// Errors   throws std::bad_alloc; as read_headers()
    static Result<std::shared_ptr<PackedStore>> open(std::shared_ptr<const PackedSource> source, std::uint64_t limit,
                                                     const Progress& progress);
    ~PackedStore();
    PackedStore(const PackedStore&) = delete;
    PackedStore& operator=(const PackedStore&) = delete;

    ChunkCache& cache() { return cache_; }
    const PackedSource& source() const { return cache_.source(); }
    CachedPieces& points() { return *points_; }
    CachedPieces& topology() { return *topology_; }
    const core::Packed& packed() const { return packed_; } ///< without a field

    /// Null where the points of a step are those of the chunks. Must not outlive the store.
    std::shared_ptr<const MovedPoints> moved_points(std::uint32_t step);

    /// As PackedFile::read_ahead().
    std::uint64_t read_ahead(const FieldEntry& field) const;

private:
    PackedStore(std::shared_ptr<const PackedSource> source, std::uint64_t limit);

    ChunkCache cache_;
    core::Packed packed_;
    std::unique_ptr<CachedPieces> points_, topology_;
    std::mutex mutex_;
    std::map<const PointsEntry*, std::weak_ptr<const MovedPoints>> moved_;
};

/// A grid of which parts are read as they are needed.
Result<std::shared_ptr<const core::Packed>> grid_of_file(const std::shared_ptr<PackedStore>& store,
                                                         const FieldEntry& field, const Progress& progress);

/// The grid of a field between its step and the next: values (1 - fraction) x those of `from` + fraction x those of `to`, of
/// points likewise where they move.
/// `fraction`   between 0 and 1
Result<std::shared_ptr<const core::Packed>> blended_grid_of_file(const std::shared_ptr<PackedStore>& store,
                                                                 const FieldEntry& from, const FieldEntry& to,
                                                                 double fraction, const Progress& progress);

/// The grid at the step of `field` with slice_field() of its points in place of the field.
Result<std::shared_ptr<const core::Packed>> sliced_grid_of_file(const std::shared_ptr<PackedStore>& store,
                                                                const FieldEntry& field, const SliceShape& shape,
                                                                const Progress& progress);

/// Of the arrays of a field's grid, all in memory.
std::uint64_t bytes_of_whole(const PackedDirectory& directory, const FieldEntry& field);

/// Of the cells and points that it is unpacked to.
std::uint64_t bytes_of_unpacked(const PackedDirectory& directory);

/// A grid in memory, all checked.
/// `same_cells`   null, or one of this file that is in memory already: only values are read
Result<std::shared_ptr<const core::Packed>> whole_grid_of_file(const PackedSource& source, const FieldEntry& field,
                                                               const core::Packed* same_cells,
                                                               const Progress& progress);

} // namespace isotet::io
