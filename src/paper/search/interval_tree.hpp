// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// McCreight's interval tree over the ranges of tets, as Cignoni, Marino, Montani, Puppo and Scopigno (1997) use it.
#pragma once

#include <memory>
#include <span>

#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "packed/tet_table.hpp"
#include "paper/search/search.hpp"

namespace isotet::search {

/// Finds exactly the active tets.
///
/// A node splits at a value. Ranges that hold the value stay at the node, in two lists: by lower end ascending, and by
/// upper end descending. An isovalue below the split takes a piece of the first list from its start on, one above it of
/// the second: whatever is read is found.
///
/// Cost   O(n log n) to build, 12 bytes a tet meanwhile; O(log n + found) to ask; 16 bytes a tet that can be cut
class IntervalTree final : public Search {
public:
    /// Where it is cancelled it holds nothing of use.
    explicit IntervalTree(const core::TetTable& table, const Progress& progress = {});
    /// Of some tets alone.
    IntervalTree(const core::TetTable& table, std::span<const std::uint32_t> tets, const Progress& progress = {});
    ~IntervalTree() override;

    std::uint64_t bytes() const override;
    void find(float isovalue, TetNumbers& found) const override;

private:
    struct Node;
    struct Item;
    /// Numbers of tets, with the end of the range that sorts them, node by node.
    struct List {
        core::Buffer<float> ends;
        core::Buffer<std::uint32_t> tets;
    };

    void build(const core::TetTable& table, std::span<const std::uint32_t> tets, const Progress& progress);
    std::unique_ptr<Node> make_node(std::span<Item> items, std::size_t first, const Progress& progress);

    List by_lower_, by_upper_;
    std::unique_ptr<Node> root_;
    std::uint64_t nodes_ = 0;
};

} // namespace isotet::search
