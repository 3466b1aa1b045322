// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Seeds and propagation: Bajaj, Pascucci and Schikore (1996), van Kreveld and others (1997).
#pragma once

#include <memory>

#include "base/buffer.hpp"
#include "packed/tet_table.hpp"
#include "paper/search/face_neighbours.hpp"
#include "paper/search/interval_tree.hpp"
#include "paper/search/search.hpp"

namespace isotet::search {

/// Finds exactly the active tets: those among the seeds by an interval tree, the others from them, across cut faces.
///
/// Tets are taken in one after another. One is no seed when the faces that it shares with tets taken in before hold all
/// its isovalues: whatever the isovalue, a cut face then leads to an earlier active tet, from there to a still earlier
/// one, and at last to a seed. Nothing is assumed of the field. Of its faces two always hold all isovalues of a tet,
/// and any two faces together do. So a tet is taken in as soon as that makes it no seed; only when none is left, the
/// next one is a seed.
///
/// Cost   O(n) to build, after the neighbours; O(log n + 4 found) to ask, and a bit a tet; 16 bytes a tet and 16 a seed
class SeedSet final : public Search {
public:
    explicit SeedSet(const core::TetTable& table);

    std::size_t seeds() const { return seeds_; }
    std::uint64_t bytes() const override { return neighbours_.bytes() + tree_->bytes(); }
    void find(float isovalue, TetNumbers& found) const override;

private:
    const core::TetTable& table_;
    FaceNeighbours neighbours_;
    std::size_t seeds_ = 0;
    std::unique_ptr<IntervalTree> tree_;
};

} // namespace isotet::search
