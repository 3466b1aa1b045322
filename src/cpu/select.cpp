// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/core.h>

#include "core/parallel.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

namespace {

constexpr std::size_t clusters_per_task = 1 << 12;

/// What some clusters add to a selection.
struct Sums {
    std::uint64_t places = 0, words = 0, tets = 0;
};

/// Calls f(cluster, first, end) for each cluster of a task whose range holds the isovalues [first, end) and no others.
template <class Real, class F>
void for_selected(const Packed& packed, std::span<const core::StoredIsovalue<Real>> isovalues, std::size_t task,
                  F&& f) {
    const auto& ranges = packed.as<Real>().ranges;
    constexpr auto value = &core::StoredIsovalue<Real>::value;
    const Real lowest = isovalues.front().value, highest = isovalues.back().value;
    for (std::size_t c = task * clusters_per_task; c < std::min(packed.clusters(), (task + 1) * clusters_per_task);
         ++c) {
        const core::Range<Real> range = ranges[c];
        if (!(range.lower <= highest && lowest <= range.upper)) continue;
        const auto first = std::ranges::lower_bound(isovalues, range.lower, {}, value);
        const auto end = std::ranges::upper_bound(first, isovalues.end(), range.upper, {}, value);
        if (first != end)
            f(c, static_cast<std::size_t>(first - isovalues.begin()),
              static_cast<std::size_t>(end - isovalues.begin()));
    }
}

} // namespace

template <class Real>
Result<Selection> select(const Packed& packed, std::span<const core::StoredIsovalue<Real>> isovalues) {
    const auto words_of = [&](std::size_t c) {
        return Masks::tied_words + core::words_of_bits(packed.headers[c].own_seams);
    };
    const std::size_t tasks = (packed.clusters() + clusters_per_task - 1) / clusters_per_task;
    std::vector<Sums> before(tasks + 1);
    core::parallel_each(tasks, 1, [&](std::size_t task) {
        Sums sums;
        for_selected(packed, isovalues, task, [&](std::size_t c, std::size_t first, std::size_t end) {
            sums.places += end - first;
            sums.words += (end - first) * words_of(c);
            sums.tets += (end - first) * packed.headers[c].like_tets();
        });
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
    core::parallel_each(tasks, 1, [&](std::size_t task) {
        Sums next = before[task];
        for_selected(packed, isovalues, task, [&](std::size_t c, std::size_t first, std::size_t end) {
            selection.base[c] = static_cast<std::uint32_t>(next.places - first);
            const std::uint64_t words = words_of(c);
            for (std::size_t k = first; k < end; ++k, ++next.places, next.words += words) {
                selection.clusters[next.places] = static_cast<std::uint32_t>(c);
                selection.isovalues[next.places] = static_cast<std::uint32_t>(k);
                selection.first_word[next.places] = next.words;
            }
        });
    });
    return selection;
}

template Result<Selection> select<float>(const Packed&, std::span<const core::StoredIsovalue<float>>);
template Result<Selection> select<double>(const Packed&, std::span<const core::StoredIsovalue<double>>);

Masks::Masks(const Selection& selection) : selection_(&selection), words_(selection.first_word[selection.size()]) {
    core::parallel_ranges(words_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        std::fill(words_.begin() + begin, words_.begin() + end, 0);
    });
}

} // namespace isotet::cpu
