// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Livnat, Shen and Johnson (1996): the range of a tet as a point (lower, upper) of the span space, in a k-d tree.
#pragma once

#include "base/buffer.hpp"
#include "packed/tet_table.hpp"
#include "paper/search/search.hpp"

namespace isotet::search {

/// Finds exactly the active tets.
///
/// The tree has no pointers: the middle of a stretch divides it, by lower and by upper end in turn. An isovalue asks
/// for the quarter plane lower < isovalue <= upper; a stretch that lies in it as a whole is taken without a look.
///
/// Cost   O(n log n) to build; O(sqrt n + found) to ask; 12 bytes a tet that can be cut
class SpanSpace final : public Search {
public:
    explicit SpanSpace(const core::TetTable& table);

    std::uint64_t bytes() const override { return ranges_.bytes() + tets_.bytes(); }
    void find(float isovalue, TetNumbers& found) const override;

private:
    /// Some items side by side, and what is known of them all.
    struct Stretch {
        std::size_t begin, end;
        bool by_upper; ///< how its middle divides it
        float highest_lower, lowest_upper;
    };
    void take(float isovalue, const Stretch& stretch, TetNumbers& found) const;

    core::Buffer<core::CutRange> ranges_;
    core::Buffer<std::uint32_t> tets_;
};

} // namespace isotet::search
