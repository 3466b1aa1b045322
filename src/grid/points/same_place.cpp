// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/points/same_place.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include <tbb/parallel_sort.h>

#include "base/parallel.hpp"
#include "grid/orientation.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::core {

namespace {

struct Entry {
    std::uint64_t hash, point;
    auto operator<=>(const Entry&) const = default;
};

bool is_comparable(const Point& p) { return p[0] == p[0] && p[1] == p[1] && p[2] == p[2]; }

/// Gives each point of a group, ascending, the first one at the same place.
void lead_by_first(std::span<const Entry> group, const PointReader& points, std::vector<std::uint64_t>& lowest) {
    std::uint64_t leader = group[0].point;
    for (const Entry& entry : group) {
        if (points[entry.point] != points[leader]) leader = entry.point;
        lowest[entry.point] = leader;
    }
}

/// Points of one hash, ascending: nearly always all at one place. The group is not sorted where it lies, because other
/// threads look at its hashes.
void settle(std::span<const Entry> group, const PointReader& points, std::vector<std::uint64_t>& lowest) {
    const Point first = points[group[0].point];
    if (std::ranges::all_of(group, [&](const Entry& entry) { return points[entry.point] == first; }))
        return lead_by_first(group, points, lowest);
    std::vector<Entry> sorted(group.begin(), group.end());
    std::ranges::sort(sorted, [&](const Entry& a, const Entry& b) {
        const Point p = points[a.point], q = points[b.point];
        return p != q ? p < q : a.point < b.point;
    });
    lead_by_first(sorted, points, lowest);
}

} // namespace

std::vector<std::uint64_t> lowest_at_same_place(const Array& points, const std::uint8_t* wanted) {
    constexpr std::size_t grain = 1 << 14;
    const PointReader reader(points);
    std::vector<std::uint64_t> lowest(points.tuples());
    std::vector<Entry> entries(points.tuples());
    parallel_each(entries.size(), grain, [&](std::size_t point) {
        lowest[point] = point;
        entries[point] = {hash_of(reader[point]), point};
    });
    const auto is_left_out = [&](const Entry& entry) {
        return (wanted && !wanted[entry.point]) || !is_comparable(reader[entry.point]);
    };
    std::erase_if(entries, is_left_out);
    tbb::parallel_sort(entries.begin(), entries.end());
    parallel_each(entries.size(), grain, [&](std::size_t i) {
        if (i > 0 && entries[i - 1].hash == entries[i].hash) return;
        std::size_t end = i + 1;
        while (end < entries.size() && entries[end].hash == entries[i].hash) ++end;
        if (end > i + 1) settle(std::span<const Entry>(entries).subspan(i, end - i), reader, lowest);
    });
    return lowest;
}

} // namespace isotet::core
