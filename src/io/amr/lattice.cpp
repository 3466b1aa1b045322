// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/amr/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"

namespace isotet::io::amr {
namespace {

constexpr double most_steps = 1 << 20;                        // of the finest level in one of the coarsest
constexpr std::int64_t most_number = std::int64_t{1} << 30;   // of a cell in its level
constexpr std::uint64_t most_points = std::uint64_t{1} << 62; // of the lattice
constexpr double in_step = 1e-5; // spacings are written with 6 digits, or in single precision
constexpr const char* axis_names[] = {"x", "y", "z"};

Result<void> check_level(const Level& level, std::size_t number) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(level.spacing[axis] > 0) || !std::isfinite(level.spacing[axis]))
            return invalid_data(fmt::format("the spacing of level {} along {} is {}, but must be above 0", number,
                                            axis_names[axis], level.spacing[axis]));
    for (std::size_t box = 0; box < level.boxes.size(); ++box)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t first = level.boxes[box].first[axis], last = level.boxes[box].last[axis];
            if (first < -most_number || last > most_number || last < first)
                return invalid_data(
                    fmt::format("box {} of level {} goes from cell {} to {} along {}: it must have cells, "
                                "with numbers up to 2^30",
                                box, number, first, last, axis_names[axis]));
        }
    return {};
}

/// Steps of the finer level in one of the coarser, along an axis.
Result<double> ratio_of(const Hierarchy& hierarchy, std::size_t coarser, std::size_t axis) {
    const double coarse = hierarchy.levels[coarser].spacing[axis], fine = hierarchy.levels[coarser + 1].spacing[axis];
    const double ratio = std::round(coarse / fine);
    if (!(ratio >= 1) || !(std::abs(coarse / fine - ratio) <= in_step * ratio))
        return invalid_data(
            fmt::format("the spacing along {} is {} in level {} and {} in level {}: that of a level must be "
                        "a whole multiple of the next one's",
                        axis_names[axis], coarse, coarser, fine, coarser + 1));
    return ratio;
}

} // namespace

std::uint64_t Lattice::volume(std::size_t level) const {
    std::uint64_t all = 1;
    for (const std::int64_t along : steps_[level]) all *= static_cast<std::uint64_t>(along);
    return all;
}

Result<Lattice> Lattice::make(const Hierarchy& hierarchy) {
    const std::size_t levels = hierarchy.levels.size();
    if (std::ranges::all_of(hierarchy.levels, [](const Level& level) { return level.boxes.empty(); }))
        return invalid_data("no level has a box");
    for (const double along : hierarchy.origin)
        if (!std::isfinite(along)) return invalid_data(fmt::format("the origin has a coordinate {}", along));
    for (std::size_t level = 0; level < levels; ++level)
        if (auto sound = check_level(hierarchy.levels[level], level); !sound) return sound.error();
    Lattice lattice;
    lattice.origin_ = hierarchy.origin;
    lattice.spacing_ = hierarchy.levels[0].spacing;
    lattice.steps_.assign(levels, {1, 1, 1});
    std::uint64_t points = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t level = levels - 1; level-- > 0;) {
            const auto ratio = ratio_of(hierarchy, level, axis);
            if (!ratio) return ratio.error();
            const double steps = *ratio * static_cast<double>(lattice.steps_[level + 1][axis]);
            if (!(steps <= most_steps))
                return invalid_data(fmt::format(
                    "the last level is {} times as fine as level {}: at most 2^20 can be read", steps, level));
            lattice.steps_[level][axis] = static_cast<std::int64_t>(steps);
        }
        std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = std::numeric_limits<std::int64_t>::min();
        for (std::size_t level = 0; level < levels; ++level)
            for (const CellBox& box : hierarchy.levels[level].boxes) {
                first = std::min(first, box.first[axis] * lattice.steps_[level][axis]);
                last = std::max(last, (box.last[axis] + 1) * lattice.steps_[level][axis]);
            }
        lattice.first_[axis] = first;
        lattice.size_[axis] = static_cast<std::uint64_t>(last - first) + 1;
        if (lattice.size_[axis] > most_points / points)
            return invalid_data("the boxes lie too far apart: the finest level would have more than 2^62 points");
        points *= lattice.size_[axis];
    }
    return lattice;
}

} // namespace isotet::io::amr
