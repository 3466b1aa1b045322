// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Structures that skip tets which cannot be cut, the contract that each meets. docs/inside/search.md compares them.
#pragma once

#include <cstdint>
#include <vector>

namespace isotet::search {

using TetNumbers = std::vector<std::uint32_t>;

/// Borrows the tet table it was built from.
/// Threads   const functions are safe from many threads
class Search {
public:
    virtual ~Search() = default;

    /// Beside the tet table.
    virtual std::uint64_t bytes() const = 0;

    /// Replaces `found` by the numbers of tets: all that the isovalue cuts, and whatever else the structure cannot tell
    /// from them; each once, in the same order every time.
    virtual void find(float isovalue, TetNumbers& found) const = 0;
};

} // namespace isotet::search
