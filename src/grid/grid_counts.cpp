// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/grid.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "numbers/point_hash.hpp"

namespace isotet {

namespace {

constexpr std::size_t max_sampled_points = std::size_t{1} << 16;
constexpr std::size_t coincident_one_in = 1000;

using TypeHistogram = std::array<std::uint64_t, 256>;

struct SampledPoint {
    std::uint64_t hash, number;
};

/// Chooses samples; cheaper than hash_of(), and like it the same for equal coordinates, -0 and +0 being equal.
template <class Coordinate>
std::uint32_t sampling_key(const Coordinate* point) {
    const auto bits = [&](std::size_t axis) {
        const Coordinate coordinate = point[axis] + Coordinate{0}; // -0 becomes +0
        if constexpr (sizeof(Coordinate) == sizeof(std::uint32_t)) {
            return std::bit_cast<std::uint32_t>(coordinate);
        } else {
            const auto all = std::bit_cast<std::uint64_t>(coordinate);
            return static_cast<std::uint32_t>(all) * 0x9E3779B1U ^ static_cast<std::uint32_t>(all >> 32);
        }
    };
    const std::uint32_t sum = bits(0) * 0x85EBCA6BU + bits(1) * 0xC2B2AE35U + bits(2) * 0x27D4EB2FU;
    const std::uint32_t mixed = (sum ^ sum >> 15) * 0x2C1B3C6DU;
    return (mixed ^ mixed >> 12) * 0x297A2D39U;
}

/// One point of 2^one_in_bits, in any order, but all at one place or none.
std::vector<SampledPoint> sample_points(const Array& points, int one_in_bits, const Progress& progress) {
    std::vector<SampledPoint> samples;
    std::mutex mutex;
    const core::PointReader reader(points);
    points.visit([&]<class Coordinate>(std::span<const Coordinate> coordinates) {
        if constexpr (std::is_floating_point_v<Coordinate>) {
            core::parallel_pieces(points.tuples(), std::size_t{1} << 16, progress,
                                  [&](std::size_t begin, std::size_t end) {
                                      std::vector<SampledPoint> found;
                                      for (std::size_t i = begin; i < end; ++i) {
                                          const std::uint64_t key = sampling_key(coordinates.data() + 3 * i);
                                          if ((key << one_in_bits) >> 32 == 0)
                                              found.push_back({core::hash_of(reader[i]), i});
                                      }
                                      const std::lock_guard lock(mutex);
                                      samples.insert(samples.end(), found.begin(), found.end());
                                  });
        }
    });
    return samples;
}

/// Samples whose hash an earlier one has.
std::size_t count_repeated(const std::vector<SampledPoint>& samples) {
    const auto bits = static_cast<int>(std::bit_width(2 * samples.size() + 1));
    std::vector<std::uint64_t> seen(std::size_t{1} << bits);
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
int one_in_bits_for(std::size_t points) {
    int bits = 0;
    while ((points >> bits) > max_sampled_points) ++bits;
    return bits;
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

/// In an array of uint8.
TypeHistogram count_types(std::span<const std::uint8_t> types, const Progress& progress) {
    TypeHistogram total{};
    std::mutex mutex;
    core::parallel_pieces(types.size(), std::size_t{1} << 20, progress, [&](std::size_t begin, std::size_t end) {
        TypeHistogram part{};
        for (const std::uint8_t type : types.subspan(begin, end - begin)) ++part[type];
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < part.size(); ++i) total[i] += part[i];
    });
    return total;
}

/// The largest finite coordinate, without its sign.
double largest_coordinate(const Array& points, const Progress& progress) {
    const core::PointReader reader(points);
    double largest = 0;
    std::mutex mutex;
    core::parallel_pieces(points.tuples(), std::size_t{1} << 16, progress, [&](std::size_t begin, std::size_t end) {
        double of_part = 0;
        for (std::size_t i = begin; i < end; ++i)
            for (const double x : reader[i])
                if (std::isfinite(x)) of_part = std::max(of_part, std::abs(x));
        const std::lock_guard lock(mutex);
        largest = std::max(largest, of_part);
    });
    return largest;
}

CoincidentPoints coincident_points(const Grid& grid, const Progress& progress) {
    if (grid.points.components() != 3 || grid.points.tuples() < 2) return {};
    const int one_in_bits = one_in_bits_for(grid.points.tuples());
    std::vector<SampledPoint> samples = sample_points(grid.points, one_in_bits, progress);
    if (few_repeat(samples)) return {};
    keep_used(samples, grid);
    if (few_repeat(samples)) return {};
    return {static_cast<std::uint64_t>(count_repeated(samples)) << one_in_bits, one_in_bits > 0};
}

} // namespace

std::map<std::uint8_t, std::uint64_t> count_cells_by_type(const Cells& cells, const Run& run) {
    std::map<std::uint8_t, std::uint64_t> counts;
    if (cells.types.empty()) {
        if (cells.count() > 0) counts[static_cast<std::uint8_t>(cells.uniform_type)] = cells.count();
        return counts;
    }
    if (cells.types.type() != ScalarType::uint8) return counts;
    TypeHistogram total{};
    core::with_threads(run.threads, [&] { total = count_types(cells.types.as<std::uint8_t>(), run.progress); });
    for (std::size_t type = 0; type < total.size(); ++type)
        if (total[type] > 0) counts[static_cast<std::uint8_t>(type)] = total[type];
    return counts;
}

bool is_contoured(std::uint8_t cell_type) noexcept {
    return core::is_contoured(cell_type) && !core::is_ordered(cell_type);
}

double rounding_of(const Array& points, const Run& run) {
    if (!is_floating(points.type()) || points.components() != 3) return 0;
    double largest = 0;
    core::with_threads(run.threads, [&] { largest = largest_coordinate(points, run.progress); });
    const double share = points.type() == ScalarType::float32 ? 0x1p-23 : 0x1p-33;
    return largest > 0 ? std::pow(10.0, std::ceil(std::log10(share * largest))) : 0;
}

CoincidentPoints estimate_coincident_points(const Grid& grid, const Run& run) {
    CoincidentPoints found;
    core::with_threads(run.threads, [&] { found = coincident_points(grid, run.progress); });
    return found;
}

bool may_have_coincident_points(const Array& points, const Run& run) {
    if (points.components() != 3 || points.tuples() < 2) return false;
    bool few = false;
    core::with_threads(
        run.threads, [&] { few = few_repeat(sample_points(points, one_in_bits_for(points.tuples()), run.progress)); });
    return !few;
}

} // namespace isotet
