// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/split_edges.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>

#include <tbb/parallel_sort.h>

#include "linear/vector.hpp"

namespace isotet::linear {

double SplitEdges::part_of(const PointOnEdge& at) const {
    const Point along = minus(points_[at.high], points_[at.low]);
    return dot(minus(points_[at.point], points_[at.low]), along) / dot(along, along);
}

/// Parts of an edge are shorter than the edge, so that each has an end.
bool SplitEdges::is_between(const PointOnEdge& at) const {
    const Point low = points_[at.low], high = points_[at.high], point = points_[at.point];
    const double length = core::squared_distance(low, high);
    return core::squared_distance(low, point) < length && core::squared_distance(point, high) < length;
}

void SplitEdges::add(const std::vector<PointOnEdge>& more) {
    std::vector<Placed> added;
    added.reserve(more.size());
    for (const PointOnEdge& at : more)
        if (is_between(at)) added.push_back({at, part_of(at)});
    if (added.empty()) return;
    const auto comes_before = [](const Placed& a, const Placed& b) {
        return std::tie(a.at.low, a.at.high, a.part, a.at.point) < std::tie(b.at.low, b.at.high, b.part, b.at.point);
    };
    tbb::parallel_sort(added.begin(), added.end(), comes_before);
    std::vector<Placed> all;
    all.reserve(all_.size() + added.size());
    std::ranges::merge(all_, added, std::back_inserter(all), comes_before);
    const auto is_same = [](const Placed& a, const Placed& b) {
        return std::tie(a.at.low, a.at.high, a.at.point) == std::tie(b.at.low, b.at.high, b.at.point);
    };
    all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
    all_ = std::move(all);
    note_first();
}

void SplitEdges::note_first() {
    first_.assign(all_.back().at.low + 2, 0);
    std::size_t next = 0;
    for (std::size_t low = 0; low + 1 < first_.size(); ++low) {
        first_[low] = next;
        while (next < all_.size() && all_[next].at.low == low) ++next;
    }
    first_.back() = next;
}

std::span<const SplitEdges::Placed> SplitEdges::known(std::uint64_t from, std::uint64_t to) const {
    const std::uint64_t low = std::min(from, to), high = std::max(from, to);
    const auto at_low = std::span(all_).subspan(first_[low], first_[low + 1] - first_[low]);
    const auto some = std::ranges::equal_range(at_low, high, {}, [](const Placed& placed) { return placed.at.high; });
    return {some.begin(), some.end()};
}

void SplitEdges::append_known(std::uint64_t from, std::uint64_t to, std::vector<std::uint64_t>& out) const {
    const std::span<const Placed> some = known(from, to);
    if (some.empty()) return;
    std::uint64_t before = from;
    const auto append = [&](std::uint64_t point) {
        append_between(before, point, out);
        out.push_back(point);
        before = point;
    };
    if (from < to)
        for (const Placed& placed : some) append(placed.at.point);
    else
        for (std::size_t i = some.size(); i > 0; --i) append(some[i - 1].at.point);
    append_between(before, to, out);
}

} // namespace isotet::linear
