// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "base/workers.hpp"
#include "grid/grid_size.hpp"
#include "grid/orientation.hpp"
#include "numbers/bounds.hpp"
#include "numbers/storage.hpp"
#include "packed/build/pack_draft.hpp"
#include "packed/frame.hpp"

namespace isotet::core {

namespace {

Bounds bounds_of(const PointReader& points, const Packed& packed) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, packed.points(), 1 << 14), Bounds{},
        [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) bounds.add(points[packed.user_point(i)]);
            return bounds;
        },
        [](Bounds a, const Bounds& b) {
            a.combine(b);
            return a;
        });
}

/// True when rounding moves a point of the cluster by more than a thousandth of its shortest edge.
template <class Real>
bool is_coarse(const PointReader& points, const Packed& packed, std::size_t cluster) {
    std::uint64_t locals[max_cluster_points];
    const std::size_t count = local_points(packed, cluster, locals);
    Point exact[max_cluster_points];
    double moved = 0;
    const Real* positions = packed.as<Real>().positions.data();
    for (std::size_t k = 0; k < count; ++k) {
        exact[k] = points[packed.user_point(locals[k])];
        Point stored;
        for (std::size_t axis = 0; axis < 3; ++axis)
            stored[axis] = positions[3 * locals[k] + axis] + packed.origin[axis];
        moved = std::max(moved, squared_distance(exact[k], stored));
    }
    if (moved == 0) return false;
    double shortest = std::numeric_limits<double>::infinity();
    for (const StoredTet& tet : packed.cluster_tets(cluster))
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = a + 1; b < 4; ++b)
                shortest = std::min(shortest, squared_distance(exact[tet.corners[a]], exact[tet.corners[b]]));
    packed.for_other_cells(cluster, [&](const StoredCell& cell) {
        for (const auto& [k, l] : edges_of(cell.kind))
            if (const auto a = cell.corners[k], b = cell.corners[l]; a != b)
                shortest = std::min(shortest, squared_distance(exact[a], exact[b]));
    });
    return moved > 1e-6 * shortest;
}

} // namespace

template <class Real>
Result<void> store_positions(const Array& array, Packed& packed) {
    const PointReader points(array);
    const bool unchanged = array.type() == ScalarType::float32 || sizeof(Real) == sizeof(double);
    constexpr Precision precision = sizeof(Real) == sizeof(float) ? Precision::float32 : Precision::float64;
    if (auto ok = check_grid_size(array, precision, packed.frame ? &*packed.frame : nullptr); !ok) return ok;
    packed.origin = {};
    packed.point_type = array.type();
    if (packed.frame)
        if (auto ok = check_point_type(*packed.frame, array.type()); !ok) return ok;
    if (!unchanged) {
        const Bounds bounds = bounds_of(points, packed);
        if (packed.frame) {
            if (auto ok = check_bounds(*packed.frame, bounds.lower, bounds.upper); !ok) return ok;
            packed.origin = origin_in(packed.frame->whole);
        } else
            for (std::size_t axis = 0; axis < 3 && packed.points(); ++axis)
                packed.origin[axis] =
                    rounded_to_float(bounds.lower[axis] + (bounds.upper[axis] - bounds.lower[axis]) / 2);
    }
    SharedBuffer<Real>& positions = packed.as<Real>().positions;
    positions = SharedBuffer<Real>(3 * packed.points());
    std::atomic<std::uint64_t> flushed{0}, coarse{0};
    worker_ranges(packed.points(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        constexpr std::size_t ahead = 16;
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            points.prefetch(packed.user_point(std::min(i + ahead, end - 1)));
            const Point p = points[packed.user_point(i)];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Real stored = store_coordinate<Real>(p[axis], packed.origin[axis]);
                count += stored == 0 && p[axis] != packed.origin[axis];
                positions[3 * i + axis] = stored;
            }
        }
        flushed += count;
    });
    if (!unchanged)
        worker_each(packed.clusters(), 64, [&](std::size_t c) { coarse += is_coarse<Real>(points, packed, c); });
    packed.report.flushed_coordinates = flushed;
    packed.report.coarse_clusters = coarse;
    return {};
}

template Result<void> store_positions<float>(const Array&, Packed&);
template Result<void> store_positions<double>(const Array&, Packed&);

} // namespace isotet::core
