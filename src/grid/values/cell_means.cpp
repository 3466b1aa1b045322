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

constexpr std::size_t cells_per_task = 1 << 12;

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
    const auto each_share = [&](std::size_t begin, std::size_t end, const auto& visit) { // of cells
        for (std::size_t cell = begin; cell < end; ++cell) {
            const double value = scalar_at(values, scalar, first + cell);
            if (std::isnan(value)) continue; // its points may be missing
            const double volume = six_volumes_of(cells, points_, cell);
            if (volume < 0) continue;
            const std::uint64_t from = cells.first(cell), to = from + cells.corners(cell);
            for (std::uint64_t i = from; i < to; ++i) {
                const std::uint64_t point = cells.corner(i);
                bool is_new = true; // a collapsed cell has a point twice, but weighs once
                for (std::uint64_t j = from; j < i; ++j) is_new &= cells.corner(j) != point;
                if (is_new) visit(Share{point, value, volume});
            }
        }
    };
    const auto add_share = [&](const Share& share) { add_to_mean(means_[share.point], share.value, share.volume); };
    const auto parts = static_cast<std::size_t>(threads_here());
    if (parts == 1) return each_share(0, cells.count(), add_share);
    const std::uint64_t of_part = means_.size() / parts + 1;
    const std::size_t tasks = (cells.count() + cells_per_task - 1) / cells_per_task;
    shares_.resize(std::max(shares_.size(), tasks * parts));
    parallel_each(tasks, 1, [&](std::size_t task) {
        std::vector<Share>* const by_part = &shares_[task * parts];
        const std::size_t begin = task * cells_per_task;
        each_share(begin, std::min(begin + cells_per_task, cells.count()),
                   [&](const Share& share) { by_part[share.point / of_part].push_back(share); });
    });
    parallel_each(parts, 1, [&](std::size_t part) {
        for (std::size_t task = 0; task < tasks; ++task) {
            std::vector<Share>& shares = shares_[task * parts + part];
            std::ranges::for_each(shares, add_share);
            shares.clear();
        }
    });
}

std::optional<Scalar> CellMeans::scalar_called(std::string_view text) { return parse_scalar(text); }

Array CellMeans::scalar_of_cells(const Array& values, Scalar scalar) { return scalar_of(values, scalar); }

Array CellMeans::finish(ScalarType type) && {
    return type == ScalarType::float32 ? values_of<float>(means_) : values_of<double>(means_);
}

} // namespace isotet::core
