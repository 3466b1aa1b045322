// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/amr/shared_points.hpp"

#include <algorithm>
#include <array>

#include "base/parallel.hpp"
#include "base/radix_sort.hpp"

namespace isotet::io::amr {
namespace {

constexpr std::size_t points_per_part = 1 << 14;

Place corner_of(const Place& cell, unsigned corner) {
    return {cell[0] + (corner & 1U), cell[1] + (corner >> 1U & 1U), cell[2] + (corner >> 2U)};
}

Place cell_at(const CellBox& box, std::uint64_t at) {
    const std::uint64_t x = box.cells(0), y = box.cells(1);
    return {box.first[0] + static_cast<std::int64_t>(at % x), box.first[1] + static_cast<std::int64_t>(at / x % y),
            box.first[2] + static_cast<std::int64_t>(at / (x * y))};
}

Place point_at(const CellBox& box, std::uint64_t at) {
    const std::uint64_t x = box.cells(0) + 1, y = box.cells(1) + 1;
    return {box.first[0] + static_cast<std::int64_t>(at % x), box.first[1] + static_cast<std::int64_t>(at / x % y),
            box.first[2] + static_cast<std::int64_t>(at / (x * y))};
}

} // namespace

SharedPoints::SharedPoints(const Hierarchy& hierarchy, const Lattice& lattice, const std::vector<Marks>& marks)
    : lattice_(lattice), marks_(marks) {
    std::uint64_t cells = 0, points = 0;
    for (std::size_t level = 0; level < hierarchy.levels.size(); ++level)
        for (const CellBox& box : hierarchy.levels[level].boxes) {
            boxes_.push_back({level, box, cells, points});
            cells += box.cells();
            points += box.points();
        }
    at_.assign(points, none);
    for (std::size_t box = 0; box < boxes_.size(); ++box)
        for (std::uint64_t cell = 0; cell < boxes_[box].box.cells(); ++cell)
            if (marks[box][cell] == 0)
                each_corner(boxes_[box].first_cell + cell, [&](std::uint64_t at) { at_[at] = 0; });
    std::vector<core::Keyed> used;
    for (const PlacedBox& placed : boxes_)
        for (std::uint64_t point = 0; point < placed.box.points(); ++point)
            if (at_[placed.first_point + point] != none)
                used.push_back({lattice.number_of(lattice.from_level(placed.level, point_at(placed.box, point))),
                                placed.first_point + point});
    std::vector<core::Keyed> scratch(used.size());
    core::radix_sort(used, scratch);
    for (const core::Keyed& one : used) {
        if (numbers_.empty() || numbers_.back() != one.key) numbers_.push_back(one.key);
        at_[one.number] = numbers_.size() - 1;
    }
    around_.emplace(numbers_.size(), cells, [&](std::uint64_t cell, const auto& body) {
        const std::size_t box = box_number_of(cell);
        if (marks_[box][cell - boxes_[box].first_cell] != 0) return;
        each_corner(cell, [&](std::uint64_t at) { body(at_[at]); });
    });
    note_levels();
}

std::size_t SharedPoints::box_number_of(std::uint64_t cell) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(boxes_, cell, {}, &PlacedBox::first_cell) -
                                    boxes_.begin()) -
           1;
}

template <class Visit>
void SharedPoints::each_corner(std::uint64_t cell, const Visit& visit) const {
    const PlacedBox& placed = boxes_[box_number_of(cell)];
    const Place first = cell_at(placed.box, cell - placed.first_cell);
    for (unsigned corner = 0; corner < 8; ++corner)
        visit(placed.first_point + placed.box.point_at(corner_of(first, corner)));
}

std::optional<std::uint64_t> SharedPoints::find(const Place& place) const {
    const std::uint64_t number = lattice_.number_of(place);
    const auto found = std::ranges::lower_bound(numbers_, number);
    if (found == numbers_.end() || *found != number) return std::nullopt;
    return static_cast<std::uint64_t>(found - numbers_.begin());
}

void SharedPoints::note_levels() {
    mixed_.resize(count());
    core::parallel_each(count(), points_per_part, [&](std::size_t point) {
        const std::span<std::uint64_t> cells = around_->of(point);
        std::ranges::sort(cells); // boxes go by level
        mixed_[point] = boxes_[box_number_of(cells.front())].level != boxes_[box_number_of(cells.back())].level;
    });
}

/// Looks for points on the edges, then on the faces of cells of one level after another.
class HangingFinder {
public:
    explicit HangingFinder(const SharedPoints& points) : points_(points), has_row_(points.count()) {}

    std::vector<HangingPlace> find() {
        for (std::size_t level = 0; level + 1 < points_.lattice_.levels(); ++level) {
            each_beside_finer(level,
                              [&](const Place& first, const Corners& corners) { add_edges(level, first, corners); });
            each_beside_finer(level,
                              [&](const Place& first, const Corners& corners) { add_faces(level, first, corners); });
        }
        return std::move(rows_);
    }

private:
    using Corners = std::array<std::uint64_t, 8>;

    /// Calls visit(first corner in the lattice, corners) for shown cells that share an edge with finer ones.
    template <class Visit>
    void each_beside_finer(std::size_t level, const Visit& visit) const {
        for (std::size_t number = 0; number < points_.boxes_.size(); ++number) {
            const PlacedBox& placed = points_.boxes_[number];
            for (std::uint64_t cell = 0; placed.level == level && cell < placed.box.cells(); ++cell) {
                if (points_.marks_[number][cell] != 0) continue;
                Corners corners;
                std::size_t count = 0;
                points_.each_corner(placed.first_cell + cell,
                                    [&](std::uint64_t at) { corners[count++] = points_.at_[at]; });
                if (std::ranges::count_if(corners, [&](auto point) { return points_.mixed_[point] != 0; }) > 1)
                    visit(points_.lattice_.from_level(level, cell_at(placed.box, cell)), corners);
            }
        }
    }

    /// Points at the places of each finer level, as long as there are some.
    template <class Scan>
    void each_finer(std::size_t level, const Scan& scan) const {
        for (std::size_t finer = level + 1; finer < points_.lattice_.levels(); ++finer)
            if (!scan(finer) && points_.lattice_.volume(finer) < points_.lattice_.volume(finer - 1)) return;
    }

    /// True where there is a point; `row` tells what it hangs on.
    template <class Row>
    bool add(const Place& place, const Row& row) {
        const auto point = points_.find(place);
        if (!point) return false;
        if (has_row_[*point] == 0) {
            rows_.push_back(row(*point));
            has_row_[*point] = 1;
        }
        return true;
    }

    void add_edges(std::size_t level, const Place& first, const Corners& corners) {
        for (unsigned axis = 0; axis < 3; ++axis)
            for (unsigned beside = 0; beside < 8; ++beside)
                if ((beside >> axis & 1U) == 0) add_edge(level, axis, first, beside, corners);
    }

    void add_edge(std::size_t level, unsigned axis, const Place& first, unsigned low, const Corners& corners) {
        const std::uint64_t a = corners[low], b = corners[low | 1U << axis];
        if (points_.mixed_[a] == 0 || points_.mixed_[b] == 0) return;
        const std::int64_t whole = points_.lattice_.steps(level, axis);
        const Place from = place_of(level, first, low);
        each_finer(level, [&](std::size_t finer) {
            bool any = false;
            const std::int64_t step = points_.lattice_.steps(finer, axis);
            for (std::int64_t along = step; along < whole; along += step) {
                const double part = static_cast<double>(along) / static_cast<double>(whole);
                any |= add(moved(from, axis, along),
                           [&](std::uint64_t point) { return HangingPlace{point, 2, {a, b}, {1 - part, part}}; });
            }
            return any;
        });
    }

    void add_faces(std::size_t level, const Place& first, const Corners& corners) {
        for (unsigned normal = 0; normal < 3; ++normal)
            for (const unsigned low : {0U, 1U << normal}) add_face(level, normal, first, low, corners);
    }

    void add_face(std::size_t level, unsigned normal, const Place& first, unsigned low, const Corners& corners) {
        const unsigned u = (normal + 1) % 3, v = (normal + 2) % 3;
        const std::array<std::uint64_t, 4> of{corners[low], corners[low | 1U << u], corners[low | 1U << v],
                                              corners[low | 1U << u | 1U << v]};
        for (const std::uint64_t point : of)
            if (points_.mixed_[point] == 0) return;
        const Lattice& lattice = points_.lattice_;
        const Place from = place_of(level, first, low);
        each_finer(level, [&](std::size_t finer) {
            bool any = false;
            for (std::int64_t i = lattice.steps(finer, u); i < lattice.steps(level, u); i += lattice.steps(finer, u))
                for (std::int64_t k = lattice.steps(finer, v); k < lattice.steps(level, v);
                     k += lattice.steps(finer, v)) {
                    const double p = static_cast<double>(i) / static_cast<double>(lattice.steps(level, u));
                    const double q = static_cast<double>(k) / static_cast<double>(lattice.steps(level, v));
                    any |= add(moved(moved(from, u, i), v, k), [&](std::uint64_t point) {
                        return HangingPlace{point, 4, of, {(1 - p) * (1 - q), p * (1 - q), (1 - p) * q, p * q}};
                    });
                }
            return any;
        });
    }

    static Place moved(Place place, unsigned axis, std::int64_t by) {
        place[axis] += by;
        return place;
    }

    Place place_of(std::size_t level, Place first, unsigned corner) const {
        for (unsigned axis = 0; axis < 3; ++axis)
            if ((corner >> axis & 1U) != 0) first[axis] += points_.lattice_.steps(level, axis);
        return first;
    }

    const SharedPoints& points_;
    std::vector<std::uint8_t> has_row_;
    std::vector<HangingPlace> rows_;
};

std::vector<HangingPlace> SharedPoints::hanging() { return HangingFinder(*this).find(); }

} // namespace isotet::io::amr
