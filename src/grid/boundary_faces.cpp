// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/boundary_faces.hpp"

#include <algorithm>

#include <tbb/parallel_sort.h>

namespace isotet::core {

std::vector<std::uint64_t> each_once(std::vector<std::uint64_t> points) {
    tbb::parallel_sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

} // namespace isotet::core
