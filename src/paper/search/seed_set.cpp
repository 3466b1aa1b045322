// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/search/seed_set.hpp"

#include <vector>

namespace isotet::search {

namespace {

class TetBits {
public:
    explicit TetBits(std::size_t tets) : words_((tets + 63) / 64, 0) {}

    bool operator[](std::uint32_t tet) const { return words_[tet / 64] >> tet % 64 & 1; }
    void set(std::uint32_t tet) { words_[tet / 64] |= std::uint64_t{1} << tet % 64; }

private:
    std::vector<std::uint64_t> words_;
};

class SeedChoice {
public:
    SeedChoice(const core::TetTable& table, const FaceNeighbours& neighbours)
        : table_(table), neighbours_(neighbours), taken_in_(table.tets.size()) {}

    TetNumbers choose() {
        TetNumbers seeds;
        for (std::uint32_t tet = 0; tet < table_.tets.size(); ++tet) {
            if (taken_in_[tet] || table_.range(tet).is_empty()) continue;
            seeds.push_back(tet);
            take_in(tet);
            while (!open_.empty()) {
                const std::uint32_t last = open_.back();
                open_.pop_back();
                for (const std::uint32_t neighbour : neighbours_.of(last))
                    if (neighbour != FaceNeighbours::none && !taken_in_[neighbour] && is_led_back(neighbour))
                        take_in(neighbour);
            }
        }
        return seeds;
    }

private:
    void take_in(std::uint32_t tet) {
        taken_in_.set(tet);
        open_.push_back(tet);
    }

    /// Whether every isovalue of a tet is one of some face behind which a tet has been taken in. The faces' isovalues
    /// leave no gap: two faces share two corners, and each has one of the two others at most besides.
    bool is_led_back(std::uint32_t tet) const {
        core::CutRange led_back;
        for (unsigned k = 0; k < 4; ++k) {
            const std::uint32_t neighbour = neighbours_.of(tet)[k];
            if (neighbour != FaceNeighbours::none && taken_in_[neighbour]) led_back.take_in(table_.face_range(tet, k));
        }
        return led_back.covers(table_.range(tet));
    }

    const core::TetTable& table_;
    const FaceNeighbours& neighbours_;
    TetBits taken_in_;
    std::vector<std::uint32_t> open_;
};

} // namespace

SeedSet::SeedSet(const core::TetTable& table) : table_(table), neighbours_(table) {
    const TetNumbers seeds = SeedChoice(table_, neighbours_).choose();
    seeds_ = seeds.size();
    tree_ = std::make_unique<IntervalTree>(table_, seeds);
}

void SeedSet::find(float isovalue, TetNumbers& found) const {
    tree_->find(isovalue, found);
    TetBits seen(table_.tets.size());
    for (const std::uint32_t seed : found) seen.set(seed);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::uint32_t tet = found[i];
        for (unsigned k = 0; k < 4; ++k) {
            const std::uint32_t neighbour = neighbours_.of(tet)[k];
            if (neighbour == FaceNeighbours::none || seen[neighbour] || !table_.face_range(tet, k).holds(isovalue))
                continue;
            seen.set(neighbour);
            found.push_back(neighbour);
        }
    }
}

} // namespace isotet::search
