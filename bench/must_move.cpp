// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/must_move.hpp"

#include <algorithm>

#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::bench {

namespace {

template <class Real>
std::uint64_t bytes_of_selected(const core::Packed& packed, Real isovalue) {
    const core::Values<Real>& reals = packed.as<Real>();
    std::uint64_t bytes = reals.ranges.bytes();
    for (std::size_t cluster = 0; cluster < packed.clusters(); ++cluster) {
        const core::Range<Real>& range = reals.ranges[cluster];
        if (!(range.lower <= isovalue && isovalue <= range.upper)) continue;
        const core::ClusterHeader& header = packed.headers[cluster];
        bytes += sizeof(header) + 4 * core::ClusterLinks::words(header) + 4 * sizeof(Real) * header.own_points;
        const std::uint8_t step = core::quantize(isovalue, range);
        std::size_t group = header.first_group;
        for (const core::CellKind kind : core::cell_kinds)
            for (std::size_t left = core::words_of(kind) * header.count(kind); left; ++group) {
                const core::GroupRange steps = packed.group_ranges[group];
                const std::size_t words = std::min(left, core::group_size);
                bytes += sizeof(steps);
                if (steps.lower <= step && step <= steps.upper) bytes += words * sizeof(core::StoredTet);
                left -= words;
            }
    }
    return bytes;
}

} // namespace

std::uint64_t bytes_of(const Surface& surface) {
    std::uint64_t bytes = surface.positions.bytes() + surface.triangles.bytes() + surface.normals.bytes() +
                          surface.edge_ends.bytes() + surface.edge_weights.bytes() + surface.source_cells.bytes();
    for (const Field& field : surface.point_fields) bytes += field.values.bytes();
    for (const Field& field : surface.cell_fields) bytes += field.values.bytes();
    return bytes;
}

std::uint64_t extraction_must_move(const PackedGrid& packed, double isovalue, const Surface& surface) {
    const core::Packed& data = packed.data();
    const auto read = [&]<class Real>() {
        return bytes_of_selected(data, core::store_isovalue<Real>(isovalue, data.storage).value);
    };
    return (data.single() ? read.operator()<float>() : read.operator()<double>()) + bytes_of(surface);
}

std::uint64_t new_field_must_move(const PackedGrid& packed, std::uint64_t field_bytes) {
    const core::Packed& data = packed.data();
    const std::uint64_t read = field_bytes + data.point_ids.bytes() + data.wide_point_ids.bytes() +
                               data.headers.bytes() + data.links.bytes() + data.cells.bytes();
    const std::uint64_t written =
        std::visit([](const auto& reals) { return reals.values.bytes() + reals.ranges.bytes(); }, data.reals);
    return read + written + data.group_ranges.bytes();
}

} // namespace isotet::bench
