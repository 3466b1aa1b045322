// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/boundary.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <mutex>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <isotet/linear_cells.hpp>

#include "core/carry_out.hpp"
#include "core/faces.hpp"
#include "core/memory.hpp"
#include "core/packed.hpp"
#include "core/parallel.hpp"
#include "core/stored_cells.hpp"

namespace isotet {

namespace core {
namespace {

/// The corners of a tet's faces, each counter-clockwise seen from outside.
constexpr std::array<std::array<std::uint8_t, 3>, 4> tet_faces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// A face by its three points, ascending, and by how often it is used as it stands (positive) or mirrored.
template <class Point>
struct Face {
    std::array<Point, 3> points;
    std::int32_t uses;

    static Face make(std::array<Point, 3> p) {
        std::int32_t sign = 1;
        const auto order = [&](std::size_t i, std::size_t j) {
            if (p[i] <= p[j]) return;
            std::swap(p[i], p[j]);
            sign = -sign;
        };
        order(0, 1);
        order(1, 2);
        order(0, 1);
        return {p, sign};
    }
    friend bool operator<(const Face& a, const Face& b) {
        return std::tie(a.points, a.uses) < std::tie(b.points, b.uses);
    }
};

/// Of sorted faces those that do not cancel, each once.
template <class Point>
void cancel(std::vector<Face<Point>>& faces) {
    std::size_t kept = 0;
    for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
        std::int32_t uses = 0;
        for (end = begin; end < faces.size() && faces[end].points == faces[begin].points; ++end)
            uses += faces[end].uses;
        if (uses != 0) faces[kept++] = {faces[begin].points, uses};
    }
    faces.resize(kept);
}

using LocalFace = Face<std::uint8_t>;
using PackedFace = Face<std::uint64_t>;

/// The faces of a cluster that its own tets do not cancel.
void add_faces(const Packed& packed, std::size_t cluster, std::vector<LocalFace>& local, std::vector<PackedFace>& out) {
    local.clear();
    for_tets(packed, cluster, [&](const std::array<std::uint8_t, 4>& corners, std::size_t) {
        for (const auto& f : tet_faces) local.push_back(LocalFace::make({corners[f[0]], corners[f[1]], corners[f[2]]}));
    });
    std::sort(local.begin(), local.end());
    cancel(local);
    std::array<std::uint64_t, max_cluster_points> points{};
    local_points(packed, cluster, points.data());
    for (const LocalFace& face : local) {
        PackedFace global = PackedFace::make({points[face.points[0]], points[face.points[1]], points[face.points[2]]});
        global.uses *= face.uses;
        out.push_back(global);
    }
}

Result<std::vector<PackedFace>> boundary_faces(const Packed& packed, const Progress& progress) {
    std::vector<PackedFace> faces;
    std::mutex mutex;
    parallel_ranges(packed.clusters(), 256, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) return;
        std::vector<LocalFace> local;
        std::vector<PackedFace> found;
        for (std::size_t cluster = begin; cluster < end; ++cluster) add_faces(packed, cluster, local, found);
        const std::lock_guard lock(mutex);
        faces.insert(faces.end(), found.begin(), found.end());
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    tbb::parallel_sort(faces.begin(), faces.end());
    cancel(faces);
    return faces;
}

Array positions_of(const Packed& packed, const std::vector<std::uint64_t>& points) {
    return std::visit(
        [&]<class Real>(const Values<Real>& reals) {
            const auto positions = [&]<class To>(To, const auto& user) {
                std::vector<To> out(3 * points.size());
                parallel_each(points.size(), 1 << 14, [&](std::size_t i) {
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        out[3 * i + axis] = user(reals.positions[3 * points[i] + axis], axis);
                });
                return Array::own(std::move(out), 3);
            };
            if (packed.point_type == ScalarType::float32)
                return positions(Real{}, [](Real x, std::size_t) { return x; });
            return positions(double{}, [&](Real x, std::size_t axis) { return x + packed.origin[axis]; });
        },
        packed.reals);
}

bool is_mirrored(const PackedFace& face) { return face.uses < 0; }
bool is_mirrored(const BoundaryFace& face) { return face.mirrored; }

/// Positions of some points, in the type of the grid's.
Array positions_of(const Array& all, const std::vector<std::uint64_t>& points) {
    const auto gathered = [&]<class Real>(Real) {
        const std::span<const Real> from = all.as<Real>();
        std::vector<Real> out(3 * points.size());
        parallel_each(points.size(), 1 << 14, [&](std::size_t i) {
            for (std::size_t axis = 0; axis < 3; ++axis) out[3 * i + axis] = from[3 * points[i] + axis];
        });
        return Array::own(std::move(out), 3);
    };
    return all.type() == ScalarType::float32 ? gathered(float{}) : gathered(double{});
}

/// Each point as both ends of an edge: edge_ends of vertices that are points.
Array both_ends(const std::vector<std::uint64_t>& points) {
    std::vector<std::int64_t> ends(2 * points.size());
    parallel_each(ends.size(), 1 << 14, [&](std::size_t i) { ends[i] = static_cast<std::int64_t>(points[i / 2]); });
    return Array::own(std::move(ends), 2);
}

/// `Source`   a packed grid, or the points of the user's
/// `Face`     with three points, ascending, and is_mirrored()
template <class Source, class Face>
Surface surface_of(const Source& source, const std::vector<Face>& faces) {
    std::vector<std::uint64_t> points;
    points.reserve(3 * faces.size());
    for (const Face& face : faces) points.insert(points.end(), face.points.begin(), face.points.end());
    tbb::parallel_sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<std::uint32_t> triangles(3 * faces.size());
    parallel_each(faces.size(), 1 << 12, [&](std::size_t i) {
        std::array<std::uint64_t, 3> corners = faces[i].points;
        if (is_mirrored(faces[i])) std::swap(corners[1], corners[2]);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto place = std::lower_bound(points.begin(), points.end(), corners[corner]);
            triangles[3 * i + corner] =
                static_cast<std::uint32_t>(place - points.begin()); // fewer than 2^32: tets use no more points
        }
    });
    Surface surface;
    surface.positions = positions_of(source, points);
    surface.triangles = Array::own(std::move(triangles), 3);
    if constexpr (std::is_same_v<Source, Array>) surface.edge_ends = both_ends(points);
    return surface;
}

Result<Surface> boundary_of_grid(const Grid& grid, const Progress& progress) {
    const auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    const TetSurvey tets = survey_tets(grid, *cells, progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    if (tets.tets == 0) return nothing_to_contour(grid, *cells);
    constexpr std::uint64_t enough_for_small_grids = 1 << 26;
    const std::uint64_t memory = std::max(free_memory() / 4, enough_for_small_grids);
    const auto faces = find_boundary_faces(grid, *cells, tets, {.memory = memory}, progress);
    if (!faces) return faces.error();
    constexpr std::uint64_t max_numbers = std::numeric_limits<std::uint32_t>::max();
    if (3 * faces->size() > max_numbers && grid.points.tuples() > max_numbers)
        return Error{ErrorCode::invalid_data, fmt::format("the boundary has {} faces, but of a grid of more than 2^32 "
                                                          "points it must have at most {}",
                                                          faces->size(), max_numbers / 3)};
    return surface_of(grid.points, *faces);
}

} // namespace
} // namespace core

Result<Surface> boundary_of(const Grid& grid, const Run& run) {
    return core::carry_out("finding the boundary", run, [&](const Progress& progress) -> Result<Surface> {
        if (!has_cells_to_linearize(grid.cells)) return core::boundary_of_grid(grid, progress);
        const auto linear =
            linearize({grid.points, grid.cells, {}, {}}, {}, {.threads = core::threads_here(), .progress = {}});
        if (!linear) return linear.error();
        return core::boundary_of_grid(linear->grid, progress);
    });
}

Result<Surface> boundary_of(const PackedGrid& packed, const Run& run) {
    return core::carry_out("finding the boundary", run, [&](const Progress& progress) -> Result<Surface> {
        const auto faces = core::boundary_faces(packed.data(), progress);
        if (!faces) return faces.error();
        return core::surface_of(packed.data(), *faces);
    });
}

} // namespace isotet
