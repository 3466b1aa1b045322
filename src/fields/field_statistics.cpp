// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/fields.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/carry_out.hpp"
#include "base/parallel.hpp"
#include "fields/fill_values.hpp"
#include "fields/sampled_values.hpp"

namespace isotet {

namespace {

constexpr std::size_t statistics_grain = std::size_t{1} << 16;

void add_value(ComponentStatistics& total, double value) {
    if (std::isnan(value)) ++total.not_a_number;
    else if (std::isinf(value)) ++total.infinite;
    else {
        total.lower = std::min(total.lower, value);
        total.upper = std::max(total.upper, value);
    }
}

void add_part(ComponentStatistics& total, const ComponentStatistics& part) {
    total.lower = std::min(total.lower, part.lower);
    total.upper = std::max(total.upper, part.upper);
    total.not_a_number += part.not_a_number;
    total.infinite += part.infinite;
}

} // namespace

Result<std::vector<ComponentStatistics>> statistics_of(const Array& values, const Run& run) {
    using Statistics = std::vector<ComponentStatistics>;
    return core::carry_out("describing a field", run, [&](const Progress& progress) -> Result<Statistics> {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const std::size_t components = values.components();
        const ComponentStatistics nothing{infinity, -infinity, 0, 0};
        Statistics totals(components, nothing);
        std::mutex mutex;
        values.visit([&](auto scalars) {
            const std::size_t grain = std::max<std::size_t>(statistics_grain / std::max<std::size_t>(components, 1), 1);
            core::parallel_pieces(values.tuples(), grain, progress, [&](std::size_t begin, std::size_t end) {
                Statistics parts(components, nothing);
                for (std::size_t tuple = begin; tuple < end; ++tuple)
                    for (std::size_t c = 0; c < components; ++c)
                        add_value(parts[c], static_cast<double>(scalars[tuple * components + c]));
                const std::lock_guard lock(mutex);
                for (std::size_t c = 0; c < components; ++c) add_part(totals[c], parts[c]);
            });
        });
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "describing a field was cancelled"};
        return totals;
    });
}

ValueRange typical_range(const Array& array) {
    constexpr std::size_t rare = 50;
    std::vector<double> values = core::sample_values(array).values;
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    if (array.components() == 1)
        for (const FillValues::Number& fill : core::fill_values_of(values).numbers) std::erase(values, fill.value);
    const ValueRange range{values[values.size() / rare], values[values.size() - 1 - values.size() / rare]};
    return range.lower < range.upper ? range : ValueRange{values.front(), values.back()};
}

} // namespace isotet
