// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/file_residency.hpp"

#include <algorithm>
#include <atomic>
#include <utility>
#include <variant>

#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/packed/boundary_piece.hpp"
#include "io/packed/checks.hpp"
#include "io/packed/file_arrays.hpp"

namespace isotet::io {

using core::Packed;

Result<void> Pins::add(std::span<CachedPieces* const> kinds, std::span<const std::size_t> chunks,
                       const Progress& progress) {
    std::vector<PieceWanted> wanted;
    for (const std::size_t chunk : chunks)
        for (CachedPieces* const kind : kinds) wanted.push_back({kind, chunk});
    pinned_.reserve(pinned_.size() + wanted.size());
    if (auto ok = store_->cache().pin(wanted, progress); !ok) return ok;
    pinned_.insert(pinned_.end(), wanted.begin(), wanted.end());
    return {};
}

std::vector<std::size_t> BroughtChunks::all() const {
    std::vector<std::size_t> chunks = own;
    chunks.insert(chunks.end(), beside.begin(), beside.end());
    return chunks;
}

FileResidency::FileResidency(std::shared_ptr<PackedStore> store, const FieldEntry& field)
    : store_(std::move(store)),
      field_(field),
      moved_(store_->moved_points(field.step)),
      packed_(store_->packed()),
      checked_(packed_.clusters()) {
    const PackedDirectory& d = store_->source().directory;
    set_field_of(field, packed_);
    if (moved_) moved_->give_to(packed_);
    const ArrayMaker maker(ArrayMaker::As::reserved, store_->cache().places());
    PieceKind values = values_kind(d, field, make_value_arrays(field, maker, packed_));
    values.check = [this](std::size_t k) {
        return check_values(packed_, chunk_range(store_->source().directory, store_->cache().places(), k));
    };
    values_ = std::make_unique<CachedPieces>(std::move(values), d.chunks.size());
    store_->cache().add(*values_);
}

Result<std::shared_ptr<FileResidency>> FileResidency::make(std::shared_ptr<PackedStore> store, const FieldEntry& field,
                                                           const Progress& progress) {
    std::shared_ptr<FileResidency> made(new FileResidency(std::move(store), field));
    if (auto ok = read_ranges(made->store_->source(), field, made->packed_, progress); !ok) return ok.error();
    return made;
}

FileResidency::~FileResidency() { store_->cache().remove(*values_); }

std::vector<CachedPieces*> FileResidency::kinds_of_step() const {
    std::vector<CachedPieces*> kinds{values_.get()};
    if (moved_) kinds.push_back(moved_->pieces.get());
    return kinds;
}

std::vector<std::size_t> FileResidency::chunks_of(std::span<const std::uint32_t> clusters) const {
    const ChunkPlaces& places = store_->cache().places();
    std::vector<std::size_t> chunks;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        if (!chunks.empty() && clusters[i] < places.first_cluster[chunks.back() + 1]) continue;
        chunks.push_back(places.chunk_of(clusters[i]));
    }
    return chunks;
}

/// Chunks with points that these clusters borrow, other than `own`.
std::vector<std::size_t> FileResidency::chunks_beside(std::span<const std::uint32_t> clusters,
                                                      std::span<const std::size_t> own) const {
    const ChunkPlaces& places = store_->cache().places();
    std::vector<std::uint8_t> named(places.first_cluster.size());
    core::parallel_ranges(clusters.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::size_t chunk = 0;
        for (std::size_t i = begin; i < end; ++i)
            for (const core::Neighbour& neighbour : packed_.cluster_links(clusters[i]).neighbours) {
                if (neighbour.cluster < places.first_cluster[chunk] ||
                    neighbour.cluster >= places.first_cluster[chunk + 1])
                    chunk = places.chunk_of(neighbour.cluster);
                std::atomic_ref(named[chunk]).store(1, std::memory_order_relaxed);
            }
    });
    for (const std::size_t chunk : own) named[chunk] = 0;
    std::vector<std::size_t> chunks;
    for (std::size_t chunk = 0; chunk < named.size(); ++chunk)
        if (named[chunk]) chunks.push_back(chunk);
    return chunks;
}

Result<void> FileResidency::check_hits(std::span<const std::uint32_t> clusters) const {
    FirstError first_error;
    core::parallel_ranges(clusters.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !first_error; ++i) {
            std::atomic_ref<std::uint8_t> checked(checked_[clusters[i]]);
            if (checked.load(std::memory_order_relaxed)) continue;
            if (auto ok = check_ranges(packed_, clusters[i]); !ok) first_error.add(i, ok.error());
            else checked.store(1, std::memory_order_relaxed);
        }
    });
    if (auto ok = first_error.result(); !ok) return store_->source().in_file(ok.error());
    return {};
}

std::uint64_t FileResidency::bytes_of(std::span<const std::size_t> chunks, std::span<CachedPieces* const> kinds) const {
    std::uint64_t bytes = 0;
    for (const std::size_t chunk : chunks)
        for (const CachedPieces* const kind : kinds) bytes += store_->cache().bytes_in_memory(*kind, chunk);
    return bytes;
}

Result<BroughtChunks> FileResidency::bring_cells(std::span<const std::uint32_t> clusters, core::Parts parts,
                                                 Amount amount, std::span<CachedPieces* const> more,
                                                 const Progress& progress) const {
    if (clusters.empty()) return BroughtChunks{};
    const ChunkPlaces& places = store_->cache().places();
    const std::uint64_t limit = store_->cache().limit();
    std::vector<CachedPieces*> points{&store_->points()}; // of neighbours, too
    if (moved_) points.push_back(moved_->pieces.get());
    std::vector<CachedPieces*> all = points;
    if (parts == core::Parts::all) all.push_back(&store_->topology());
    const auto bytes_with_more = [&](std::span<const std::size_t> some, std::span<CachedPieces* const> kinds) {
        return bytes_of(some, kinds) + bytes_of(some, more);
    };

    const std::vector<std::size_t> chunks = chunks_of(clusters);
    std::size_t count = amount == Amount::all ? chunks.size() : 1;
    std::uint64_t bytes = bytes_with_more(std::span(chunks).first(count), all);
    for (; count < chunks.size(); ++count) {
        bytes += bytes_with_more(std::span(chunks).subspan(count, 1), all);
        if (bytes > limit) break;
    }
    for (;; count /= 2) { // what the first chunks borrow must fit, too
        const std::span<const std::size_t> own = std::span(chunks).first(count);
        const auto end = std::ranges::lower_bound(clusters, places.first_cluster[own.back() + 1]);
        const auto some = clusters.first(static_cast<std::size_t>(end - clusters.begin()));
        BroughtChunks brought{some.size(), {own.begin(), own.end()}, {}, std::make_shared<Pins>(store_)};
        if (auto ok = brought.pins->add(all, own, progress); !ok) return ok.error();
        if (parts != core::Parts::all) return brought;
        brought.beside = chunks_beside(some, own);
        const bool fits = bytes_with_more(own, all) + bytes_with_more(brought.beside, points) <= limit;
        if (!fits && count > 1 && amount == Amount::fitting) continue;
        if (auto ok = brought.pins->add(points, brought.beside, progress); !ok) return ok.error();
        return brought;
    }
}

Result<core::Brought> FileResidency::bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                           const Progress& progress) const {
    if (clusters.empty()) return core::Brought{};
    CachedPieces* const values = values_.get();
    auto brought = bring_cells(clusters, parts, amount, {&values, 1}, progress);
    if (!brought) return brought.error();
    if (auto ok = brought->pins->add({&values, 1}, brought->all(), progress); !ok) return ok.error();
    if (parts == core::Parts::all)
        if (auto ok = check_hits(clusters.first(brought->count)); !ok) return ok.error();
    return core::Brought{brought->count, std::move(brought->pins)};
}

Result<std::optional<Surface>> FileResidency::boundary() const {
    if (!store_->source().directory.boundary) return std::optional<Surface>();
    Result<StoredBoundary> stored = read_boundary(store_->source(), field_.step);
    if (!stored) return stored.error();
    return std::optional(surface_of(*std::move(stored), packed_.point_type));
}

Result<Array> FileResidency::boundary_values() const {
    return std::visit(
        [&]<class Real>(const core::Values<Real>&) -> Result<Array> {
            const auto stored = read_boundary_values<Real>(store_->source(), field_);
            if (!stored) return stored.error();
            return user_values(*stored, field_.type, field_.storage);
        },
        packed_.reals);
}

core::Residency::Use FileResidency::use() const {
    const ResidencyReport report = store_->cache().report();
    return {report.bytes_read, report.bytes};
}

Result<std::shared_ptr<const Packed>> FileResidency::whole(const Progress& progress) const {
    return whole_grid_of_file(store_->source(), field_, nullptr, progress);
}

} // namespace isotet::io
