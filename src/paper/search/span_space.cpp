// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/search/span_space.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include <tbb/parallel_invoke.h>

namespace isotet::search {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::size_t few = 16; ///< so many are looked at one by one

struct Item {
    core::CutRange range;
    std::uint32_t tet;
};

float key_of(const core::CutRange& range, bool by_upper) { return by_upper ? range.upper : range.lower; }

void arrange(std::span<Item> items, bool by_upper) {
    if (items.size() <= few) return;
    const std::size_t middle = items.size() / 2;
    std::nth_element(
        items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
        [&](const Item& a, const Item& b) { return key_of(a.range, by_upper) < key_of(b.range, by_upper); });
    const auto left = [&] { arrange(items.first(middle), !by_upper); };
    const auto right = [&] { arrange(items.subspan(middle + 1), !by_upper); };
    if (items.size() > 1 << 14) {
        tbb::parallel_invoke(left, right);
    } else {
        left();
        right();
    }
}

} // namespace

SpanSpace::SpanSpace(const core::TetTable& table) {
    core::Buffer<Item> items(table.tets.size());
    std::size_t count = 0;
    for (std::uint32_t tet = 0; tet < items.size(); ++tet)
        if (const core::CutRange range = table.range(tet); !range.is_empty()) items[count++] = {range, tet};
    arrange({items.data(), count}, false);
    ranges_ = core::Buffer<core::CutRange>(count);
    tets_ = core::Buffer<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
        ranges_[i] = items[i].range;
        tets_[i] = items[i].tet;
    }
}

void SpanSpace::take(float isovalue, const Stretch& stretch, TetNumbers& found) const {
    const auto [begin, end, by_upper, highest_lower, lowest_upper] = stretch;
    if (highest_lower < isovalue && isovalue <= lowest_upper) {
        found.insert(found.end(), tets_.begin() + begin, tets_.begin() + end);
        return;
    }
    if (end - begin <= few) {
        for (std::size_t i = begin; i < end; ++i)
            if (ranges_[i].holds(isovalue)) found.push_back(tets_[i]);
        return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const float key = key_of(ranges_[middle], by_upper);
    if (ranges_[middle].holds(isovalue)) found.push_back(tets_[middle]);
    Stretch left{begin, middle, !by_upper, highest_lower, lowest_upper};
    Stretch right{middle + 1, end, !by_upper, highest_lower, lowest_upper};
    if (by_upper) {
        right.lowest_upper = key;
        if (key >= isovalue) take(isovalue, left, found); // otherwise all upper ends there are too low
        take(isovalue, right, found);
    } else {
        left.highest_lower = key;
        take(isovalue, left, found);
        if (key < isovalue) take(isovalue, right, found); // otherwise all lower ends there are too high
    }
}

void SpanSpace::find(float isovalue, TetNumbers& found) const {
    found.clear();
    take(isovalue, {0, tets_.size(), false, infinity, -infinity}, found);
}

} // namespace isotet::search
