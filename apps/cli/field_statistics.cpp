// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "field_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/parallel.hpp"

namespace isotet::cli {

namespace {

constexpr std::size_t values_per_piece = std::size_t{1} << 16;
constexpr double infinity = std::numeric_limits<double>::infinity();

void add(ComponentStatistics& total, const ComponentStatistics& part) {
    total.lower = std::min(total.lower, part.lower);
    total.upper = std::max(total.upper, part.upper);
    total.not_a_number += part.not_a_number;
    total.infinite += part.infinite;
}

void add(ComponentStatistics& total, double value) {
    if (std::isnan(value)) ++total.not_a_number;
    else if (std::isinf(value)) ++total.infinite;
    else {
        total.lower = std::min(total.lower, value);
        total.upper = std::max(total.upper, value);
    }
}

std::vector<ComponentStatistics> statistics(const Array& values, const Progress& progress) {
    const std::size_t components = values.components();
    const ComponentStatistics nothing{infinity, -infinity, 0, 0};
    std::vector<ComponentStatistics> totals(components, nothing);
    std::mutex mutex;
    values.visit([&](auto scalars) {
        const std::size_t grain = std::max<std::size_t>(values_per_piece / std::max<std::size_t>(components, 1), 1);
        core::parallel_pieces(values.tuples(), grain, progress, [&](std::size_t begin, std::size_t end) {
            std::vector<ComponentStatistics> parts(components, nothing);
            for (std::size_t tuple = begin; tuple < end; ++tuple) {
                for (std::size_t c = 0; c < components; ++c)
                    add(parts[c], static_cast<double>(scalars[tuple * components + c]));
            }
            const std::lock_guard lock(mutex);
            for (std::size_t c = 0; c < components; ++c) add(totals[c], parts[c]);
        });
    });
    return totals;
}

} // namespace

std::vector<std::vector<ComponentStatistics>> statistics(const std::vector<Array>& arrays, const Progress& progress) {
    std::vector<std::vector<ComponentStatistics>> all(arrays.size());
    core::parallel_each(arrays.size(), 1, [&](std::size_t i) { all[i] = statistics(arrays[i], progress); });
    return all;
}

} // namespace isotet::cli
