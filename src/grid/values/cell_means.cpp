// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/values/cell_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "grid/values/average_to_points.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_per_task = 1 << 12, most_parts = 4; // each part looks at all cells

/// Cells without a volume count, all alike, where no other is.
void add_to_mean(RunningMean& mean, double value, double volume) {
    if (volume > 0) {
        if (mean.weights < 0) mean = {};
        return mean.add(value, volume);
    }
    if (mean.weights > 0) return;
    RunningMean alike{mean.mean, -mean.weights};
    alike.add(value, 1);
    mean = {alike.mean, -alike.weights};
}

template <class Value>
Array values_of(const Buffer<RunningMean>& means) {
    Buffer<Value> values(means.size());
    parallel_each(means.size(), cells_per_task, [&](std::size_t i) {
        const bool any = means[i].weights != 0;
        values[i] = any ? static_cast<Value>(means[i].mean) : std::numeric_limits<Value>::quiet_NaN();
    });
    return std::move(values).to_array();
}

} // namespace

CellMeans::CellMeans(const Array& points)
    : points_(points), sound_(all_points_are_sound({points, {}, {}, {}})), means_(points.tuples()) {
    std::ranges::fill(means_, RunningMean{});
}

void CellMeans::add(const CellReader& cells, const Array& values, Scalar scalar, std::size_t first) {
    if (volumes_.size() < cells.count()) volumes_ = Buffer<double>(cells.count());
    parallel_each(cells.count(), cells_per_task,
                  [&](std::size_t cell) { volumes_[cell] = six_volumes_of(cells, points_, cell); });
    const auto add_to = [&](std::uint64_t lowest, std::uint64_t count) { // points from the lowest on
        for (std::size_t cell = 0; cell < cells.count(); ++cell) {
            const double value = scalar_at(values, scalar, first + cell);
            if (volumes_[cell] < 0 || std::isnan(value)) continue;
            const std::uint64_t begin = cells.first(cell), end = begin + cells.corners(cell);
            for (std::uint64_t i = begin; i < end; ++i) {
                const std::uint64_t point = cells.corner(i);
                if (point - lowest >= count) continue;
                bool is_new = true; // a collapsed cell has a point twice, but weighs once
                for (std::uint64_t j = begin; j < i; ++j) is_new &= cells.corner(j) != point;
                if (is_new) add_to_mean(means_[point], value, volumes_[cell]);
            }
        }
    };
    const std::size_t parts = std::min<std::size_t>(static_cast<std::size_t>(threads_here()), most_parts);
    const std::uint64_t of_part = means_.size() / parts + 1;
    parallel_each(parts, 1, [&](std::size_t part) { add_to(part * of_part, of_part); });
}

std::optional<Scalar> CellMeans::scalar_called(std::string_view text) { return parse_scalar(text); }

Array CellMeans::finish(ScalarType type) && {
    return type == ScalarType::float32 ? values_of<float>(means_) : values_of<double>(means_);
}

} // namespace isotet::core
