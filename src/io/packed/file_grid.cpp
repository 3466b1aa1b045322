// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/file_grid.hpp"

#include <fcntl.h>

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/packed/boundary_piece.hpp"
#include "io/packed/checks.hpp"
#include "packed/field_storage.hpp"
#include "packed/residency.hpp"

namespace isotet::io {

using core::Packed;
using core::SharedBuffer;

namespace {

/// Makes the arrays of a packed grid.
class ArrayMaker {
public:
    enum class As { reserved, memory };
    ArrayMaker(As as, const ChunkPlaces& places) : as_(as), places_(places) {}

    /// `components`   numbers a point, word, link word or group;  `slack`  more that may be read at the end
    template <class T>
    ChunkedArray make(SharedBuffer<T>& out, Unit unit, std::size_t components = 1, std::size_t slack = 0) const {
        if (places_.size(unit) == 0) slack = 0; // as packing has it
        const std::size_t size = components * places_.size(unit) + slack;
        if (as_ == As::memory) {
            out = SharedBuffer<T>(size);
            std::fill(out.end() - static_cast<std::ptrdiff_t>(slack), out.end(), T{});
        } else {
            auto space = reserve_address_space(size * sizeof(T));
            T* const first = reinterpret_cast<T*>(space.get());
            out = SharedBuffer<T>(std::shared_ptr<T>(std::move(space), first), size);
        }
        return {reinterpret_cast<std::byte*>(out.data()), components * sizeof(T), unit};
    }

private:
    As as_;
    const ChunkPlaces& places_;
};

std::vector<ChunkedArray> make_point_arrays(const PackedDirectory& d, const ArrayMaker& maker, Packed& packed) {
    std::vector<ChunkedArray> arrays;
    std::visit([&](auto& reals) { arrays.push_back(maker.make(reals.positions, Unit::points, 3)); }, packed.reals);
    if (d.wide_point_ids) arrays.push_back(maker.make(packed.wide_point_ids, Unit::points));
    else arrays.push_back(maker.make(packed.point_ids, Unit::points));
    if (d.ranks) arrays.push_back(maker.make(packed.point_ranks, Unit::points));
    return arrays;
}

std::vector<ChunkedArray> make_topology_arrays(const PackedDirectory& d, const ArrayMaker& maker, Packed& packed) {
    std::vector<ChunkedArray> arrays;
    arrays.push_back(maker.make(packed.cells, Unit::words, 1, core::slack_words));
    arrays.push_back(maker.make(packed.links, Unit::links, 1, core::slack_words));
    if (d.cell_ids && d.wide_cell_ids) arrays.push_back(maker.make(packed.wide_cell_ids, Unit::words));
    else if (d.cell_ids) arrays.push_back(maker.make(packed.cell_ids, Unit::words));
    return arrays;
}

std::vector<ChunkedArray> make_value_arrays(const FieldEntry& field, const ArrayMaker& maker, Packed& packed) {
    std::vector<ChunkedArray> arrays;
    std::visit([&](auto& reals) { arrays.push_back(maker.make(reals.values, Unit::points)); }, packed.reals);
    arrays.push_back(maker.make(packed.group_ranges, Unit::groups));
    packed.gradients = {};
    if (field.gradients) arrays.push_back(maker.make(packed.gradients, Unit::points));
    return arrays;
}

/// All that the directory tells of the grid.
Packed packed_of(const PackedDirectory& d) {
    Packed packed;
    if (d.precision == Precision::float64) packed.reals = core::Values<double>{};
    packed.origin = d.origin;
    packed.point_type = d.point_type;
    packed.frame = d.frame;
    packed.user_points = d.user_points;
    packed.user_cells = d.user_cells;
    packed.report = d.report;
    packed.storage_cache = std::make_shared<core::StorageCache>();
    return packed;
}

void set_field_of(const FieldEntry& field, Packed& packed) {
    packed.storage = field.storage;
    packed.field = Array(field.type, nullptr, 0, 1, nullptr);
    packed.field_report = field.report;
    packed.report.gradient_bytes = field.gradients ? 4 * packed.report.points : 0;
}

PieceKind points_kind(const PackedDirectory& d, std::vector<ChunkedArray> arrays) {
    const auto checksum = [&d](std::size_t k) { return d.chunks[k].points_checksum; };
    return {std::move(arrays), PieceOffsets(d).points, checksum, {}};
}
PieceKind topology_kind(const PackedDirectory& d, std::vector<ChunkedArray> arrays) {
    const auto checksum = [&d](std::size_t k) { return d.chunks[k].topology_checksum; };
    return {std::move(arrays), PieceOffsets(d).topology, checksum, {}};
}
PieceKind values_kind(const PackedDirectory& d, const FieldEntry& field, std::vector<ChunkedArray> arrays) {
    const auto checksum = [&field](std::size_t k) { return field.values_checksums[k]; };
    return {std::move(arrays), values_offsets(d, field), checksum, {}};
}

} // namespace

PackedStore::PackedStore(std::shared_ptr<const PackedSource> source, std::uint64_t limit)
    : cache_(std::move(source), limit), packed_(packed_of(cache_.source().directory)) {
    const PackedDirectory& d = cache_.source().directory;
    const ArrayMaker maker(ArrayMaker::As::reserved, cache_.places());
    PieceKind points = points_kind(d, make_point_arrays(d, maker, packed_));
    points.check = [this](std::size_t k) {
        return check_points(packed_, chunk_range(cache_.source().directory, cache_.places(), k));
    };
    PieceKind topology = topology_kind(d, make_topology_arrays(d, maker, packed_));
    topology.check = [this](std::size_t k) {
        return check_topology(packed_, chunk_range(cache_.source().directory, cache_.places(), k));
    };
    points_ = std::make_unique<CachedPieces>(std::move(points), d.chunks.size());
    topology_ = std::make_unique<CachedPieces>(std::move(topology), d.chunks.size());
    cache_.add(*points_);
    cache_.add(*topology_);
}

PackedStore::~PackedStore() {
    cache_.remove(*points_);
    cache_.remove(*topology_);
}

Result<std::shared_ptr<PackedStore>> PackedStore::open(std::shared_ptr<const PackedSource> source, std::uint64_t limit,
                                                       const Progress& progress) {
    std::shared_ptr<PackedStore> store(new PackedStore(std::move(source), limit));
    auto headers = read_headers(store->source(), store->cache_.places(), progress);
    if (!headers) return headers.error();
    store->packed_.headers = *std::move(headers);
    return store;
}

std::uint64_t PackedStore::read_ahead(const FieldEntry& field) const {
    const PackedDirectory& d = source().directory;
    std::uint64_t asked = 0;
    const auto ask = [&](std::uint64_t offset, std::uint64_t bytes) {
        ::posix_fadvise(source().file.descriptor.number(), static_cast<off_t>(offset), static_cast<off_t>(bytes),
                        POSIX_FADV_WILLNEED); // without it they are read later
        asked += bytes;
    };
    std::uint64_t ranges = 0;
    for (const ChunkEntry& chunk : d.chunks) ranges += d.ranges_bytes(chunk);
    ask(field.ranges_offset, ranges);
    const std::vector<std::uint64_t> offsets = values_offsets(d, field);
    for (const std::size_t chunk : cache_.present(*topology_))
        ask(offsets[chunk], d.values_bytes(d.chunks[chunk], field));
    return asked;
}

/// Brings the chunks of a field.
class FileResidency final : public core::Residency {
public:
    static Result<std::shared_ptr<FileResidency>> make(std::shared_ptr<PackedStore> store, const FieldEntry& field,
                                                       const Progress& progress) {
        std::shared_ptr<FileResidency> made(new FileResidency(std::move(store), field));
        if (auto ok = read_ranges(made->store_->source(), field, made->packed_, progress); !ok) return ok.error();
        return made;
    }
    ~FileResidency() override { store_->cache().remove(*values_); }

    /// Without residency.
    const Packed& packed() const { return packed_; }

    Result<core::Brought> bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                const Progress& progress) const override;
    Result<std::optional<Surface>> boundary() const override {
        if (!store_->source().directory.boundary) return std::optional<Surface>();
        Result<StoredBoundary> stored = read_boundary(store_->source());
        if (!stored) return stored.error();
        return std::optional(std::move(stored->surface));
    }
    Result<Array> boundary_values() const override { return read_boundary_values(store_->source(), field_); }
    Use use() const override {
        const ResidencyReport report = store_->cache().report();
        return {report.bytes_read, report.bytes};
    }
    Result<std::shared_ptr<const Packed>> whole(const Progress& progress) const override {
        return whole_grid_of_file(store_->source(), field_, nullptr, progress);
    }

private:
    FileResidency(std::shared_ptr<PackedStore> store, const FieldEntry& field);

    /// Keeps pieces pinned while it lives.
    struct Pins {
        explicit Pins(std::shared_ptr<PackedStore> from) : store(std::move(from)) {}
        Pins(const Pins&) = delete;
        Pins& operator=(const Pins&) = delete;
        ~Pins() { store->cache().unpin(pinned); }

        std::shared_ptr<PackedStore> store;
        std::vector<PieceWanted> pinned;
    };

    Result<void> pin(std::span<const std::size_t> chunks, bool topology, Pins& pins, const Progress& progress) const;
    std::uint64_t bytes_of(std::span<const std::size_t> chunks, bool topology) const;
    Result<core::Brought> bring_chunks(std::span<const std::uint32_t> clusters, std::span<const std::size_t> own,
                                       Amount amount, const Progress& progress) const;
    std::vector<std::size_t> chunks_of(std::span<const std::uint32_t> clusters) const;
    std::vector<std::size_t> chunks_beside(std::span<const std::uint32_t> clusters,
                                           std::span<const std::size_t> own) const;
    Result<void> check_hits(std::span<const std::uint32_t> clusters) const;

    std::shared_ptr<PackedStore> store_;
    const FieldEntry& field_; ///< of the source's directory
    Packed packed_;
    std::unique_ptr<CachedPieces> values_;
    mutable std::vector<std::uint8_t> checked_; ///< clusters whose ranges were compared: other bytes would have other
                                                ///< checksums
};

FileResidency::FileResidency(std::shared_ptr<PackedStore> store, const FieldEntry& field)
    : store_(std::move(store)), field_(field), packed_(store_->packed_), checked_(packed_.clusters()) {
    const PackedDirectory& d = store_->source().directory;
    set_field_of(field, packed_);
    const ArrayMaker maker(ArrayMaker::As::reserved, store_->cache().places());
    PieceKind values = values_kind(d, field, make_value_arrays(field, maker, packed_));
    values.check = [this](std::size_t k) {
        return check_values(packed_, chunk_range(store_->source().directory, store_->cache().places(), k));
    };
    values_ = std::make_unique<CachedPieces>(std::move(values), d.chunks.size());
    store_->cache().add(*values_);
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

Result<void> FileResidency::pin(std::span<const std::size_t> chunks, bool topology, Pins& pins,
                                const Progress& progress) const {
    std::vector<PieceWanted> wanted;
    for (const std::size_t chunk : chunks) {
        wanted.push_back({store_->points_.get(), chunk});
        if (topology) wanted.push_back({store_->topology_.get(), chunk});
        wanted.push_back({values_.get(), chunk});
    }
    pins.pinned.reserve(pins.pinned.size() + wanted.size());
    if (auto ok = store_->cache().pin(wanted, progress); !ok) return ok;
    pins.pinned.insert(pins.pinned.end(), wanted.begin(), wanted.end());
    return {};
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

std::uint64_t FileResidency::bytes_of(std::span<const std::size_t> chunks, bool topology) const {
    const ChunkCache& cache = store_->cache();
    std::uint64_t bytes = 0;
    for (const std::size_t chunk : chunks) {
        bytes += cache.bytes_in_memory(*store_->points_, chunk) + cache.bytes_in_memory(*values_, chunk);
        if (topology) bytes += cache.bytes_in_memory(*store_->topology_, chunk);
    }
    return bytes;
}

/// Clusters of the chunks `own`, with their neighbours' points, or of the first ones of these so that all is within the
/// limit.
Result<core::Brought> FileResidency::bring_chunks(std::span<const std::uint32_t> clusters,
                                                  std::span<const std::size_t> own, Amount amount,
                                                  const Progress& progress) const {
    const ChunkPlaces& places = store_->cache().places();
    for (;;) {
        const auto end = std::ranges::lower_bound(clusters, places.first_cluster[own.back() + 1]);
        const auto some = clusters.first(static_cast<std::size_t>(end - clusters.begin()));
        auto pins = std::make_shared<Pins>(store_);
        if (auto ok = pin(own, true, *pins, progress); !ok) return ok.error();
        const std::vector<std::size_t> beside = chunks_beside(some, own);
        const bool fits = bytes_of(own, true) + bytes_of(beside, false) <= store_->cache().limit();
        if (!fits && own.size() > 1 && amount == Amount::fitting) {
            own = own.first(own.size() / 2);
            continue;
        }
        if (auto ok = pin(beside, false, *pins, progress); !ok) return ok.error();
        if (auto ok = check_hits(some); !ok) return ok.error();
        return core::Brought{some.size(), std::move(pins)};
    }
}

Result<core::Brought> FileResidency::bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                           const Progress& progress) const {
    if (clusters.empty()) return core::Brought{};
    const ChunkPlaces& places = store_->cache().places();
    const bool topology = parts == core::Parts::all;
    const std::vector<std::size_t> chunks = chunks_of(clusters);
    std::size_t count = amount == Amount::all ? chunks.size() : 1;
    std::uint64_t bytes = bytes_of(std::span(chunks).first(count), topology);
    for (; count < chunks.size(); ++count) {
        bytes += bytes_of(std::span(chunks).subspan(count, 1), topology);
        if (bytes > store_->cache().limit()) break;
    }
    const std::span<const std::size_t> own = std::span(chunks).first(count);
    if (topology) return bring_chunks(clusters, own, amount, progress);
    auto pins = std::make_shared<Pins>(store_);
    if (auto ok = pin(own, false, *pins, progress); !ok) return ok.error();
    const auto end = std::ranges::lower_bound(clusters, places.first_cluster[own.back() + 1]);
    return core::Brought{static_cast<std::size_t>(end - clusters.begin()), std::move(pins)};
}

Result<std::shared_ptr<const Packed>> grid_of_file(const std::shared_ptr<PackedStore>& store, const FieldEntry& field,
                                                   const Progress& progress) {
    auto residency = FileResidency::make(store, field, progress);
    if (!residency) return residency.error();
    auto packed = std::make_shared<Packed>((*residency)->packed());
    packed->residency = *std::move(residency);
    return std::shared_ptr<const Packed>(std::move(packed));
}

std::uint64_t bytes_of_whole(const PackedDirectory& d, const FieldEntry& field) {
    std::uint64_t bytes = d.clusters * sizeof(core::ClusterHeader);
    for (const ChunkEntry& chunk : d.chunks)
        bytes += d.points_bytes(chunk) + d.topology_bytes(chunk) + d.ranges_bytes(chunk) + d.values_bytes(chunk, field);
    return bytes;
}

namespace {

Result<void> check_all_ranges(const Packed& packed, const Progress& progress) {
    FirstError first_error;
    core::parallel_pieces(packed.clusters(), 256, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end && !first_error; ++c)
            if (auto ok = check_ranges(packed, static_cast<std::uint32_t>(c)); !ok) first_error.add(c, ok.error());
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    return first_error.result();
}

} // namespace

Result<std::shared_ptr<const Packed>> whole_grid_of_file(const PackedSource& source, const FieldEntry& field,
                                                         const Packed* same_cells, const Progress& progress) {
    const PackedDirectory& d = source.directory;
    if (auto ok = core::require_memory(fmt::format("all of {}", source.path), bytes_of_whole(d, field)); !ok)
        return ok.error();
    const ChunkPlaces places = ChunkPlaces::compact(d);
    const ArrayMaker maker(ArrayMaker::As::memory, places);
    auto packed = std::make_shared<Packed>(same_cells ? *same_cells : packed_of(d));
    set_field_of(field, *packed);
    std::vector<PieceKind> kinds;
    if (!same_cells) {
        auto headers = read_headers(source, places, progress);
        if (!headers) return headers.error();
        packed->headers = *std::move(headers);
        kinds.push_back(points_kind(d, make_point_arrays(d, maker, *packed)));
        kinds.back().check = [&](std::size_t k) { return check_points(*packed, chunk_range(d, places, k)); };
        kinds.push_back(topology_kind(d, make_topology_arrays(d, maker, *packed)));
        kinds.back().check = [&](std::size_t k) { return check_topology(*packed, chunk_range(d, places, k)); };
    }
    if (auto ok = read_ranges(source, field, *packed, progress); !ok) return ok.error();
    kinds.push_back(values_kind(d, field, make_value_arrays(field, maker, *packed)));
    kinds.back().check = [&](std::size_t k) { return check_values(*packed, chunk_range(d, places, k)); };
    std::vector<PieceWish> wishes;
    for (const PieceKind& kind : kinds)
        for (std::size_t chunk = 0; chunk < d.chunks.size(); ++chunk) wishes.push_back({&kind, chunk});
    if (auto ok = read_pieces(source, places, std::move(wishes), progress); !ok) return ok.error();
    if (auto ok = check_all_ranges(*packed, progress); !ok) return source.in_file(ok.error());
    return std::shared_ptr<const Packed>(std::move(packed));
}

} // namespace isotet::io
