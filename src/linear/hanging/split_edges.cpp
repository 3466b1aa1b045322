// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/split_edges.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include <tbb/parallel_sort.h>

#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

auto ends_of(const PointOnEdge& at) { return std::pair(at.low, at.high); }

} // namespace

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

void SplitEdges::add(std::vector<PointOnEdge> more) {
    struct Placed {
        PointOnEdge at;
        double part;
    };
    std::erase_if(more, [&](const PointOnEdge& at) { return !is_between(at); });
    all_.insert(all_.end(), more.begin(), more.end());
    tbb::parallel_sort(all_.begin(), all_.end(), [](const PointOnEdge& a, const PointOnEdge& b) {
        return std::tie(a.low, a.high, a.point) < std::tie(b.low, b.high, b.point);
    });
    const auto same = [](const PointOnEdge& a, const PointOnEdge& b) {
        return std::tie(a.low, a.high, a.point) == std::tie(b.low, b.high, b.point);
    };
    all_.erase(std::unique(all_.begin(), all_.end(), same), all_.end());
    if (!all_.empty()) is_low_.resize(all_.back().low + 1);
    for (const PointOnEdge& at : all_) is_low_[at.low] = 1;
    std::vector<Placed> placed;
    placed.reserve(all_.size());
    for (const PointOnEdge& at : all_) placed.push_back({at, part_of(at)});
    tbb::parallel_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.at.low, a.at.high, a.part, a.at.point) < std::tie(b.at.low, b.at.high, b.part, b.at.point);
    });
    for (std::size_t i = 0; i < placed.size(); ++i) all_[i] = placed[i].at;
}

void SplitEdges::append_between(std::uint64_t from, std::uint64_t to, std::vector<std::uint64_t>& out) const {
    const std::pair ends = std::minmax(from, to);
    if (ends.first >= is_low_.size() || is_low_[ends.first] == 0) return;
    const auto [begin, end] = std::ranges::equal_range(all_, std::pair(ends.first, ends.second), {}, ends_of);
    if (begin == end) return;
    std::uint64_t before = from;
    const auto append = [&](std::uint64_t point) {
        append_between(before, point, out);
        out.push_back(point);
        before = point;
    };
    if (from < to)
        for (auto at = begin; at != end; ++at) append(at->point);
    else
        for (auto at = end; at != begin;) append((--at)->point);
    append_between(before, to, out);
}

void SplitEdges::expand(std::span<const std::uint64_t> loop, std::vector<std::uint64_t>& out) const {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        out.push_back(loop[i]);
        append_between(loop[i], loop[(i + 1) % loop.size()], out);
    }
}

} // namespace isotet::linear
