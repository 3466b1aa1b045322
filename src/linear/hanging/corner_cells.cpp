// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/corner_cells.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "grid/cell_faces.hpp"
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

CornerCells corner_cells(const Grid& grid) {
    CornerCells out{{grid.points, {}, {}, {}}, {}};
    const auto cells = core::CellReader::open(grid);
    const auto listed = core::FaceReader::open(grid.cells);
    if (!cells || !listed) return out;
    std::vector<std::uint64_t> connectivity, offsets{0}, faces, face_offsets{0};
    std::vector<std::uint8_t> types;
    for (std::size_t cell = 0; cell < cells->count(); ++cell) {
        const std::uint64_t first = cells->first(cell), nodes = cells->corners(cell);
        const std::uint64_t size = cells->connectivity_size();
        const bool is_polyhedron = core::is_polyhedron(*cells, *listed, cell);
        const auto corners =
            is_polyhedron ? std::optional(Corners{cells->type(cell), nodes}) : corners_of(cells->type(cell), nodes);
        if (!corners || nodes < corners->count || first > size || corners->count > size - first) continue;
        for (std::uint64_t i = first; i < first + corners->count; ++i) connectivity.push_back(cells->corner(i));
        for (std::uint64_t i = listed->begin(cell); i < listed->end(cell); ++i) faces.push_back(listed->at(i));
        offsets.push_back(connectivity.size());
        face_offsets.push_back(faces.size());
        types.push_back(corners->type);
        out.sources.push_back(cell);
    }
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    out.grid.cells.offsets = Array::own(std::move(offsets));
    out.grid.cells.types = Array::own(std::move(types));
    if (!faces.empty()) {
        out.grid.cells.faces = Array::own(std::move(faces));
        out.grid.cells.face_offsets = Array::own(std::move(face_offsets));
    }
    return out;
}

} // namespace isotet::linear
