// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/grid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "grid/points/coincident_points.hpp"

namespace isotet {

namespace {

using TypeHistogram = std::array<std::uint64_t, 256>;

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
    return largest > 0 ? std::pow(10.0, std::ceil(std::log10(core::share_of_rounding(points.type()) * largest))) : 0;
}

} // namespace isotet
