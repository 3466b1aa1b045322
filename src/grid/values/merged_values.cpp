// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/values/merged_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/buffer.hpp"

namespace isotet::core {

namespace {

/// The points that stand for others have rows 0, 1, ...; all others none.
struct MergedRows {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> of_point;
    std::size_t count = 0;

    explicit MergedRows(const std::vector<std::uint64_t>& lowest) : of_point(lowest.size(), none) {
        for (std::uint64_t point = 0; point < lowest.size(); ++point) {
            std::uint32_t& row = of_point[lowest[point]];
            if (lowest[point] != point && row == none) row = static_cast<std::uint32_t>(count++);
        }
        for (std::uint64_t point = 0; point < lowest.size(); ++point) of_point[point] = of_point[lowest[point]];
    }
};

struct MergedRange {
    double lower = std::numeric_limits<double>::infinity(), upper = -std::numeric_limits<double>::infinity();
};

/// The mean of values as the first of them and the sum of what the others differ from it.
struct MergedMean {
    double first = std::numeric_limits<double>::quiet_NaN(), more = 0;
    std::uint64_t count = 0;

    void add(double value) {
        if (std::isnan(value)) return;
        if (count++ == 0) first = value;
        else more += value - first;
    }
    double mean() const { return count > 1 ? first + more / static_cast<double>(count) : first; }
};

} // namespace

double largest_jump(const Array& values, const std::vector<std::uint64_t>& lowest) {
    const MergedRows rows(lowest);
    double largest = 0;
    values.visit([&](auto all) {
        for (std::size_t c = 0; c < values.components(); ++c) {
            std::vector<MergedRange> ranges(rows.count);
            for (std::size_t point = 0; point < lowest.size(); ++point) {
                if (rows.of_point[point] == MergedRows::none) continue;
                MergedRange& range = ranges[rows.of_point[point]];
                const auto value = static_cast<double>(all[point * values.components() + c]);
                range.lower = std::min(range.lower, value); // a NaN changes neither
                range.upper = std::max(range.upper, value);
            }
            for (const MergedRange& range : ranges) largest = std::max(largest, range.upper - range.lower);
        }
    });
    return largest;
}

Array with_means(const Array& values, const std::vector<std::uint64_t>& lowest) {
    const MergedRows rows(lowest);
    const std::size_t components = values.components();
    return values.visit([&]<class From>(std::span<const From> all) -> Array {
        using To = std::conditional_t<std::is_same_v<From, float>, float, double>;
        Buffer<To> out(all.size());
        std::ranges::transform(all, out.begin(), [](From value) { return static_cast<To>(value); });
        for (std::size_t c = 0; c < components; ++c) {
            std::vector<MergedMean> means(rows.count);
            for (std::size_t point = 0; point < lowest.size(); ++point)
                if (rows.of_point[point] != MergedRows::none)
                    means[rows.of_point[point]].add(static_cast<double>(all[point * components + c]));
            for (std::size_t point = 0; point < lowest.size(); ++point)
                if (rows.of_point[point] != MergedRows::none)
                    out[point * components + c] = static_cast<To>(means[rows.of_point[point]].mean());
        }
        return std::move(out).to_array(components);
    });
}

} // namespace isotet::core
