// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The part of the cutter that is for pyramids, wedges and hexahedra. Included by cutter.cpp alone, which instantiates it.
#pragma once

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "cpu/direct/cutter.hpp"
#include "grid/cell/cell_cases.hpp"

namespace isotet::cpu::direct {

/// A cell of the batch that gives triangles.
struct CutCell {
    std::uint32_t in_batch;
    std::uint8_t index; ///< its case as the file has it, then as it is stored
    bool has_tied;
};

/// Which of the triangles (0, 1, 2) and (0, 2, 3) of a polygon have three different corners. Puts the only one that has
/// first. Returns how many.
template <class Edge>
unsigned drop_degenerate(std::array<Edge, 4>& polygon, unsigned triangles) {
    const auto differ = [&](std::size_t a, std::size_t b, std::size_t c) {
        return polygon[a] != polygon[b] && polygon[b] != polygon[c] && polygon[c] != polygon[a];
    };
    const bool first = differ(0, 1, 2), second = triangles == 2 && differ(0, 2, 3);
    if (second && !first) polygon[1] = polygon[2], polygon[2] = polygon[3];
    if (!(first && second)) polygon[3] = polygon[2];
    return unsigned{first} + unsigned{second};
}

inline unsigned mirrored_case(core::CellKind kind, unsigned index) {
    const auto& order = core::mirrored_corners[static_cast<std::size_t>(kind)];
    unsigned out = 0;
    for (std::size_t k = 0; k < core::corner_count(kind); ++k) out |= (index >> order[k] & 1) << k;
    return out;
}

template <class Point>
void Cutter<Point>::cut_cells() {
    const std::size_t count = std::exchange(pending_cells_, 0);
    std::array<CutCell, std::tuple_size_v<decltype(cell_batch_)>> cut;
    std::size_t cut_count = 0, polygon_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        NativeCell<Point>& cell = cell_batch_[i];
        unsigned seen = 0, index = 0;
        for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k) {
            const unsigned flags = context_.sides[cell.corners[k]];
            seen |= flags;
            index |= (flags & side::above) << k;
        }
        if (seen & side::no_data) continue;
        std::array<core::Point, 8> places;
        for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k) places[k] = points_[cell.corners[k]];
        if (!core::is_ordered(context_.input.cells.type(first_cell_ + cells_[i])) &&
            core::is_mirrored(cell.kind, cell.corners,
                              [&](std::size_t k) -> const core::Point& { return places[k]; })) {
            index = mirrored_case(cell.kind, index);
            cell.corners = core::mirrored(cell.kind, cell.corners);
        }
        polygon_count += core::polygons_of(cell.kind, index).size();
        cut[cut_count++] = {static_cast<std::uint32_t>(i), static_cast<std::uint8_t>(index), (seen & side::tied) != 0};
    }

    auto* const polygons = arena_.template take<std::array<std::uint32_t, 4>>(polygon_count);
    auto* const triangles = arena_.template take<std::uint8_t>(polygon_count);
    auto* const places = context_.keep_cells ? arena_.template take<std::uint32_t>(polygon_count) : nullptr;
    auto* const found = found_arena_.template take<ActiveEdge<Point>>(4 * polygon_count + 1);
    EdgeNumbers<Point> edge_numbers(memory_, chunks_, edges_, found);
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < cut_count; ++i) {
        const NativeCell<Point>& cell = cell_batch_[cut[i].in_batch];
        const std::uint32_t before = kept;
        for (const core::CellPolygon& polygon : core::polygons_of(cell.kind, cut[i].index)) {
            std::array<ActiveEdge<Point>, 4> edges;
            for (std::size_t k = 0; k < 4; ++k) {
                const Point above = cell.corners[polygon.edges[k].above];
                const Point below = cell.corners[polygon.edges[k].below];
                const bool is_tied = cut[i].has_tied && (context_.sides[above] & side::tied);
                edges[k] = is_tied ? ActiveEdge<Point>{above, above}
                                   : ActiveEdge<Point>{std::min(above, below), std::max(above, below)};
            }
            const unsigned made = cut[i].has_tied ? drop_degenerate(edges, polygon.triangles) : polygon.triangles;
            if (made == 0) continue;
            for (std::size_t k = 0; k < 4; ++k) polygons[kept][k] = edge_numbers.of(edges[k]);
            triangles[kept] = static_cast<std::uint8_t>(made);
            if (places) places[kept] = cells_[cut[i].in_batch];
            chunk_->triangles += made;
            ++kept;
        }
        if (context_.rounds_coordinates && kept > before) counts_.coarse_tets += is_coarse(cell);
    }
    const std::uint32_t new_edges = keep_found(edge_numbers);
    if (kept) chunk_->pieces.push_back({kept, new_edges, polygons, triangles, places, found});
}

template <class Point>
bool Cutter<Point>::is_coarse(const NativeCell<Point>& cell) const {
    std::array<core::Point, 8> exact;
    double moved = 0, shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k) {
        exact[k] = points_[cell.corners[k]];
        core::Point stored;
        for (std::size_t axis = 0; axis < 3; ++axis)
            stored[axis] = core::store_coordinate<float>(exact[k][axis], context_.origin[axis]) + context_.origin[axis];
        moved = std::max(moved, core::squared_distance(exact[k], stored));
    }
    for (const auto& [a, b] : core::edges_of(cell.kind))
        if (cell.corners[a] != cell.corners[b])
            shortest = std::min(shortest, core::squared_distance(exact[a], exact[b]));
    return moved > 1e-6 * shortest;
}

} // namespace isotet::cpu::direct
