// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/patches.hpp"

#include <span>

#include <fmt/core.h>

#include "base/errors.hpp"

namespace isotet::core {

namespace {

bool is_list(const Array& array) { return array.type() == ScalarType::int64 && array.components() == 1; }

} // namespace

Result<void> check_patches(const Grid& grid) {
    const BoundaryPatches& patches = grid.patches;
    if (patches.numbers.empty() && patches.offsets.empty() && patches.points.empty()) return {};
    if (!is_list(patches.points) || !is_list(patches.offsets) || !is_list(patches.numbers))
        return invalid_data("points, offsets and numbers of patches must be int64, one component");
    const auto points = patches.points.as<std::int64_t>(), offsets = patches.offsets.as<std::int64_t>();
    if (offsets.size() != patches.count() + 1 || offsets.front() != 0 ||
        offsets.back() != static_cast<std::int64_t>(points.size()))
        return invalid_data(fmt::format("patches have {} faces, {} offsets and {} points, but must have one offset more "
                                        "than faces, from 0 to the number of points",
                                        patches.count(), offsets.size(), points.size()));
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i)
        if (offsets[i + 1] < offsets[i])
            return invalid_data(fmt::format("offset {} of patches is {}, below the one before, {}", i + 1, offsets[i + 1],
                                            offsets[i]));
    for (const std::int64_t number : patches.numbers.as<std::int64_t>())
        if (number < 0) return invalid_data(fmt::format("a face of a patch has the number {}, below 0", number));
    for (const std::int64_t point : points)
        if (point < 0 || static_cast<std::uint64_t>(point) >= grid.points.tuples())
            return invalid_data(fmt::format("a face of a patch has point {}, but the grid has {} points", point,
                                            grid.points.tuples()));
    return {};
}

} // namespace isotet::core
