// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include "packed/tet_table.hpp"
#include "paper/search/search.hpp"

namespace isotet::search {

/// No index: finds all tets. What the others are compared with.
class AllTets final : public Search {
public:
    explicit AllTets(const core::TetTable& table) : table_(table) {}

    std::uint64_t bytes() const override { return 0; }
    void find(float, TetNumbers& found) const override {
        found.resize(table_.tets.size());
        std::iota(found.begin(), found.end(), 0);
    }

private:
    const core::TetTable& table_;
};

} // namespace isotet::search
