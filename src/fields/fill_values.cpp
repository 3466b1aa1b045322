// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/fill_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace isotet::core {

namespace {

constexpr double least_large = 1e20;
constexpr std::size_t max_distinct = 4;

bool stands_for_none(double value) noexcept {
    static constexpr std::array<double, 16> numbers{
        -999.25,       -999.0,        -9999.0, -99999.0, -999999.0, -9999999.0, -99999999.0, -32768.0,
        -2147483648.0, -2147483647.0, 9999.0,  99999.0,  999999.0,  9999999.0,  99999999.0,  2147483647.0};
    return std::abs(value) >= least_large || std::ranges::find(numbers, value) != numbers.end();
}

void widen(ValueRange& range, double value) noexcept {
    if (!(range.lower <= range.upper)) range = {value, value};
    else range = {std::min(range.lower, value), std::max(range.upper, value)};
}

/// Halves: the difference of two doubles may overflow.
bool is_far(double value, const ValueRange& others) noexcept {
    if (!(others.lower < others.upper)) return false;
    const double gap = value < others.lower ? others.lower / 2 - value / 2 : value / 2 - others.upper / 2;
    const double times = std::abs(value) >= least_large ? 1e6 : 1;
    return gap > times * (others.upper / 2 - others.lower / 2);
}

/// Which of some numbers are fill values; how many there are of each is known.
/// `others`   the range of all other numbers
FillValues choose_fill_values(std::map<double, std::uint64_t> numbers, ValueRange others) {
    const auto is_near = [&](const auto& number) { return !is_far(number.first, others); };
    for (;;) {
        const auto near = std::ranges::find_if(numbers, is_near);
        if (near == numbers.end()) break;
        widen(others, near->first); // it is a value
        numbers.erase(near);
    }
    FillValues found{{}, others};
    for (const auto& [value, count] : numbers) found.values.push_back({value, count});
    return found;
}

/// `numbers`   of any type
template <class Numbers>
FillValues find_among(const Numbers& numbers, const ValueRange& range) {
    if (!stands_for_none(range.lower) && !stands_for_none(range.upper)) return {{}, range};
    std::map<double, std::uint64_t> counts;
    ValueRange others;
    for (const auto number : numbers) {
        const auto value = static_cast<double>(number);
        if (!std::isfinite(value)) continue;
        if (!stands_for_none(value)) widen(others, value);
        else ++counts[value];
        if (counts.size() > max_distinct) return {{}, range};
    }
    FillValues found = choose_fill_values(counts, others);
    if (found.values.empty()) found.others = range;
    return found;
}

} // namespace

FillValues fill_values_of(const Array& values, const ValueRange& range) {
    if (values.components() != 1) return {{}, range};
    return values.visit([&](auto numbers) { return find_among(numbers, range); });
}

Result<FillValues> find_fill_values(const Array& values, const Run& run) {
    const auto statistics = statistics_of(values, run);
    if (!statistics) return statistics.error();
    if (statistics->size() != 1) return FillValues{};
    return fill_values_of(values, {statistics->front().lower, statistics->front().upper});
}

FillValues fill_values_of(std::span<const double> ascending) {
    if (ascending.empty()) return {};
    return find_among(ascending, {ascending.front(), ascending.back()});
}

} // namespace isotet::core
