// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Places whose clusters are in memory together: all of them, unless the grid lies in a file that is larger than what may be
// kept of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "cpu/steps.hpp"
#include "packed/residency.hpp"

namespace isotet::cpu {

class Batches {
public:
    /// `grids`   the packed grid, and those of fields that are carried
    Batches(std::vector<const Packed*> grids, Selection& selection, const Progress& progress)
        : grids_(std::move(grids)), selection_(selection), progress_(progress) {
        std::erase_if(grids_, [](const Packed* grid) { return !grid->residency; });
    }

    /// Calls work(first, last) for batches of places, one after another. Places of one cluster are never parted.
    template <class Work>
    Result<void> run(const Work& work) {
        const std::span<const std::uint32_t> clusters(selection_.clusters.data(), selection_.size());
        for (std::size_t first = 0; first < clusters.size();) {
            if (first < brought_first_ || first >= brought_last_)
                if (auto ok = bring(clusters, first); !ok) return ok;
            const std::size_t last = brought_last_;
            selection_.ahead_end = last;
            work(first, last);
            first = last;
        }
        return {};
    }

private:
    /// What was brought for the last batch stays until another is wanted: mostly there is one.
    Result<void> bring(std::span<const std::uint32_t> clusters, std::size_t first) {
        brought_.clear();
        std::span<const std::uint32_t> some = clusters.subspan(first);
        for (const Packed* grid : grids_) { // the first one tells how many
            const auto amount = brought_.empty() ? core::Residency::Amount::fitting : core::Residency::Amount::all;
            Result<core::Brought> brought = grid->residency->bring(some, core::Parts::all, amount, progress_);
            if (!brought) return brought.error();
            some = some.first(brought->count);
            brought_.push_back(*std::move(brought));
        }
        brought_first_ = first;
        brought_last_ = first + some.size();
        return {};
    }

    std::vector<const Packed*> grids_;
    Selection& selection_;
    const Progress& progress_;
    std::vector<core::Brought> brought_;
    std::size_t brought_first_ = 0, brought_last_ = 0;
};

} // namespace isotet::cpu
