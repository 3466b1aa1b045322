// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/points/coincident_points.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>

#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "grid/points/close_points.hpp"
#include "numbers/point_hash.hpp"

namespace isotet {
namespace core {
namespace {

constexpr std::size_t max_sampled_points = std::size_t{1} << 16;
constexpr std::size_t coincident_one_in = 1000;
constexpr double share_where_cells_are_apart = 0x1p-24;

struct SampledPoint {
    std::uint64_t hash, close; ///< of the place, and of a place rounded to a millionth of the grid
    std::uint64_t number;
};

/// Rounds coordinates to a millionth of the length of a box around some of the points.
class RoundedPlaces {
public:
    explicit RoundedPlaces(const Array& points) {
        constexpr std::size_t most = 1024;
        const PointReader places(points);
        Point lower{places[0]}, upper{places[0]};
        const std::size_t step = std::max<std::size_t>(points.tuples() / most, 1);
        for (std::size_t i = 0; i < points.tuples(); i += step)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                lower[axis] = std::min(lower[axis], places[i][axis]);
                upper[axis] = std::max(upper[axis], places[i][axis]);
            }
        double length = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) length = std::max(length, upper[axis] - lower[axis]);
        if (const double steps = 0x1p20 / length; std::isfinite(steps) && steps > 0) steps_ = steps;
    }

    /// How many steps a coordinate is from 0: in the low bits. The same for equal ones, -0 and +0 being equal.
    std::uint64_t operator()(double coordinate) const {
        return std::bit_cast<std::uint64_t>(coordinate * steps_ + 0x1.8p52);
    }

private:
    double steps_ = 1;
};

/// Chooses samples; cheaper than hash_of(), and the same for points close to each other, but for few.
template <class Coordinate>
std::uint32_t sampling_key(const RoundedPlaces& rounded, const Coordinate* point) {
    const auto low = [&](std::size_t axis) {
        return static_cast<std::uint32_t>(rounded(static_cast<double>(point[axis])));
    };
    const std::uint32_t sum = low(0) * 0x85EBCA6BU + low(1) * 0xC2B2AE35U + low(2) * 0x27D4EB2FU;
    const std::uint32_t mixed = (sum ^ sum >> 15) * 0x2C1B3C6DU;
    return (mixed ^ mixed >> 12) * 0x297A2D39U;
}

/// One point of 2^one_in_bits, in any order, but all at one place or none.
std::vector<SampledPoint> sample_points(const Array& points, int one_in_bits, const Progress& progress) {
    std::vector<SampledPoint> samples;
    std::mutex mutex;
    const PointReader reader(points);
    points.visit([&]<class Coordinate>(std::span<const Coordinate> coordinates) {
        if constexpr (std::is_floating_point_v<Coordinate>) {
            const RoundedPlaces rounded(points);
            const auto close = [&](const Point& place) {
                return hash_of({std::bit_cast<double>(rounded(place[0])), std::bit_cast<double>(rounded(place[1])),
                                std::bit_cast<double>(rounded(place[2]))});
            };
            parallel_pieces(points.tuples(), std::size_t{1} << 16, progress, [&](std::size_t begin, std::size_t end) {
                std::vector<SampledPoint> found;
                for (std::size_t i = begin; i < end; ++i) {
                    const std::uint64_t key = sampling_key(rounded, coordinates.data() + 3 * i);
                    if ((key << one_in_bits) >> 32 == 0) found.push_back({hash_of(reader[i]), close(reader[i]), i});
                }
                const std::lock_guard lock(mutex);
                samples.insert(samples.end(), found.begin(), found.end());
            });
        }
    });
    return samples;
}

/// Samples whose hash an earlier one has.
std::size_t count_repeated(const std::vector<SampledPoint>& samples, std::uint64_t SampledPoint::* hash) {
    const auto bits = static_cast<int>(std::bit_width(2 * samples.size() + 1));
    std::vector<std::uint64_t> seen(std::size_t{1} << bits);
    const std::size_t mask = seen.size() - 1;
    std::size_t count = 0, zeros = 0;
    for (const SampledPoint& sample : samples) {
        if (sample.*hash == 0) { // means an empty place in the table
            count += zeros++ > 0;
            continue;
        }
        std::size_t place = sample.*hash >> (64 - bits);
        while (seen[place] != 0 && seen[place] != sample.*hash) place = (place + 1) & mask;
        count += seen[place] == sample.*hash;
        seen[place] = sample.*hash;
    }
    return count;
}

bool are_few(std::size_t count, const std::vector<SampledPoint>& samples) {
    return count <= samples.size() / coincident_one_in;
}

bool few_are_close(const std::vector<SampledPoint>& samples) {
    return are_few(count_repeated(samples, &SampledPoint::close), samples);
}

/// Samples by chains of those that are close to each other.
struct CloseSamples {
    std::vector<std::uint64_t> lowest; ///< sample of each one's chain
    Point lower{};                     ///< of the samples
};

/// `share`   of the largest coordinate: how far points are apart at most
CloseSamples chains_of(const std::vector<SampledPoint>& samples, const Array& points, double share,
                       const Progress& progress) {
    const PointReader reader(points);
    std::vector<double> places;
    std::vector<std::uint8_t> wanted;
    CloseSamples chains;
    chains.lower.fill(std::numeric_limits<double>::infinity());
    double largest = 0;
    for (const SampledPoint& sample : samples) {
        const Point place = reader[sample.number];
        places.insert(places.end(), place.begin(), place.end());
        wanted.push_back(std::ranges::all_of(place, [](double x) { return std::isfinite(x); }));
        for (std::size_t axis = 0; wanted.back() && axis < 3; ++axis) {
            chains.lower[axis] = std::min(chains.lower[axis], place[axis]);
            largest = std::max(largest, std::abs(place[axis]));
        }
    }
    if (largest == 0) return chains;
    chains.lowest = lowest_of_chain(Array::borrow(places, 3), wanted, chains.lower, share * largest, progress);
    return chains;
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

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

/// Marks chains along which a cell lies: it is thin, and its corners are no doubled points.
/// `samples`   ascending by number
std::vector<std::uint8_t> thin_chains(const std::vector<SampledPoint>& samples, const CloseSamples& chains,
                                      const Grid& grid, const Progress& progress) {
    std::vector<bool> sampled(grid.points.tuples());
    for (const SampledPoint& sample : samples) sampled[sample.number] = true;
    const auto chain_of = [&](std::uint64_t point) {
        const auto found = std::ranges::lower_bound(samples, point, {}, &SampledPoint::number);
        return chains.lowest[static_cast<std::size_t>(found - samples.begin())];
    };
    const Cells& cells = grid.cells;
    const auto corners_each = static_cast<std::size_t>(corners_of(static_cast<std::uint8_t>(cells.uniform_type)));
    std::vector<std::uint8_t> thin(samples.size());
    cells.connectivity.visit([&]<class Number>(std::span<const Number> corners) {
        if constexpr (!std::is_integral_v<Number>) return;
        const auto end_of = [&](std::size_t cell) { // of the cells before it
            if (cells.offsets.empty()) return cell * corners_each;
            const double end = cells.offsets.at(cell);
            return end >= 0 ? std::min(static_cast<std::size_t>(end), corners.size()) : corners.size();
        };
        const std::size_t count = cells.offsets.empty() ? corners.size() / std::max<std::size_t>(corners_each, 1)
                                                        : cells.offsets.tuples() - 1;
        parallel_pieces(count, std::size_t{1} << 14, progress, [&](std::size_t begin, std::size_t end) {
            std::vector<std::pair<std::uint64_t, std::uint64_t>> here; // chain, point
            for (std::size_t cell = begin; cell < end; ++cell) {
                here.clear();
                for (std::size_t k = end_of(cell); k < end_of(cell + 1); ++k) {
                    const auto point = static_cast<std::uint64_t>(corners[k]);
                    if (point < sampled.size() && sampled[point]) here.emplace_back(chain_of(point), point);
                }
                std::ranges::sort(here);
                for (std::size_t i = 1; i < here.size(); ++i)
                    if (here[i].first == here[i - 1].first && here[i].second != here[i - 1].second)
                        std::atomic_ref(thin[here[i].first]).store(1, std::memory_order_relaxed);
            }
        });
    });
    return thin;
}

double share_of(ScalarType type, bool are_cells_apart) {
    return are_cells_apart ? share_where_cells_are_apart : share_of_rounding(type);
}

/// Of the samples, and how far doubled ones are apart; none where few are.
DoubledPoints close_points(const std::vector<SampledPoint>& samples, const Grid& grid, const Progress& progress) {
    // Where cells share next to no points, farther ones are doubled, too.
    const bool are_cells_apart = grid.cells.connectivity.tuples() < 2 * grid.points.tuples();
    const CloseSamples chains =
        chains_of(samples, grid.points, share_of(grid.points.type(), are_cells_apart), progress);
    if (chains.lowest.empty()) return {};
    const std::vector<std::uint8_t> thin = thin_chains(samples, chains, grid, progress);
    const PointReader places(grid.points);
    DoubledPoints found;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::uint64_t first = chains.lowest[i];
        if (first == i || thin[first] != 0) continue;
        ++found.points;
        found.gap = std::max(found.gap, distance(places[samples[i].number], places[samples[first].number]));
    }
    return are_few(found.points, samples) ? DoubledPoints{} : found;
}

DoubledPoints find_doubled(const Grid& grid, const Progress& progress) {
    if (grid.points.components() != 3 || grid.points.tuples() < 2) return {};
    const int one_in_bits = one_in_bits_for(grid.points.tuples());
    std::vector<SampledPoint> samples = sample_points(grid.points, one_in_bits, progress);
    if (few_are_close(samples)) return {};
    keep_used(samples, grid);
    if (few_are_close(samples)) return {};
    std::ranges::sort(samples, {}, &SampledPoint::number);
    DoubledPoints found = close_points(samples, grid, progress);
    if (const std::size_t equal = count_repeated(samples, &SampledPoint::hash);
        found.points <= equal && !are_few(equal, samples))
        found = {equal, false, 0};
    found.points <<= one_in_bits;
    found.estimated = found.points > 0 && one_in_bits > 0;
    return found;
}

/// `share`   as chains_of() takes it
bool may_be_doubled(const Array& points, double share, const Progress& progress) {
    const auto samples = sample_points(points, one_in_bits_for(points.tuples()), progress);
    if (few_are_close(samples)) return false;
    if (!are_few(count_repeated(samples, &SampledPoint::hash), samples)) return true;
    const CloseSamples chains = chains_of(samples, points, share, progress);
    std::size_t close = 0;
    for (std::size_t i = 0; i < chains.lowest.size(); ++i) close += chains.lowest[i] != i;
    return !are_few(close, samples);
}

} // namespace

DoubledPoints estimate_doubled_points(const Grid& grid, const Run& run) {
    DoubledPoints found;
    with_threads(run.threads, [&] { found = find_doubled(grid, run.progress); });
    return found;
}

bool may_have_doubled_points(const Array& points, bool are_cells_apart, const Run& run) {
    if (points.components() != 3 || points.tuples() < 2) return false;
    bool may = false;
    with_threads(run.threads,
                 [&] { may = may_be_doubled(points, share_of(points.type(), are_cells_apart), run.progress); });
    return may;
}

} // namespace core

CoincidentPoints estimate_coincident_points(const Grid& grid, const Run& run) {
    const core::DoubledPoints found = core::estimate_doubled_points(grid, run);
    return {found.points, found.estimated};
}

bool may_have_coincident_points(const Array& points, const Run& run) {
    return core::may_have_doubled_points(points, false, run);
}

} // namespace isotet
