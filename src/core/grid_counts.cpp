// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/grid_counts.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/cells.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"
#include "core/point_hash.hpp"

namespace isotet {

namespace {

constexpr std::size_t max_sampled_points = std::size_t{1} << 16;
constexpr std::size_t coincident_one_in = 1000;

using TypeHistogram = std::array<std::uint64_t, 256>;

struct SampledPoint {
    std::uint64_t hash, number;
};

/// The points whose hash ends with `zero_bits` bits of zero, in any order.
std::vector<SampledPoint> sample_points(const Array& points, int zero_bits) {
    std::vector<SampledPoint> samples;
    std::mutex mutex;
    const core::PointReader reader(points);
    core::parallel_ranges(points.tuples(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
        std::vector<SampledPoint> found;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint64_t hash = core::hash_of(reader[i]);
            if ((hash & ((std::uint64_t{1} << zero_bits) - 1)) == 0) found.push_back({hash, i});
        }
        const std::lock_guard lock(mutex);
        samples.insert(samples.end(), found.begin(), found.end());
    });
    return samples;
}

/// Samples whose hash an earlier one has.
std::size_t count_repeated(const std::vector<SampledPoint>& samples) {
    const auto bits = static_cast<int>(std::bit_width(2 * samples.size() + 1));
    std::vector<std::uint64_t> seen(std::size_t{1} << bits); // by the highest bits: the lowest are all 0
    const std::size_t mask = seen.size() - 1;
    std::size_t count = 0, zeros = 0;
    for (const SampledPoint& sample : samples) {
        if (sample.hash == 0) { // means an empty place in the table
            count += zeros++ > 0;
            continue;
        }
        std::size_t place = sample.hash >> (64 - bits);
        while (seen[place] != 0 && seen[place] != sample.hash) place = (place + 1) & mask;
        count += seen[place] == sample.hash;
        seen[place] = sample.hash;
    }
    return count;
}

bool few_repeat(const std::vector<SampledPoint>& samples) {
    return count_repeated(samples) <= samples.size() / coincident_one_in;
}

/// So many that a sample is not too large.
int zero_bits_for(std::size_t points) {
    int zero_bits = 0;
    while ((points >> zero_bits) > max_sampled_points) ++zero_bits;
    return zero_bits;
}

/// Removes points that no cell uses.
void keep_used(std::vector<SampledPoint>& samples, const Grid& grid) {
    std::vector<bool> used(grid.points.tuples(), false);
    grid.cells.connectivity.visit([&](auto corners) {
        if constexpr (std::is_integral_v<typename decltype(corners)::value_type>) {
            for (const auto corner : corners) {
                const auto point = static_cast<std::uint64_t>(corner);
                if (point < used.size()) used[point] = true;
            }
        }
    });
    std::erase_if(samples, [&](const SampledPoint& sample) { return !used[sample.number]; });
}

} // namespace

std::map<std::uint8_t, std::uint64_t> count_cells_by_type(const Cells& cells) {
    std::map<std::uint8_t, std::uint64_t> counts;
    if (cells.types.empty()) {
        if (cells.count() > 0) counts[static_cast<std::uint8_t>(cells.uniform_type)] = cells.count();
        return counts;
    }
    if (cells.types.type() != ScalarType::uint8) return counts;
    TypeHistogram total{};
    std::mutex mutex;
    const std::span<const std::uint8_t> types = cells.types.as<std::uint8_t>();
    core::parallel_ranges(types.size(), std::size_t{1} << 20, [&](std::size_t begin, std::size_t end) {
        TypeHistogram part{};
        for (const std::uint8_t type : types.subspan(begin, end - begin)) ++part[type];
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < part.size(); ++i) total[i] += part[i];
    });
    for (std::size_t type = 0; type < total.size(); ++type)
        if (total[type] > 0) counts[static_cast<std::uint8_t>(type)] = total[type];
    return counts;
}

bool is_contoured(std::uint8_t cell_type) noexcept { return core::is_contoured(cell_type); }

CoincidentPoints estimate_coincident_points(const Grid& grid) {
    if (grid.points.components() != 3 || grid.points.tuples() < 2) return {};
    const int zero_bits = zero_bits_for(grid.points.tuples());
    std::vector<SampledPoint> samples = sample_points(grid.points, zero_bits);
    if (few_repeat(samples)) return {};
    keep_used(samples, grid);
    if (few_repeat(samples)) return {};
    return {static_cast<std::uint64_t>(count_repeated(samples)) << zero_bits, zero_bits > 0};
}

bool may_have_coincident_points(const Array& points) {
    if (points.components() != 3 || points.tuples() < 2) return false;
    return !few_repeat(sample_points(points, zero_bits_for(points.tuples())));
}

} // namespace isotet
