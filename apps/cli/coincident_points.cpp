// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "coincident_points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <mutex>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/parallel.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

constexpr std::size_t enough_points = std::size_t{1} << 22;
constexpr std::size_t grain = std::size_t{1} << 16;
constexpr std::size_t one_in = 1000;

struct Sample {
    std::uint64_t hash = 0;
    std::uint64_t point = 0;
    friend auto operator<=>(const Sample&, const Sample&) = default;
};

std::uint64_t mixed(std::uint64_t value) noexcept { // the finalizer of splitmix64
    value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31);
}

template <class Scalar>
std::uint64_t hash_of(const Scalar* position) noexcept {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double value = static_cast<double>(position[axis]) + 0.0; // -0 becomes +0
        hash = mixed(hash + 0x9E3779B97F4A7C15U + std::bit_cast<std::uint64_t>(value));
    }
    return hash;
}

/// Point and hash of those whose hash has `zero_bits` low bits of zero, by hash, then by point.
std::vector<Sample> sampled(const Array& points, int zero_bits) {
    std::vector<Sample> samples;
    std::mutex mutex;
    points.visit([&](auto scalars) {
        core::parallel_ranges(points.tuples(), grain, [&](std::size_t begin, std::size_t end) {
            std::vector<Sample> found;
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint64_t hash = hash_of(scalars.data() + 3 * i);
                if ((hash & ((std::uint64_t{1} << zero_bits) - 1)) == 0) found.push_back({hash, i});
            }
            const std::lock_guard lock(mutex);
            samples.insert(samples.end(), found.begin(), found.end());
        });
    });
    std::sort(samples.begin(), samples.end());
    return samples;
}

std::size_t repeated(const std::vector<Sample>& samples) {
    std::size_t count = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) count += samples[i].hash == samples[i - 1].hash;
    return count;
}

/// Takes away samples of points that no cell uses.
void keep_used(std::vector<Sample>& samples, const Grid& grid) {
    std::vector<bool> used(grid.points.tuples(), false);
    grid.cells.connectivity.visit([&](auto corners) {
        if constexpr (std::is_integral_v<typename decltype(corners)::value_type>) {
            for (const auto corner : corners) {
                const auto point = static_cast<std::uint64_t>(corner);
                if (point < used.size()) used[point] = true;
            }
        }
    });
    std::erase_if(samples, [&](const Sample& sample) { return !used[sample.point]; });
}

} // namespace

std::string coincident_points_note(const Grid& grid) {
    const std::size_t points = grid.points.tuples();
    if (grid.points.components() != 3 || points < 2) return {};
    int zero_bits = 0;
    while ((points >> zero_bits) > enough_points) ++zero_bits;
    std::vector<Sample> samples = sampled(grid.points, zero_bits);
    const auto many = [&] { return repeated(samples) > samples.size() / one_in; };
    if (!many()) return {};
    keep_used(samples, grid);
    if (!many()) return {};
    return fmt::format(
        "{}{} points lie exactly on others of lower numbers: the surface is open there; --merge-points 0 welds them",
        zero_bits ? "about " : "", grouped(static_cast<std::uint64_t>(repeated(samples)) << zero_bits));
}

} // namespace isotet::cli
