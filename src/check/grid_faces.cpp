// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/grid_faces.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <span>
#include <tuple>

#include <fmt/core.h>
#include <tbb/parallel_sort.h>

#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "grid/points/hanging.hpp"
#include "grid/tet_survey.hpp"

namespace isotet::checking {

namespace {

using core::CellKind;
using core::Tet;
using core::WholeCell;

/// A cell as stored, and where it comes from.
struct FoundCell {
    WholeCell cell;
    std::uint64_t id;
};

std::span<const std::uint64_t> corners_of(const WholeCell& cell) {
    return {cell.corners.data(), core::corner_count(cell.kind)};
}

WholeCell whole_tet(const Tet& t) { return {CellKind::tetrahedron, {t[0], t[1], t[2], t[3]}}; }

/// All edges, ascending; behind the last the highest numbers.
std::array<std::array<std::uint64_t, 2>, 12> sorted_edges(const WholeCell& cell) {
    std::array<std::array<std::uint64_t, 2>, 12> out;
    constexpr std::uint64_t highest = std::numeric_limits<std::uint64_t>::max();
    out.fill({highest, highest});
    std::size_t count = 0;
    for (const auto& [k, l] : core::edges_of(cell.kind)) {
        const std::uint64_t a = cell.corners[k], b = cell.corners[l];
        out[count++] = {std::min(a, b), std::max(a, b)};
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// The points that are asked about, and how many of them a face needs to matter.
struct Marks {
    std::vector<std::uint8_t> marked;
    int least = 4;

    Marks(std::uint64_t points, const std::vector<PointSet>& sets) : marked(points) {
        for (const PointSet& set : sets) {
            least = std::min(least, static_cast<int>(set.size()));
            for (const std::uint64_t point : set) marked[point] = 1;
        }
    }
    template <class Points>
    bool enough(const Points& points) const {
        // A point may stand there twice.
        int count = 0;
        for (auto at = points.begin(); at != points.end(); ++at)
            count += marked[*at] && std::find(points.begin(), at, *at) == at;
        return count >= least;
    }
};

std::vector<std::uint8_t> no_data_of(const PointField& field) {
    return field.values.visit([](auto values) {
        std::vector<std::uint8_t> no_data(values.size());
        core::parallel_each(values.size(), 1 << 16, [&](std::size_t i) { no_data[i] = values[i] != values[i]; });
        return no_data;
    });
}

/// What is stored of cells, one by one.
class StoredCells {
public:
    StoredCells(const Grid& grid, const core::CellReader& cells, bool split_cells, bool mostly_negative)
        : cells_(cells), split_(split_cells), points_(grid.points), orienter_(grid.points, mostly_negative) {}

    /// Calls f(stored) for all of a cell for which f.wants(corners as the file has them).
    template <class Wants, class F>
    void of(std::size_t cell, const Wants& wants, core::Orienter::Counts& counts, const F& f) const {
        if (!core::is_contoured(cells_.type(cell))) return;
        const auto add_tet = [&](const Tet& tet) {
            if (wants(std::span<const std::uint64_t>(tet)))
                f(whole_tet(orienter_.stored(cells_.type(cell), cells_.tets(cell), tet, counts)));
        };
        if (split_ || cells_.only_tets()) {
            for (const Tet& tet : cells_.tets(cell)) add_tet(tet);
            return;
        }
        for (WholeCell part : core::native_parts(cells_.whole(cell))) {
            const auto& v = part.corners;
            if (part.kind == CellKind::tetrahedron) {
                add_tet({v[0], v[1], v[2], v[3]});
            } else if (wants(corners_of(part))) {
                if (!core::is_ordered(cells_.type(cell)) &&
                    core::turn_of(part, [&](std::size_t k) { return points_[v[k]]; }).is_mirrored())
                    part.corners = core::mirrored(part.kind, v);
                f(part);
            }
        }
    }

private:
    const core::CellReader& cells_;
    const bool split_;
    const core::PointReader points_;
    const core::Orienter orienter_;
};

/// The valid cells with enough marked corners, as stored; adds to `counts`.
std::vector<FoundCell> cells_near(const core::CellReader& cells, const StoredCells& stored, const Marks& marks,
                                  const std::vector<std::uint8_t>& no_data, core::Orienter::Counts& counts,
                                  const Progress& progress) {
    const auto has_data = [&](std::uint64_t point) { return no_data.empty() || !no_data[point]; };
    std::vector<FoundCell> found;
    std::mutex mutex;
    core::parallel_ranges(cells.count(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) return;
        std::vector<FoundCell> near;
        core::Orienter::Counts seen;
        for (std::size_t cell = begin; cell < end; ++cell)
            stored.of(
                cell,
                [&](std::span<const std::uint64_t> corners) {
                    return marks.enough(corners) && std::ranges::all_of(corners, has_data);
                },
                seen, [&](const WholeCell& part) { near.push_back({part, cell}); });
        const std::lock_guard lock(mutex);
        counts.combine(seen);
        found.insert(found.end(), near.begin(), near.end());
    });
    return found;
}

/// Of cells with the same edges the first in the user's order.
void drop_repeated(std::vector<FoundCell>& found) {
    tbb::parallel_sort(found.begin(), found.end(), [](const FoundCell& a, const FoundCell& b) {
        return std::tuple(a.cell.kind, sorted_edges(a.cell), a.id) <
               std::tuple(b.cell.kind, sorted_edges(b.cell), b.id);
    });
    const auto repeated = std::ranges::unique(found, [](const FoundCell& a, const FoundCell& b) {
        return a.cell.kind == b.cell.kind && sorted_edges(a.cell) == sorted_edges(b.cell);
    });
    found.erase(repeated.begin(), repeated.end());
}

/// A face by its corners around, the lowest first, then the lower of the two beside it; a triangle ends with its third
/// once more.
struct OrientedFace {
    std::array<std::uint64_t, 4> around;
    bool forward; ///< whether the cell has it in this direction, seen from outside

    friend bool operator<(const OrientedFace& a, const OrientedFace& b) { return a.around < b.around; }
};

OrientedFace oriented(const WholeCell& cell, const core::CellFace& face) {
    std::array<std::uint64_t, 4> points{};
    const std::size_t n = face.count;
    for (std::size_t k = 0; k < n; ++k) points[k] = cell.corners[face.corners[k]];
    std::rotate(points.begin(), std::min_element(points.begin(), points.begin() + n), points.begin() + n);
    const bool forward = points[1] < points[n - 1];
    if (!forward) std::swap(points[1], points[n - 1]);
    if (n == 3) points[3] = points[2];
    return {points, forward};
}

/// Whether one of the triangles of a face, by either diagonal, is among some.
bool has_triangle_of(const std::vector<std::array<std::uint64_t, 3>>& triangles,
                     const std::array<std::uint64_t, 4>& around) {
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
        std::array<std::uint64_t, 3> points{};
        for (std::size_t k = 0, count = 0; k < 4; ++k)
            if (k != left_out) points[count++] = around[k];
        std::ranges::sort(points);
        if (std::ranges::binary_search(triangles, points)) return true;
    }
    return false;
}

template <class T>
void sort_unique(std::vector<T>& list) {
    tbb::parallel_sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

} // namespace

bool PointSet::add(std::uint64_t point) {
    const auto place = std::lower_bound(points_.begin(), points_.begin() + size_, point);
    if (place != points_.begin() + size_ && *place == point) return true;
    if (size_ == points_.size()) return false;
    std::move_backward(place, points_.begin() + size_, points_.begin() + size_ + 1);
    *place = point;
    ++size_;
    return true;
}

Result<GridFaces> GridFaces::find(const Grid& grid, const PointField* field, bool split_cells, bool conforming,
                                  const std::vector<PointSet>& sets, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (field && (field->values.components() != 1 || field->values.tuples() != cells->points()))
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the field '{}' has {} values of {} components, but the grid has {} points",
                                 field->name, field->values.tuples(), field->values.components(), cells->points())};
    if (auto checked = core::check_cells(grid, *cells, progress); !checked) return checked.error();
    GridFaces faces;
    if (sets.empty()) return faces;

    const Marks marks(cells->points(), sets);
    const std::vector<std::uint8_t> no_data = field ? no_data_of(*field) : std::vector<std::uint8_t>{};
    core::Orienter::Counts counts;
    auto near = cells_near(*cells, StoredCells(grid, *cells, split_cells, false), marks, no_data, counts, progress);
    // Only flat tets depend on how most of the grid is oriented.
    if (counts.flat > 0 && core::survey_tets(grid, *cells).mostly_negative())
        near = cells_near(*cells, StoredCells(grid, *cells, split_cells, true), marks, no_data, counts, progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking against the grid was cancelled"};

    drop_repeated(near);
    std::vector<OrientedFace> all;
    for (const FoundCell& found : near)
        for (const core::CellFace& face : core::shape_of(found.cell.kind).faces())
            all.push_back(oriented(found.cell, face));
    tbb::parallel_sort(all.begin(), all.end());
    std::vector<std::array<std::uint64_t, 4>> boundary;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        std::size_t forward = 0;
        for (end = begin; end < all.size() && all[end].around == all[begin].around; ++end) forward += all[end].forward;
        const std::size_t backward = end - begin - forward;
        if (!marks.enough(all[begin].around)) continue;
        if (forward > 1 || backward > 1) faces.doubled_.add(all[begin].around);
        if (forward != backward) boundary.push_back(all[begin].around);
    }
    for (const auto& around : boundary) faces.boundary_.add(around);
    if (!boundary.empty() && !conforming) {
        const auto hanging = core::find_hanging(grid, *cells, progress);
        if (!hanging) return hanging.error();
        for (const auto& around : boundary)
            if (has_triangle_of(hanging->faces, around)) faces.hanging_.add(around);
    }
    faces.hanging_.sort();
    faces.doubled_.sort();
    faces.boundary_.sort();
    return faces;
}

void SetsOfFaces::add(const std::array<std::uint64_t, 4>& around) {
    std::array<std::uint64_t, 4> points = around;
    std::sort(points.begin(), points.end());
    const auto end = std::unique(points.begin(), points.end());
    const auto n = static_cast<std::size_t>(end - points.begin());
    for (unsigned chosen = 1; chosen < 1u << n; ++chosen) {
        PointSet set;
        for (std::size_t k = 0; k < n; ++k)
            if (chosen >> k & 1) set.add(points[k]);
        sets_.push_back(set);
    }
}

void SetsOfFaces::sort() { sort_unique(sets_); }

bool SetsOfFaces::hold(const PointSet& set) const { return std::ranges::binary_search(sets_, set); }

} // namespace isotet::checking
