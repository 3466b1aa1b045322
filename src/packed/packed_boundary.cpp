// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/boundary.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>
#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/boundary_faces.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/cell/splitter.hpp"
#include "numbers/point_hash.hpp"
#include "packed/boundary_points.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"
#include "packed/stored_cells.hpp"
#include "packed/user_value.hpp"

namespace isotet {

namespace core {
namespace {

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
        if constexpr (sizeof(Point) == 1) { // else each comparison calls memcmp()
            const auto key = [](const std::array<Point, 3>& p) {
                return unsigned{p[0]} << 16 | unsigned{p[1]} << 8 | p[2];
            };
            return std::pair(key(a.points), a.uses) < std::pair(key(b.points), b.uses);
        } else {
            return std::tie(a.points, a.uses) < std::tie(b.points, b.uses);
        }
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

/// Calls f(a, b, c) for the outer faces of the tets into which a stored cell is split, counter-clockwise seen from
/// outside: the others cancel within the cell.
template <class F>
void for_outer_faces(const Packed& packed, const std::uint64_t* locals, const StoredCell& cell, const F& f) {
    const WholeCell whole = ranked_cell(packed, locals, cell);
    const auto& corners = cell.corners;
    if (has_repeated_corner(whole)) {
        for (const auto& tet : split_locally(whole))
            for (const CellFace& face : shape_of(CellKind::tetrahedron).faces())
                f(corners[tet[face.corners[0]]], corners[tet[face.corners[1]]], corners[tet[face.corners[2]]]);
        return;
    }
    for (const CellFace& face : shape_of(cell.kind).faces()) {
        const auto& [a, b, c, d] = face.corners;
        if (face.count == 3) {
            f(corners[a], corners[b], corners[c]);
        } else if (is_cut_from_first(whole.corners[a], whole.corners[b], whole.corners[c], whole.corners[d])) {
            f(corners[a], corners[b], corners[c]);
            f(corners[a], corners[c], corners[d]);
        } else {
            f(corners[a], corners[b], corners[d]);
            f(corners[b], corners[c], corners[d]);
        }
    }
}

/// Calls f(face) for the faces of a cluster's cells, as tets. Local indices ascend as packed points do.
template <class F>
void for_faces(const Packed& packed, std::size_t cluster, const std::uint64_t* locals, const F& f) {
    const auto call = [&](std::uint8_t a, std::uint8_t b, std::uint8_t c) { f(LocalFace::make({a, b, c})); };
    for (const StoredTet& tet : packed.cluster_tets(cluster))
        for (const CellFace& face : shape_of(CellKind::tetrahedron).faces())
            call(tet.corners[face.corners[0]], tet.corners[face.corners[1]], tet.corners[face.corners[2]]);
    packed.for_other_cells(cluster, [&](const StoredCell& cell) { for_outer_faces(packed, locals, cell, call); });
}

/// Sums of the hashes of faces at their lowest points, signed by how they are used: 0 where all faces cancel.
class FaceSums {
public:
    explicit FaceSums(const Packed& packed) : packed_(packed), sums_(packed.points()) {
        parallel_ranges(sums_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            std::fill(sums_.data() + begin, sums_.data() + end, std::uint64_t{0});
        });
    }

    void add(std::size_t cluster) {
        std::array<std::uint64_t, max_cluster_points> points{}, hashes{}, sums{};
        const std::size_t count = local_points(packed_, cluster, points.data());
        for (std::size_t i = 0; i < count; ++i) hashes[i] = mixed(points[i] + 1);
        for_faces(packed_, cluster, points.data(), [&](const LocalFace& face) {
            const auto& [a, b, c] = face.points;
            const std::uint64_t hash = mixed(hashes[a] + hashes[b] + hashes[c]);
            sums[a] += face.uses > 0 ? hash : -hash;
        });
        for (std::size_t i = 0; i < count; ++i)
            if (sums[i] != 0) std::atomic_ref(sums_[points[i]]).fetch_add(sums[i], std::memory_order_relaxed);
    }

    bool is_open_at(std::uint64_t lowest) const { return sums_[lowest] != 0; }

private:
    const Packed& packed_;
    Buffer<std::uint64_t> sums_; ///< a point
};

/// The faces of a cluster that its own tets do not cancel, of those that are open at their lowest point.
void add_faces(const Packed& packed, std::size_t cluster, const FaceSums& sums, std::vector<LocalFace>& local,
               std::vector<PackedFace>& out) {
    std::array<std::uint64_t, max_cluster_points> points{};
    const std::size_t count = local_points(packed, cluster, points.data());
    std::array<bool, max_cluster_points> open{};
    for (std::size_t i = 0; i < count; ++i) open[i] = sums.is_open_at(points[i]);
    if (std::ranges::find(open, true) == open.end()) return;
    local.clear();
    for_faces(packed, cluster, points.data(), [&](const LocalFace& face) {
        if (open[face.points[0]]) local.push_back(face);
    });
    std::sort(local.begin(), local.end());
    cancel(local);
    for (const LocalFace& face : local) {
        PackedFace global = PackedFace::make({points[face.points[0]], points[face.points[1]], points[face.points[2]]});
        global.uses *= face.uses;
        out.push_back(global);
    }
}

/// Calls work(cluster, scratch) for all clusters, on all threads, and done(scratch) behind several of them.
template <class Scratch, class Work, class Done>
Result<void> for_clusters(const Packed& packed, const Progress& progress, const Work& work, const Done& done) {
    const std::vector<std::uint32_t> clusters = all_clusters(packed);
    return in_memory(packed, clusters, Parts::all, progress, [&](std::size_t first, std::size_t last) -> Result<void> {
        parallel_ranges(last - first, 256, [&](std::size_t begin, std::size_t end) {
            if (progress.cancelled()) return;
            Scratch scratch;
            for (std::size_t i = first + begin; i < first + end; ++i) work(clusters[i], scratch);
            done(scratch);
        });
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
        return {};
    });
}

Result<std::vector<PackedFace>> boundary_faces(const Packed& packed, const Progress& progress) {
    if (auto fits = require_memory("finding the boundary", sizeof(std::uint64_t) * packed.points()); !fits)
        return fits.error();
    FaceSums sums(packed);
    struct Nothing {};
    const auto add = [&](std::uint32_t cluster, Nothing&) { sums.add(cluster); };
    if (auto added = for_clusters<Nothing>(packed, progress, add, [](Nothing&) {}); !added) return added.error();

    struct Found {
        std::vector<LocalFace> local;
        std::vector<PackedFace> faces;
    };
    std::vector<PackedFace> faces;
    std::mutex mutex;
    const auto look = [&](std::uint32_t cluster, Found& found) {
        add_faces(packed, cluster, sums, found.local, found.faces);
    };
    const auto keep = [&](Found& found) {
        const std::lock_guard lock(mutex);
        faces.insert(faces.end(), found.faces.begin(), found.faces.end());
    };
    if (auto looked = for_clusters<Found>(packed, progress, look, keep); !looked) return looked.error();
    tbb::parallel_sort(faces.begin(), faces.end());
    cancel(faces);
    return faces;
}

bool is_mirrored(const PackedFace& face) { return face.uses < 0; }

/// Owners of ascending points, and where the points of each begin; one more at the end.
struct OwnedPoints {
    std::vector<std::uint32_t> clusters;
    std::vector<std::size_t> first;
};

OwnedPoints owners_of(const Packed& packed, const std::vector<std::uint64_t>& points) {
    OwnedPoints owned;
    for (std::size_t i = 0, cluster = 0; i < points.size();) {
        const auto above = std::upper_bound(
            packed.headers.begin() + static_cast<std::ptrdiff_t>(cluster), packed.headers.end(), points[i],
            [](std::uint64_t point, const ClusterHeader& h) { return point < h.first_point; });
        cluster = static_cast<std::size_t>(above - packed.headers.begin()) - 1;
        owned.clusters.push_back(static_cast<std::uint32_t>(cluster));
        owned.first.push_back(i);
        const std::uint64_t end = packed.headers[cluster].first_point + packed.headers[cluster].own_points;
        while (i < points.size() && points[i] < end) ++i;
    }
    owned.first.push_back(points.size());
    return owned;
}

/// f(packed point, out) writes `components` numbers of each point.
/// Errors   as Residency::bring()
template <class To, class F>
Result<Array> at_points(const Packed& packed, const std::vector<std::uint64_t>& points, std::size_t components,
                        const Progress& progress, const F& f) {
    std::vector<To> out(components * points.size());
    const OwnedPoints owned = owners_of(packed, points);
    const auto write = [&](std::size_t first, std::size_t last) -> Result<void> {
        const std::size_t begin = owned.first[first];
        parallel_each(owned.first[last] - begin, 1 << 14,
                      [&](std::size_t k) { f(points[begin + k], out.data() + components * (begin + k)); });
        return {};
    };
    if (auto done = in_memory(packed, owned.clusters, Parts::values, progress, write); !done) return done.error();
    return Array::own(std::move(out), components);
}

template <class Real>
Result<Array> positions_at(const Packed& packed, const std::vector<std::uint64_t>& points, const Progress& progress) {
    const Real* const positions = packed.as<Real>().positions.data();
    if (packed.point_type == ScalarType::float32)
        return at_points<Real>(packed, points, 3, progress,
                               [&](std::uint64_t p, Real* to) { std::copy_n(positions + 3 * p, 3, to); });
    return at_points<double>(packed, points, 3, progress, [&](std::uint64_t p, double* to) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            to[axis] = static_cast<double>(positions[3 * p + axis]) + packed.origin[axis];
    });
}

template <class Real>
Result<Array> values_at(const Packed& packed, const std::vector<std::uint64_t>& points, const Progress& progress) {
    const Real* const values = packed.as<Real>().values.data();
    return packed.field.visit([&]<class T>(std::span<const T>) {
        return at_points<T>(packed, points, 1, progress, [&](std::uint64_t p, T* to) {
            *to = user_value<T>(static_cast<double>(values[p]), packed.storage);
        });
    });
}

/// Points of one grid have the same numbers in all of `fields`.
Result<void> check_same_cells(const Packed& packed, const std::vector<PackedGrid>& fields) {
    for (const PackedGrid& field : fields)
        if (field.data().headers.data() != packed.headers.data() ||
            (field.data().residency != nullptr) != (packed.residency != nullptr))
            return invalid_argument(
                fmt::format("field '{}' is of another packed grid than the boundary", field.field().name));
    return {};
}

/// What the file has of a boundary.
Result<std::optional<Surface>> stored_boundary(const Packed& packed, const std::vector<PackedGrid>& fields) {
    if (!packed.residency) return std::optional<Surface>();
    Result<std::optional<Surface>> boundary = packed.residency->boundary();
    if (!boundary || !*boundary) return boundary;
    for (const PackedGrid& field : fields) {
        Result<Array> values = field.data().residency->boundary_values(); // of the same file: it has the same cells
        if (!values) return values.error();
        (*boundary)->point_fields.push_back({field.field().name, *std::move(values)});
    }
    return boundary;
}

Result<Surface> boundary_with(const Packed& packed, const std::vector<PackedGrid>& fields, const Progress& progress) {
    if (auto same = check_same_cells(packed, fields); !same) return same.error();
    auto stored = stored_boundary(packed, fields);
    if (!stored) return stored.error();
    if (*stored) return std::move(**stored);
    auto found = find_boundary(packed, progress);
    if (!found) return found.error();
    auto positions = packed.single() ? positions_at<float>(packed, found->points, progress)
                                     : positions_at<double>(packed, found->points, progress);
    if (!positions) return positions.error();
    Surface surface;
    surface.positions = *std::move(positions);
    surface.triangles = std::move(found->triangles);
    for (const PackedGrid& field : fields) {
        auto values = packed.single() ? values_at<float>(field.data(), found->points, progress)
                                      : values_at<double>(field.data(), found->points, progress);
        if (!values) return values.error();
        surface.point_fields.push_back({field.field().name, *std::move(values)});
    }
    return surface;
}

} // namespace

Result<PackedBoundary> find_boundary(const Packed& packed, const Progress& progress) {
    const auto faces = boundary_faces(packed, progress);
    if (!faces) return faces.error();
    PackedBoundary boundary;
    boundary.points = points_of_faces(*faces);
    boundary.triangles = triangles_of_faces(*faces, boundary.points);
    return boundary;
}

} // namespace core

Result<Surface> boundary_of(const PackedGrid& packed, const Run& run) { return boundary_of(packed, {}, run); }

Result<Surface> boundary_of(const PackedGrid& packed, const std::vector<PackedGrid>& fields, const Run& run) {
    return core::carry_out("finding the boundary", run, [&](const Progress& progress) {
        return core::boundary_with(packed.data(), fields, progress);
    });
}

} // namespace isotet
