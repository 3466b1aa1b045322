// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/boundary_faces.hpp"

#include <algorithm>

#include <tbb/parallel_sort.h>

#include "grid/renumber.hpp"

namespace isotet::core {

void place_vertices(Surface& surface, const Array& all, const std::vector<std::uint64_t>& points) {
    surface.positions = in_order(all, points);
    std::vector<std::int64_t> ends(2 * points.size());
    parallel_each(ends.size(), 1 << 14, [&](std::size_t i) { ends[i] = static_cast<std::int64_t>(points[i / 2]); });
    surface.edge_ends = Array::own(std::move(ends), 2);
}

std::vector<std::uint64_t> each_once(std::vector<std::uint64_t> points) {
    tbb::parallel_sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

} // namespace isotet::core
