// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/file_grid.hpp"

#include <fcntl.h>

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/packed/checks.hpp"
#include "io/packed/file_arrays.hpp"
#include "io/packed/file_residency.hpp"

namespace isotet::io {

using core::Packed;

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

MovedPoints::MovedPoints(ChunkCache& where, const PointsEntry& moved, const Packed& of)
    : cache(where), entry(moved), packed(of) {
    const PackedDirectory& d = cache.source().directory;
    const ArrayMaker maker(ArrayMaker::As::reserved, cache.places());
    PieceKind kind = positions_kind(d, entry, make_position_arrays(maker, packed));
    kind.check = [this](std::size_t k) {
        return check_positions(packed, chunk_range(cache.source().directory, cache.places(), k));
    };
    pieces = std::make_unique<CachedPieces>(std::move(kind), d.chunks.size());
    cache.add(*pieces);
}

void MovedPoints::give_to(Packed& other) const {
    std::visit([&]<class Real>(core::Values<Real>& reals) { reals.positions = packed.as<Real>().positions; },
               other.reals);
    set_points_of(entry, other);
}

std::shared_ptr<const MovedPoints> PackedStore::moved_points(std::uint32_t step) {
    const PointsEntry* const entry = source().directory.points_at(step);
    if (!entry) return nullptr;
    const std::lock_guard lock(mutex_);
    std::weak_ptr<const MovedPoints>& known = moved_[entry];
    std::shared_ptr<const MovedPoints> points = known.lock();
    if (!points) known = points = std::make_shared<const MovedPoints>(cache_, *entry, packed_);
    return points;
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
    const PointsEntry* const moved = d.points_at(field.step);
    const std::vector<std::uint64_t> positions = moved ? positions_offsets(d, *moved) : std::vector<std::uint64_t>();
    for (const std::size_t chunk : cache_.present(*topology_)) {
        ask(offsets[chunk], d.values_bytes(d.chunks[chunk], field));
        if (moved) ask(positions[chunk], d.positions_bytes(d.chunks[chunk]));
    }
    return asked;
}

Result<std::shared_ptr<const Packed>> grid_of_file(const std::shared_ptr<PackedStore>& store, const FieldEntry& field,
                                                   const Progress& progress) {
    auto residency = FileResidency::make(store, field, progress);
    if (!residency) return residency.error();
    auto packed = std::make_shared<Packed>((*residency)->packed());
    packed->residency = *std::move(residency);
    return std::shared_ptr<const Packed>(std::move(packed));
}

/// Of what fields do not share.
static std::uint64_t bytes_of_field(const PackedDirectory& d, const FieldEntry& field) {
    const bool moved = d.points_at(field.step) != nullptr;
    std::uint64_t bytes = 0;
    for (const ChunkEntry& chunk : d.chunks)
        bytes += d.ranges_bytes(chunk) + d.values_bytes(chunk, field) + (moved ? d.positions_bytes(chunk) : 0);
    return bytes;
}

std::uint64_t bytes_of_whole(const PackedDirectory& d, const FieldEntry& field) {
    std::uint64_t bytes = d.clusters * sizeof(core::ClusterHeader) + bytes_of_field(d, field);
    for (const ChunkEntry& chunk : d.chunks) bytes += d.points_bytes(chunk) + d.topology_bytes(chunk);
    return bytes;
}

std::uint64_t bytes_of_unpacked(const PackedDirectory& d) {
    const PackReport& cells = d.report;
    const std::uint64_t corners = 4 * cells.tets + 5 * cells.pyramids + 6 * cells.wedges + 8 * cells.hexahedra;
    const std::uint64_t others = cells.pyramids + cells.wedges + cells.hexahedra;
    return corners * (d.user_points < (std::uint64_t{1} << 31) ? 4 : 8) + (others ? (others + cells.tets) * 9 : 0) +
           3 * d.user_points * size_of(d.point_type);
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
    const std::uint64_t bytes = same_cells ? bytes_of_field(d, field) : bytes_of_whole(d, field);
    if (auto ok = core::require_memory(fmt::format("all of {}", source.path), bytes); !ok) return ok.error();
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
    Packed with_points = *packed; // of the step
    if (const PointsEntry* const moved = d.points_at(field.step)) {
        set_points_of(*moved, with_points);
        kinds.push_back(positions_kind(d, *moved, make_position_arrays(maker, with_points)));
        kinds.back().check = [&](std::size_t k) { return check_positions(with_points, chunk_range(d, places, k)); };
    }
    std::vector<PieceWish> wishes;
    for (const PieceKind& kind : kinds)
        for (std::size_t chunk = 0; chunk < d.chunks.size(); ++chunk) wishes.push_back({&kind, chunk});
    if (auto ok = read_pieces(source, places, std::move(wishes), progress); !ok) return ok.error();
    if (auto ok = check_all_ranges(*packed, progress); !ok) return source.in_file(ok.error());
    return std::make_shared<const Packed>(std::move(with_points));
}

} // namespace isotet::io
