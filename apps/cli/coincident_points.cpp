// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "coincident_points.hpp"

#include <cstdint>
#include <mutex>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/orientation.hpp"
#include "core/parallel.hpp"
#include "core/point_hash.hpp"
#include "core/radix_sort.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

constexpr std::size_t enough_points = std::size_t{1} << 22;
constexpr std::size_t points_per_task = std::size_t{1} << 16;
constexpr std::size_t one_in = 1000;

/// Hash and number of the points whose hash ends with `zero_bits` bits of zero, by hash.
std::vector<core::Keyed> sampled(const Array& points, int zero_bits) {
    std::vector<core::Keyed> samples;
    std::mutex mutex;
    const core::PointReader reader(points);
    core::parallel_ranges(points.tuples(), points_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<core::Keyed> found;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint64_t hash = core::hash_of(reader[i]);
            if ((hash & ((std::uint64_t{1} << zero_bits) - 1)) == 0) found.push_back({hash, i});
        }
        const std::lock_guard lock(mutex);
        samples.insert(samples.end(), found.begin(), found.end());
    });
    std::vector<core::Keyed> scratch(samples.size());
    core::radix_sort(samples, scratch);
    return samples;
}

std::size_t repeated(const std::vector<core::Keyed>& samples) {
    std::size_t count = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) count += samples[i].key == samples[i - 1].key;
    return count;
}

/// Takes away samples of points that no cell uses.
void keep_used(std::vector<core::Keyed>& samples, const Grid& grid) {
    std::vector<bool> used(grid.points.tuples(), false);
    grid.cells.connectivity.visit([&](auto corners) {
        if constexpr (std::is_integral_v<typename decltype(corners)::value_type>) {
            for (const auto corner : corners) {
                const auto point = static_cast<std::uint64_t>(corner);
                if (point < used.size()) used[point] = true;
            }
        }
    });
    std::erase_if(samples, [&](const core::Keyed& sample) { return !used[sample.number]; });
}

} // namespace

std::string coincident_points_note(const Grid& grid) {
    const std::size_t points = grid.points.tuples();
    if (grid.points.components() != 3 || points < 2) return {};
    int zero_bits = 0;
    while ((points >> zero_bits) > enough_points) ++zero_bits;
    std::vector<core::Keyed> samples = sampled(grid.points, zero_bits);
    const auto many = [&] { return repeated(samples) > samples.size() / one_in; };
    if (!many()) return {};
    keep_used(samples, grid);
    if (!many()) return {};
    return fmt::format(
        "{}{} points lie exactly on others of lower numbers: the surface is open there; --merge-points 0 welds them",
        zero_bits ? "about " : "", grouped(static_cast<std::uint64_t>(repeated(samples)) << zero_bits));
}

} // namespace isotet::cli
