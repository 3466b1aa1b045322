// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed_series.hpp"

namespace isotet::cli {

Result<PackedSeries::Work> PackedSeries::pack_again(const Grid& grid, const PointField& field, Extractor& extractor,
                                                    const Progress& progress) {
    extractor.unload();
    packed_ = PackedGrid(); // the old one goes before the new one comes
    Result<PackedGrid> packed = pack(grid, field, options_, progress);
    if (!packed) return packed.error();
    packed_ = *std::move(packed);
    return Work::packed;
}

Result<PackedSeries::Work> PackedSeries::load(const Grid& grid, const PointField& field, Extractor& extractor,
                                              const Progress& progress) {
    if (!several_) return pack_again(grid, field, extractor, progress);
    const Fingerprint cells = fingerprint(grid.cells);
    const Fingerprint points = fingerprint(grid.points);
    const bool same_cells = cells_ == cells && packed_.user_points() == grid.points.tuples();
    const bool same_points = points_ == points;
    cells_ = cells;
    points_ = points;
    if (!same_cells) return pack_again(grid, field, extractor, progress);
    if (!same_points) {
        const Result<void> moved = extractor.set_points(packed_, grid.points, options_.threads);
        // A tet that turned over, or coordinates that packing has more to say about.
        if (!moved && moved.error().code == ErrorCode::invalid_data)
            return pack_again(grid, field, extractor, progress);
        if (!moved) return moved.error();
    }
    if (const Result<void> set = extractor.set_field(packed_, field, options_.threads); !set) return set.error();
    return same_points ? Work::set_field : Work::moved_points;
}

} // namespace isotet::cli
