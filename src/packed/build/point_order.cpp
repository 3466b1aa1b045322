// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/build/point_order.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "base/workers.hpp"
#include "numbers/bounds.hpp"
#include "numbers/hilbert.hpp"

namespace isotet::core {

Bounds bounds_of_used(const PointReader& points, const Buffer<std::uint8_t>& used) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, used.size(), 1 << 16), Bounds{},
        [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                if (used[i]) bounds.add(points[i]);
            return bounds;
        },
        [](Bounds a, const Bounds& b) {
            a.combine(b);
            return a;
        });
}

namespace {

/// Maps points to a Hilbert curve through the cube around the grid, 2^21 steps a side, the same scale on all axes.
class Curve {
public:
    explicit Curve(const Bounds& bounds) : lower_(bounds.lower) {
        double extent = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, bounds.upper[axis] - bounds.lower[axis]);
        scale_ = extent > 0 ? 0x1.fffffp20 / extent : 0;
        if (!(scale_ < std::numeric_limits<double>::max())) scale_ = 0;
    }
    std::uint64_t key(const Point& p) const {
        const auto step = [&](std::size_t axis) {
            return static_cast<std::uint32_t>((p[axis] - lower_[axis]) * scale_);
        };
        return hilbert_index(step(0), step(1), step(2));
    }

private:
    Point lower_;
    double scale_;
};

} // namespace

Buffer<Keyed> sort_points(const PointReader& points, const Buffer<std::uint8_t>& used) {
    constexpr std::size_t points_per_chunk = 1 << 16;
    const std::size_t chunks = (used.size() + points_per_chunk - 1) / points_per_chunk;
    const auto chunk_of = [&](std::size_t chunk) {
        return std::span(used.data(), used.size())
            .subspan(chunk * points_per_chunk, std::min(points_per_chunk, used.size() - chunk * points_per_chunk));
    };
    std::vector<std::size_t> first(chunks + 1, 0);
    worker_each(chunks, 1, [&](std::size_t chunk) {
        for (const std::uint8_t flag : chunk_of(chunk)) first[chunk + 1] += flag;
    });
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) first[chunk + 1] += first[chunk];

    const Curve curve(bounds_of_used(points, used));
    Buffer<Keyed> sorted(first[chunks]), scratch(first[chunks]);
    worker_each(chunks, 1, [&](std::size_t chunk) {
        Keyed* out = sorted.data() + first[chunk];
        const std::size_t begin = chunk * points_per_chunk;
        for (std::size_t i = begin; i < begin + chunk_of(chunk).size(); ++i)
            if (used[i]) *out++ = {curve.key(points[i]), i};
    });
    radix_sort({sorted.data(), sorted.size()}, {scratch.data(), scratch.size()});
    return sorted;
}

} // namespace isotet::core
