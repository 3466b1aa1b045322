// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/corner_cells.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "grid/cells.hpp"
#include "linear/curved/curved_kinds.hpp"

namespace isotet::linear {

namespace {

/// Voxels keep their order of corners.
struct Corners {
    std::uint8_t type;
    std::uint64_t count;
};

Corners corners_of_kind(core::CellKind kind) {
    constexpr std::array<std::uint8_t, core::cell_kind_count> types{10, 14, 13, 12}; // by CellKind
    return {types[static_cast<std::size_t>(kind)], core::corner_count(kind)};
}

std::optional<Corners> corners_of(std::uint8_t type, std::uint64_t nodes) {
    if (const int count = core::corners_of(type); count > 0) return Corners{type, static_cast<std::uint64_t>(count)};
    if (const auto layout = layout_of(type, nodes)) return corners_of_kind(layout->kind);
    if (const auto high = high_degree_of(type, nodes)) return corners_of_kind(high->kind);
    return std::nullopt;
}

} // namespace

Grid corner_cells(const Grid& grid) {
    Grid out{grid.points, {}, {}, {}};
    const auto cells = core::CellReader::open(grid);
    if (!cells) return out;
    std::vector<std::uint64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    for (std::size_t cell = 0; cell < cells->count(); ++cell) {
        const std::uint64_t first = cells->first(cell), nodes = cells->corners(cell);
        const auto corners = corners_of(cells->type(cell), nodes);
        const std::uint64_t size = cells->connectivity_size();
        if (!corners || nodes < corners->count || first > size || corners->count > size - first) continue;
        for (std::uint64_t i = first; i < first + corners->count; ++i) connectivity.push_back(cells->corner(i));
        offsets.push_back(connectivity.size());
        types.push_back(corners->type);
    }
    out.cells.connectivity = Array::own(std::move(connectivity));
    out.cells.offsets = Array::own(std::move(offsets));
    out.cells.types = Array::own(std::move(types));
    return out;
}

} // namespace isotet::linear
