// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/values/average_to_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <isotet/grid.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/values/incidence.hpp"
#include "grid/values/running_mean.hpp"
#include "grid/orientation.hpp"
#include "grid/patches.hpp"
#include "grid/renumber.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t grain = 1 << 14;
constexpr double left_out = -1; // a volume that no cell has

Buffer<double> volumes_of(const Grid& grid, const CellReader& cells, const Array& values, Scalar scalar,
                          std::span<const double> known, const Progress& progress) {
    const PointReader points(grid.points);
    const bool only_flat = has_only_flat_cells(grid.cells);
    Buffer<double> volumes(cells.count());
    parallel_pieces(cells.count(), grain, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (std::isnan(scalar_at(values, scalar, cell))) volumes[cell] = left_out;
            else if (!known.empty()) volumes[cell] = known[cell];
            else volumes[cell] = only_flat && is_flat_cell(cells.type(cell)) ? 0 : six_volumes_of(cells, points, cell);
        }
    });
    return volumes;
}

template <class Index>
Incidence<Index> cells_around_points(const CellReader& cells, const Buffer<double>& volumes, const Progress& progress) {
    return {cells.points(), cells.count(),
            [&](std::size_t cell, const auto& body) {
                if (volumes[cell] == left_out) return;
                const std::uint64_t first = cells.first(cell), end = first + cells.corners(cell);
                for (std::uint64_t i = first; i < end; ++i) {
                    const std::uint64_t point = cells.corner(i);
                    bool is_new = true; // a collapsed cell has a point twice, but weighs once
                    for (std::uint64_t j = first; j < i; ++j) is_new &= cells.corner(j) != point;
                    if (is_new) body(point);
                }
            },
            progress};
}

template <class Value, class Index>
Array average(const CellReader& cells, const Buffer<double>& volumes, const Array& values, Scalar scalar, bool by_value,
              const Progress& progress) {
    Incidence<Index> around = cells_around_points<Index>(cells, volumes, progress);
    Buffer<Value> means(cells.points());
    const auto average_at = [&](std::size_t point) {
        const std::span<Index> list = around.of(point);
        std::ranges::sort(list);
        if (by_value)
            std::ranges::sort(list, {},
                              [&](Index cell) { return std::pair(scalar_at(values, scalar, cell), volumes[cell]); });
        const bool flat = std::ranges::all_of(list, [&](Index cell) { return volumes[cell] == 0; });
        RunningMean mean;
        for (const Index cell : list) mean.add(scalar_at(values, scalar, cell), flat ? 1 : volumes[cell]);
        means[point] = list.empty() ? std::numeric_limits<Value>::quiet_NaN() : static_cast<Value>(mean.mean);
    };
    parallel_pieces(means.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t point = begin; point < end; ++point) average_at(point);
    });
    return std::move(means).to_array();
}

} // namespace

double six_volumes_of(const CellReader& cells, const PointReader& points, std::size_t cell) {
    if (!is_contoured(cells.type(cell))) return left_out;
    double volume = 0;
    for (const Tet& tet : cells.tets(cell)) volume += std::abs(points.six_volumes(tet));
    return volume;
}

Array average_to_points(const Grid& grid, const CellReader& cells, const Array& values, Scalar scalar, bool by_value,
                        std::span<const double> known, const Progress& progress) {
    Buffer<double> volumes;
    if (by_value && known.empty() && !grid.point_numbers.empty()) {
        const Renumbered sorted = sort_points_by_number(grid).value();
        volumes = volumes_of(sorted.grid, CellReader::open(sorted.grid).value(), values, scalar, {}, progress);
    } else {
        volumes = volumes_of(grid, cells, values, scalar, known, progress);
    }
    if (progress.cancelled()) return {};
    const bool narrow = cells.count() <= std::numeric_limits<std::uint32_t>::max();
    if (values.type() == ScalarType::float32)
        return narrow ? average<float, std::uint32_t>(cells, volumes, values, scalar, by_value, progress)
                      : average<float, std::uint64_t>(cells, volumes, values, scalar, by_value, progress);
    return narrow ? average<double, std::uint32_t>(cells, volumes, values, scalar, by_value, progress)
                  : average<double, std::uint64_t>(cells, volumes, values, scalar, by_value, progress);
}

} // namespace isotet::core
