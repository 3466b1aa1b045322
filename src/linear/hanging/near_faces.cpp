// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/near_faces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "linear/hanging/face_shapes.hpp"
#include "linear/hanging/place_tree.hpp"

namespace isotet::linear {

namespace {

constexpr double near_face = 0.1; // of a face's extent: one that may lie on it

} // namespace

bool has_smaller_faces(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points) {
    const FaceShapes shapes(faces, cells, points);
    std::vector<Point> middles(faces.size());
    for (std::size_t i = 0; i < middles.size(); ++i) middles[i] = shapes.middle(i);
    const PlaceTree tree(std::move(middles));
    std::atomic<bool> found{false};
    const auto look_at = [&](std::size_t face) {
        Point lower = points[faces.loop(face)[0]], upper = lower;
        for (const std::uint64_t point : faces.loop(face))
            for (std::size_t axis = 0; axis < 3; ++axis) {
                lower[axis] = std::min(lower[axis], points[point][axis]);
                upper[axis] = std::max(upper[axis], points[point][axis]);
            }
        const double more = beside_face * std::sqrt(core::squared_distance(lower, upper));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] -= more;
            upper[axis] += more;
        }
        tree.each_in(lower, upper, [&](std::uint32_t other) {
            if (shapes.is_over(face, other) && shapes.distance(face, other) <= near_face)
                found.store(true, std::memory_order_relaxed);
        });
    };
    core::parallel_ranges(faces.size(), 1 << 9, [&](std::size_t begin, std::size_t end) {
        for (std::size_t face = begin; face < end && !found.load(std::memory_order_relaxed); ++face) look_at(face);
    });
    return found;
}

} // namespace isotet::linear
