// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/grid_faces.hpp"

#include <algorithm>
#include <mutex>

#include <fmt/core.h>
#include <tbb/parallel_sort.h>

#include "core/cells.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"
#include "core/faces.hpp"

namespace isotet::checking {

namespace {

using core::Tet;

/// A tet as stored, and where it comes from.
struct FoundTet {
    Tet tet;
    core::TetId id;
};

/// The four corners, ascending; a canonical tet has its two lowest in front.
Tet sorted_corners(const Tet& t) { return {t[0], t[1], std::min(t[2], t[3]), std::max(t[2], t[3])}; }

/// The points that are asked about, and how many of them a face needs to matter.
struct Marks {
    std::vector<std::uint8_t> marked;
    int least = 3;

    Marks(std::uint64_t points, const std::vector<PointSet>& sets) : marked(points) {
        for (const PointSet& set : sets) {
            least = std::min(least, static_cast<int>(set.size()));
            for (const std::uint64_t point : set) marked[point] = 1;
        }
    }
    template <class Points>
    bool enough(const Points& points) const {
        int count = 0;
        for (const std::uint64_t point : points) count += marked[point];
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

/// The valid tets with enough marked corners, as stored; adds to `counts`.
std::vector<FoundTet> tets_near(const core::CellReader& cells, const core::Orienter& orienter, const Marks& marks,
                                const std::vector<std::uint8_t>& no_data, core::Orienter::Counts& counts,
                                const Progress& progress) {
    const auto has_data = [&](std::uint64_t point) { return no_data.empty() || !no_data[point]; };
    std::vector<FoundTet> found;
    std::mutex mutex;
    core::parallel_ranges(cells.count(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) return;
        std::vector<FoundTet> near;
        core::Orienter::Counts seen;
        for (std::size_t cell = begin; cell < end; ++cell) {
            const core::CellTets tets = cells.tets(cell);
            for (unsigned piece = 0; piece < static_cast<unsigned>(tets.count); ++piece) {
                const Tet& t = tets.tets[piece];
                if (marks.enough(t) && std::ranges::all_of(t, has_data))
                    near.push_back(
                        {orienter.stored(cells.type(cell), tets, piece, seen), core::TetId::make(cell, piece)});
            }
        }
        const std::lock_guard lock(mutex);
        counts.combine(seen);
        found.insert(found.end(), near.begin(), near.end());
    });
    return found;
}

/// The tets alone; of those with the same four corners the first in the user's order.
std::vector<Tet> without_repeated(std::vector<FoundTet> found) {
    tbb::parallel_sort(found.begin(), found.end(), [](const FoundTet& a, const FoundTet& b) {
        const Tet p = sorted_corners(a.tet), q = sorted_corners(b.tet);
        return p != q ? p < q : a.id.value < b.id.value;
    });
    const auto repeated = std::ranges::unique(found, {}, [](const FoundTet& t) { return sorted_corners(t.tet); });
    found.erase(repeated.begin(), repeated.end());
    std::vector<Tet> tets(found.size());
    std::ranges::transform(found, tets.begin(), &FoundTet::tet);
    return tets;
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

Result<GridFaces> GridFaces::find(const Grid& grid, const PointField* field, const std::vector<PointSet>& sets,
                                  const Progress& progress) {
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
    auto tets = tets_near(*cells, core::Orienter(grid.points, false), marks, no_data, counts, progress);
    // Only flat tets depend on how most of the grid is oriented.
    if (counts.flat > 0 && core::survey_tets(grid, *cells).mostly_negative())
        tets = tets_near(*cells, core::Orienter(grid.points, true), marks, no_data, counts, progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking against the grid was cancelled"};

    for (const core::StoredFace& face : core::faces_of(without_repeated(std::move(tets)))) {
        const Face& p = face.points;
        if (!marks.enough(p)) continue;
        if (face.forward > 1 || face.backward > 1) faces.doubled_.push_back(p);
        if (face.forward == face.backward) continue;
        faces.boundary_.push_back(p);
        faces.boundary_edges_.insert(faces.boundary_edges_.end(), {{p[0], p[1]}, {p[0], p[2]}, {p[1], p[2]}});
        faces.boundary_points_.insert(faces.boundary_points_.end(), p.begin(), p.end());
    }
    sort_unique(faces.boundary_edges_);
    sort_unique(faces.boundary_points_);
    return faces;
}

bool GridFaces::in_boundary_face(const PointSet& set) const {
    const std::uint64_t* p = set.begin();
    switch (set.size()) {
    case 1: return std::ranges::binary_search(boundary_points_, p[0]);
    case 2: return std::ranges::binary_search(boundary_edges_, std::array{p[0], p[1]});
    case 3: return std::ranges::binary_search(boundary_, Face{p[0], p[1], p[2]});
    default: return false;
    }
}

bool GridFaces::has_two_tets_on_one_side(const PointSet& set) const {
    const std::uint64_t* p = set.begin();
    return set.size() == 3 && std::ranges::binary_search(doubled_, Face{p[0], p[1], p[2]});
}

} // namespace isotet::checking
