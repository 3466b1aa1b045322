// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/boundary_faces.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <tuple>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "linear/hanging/covers.hpp"
#include "linear/hanging/open_faces.hpp"
#include "numbers/point_hash.hpp"
#include "numbers/storage.hpp"

namespace isotet::solid {

namespace {

constexpr std::size_t cells_at_once = 1 << 12;
constexpr std::uint64_t no_point = std::numeric_limits<std::uint64_t>::max();

/// A face from its lowest point on, in the one of its two directions in which the second point is below the last.
struct DirectedFace {
    std::array<std::uint64_t, 4> points{no_point, no_point, no_point, no_point}; ///< a triangle's last is no_point
    bool mirrored = false; ///< seen from outside it goes the other way
    std::uint64_t cell = 0;

    std::size_t count() const { return points[3] == no_point ? 3 : 4; }
    friend bool operator<(const DirectedFace& a, const DirectedFace& b) {
        return std::tie(a.points, a.mirrored, a.cell) < std::tie(b.points, b.mirrored, b.cell);
    }
};

DirectedFace directed(std::span<const std::uint64_t> corners, std::uint64_t cell) {
    DirectedFace face;
    face.cell = cell;
    const std::size_t n = corners.size();
    const auto lowest = static_cast<std::size_t>(std::ranges::min_element(corners) - corners.begin());
    face.mirrored = corners[(lowest + n - 1) % n] < corners[(lowest + 1) % n];
    for (std::size_t k = 0; k < n; ++k) face.points[k] = corners[(lowest + (face.mirrored ? n - k : k)) % n];
    return face;
}

/// Of the points but the lowest, signed by the direction.
std::uint64_t hash_of(const DirectedFace& face) {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (std::size_t k = 1; k < 4; ++k) hash = core::mixed(hash + face.points[k]);
    return face.mirrored ? 0 - hash : hash;
}

/// Faces of the cells that count.
class FaceSource {
public:
    FaceSource(const Grid& grid, const core::CellReader& cells, const Array& values, CellMode mode)
        : cells_(cells), points_(grid.points), mode_(mode) {
        values.visit([&](auto typed) {
            std::atomic<bool> some{false};
            core::parallel_ranges(typed.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    if (core::is_nan(static_cast<double>(typed[i]))) some.store(true, std::memory_order_relaxed);
            });
            if (!some) return;
            no_data_ = core::Buffer<std::uint8_t>(typed.size());
            core::parallel_each(typed.size(), 1 << 16, [&](std::size_t i) {
                no_data_[i] = core::is_nan(static_cast<double>(typed[i])) ? 1 : 0;
            });
        });
    }

    /// Calls f(face) for the faces of the cells [begin, end).
    template <class F>
    void for_faces(std::size_t begin, std::size_t end, const F& f) const {
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (!core::is_contoured(cells_.type(cell))) continue;
            if (mode_ == CellMode::split || cells_.type(cell) == static_cast<std::uint8_t>(CellType::tetrahedron)) {
                for (const core::Tet& tet : cells_.tets(cell))
                    add_part({core::CellKind::tetrahedron, {tet[0], tet[1], tet[2], tet[3]}}, cell, f);
            } else {
                for (const core::WholeCell& part : core::native_parts(cells_.whole(cell))) add_part(part, cell, f);
            }
        }
    }

private:
    template <class F>
    void add_part(const core::WholeCell& part, std::uint64_t cell, const F& f) const {
        const std::size_t corners = core::corner_count(part.kind);
        if (!no_data_.empty())
            for (std::size_t k = 0; k < corners; ++k)
                if (no_data_[part.corners[k]]) return;
        const auto at = [&](std::uint8_t corner) { return points_[part.corners[corner]]; };
        const bool mirrored = !core::is_ordered(cells_.type(cell)) && core::is_mirrored(part.kind, part.corners, at);
        for (const core::CellFace& shape : core::shape_of(part.kind).faces()) {
            std::array<std::uint64_t, 4> points{};
            std::size_t count = 0; // a corner that is repeated once
            for (const std::uint8_t corner : shape.all())
                if (count == 0 || points[count - 1] != part.corners[corner]) points[count++] = part.corners[corner];
            while (count > 1 && points[0] == points[count - 1]) --count;
            if (count < 3) continue;
            DirectedFace face = directed(std::span(points).first(count), cell);
            face.mirrored ^= mirrored;
            f(face);
        }
    }

    const core::CellReader& cells_;
    core::PointReader points_;
    core::Buffer<std::uint8_t> no_data_; ///< empty: all points have data
    CellMode mode_;
};

core::Buffer<std::uint64_t> sums_of_hashes(const FaceSource& source, std::size_t cells, std::size_t points,
                                           const Progress& progress) {
    core::Buffer<std::uint64_t> sums(points);
    core::parallel_ranges(points, 1 << 16, [&](std::size_t begin, std::size_t end) {
        std::fill(sums.begin() + begin, sums.begin() + end, std::uint64_t{0});
    });
    core::parallel_pieces(cells, cells_at_once, progress, [&](std::size_t begin, std::size_t end) {
        source.for_faces(begin, end, [&](const DirectedFace& face) {
            std::atomic_ref(sums[face.points[0]]).fetch_add(hash_of(face), std::memory_order_relaxed);
        });
    });
    return sums;
}

/// Of sorted faces those that do not cancel, the surplus of each.
std::vector<DirectedFace> surplus_of(const std::vector<DirectedFace>& sorted) {
    std::vector<DirectedFace> out;
    for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
        std::size_t forward = 0;
        for (end = begin; end < sorted.size() && sorted[end].points == sorted[begin].points; ++end)
            forward += sorted[end].mirrored ? 0 : 1;
        const std::size_t backward = end - begin - forward;
        if (forward >= backward)
            out.insert(out.end(), sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                       sorted.begin() + static_cast<std::ptrdiff_t>(begin + forward - backward));
        else
            out.insert(out.end(), sorted.begin() + static_cast<std::ptrdiff_t>(begin + forward),
                       sorted.begin() + static_cast<std::ptrdiff_t>(begin + backward));
    }
    return out;
}

/// By places among the points that they use, turned outwards.
BoundaryFaces with_places(const std::vector<DirectedFace>& surplus) {
    BoundaryFaces out;
    for (const DirectedFace& face : surplus)
        out.points.insert(out.points.end(), face.points.begin(),
                          face.points.begin() + static_cast<std::ptrdiff_t>(face.count()));
    tbb::parallel_sort(out.points.begin(), out.points.end());
    out.points.erase(std::unique(out.points.begin(), out.points.end()), out.points.end());
    out.faces.resize(surplus.size());
    core::parallel_each(surplus.size(), 1 << 12, [&](std::size_t i) {
        const DirectedFace& from = surplus[i];
        BoundaryFace& face = out.faces[i];
        face.count = static_cast<std::uint32_t>(from.count());
        face.cell = from.cell;
        for (std::size_t k = 0; k < face.count; ++k) {
            const auto place = std::ranges::lower_bound(out.points, from.points[k]) - out.points.begin();
            face.places[from.mirrored ? face.count - 1 - k : k] = static_cast<std::uint32_t>(place);
        }
    });
    return out;
}

/// Of each place the first one with the same coordinates; empty where all differ.
std::vector<std::uint32_t> first_at_place(const BoundaryFaces& boundary, const core::PointReader& points) {
    const auto at = [&](std::uint32_t place) { return points[boundary.points[place]]; };
    std::vector<std::uint32_t> order(boundary.points.size());
    std::iota(order.begin(), order.end(), 0U);
    tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto p = at(a), q = at(b);
        return p != q ? p < q : a < b;
    });
    std::vector<std::uint32_t> first(order.size());
    bool doubled = false;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && at(order[i]) == at(order[i - 1]);
        first[order[i]] = same ? first[order[i - 1]] : order[i];
        doubled |= same;
    }
    if (!doubled) first.clear();
    return first;
}

/// Faces that would cancel each other if points with the same coordinates were one.
std::vector<Wall> walls_of(const BoundaryFaces& boundary, const core::PointReader& points) {
    const std::vector<std::uint32_t> first = first_at_place(boundary, points);
    if (first.empty()) return {};
    std::vector<DirectedFace> faces(boundary.faces.size()); // their numbers in place of cells
    core::parallel_each(faces.size(), 1 << 12, [&](std::size_t i) {
        std::array<std::uint64_t, 4> corners{};
        const auto all = boundary.faces[i].all();
        for (std::size_t k = 0; k < all.size(); ++k) corners[k] = first[all[k]];
        faces[i] = directed(std::span(corners).first(all.size()), i);
    });
    tbb::parallel_sort(faces.begin(), faces.end());
    std::vector<Wall> walls(faces.size(), Wall::doubled);
    for (const DirectedFace& face : surplus_of(faces)) walls[face.cell] = Wall::none;
    if (std::ranges::find(walls, Wall::doubled) == walls.end()) walls.clear();
    return walls;
}

/// Marks faces that lie on smaller ones, whether these cover them or not, and these.
Result<void> find_unfit_faces(const core::CellReader& cells, const core::PointReader& points, const Progress& progress,
                              BoundaryFaces& boundary) {
    linear::OpenFaces faces;
    faces.reserve(boundary.faces.size(), 4 * boundary.faces.size());
    for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
        const BoundaryFace& face = boundary.faces[i];
        std::array<std::uint64_t, 4> loop{};
        for (std::size_t k = 0; k < face.count; ++k) loop[k] = boundary.points[face.places[k]];
        faces.add({face.cell, static_cast<std::uint32_t>(i)}, std::span(loop).first(face.count));
    }
    const auto covers = linear::find_covers(faces, cells, points, progress);
    if (!covers) return covers.error();
    for (const std::vector<linear::Cover>* some : {&covers->whole, &covers->open})
        for (const linear::Cover& cover : *some) {
            boundary.walls.resize(boundary.faces.size(), Wall::none);
            boundary.walls[cover.face] = Wall::unfit;
            for (const linear::Cover::Part& part : cover.by) boundary.walls[part.face] = Wall::unfit;
        }
    return {};
}

} // namespace

Result<BoundaryFaces> find_boundary_faces(const Grid& grid, const Array& values, CellMode mode,
                                          const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    if (auto ok = core::require_memory("finding the boundary", 9 * grid.points.tuples()); !ok) return ok.error();
    const FaceSource source(grid, *cells, values, mode);
    const core::Buffer<std::uint64_t> sums = sums_of_hashes(source, cells->count(), grid.points.tuples(), progress);
    std::vector<DirectedFace> found;
    std::mutex mutex;
    core::parallel_pieces(cells->count(), cells_at_once, progress, [&](std::size_t begin, std::size_t end) {
        std::vector<DirectedFace> here;
        source.for_faces(begin, end, [&](const DirectedFace& face) {
            if (sums[face.points[0]] != 0) here.push_back(face);
        });
        const std::lock_guard lock(mutex);
        found.insert(found.end(), here.begin(), here.end());
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    tbb::parallel_sort(found.begin(), found.end());
    const std::vector<DirectedFace> surplus = surplus_of(found);
    if (surplus.size() > std::numeric_limits<std::uint32_t>::max() / 4)
        return invalid_data(fmt::format("the boundary has {} faces, but must have at most {}", surplus.size(),
                                        std::numeric_limits<std::uint32_t>::max() / 4));
    BoundaryFaces boundary = with_places(surplus);
    return boundary;
}

Result<void> find_walls(const Grid& grid, BoundaryFaces& boundary, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    const core::PointReader points(grid.points);
    boundary.walls = walls_of(boundary, points);
    return find_unfit_faces(*cells, points, progress, boundary);
}

} // namespace isotet::solid
