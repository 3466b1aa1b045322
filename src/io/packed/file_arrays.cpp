// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/file_arrays.hpp"

#include <variant>

#include "packed/field_storage.hpp"

namespace isotet::io {

using core::Packed;

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

std::vector<ChunkedArray> make_position_arrays(const ArrayMaker& maker, Packed& packed) {
    return std::visit([&](auto& reals) { return std::vector{maker.make(reals.positions, Unit::points, 3)}; },
                      packed.reals);
}

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

void set_points_of(const PointsEntry& points, Packed& packed) {
    packed.origin = points.origin;
    packed.report.flushed_coordinates = points.flushed_coordinates;
    packed.report.coarse_clusters = points.coarse_clusters;
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
PieceKind positions_kind(const PackedDirectory& d, const PointsEntry& points, std::vector<ChunkedArray> arrays) {
    const auto checksum = [&points](std::size_t k) { return points.checksums[k]; };
    return {std::move(arrays), positions_offsets(d, points), checksum, {}};
}

} // namespace isotet::io
