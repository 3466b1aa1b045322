// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <fmt/core.h>

#include "base/workers.hpp"
#include "base/prefetch.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

namespace {

constexpr std::size_t clusters_per_task = 1 << 12;

/// A cluster whose range holds the isovalues [first, end).
struct Hit {
    std::uint32_t cluster, first, end, words; ///< words of each place's masks
};

/// What some clusters add to a selection.
struct Sums {
    std::uint64_t places = 0, words = 0, tets = 0;
};

/// The clusters of a task that are hit, added up in `sums`.
template <class Real>
std::vector<Hit> find_hits(const Packed& packed, std::span<const core::StoredIsovalue<Real>> isovalues,
                           std::size_t task, Sums& sums) {
    const auto& ranges = packed.as<Real>().ranges;
    constexpr auto value = &core::StoredIsovalue<Real>::value;
    const Real lowest = isovalues.front().value, highest = isovalues.back().value;
    // Which clusters are hit is as good as random: they are listed first, without a branch.
    std::array<std::uint32_t, clusters_per_task + 1> near;
    std::size_t count = 0;
    const std::size_t begin = task * clusters_per_task, end = std::min(packed.clusters(), begin + clusters_per_task);
    for (std::size_t c = begin; c < end; ++c) {
        near[count] = static_cast<std::uint32_t>(c);
        count += unsigned{ranges[c].lower <= highest} & unsigned{lowest <= ranges[c].upper};
    }
    constexpr std::size_t ahead = 16;
    std::vector<Hit> hits;
    hits.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (i + ahead < count) core::prefetch(&packed.headers[near[i + ahead]]);
        const core::Range<Real> range = ranges[near[i]];
        const auto first = std::ranges::lower_bound(isovalues, range.lower, {}, value);
        const auto last = std::ranges::upper_bound(first, isovalues.end(), range.upper, {}, value);
        if (first == last) continue;
        const core::ClusterHeader& h = packed.headers[near[i]];
        const Hit hit{near[i], static_cast<std::uint32_t>(first - isovalues.begin()),
                      static_cast<std::uint32_t>(last - isovalues.begin()),
                      static_cast<std::uint32_t>(Masks::tied_words + core::words_of_bits(h.own_seams))};
        const std::uint64_t places = hit.end - hit.first;
        sums.places += places;
        sums.words += places * hit.words;
        sums.tets += places * h.like_tets();
        hits.push_back(hit);
    }
    return hits;
}

} // namespace

template <class Real>
Result<Selection> select(const Packed& packed, std::span<const core::StoredIsovalue<Real>> isovalues) {
    const std::size_t tasks = (packed.clusters() + clusters_per_task - 1) / clusters_per_task;
    std::vector<Sums> before(tasks + 1);
    std::vector<std::vector<Hit>> hits(tasks);
    core::worker_each(tasks, 1, [&](std::size_t task) {
        Sums sums; // not in place: those of other tasks stand in the same line of the cache
        hits[task] = find_hits(packed, isovalues, task, sums);
        before[task + 1] = sums;
    });
    for (std::size_t task = 0; task < tasks; ++task) {
        before[task + 1].places += before[task].places;
        before[task + 1].words += before[task].words;
        before[task + 1].tets += before[task].tets;
    }
    const Sums all = before[tasks];
    if (all.places > std::numeric_limits<std::uint32_t>::max())
        return Error{
            ErrorCode::invalid_argument,
            fmt::format("{} isovalues lie in the ranges of {} clusters altogether, but in one pass there must be less "
                        "than 2^32: ask for fewer at a time",
                        isovalues.size(), all.places)};

    Selection selection;
    selection.clusters = core::Buffer<std::uint32_t>(all.places);
    selection.isovalues = core::Buffer<std::uint32_t>(all.places);
    selection.first_word = core::Buffer<std::uint64_t>(all.places + 1);
    selection.base = core::Buffer<std::uint32_t>(packed.clusters());
    selection.first_word[all.places] = all.words;
    selection.tets = all.tets;
    selection.ahead_end = all.places;
    core::worker_each(tasks, 1, [&](std::size_t task) {
        Sums next = before[task];
        for (const Hit& hit : hits[task]) {
            selection.base[hit.cluster] = static_cast<std::uint32_t>(next.places - hit.first);
            for (std::uint32_t k = hit.first; k < hit.end; ++k, ++next.places, next.words += hit.words) {
                selection.clusters[next.places] = hit.cluster;
                selection.isovalues[next.places] = k;
                selection.first_word[next.places] = next.words;
            }
        }
    });
    return selection;
}

template Result<Selection> select<float>(const Packed&, std::span<const core::StoredIsovalue<float>>);
template Result<Selection> select<double>(const Packed&, std::span<const core::StoredIsovalue<double>>);

Masks::Masks(const Selection& selection) : selection_(&selection), words_(selection.first_word[selection.size()]) {
    core::worker_ranges(words_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        std::fill(words_.begin() + begin, words_.begin() + end, 0);
    });
}

} // namespace isotet::cpu
