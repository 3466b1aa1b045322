// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/fill_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <isotet/fields.hpp>

namespace isotet::core {

namespace {

constexpr double least_large = 1e20;
constexpr std::size_t max_distinct = 4;

bool is_empty(const ValueRange& range) noexcept { return !(range.lower <= range.upper); }

bool stands_for_none(double value) noexcept {
    if (std::abs(value) < 999) return false;
    static constexpr std::array<double, 16> numbers{
        -999.25,       -999.0,        -9999.0, -99999.0, -999999.0, -9999999.0, -99999999.0, -32768.0,
        -2147483648.0, -2147483647.0, 9999.0,  99999.0,  999999.0,  9999999.0,  99999999.0,  2147483647.0};
    return std::abs(value) >= least_large || std::ranges::find(numbers, value) != numbers.end();
}

void widen(ValueRange& range, double value) noexcept {
    if (is_empty(range)) range = {value, value};
    else range = {std::min(range.lower, value), std::max(range.upper, value)};
}

/// Halves: the difference of two doubles may overflow.
bool is_far(double value, const ValueRange& others) noexcept {
    if (!(others.lower < others.upper)) return false;
    const double gap = value < others.lower ? others.lower / 2 - value / 2 : value / 2 - others.upper / 2;
    const double times = std::abs(value) >= least_large ? 1e6 : 1;
    return gap > times * (others.upper / 2 - others.lower / 2);
}

} // namespace

/// More than there may be are not counted.
template <class Numbers>
void FillFinder::add_each(const Numbers& numbers) {
    for (const auto number : numbers) {
        const auto value = static_cast<double>(number);
        if (!std::isfinite(value)) continue;
        if (!stands_for_none(value)) widen(others_, value);
        else if (counts_.size() <= max_distinct) ++counts_[value];
    }
}

void FillFinder::add(const Array& values, const ValueRange& range) {
    if (values.components() != 1) return;
    values_ += values.tuples();
    if (is_empty(range)) return;
    for (const double end : {range.lower, range.upper}) widen(range_, end);
    if (stands_for_none(range.lower) || stands_for_none(range.upper))
        return values.visit([&](auto numbers) { add_each(numbers); });
    for (const double end : {range.lower, range.upper}) widen(others_, end);
}

void FillFinder::add(std::span<const double> finite) {
    values_ += finite.size();
    for (const double value : finite) widen(range_, value);
    add_each(finite);
}

Result<void> FillFinder::add(const Array& values, const Run& run) {
    const auto statistics = statistics_of(values, run);
    if (!statistics) return statistics.error();
    if (statistics->size() == 1) add(values, {statistics->front().lower, statistics->front().upper});
    return {};
}

FillValues FillFinder::find() const {
    FillValues found{{}, range_, values_};
    if (counts_.empty() || counts_.size() > max_distinct) return found;
    std::map<double, std::uint64_t> far = counts_;
    ValueRange others = others_;
    const auto is_near = [&](const auto& number) { return !is_far(number.first, others); };
    for (;;) {
        const auto near = std::ranges::find_if(far, is_near);
        if (near == far.end()) break;
        widen(others, near->first); // it is a value
        far.erase(near);
    }
    if (far.empty()) return found;
    found.others = others;
    for (const auto& [value, count] : far) found.numbers.push_back({value, count});
    return found;
}

Result<FillValues> find_fill_values(const Array& values, const Run& run) {
    FillFinder finder;
    if (auto added = finder.add(values, run); !added) return added.error();
    return finder.find();
}

Result<FillValues> find_fill_values(const PointField& field, const Run& run) {
    if (!field.cell_fill.numbers.empty()) return field.cell_fill;
    return find_fill_values(field.values, run);
}

FillValues fill_values_of(std::span<const double> finite) {
    FillFinder finder;
    finder.add(finite);
    return finder.find();
}

ValueRange typical_range_of(const PointField& field) {
    ValueRange range = typical_range(field.values);
    if (field.cell_fill.numbers.empty() || is_empty(range)) return range;
    const ValueRange& cells = field.cell_fill.others;
    range = {std::max(range.lower, cells.lower), std::min(range.upper, cells.upper)};
    return range.lower < range.upper ? range : cells;
}

} // namespace isotet::core
