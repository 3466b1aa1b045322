// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "core/parallel.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

namespace {
constexpr std::size_t clusters_a_task = 1 << 13;
}

template <class Real>
Selection select(const Packed& packed, Real isovalue) {
    const auto& ranges = packed.as<Real>().ranges;
    const std::size_t clusters = packed.clusters();
    const std::size_t tasks = (clusters + clusters_a_task - 1) / clusters_a_task;
    std::vector<std::size_t> first(tasks + 1, 0);
    const auto selected = [&](std::size_t c) { return ranges[c].lower <= isovalue && isovalue <= ranges[c].upper; };
    core::parallel_each(tasks, 1, [&](std::size_t task) {
        std::size_t n = 0;
        for (std::size_t c = task * clusters_a_task; c < std::min(clusters, (task + 1) * clusters_a_task); ++c) n += selected(c);
        first[task + 1] = n;
    });
    for (std::size_t task = 0; task < tasks; ++task) first[task + 1] += first[task];

    Selection selection;
    selection.clusters = core::Buffer<std::uint32_t>(first[tasks]);
    selection.place = core::Buffer<std::uint32_t>(clusters);
    core::parallel_each(tasks, 1, [&](std::size_t task) {
        std::size_t n = first[task];
        for (std::size_t c = task * clusters_a_task; c < std::min(clusters, (task + 1) * clusters_a_task); ++c) {
            if (!selected(c)) continue;
            selection.place[c] = static_cast<std::uint32_t>(n);
            selection.clusters[n++] = static_cast<std::uint32_t>(c);
        }
    });
    return selection;
}

template Selection select<float>(const Packed&, float);
template Selection select<double>(const Packed&, double);

Masks::Masks(const Packed& packed, const Selection& selection) : first_word_(selection.clusters.size() + 1) {
    std::uint64_t words = 0;
    for (std::size_t place = 0; place < selection.clusters.size(); ++place) {
        first_word_[place] = words;
        words += tied_words + core::words_of_bits(packed.headers[selection.clusters[place]].own_seams);
    }
    first_word_[selection.clusters.size()] = words;
    words_ = core::Buffer<std::uint64_t>(words);
    core::parallel_ranges(words, 1 << 15, [&](std::size_t begin, std::size_t end) { std::fill(words_.begin() + begin, words_.begin() + end, 0); });
}

} // namespace isotet::cpu
