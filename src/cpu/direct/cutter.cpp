// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/cutter.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "cpu/at_level.hpp"
#include "cpu/direct/cut_cells.hpp"
#include "cpu/direct/orient.hpp"
#include "grid/cell/case_table.hpp"

namespace isotet::cpu::direct {

namespace {

/// The polygon of a tet with its corners ascending: from which to which corner each of its edges goes. The fourth
/// repeats the third when there are three.
struct SortedPolygon {
    std::array<std::uint8_t, 4> lower{}, higher{};
    std::uint8_t triangles = 0;
};

/// By case, and 16 more where the volume is negative: the stored form then has its last two corners exchanged.
constexpr std::array<SortedPolygon, 32> sorted_polygons = [] {
    std::array<SortedPolygon, 32> table{};
    for (unsigned code = 0; code < 32; ++code) {
        const std::array<std::uint8_t, 4> place =
            code & 16 ? std::array<std::uint8_t, 4>{0, 1, 3, 2} : std::array<std::uint8_t, 4>{0, 1, 2, 3};
        unsigned stored_case = 0;
        for (unsigned k = 0; k < 4; ++k) stored_case |= (code >> place[k] & 1) << k;
        const core::TetCase& c = core::case_table[stored_case];
        table[code].triangles = c.triangles;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint8_t a = place[c.polygon[k].above], b = place[c.polygon[k].below];
            table[code].lower[k] = std::min(a, b);
            table[code].higher[k] = std::max(a, b);
        }
    }
    return table;
}();

} // namespace

template <class Point>
Cutter<Point>::Cutter(CutContext& context, std::size_t number)
    : context_(context),
      number_(number),
      points_(context.input.grid.points),
      arena_(context.budget),
      found_arena_(context.budget),
      in_range_(context.ranges.count, 0),
      memory_(std::size_t{1} << edge_memory_bits, RememberedEdge<Point>{{0, 0}, 0, 0}) {}

template <class Point>
void Cutter<Point>::begin(Chunk<Point>& chunk, std::uint64_t first_cell) {
    chunk_ = &chunk;
    first_cell_ = first_cell;
    chunk.cutter = number_;
    ++chunks_;
    edges_ = 0;
    pending_ = 0;
}

template <class Point>
void Cutter<Point>::end() {
    if (pending_) cut();
    if (pending_cells_) cut_cells();
    chunk_->edges = edges_;
    counts_.edges += edges_;
    counts_.triangles += chunk_->triangles;
}

template <class Point>
void Cutter<Point>::cut() {
    const std::size_t count = std::exchange(pending_, 0);
    for (std::size_t i = 0; i < count; ++i) {
        unsigned seen = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Point point = corners_[k][i];
            const unsigned flags = context_.sides[point];
            sorted_[k][i] = static_cast<Point>(2 * point + (flags & side::above));
            seen |= flags;
        }
        codes_[i] = seen & (side::tied | side::no_data) ? tet_code::special : 0;
    }
    if (std::exchange(has_ordered_, false))
        for (std::size_t i = 0; i < count; ++i)
            if (is_ordered(i)) codes_[i] |= tet_code::unsure;
    const auto sort_and_sign = [&](const auto* coordinates) {
        at_level([&] {
            sort_corners(sorted_, codes_, count);
            sign_tets(sorted_, codes_, count, coordinates);
        });
    };
    const Array& points = context_.input.grid.points;
    if (points.type() == ScalarType::float32) sort_and_sign(points.as<float>().data());
    else sort_and_sign(points.as<double>().data());

    auto* const polygons = arena_.template take<std::array<std::uint32_t, 4>>(count);
    auto* const triangles = arena_.template take<std::uint8_t>(count);
    auto* const cells = context_.keep_cells ? arena_.template take<std::uint32_t>(count) : nullptr;
    auto* const found = found_arena_.template take<ActiveEdge<Point>>(4 * count + 1);
    EdgeNumbers<Point> edge_numbers(memory_, chunks_, edges_, found);
    std::uint32_t tets = 0;
    std::uint64_t made_triangles = 0;
    for (std::size_t i = 0; i < count; ++i) {
        unsigned made;
        std::array<std::uint32_t, 4>& numbers = polygons[tets];
        if (codes_[i] & tet_code::unusual) [[unlikely]] {
            std::array<ActiveEdge<Point>, 4> polygon;
            made = unusual_polygon(i, polygon);
            if (made == 0) continue;
            for (std::size_t k = 0; k < 4; ++k) numbers[k] = edge_numbers.of(polygon[k]);
        } else {
            const SortedPolygon& p = sorted_polygons[codes_[i]];
            made = p.triangles;
            for (std::size_t k = 0; k < 4; ++k)
                numbers[k] = edge_numbers.of({sorted_[p.lower[k]][i] >> 1, sorted_[p.higher[k]][i] >> 1});
        }
        triangles[tets] = static_cast<std::uint8_t>(made);
        if (cells) cells[tets] = cells_[i];
        made_triangles += made;
        ++tets;
        if (context_.rounds_coordinates) counts_.coarse_tets += is_coarse(i);
    }
    chunk_->triangles += made_triangles;
    const std::uint32_t new_edges = keep_found(edge_numbers);
    if (tets) chunk_->pieces.push_back({tets, new_edges, polygons, triangles, cells, found});
}

/// Counts what was found by range, and keeps it. Returns how many.
template <class Point>
std::uint32_t Cutter<Point>::keep_found(const EdgeNumbers<Point>& numbers) {
    for (const ActiveEdge<Point>* edge = numbers.found(); edge < numbers.end(); ++edge)
        ++in_range_[context_.ranges.of(edge->lower)];
    const auto count = static_cast<std::uint32_t>(numbers.end() - numbers.found());
    found_arena_.keep(numbers.found(), count);
    edges_ += count;
    return count;
}

/// The polygon of a tet that the batch leaves open, with equal edges at a tied point; the fourth repeats the third when
/// there is one triangle. Returns the number of triangles.
template <class Point>
unsigned Cutter<Point>::unusual_polygon(std::size_t tet, std::array<ActiveEdge<Point>, 4>& polygon) {
    std::uint8_t code = codes_[tet];
    if (code & tet_code::collapsed) return 0;
    std::array<Point, 4> corner;
    std::array<bool, 4> is_tied;
    for (std::size_t k = 0; k < 4; ++k) {
        corner[k] = sorted_[k][tet] >> 1;
        const std::uint8_t flags = context_.sides[corner[k]];
        if (flags & side::no_data) return 0;
        is_tied[k] = flags & side::tied;
    }
    if (code & tet_code::unsure) {
        const auto is_negative = [&] {
            if (is_ordered(tet)) return is_odd(tet);
            const int sign = points_.orientation({corner[0], corner[1], corner[2], corner[3]});
            return sign < 0 || (sign == 0 && is_mirrored_flat(tet));
        };
        code = static_cast<std::uint8_t>((code & tet_code::case_mask) | (is_negative() ? tet_code::negative : 0));
    }
    const SortedPolygon& p = sorted_polygons[code & (tet_code::case_mask | tet_code::negative)];
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t a = p.lower[k], b = p.higher[k], above = code >> a & 1 ? a : b;
        polygon[k] =
            is_tied[above] ? ActiveEdge<Point>{corner[above], corner[above]} : ActiveEdge<Point>{corner[a], corner[b]};
    }
    const auto differ = [&](std::size_t a, std::size_t b, std::size_t c) {
        return polygon[a] != polygon[b] && polygon[b] != polygon[c] && polygon[c] != polygon[a];
    };
    const bool first = differ(0, 1, 2), second = p.triangles == 2 && differ(0, 2, 3);
    if (first && second) return 2;
    if (!first && !second) return 0;
    if (second) polygon[1] = polygon[2], polygon[2] = polygon[3];
    polygon[3] = polygon[2];
    return 1;
}

template <class Point>
bool Cutter<Point>::is_ordered(std::size_t tet) const {
    return core::is_ordered(context_.input.cells.type(first_cell_ + cells_[tet]));
}

/// Whether the order of the file is an odd permutation of the ascending one.
template <class Point>
bool Cutter<Point>::is_odd(std::size_t tet) const {
    bool odd = false;
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b) odd ^= corners_[a][tet] > corners_[b][tet];
    return odd;
}

/// Whether the stored form of a flat tet, which keeps the order of the file or mirrors it, has its last two corners
/// exchanged.
template <class Point>
bool Cutter<Point>::is_mirrored_flat(std::size_t tet) {
    const bool odd = is_odd(tet);
    const core::CellReader& reader = context_.input.cells;
    const std::uint64_t cell = first_cell_ + cells_[tet];
    if (core::Orienter::is_whole(reader.type(cell))) {
        context_.saw_flat.store(true, std::memory_order_relaxed);
        return odd != context_.mostly_negative;
    }
    return odd != (core::Orienter::six_volumes(points_, reader.tets(cell)) < 0);
}

template <class Point>
bool Cutter<Point>::is_coarse(std::size_t tet) const {
    std::array<core::Point, 4> exact;
    double moved = 0, shortest = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < 4; ++a) {
        exact[a] = points_[corners_[a][tet]];
        core::Point stored;
        for (std::size_t axis = 0; axis < 3; ++axis)
            stored[axis] = core::store_coordinate<float>(exact[a][axis], context_.origin[axis]) + context_.origin[axis];
        moved = std::max(moved, core::squared_distance(exact[a], stored));
        for (std::size_t b = 0; b < a; ++b) shortest = std::min(shortest, core::squared_distance(exact[a], exact[b]));
    }
    return moved > 1e-6 * shortest;
}

template class Cutter<std::uint32_t>;
template class Cutter<std::uint64_t>;

} // namespace isotet::cpu::direct
