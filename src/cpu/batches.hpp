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
            do_batch(work, first, brought_last_);
            first = brought_last_;
        }
        return {};
    }

    /// The same for work that looks at the clusters of some places alone.
    /// `needs`   needs(place): at this one's
    template <class Work, class Needs>
    Result<void> run(const Work& work, const Needs& needs) {
        if (has_all()) return run(work);
        std::vector<std::size_t> places;
        std::vector<std::uint32_t> clusters;
        for (std::size_t place = 0; place < selection_.size(); ++place)
            if (needs(place)) {
                places.push_back(place);
                clusters.push_back(selection_.clusters[place]);
            }
        std::size_t done = 0;
        for (std::size_t first = 0; first < clusters.size(); first = brought_last_) {
            if (auto ok = bring(clusters, first); !ok) return ok;
            const std::size_t end = brought_last_ < places.size() ? places[brought_last_] : selection_.size();
            do_batch(work, done, end);
            done = end;
        }
        brought_first_ = brought_last_ = 0; // numbers of `places`
        if (done < selection_.size()) do_batch(work, done, selection_.size());
        return {};
    }

private:
    /// Nothing lies in a file, or all of it was brought.
    bool has_all() const { return grids_.empty() || (brought_first_ == 0 && brought_last_ == selection_.size()); }

    template <class Work>
    void do_batch(const Work& work, std::size_t first, std::size_t last) {
        selection_.ahead_end = last;
        work(first, last);
    }

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
