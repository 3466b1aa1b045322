// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell/split.hpp"

#include "grid/cell/splitter.hpp"

namespace isotet::core {

namespace {

/// Lists the tets without repeated corners, and counts the others.
struct Lister {
    const std::uint64_t* numbers;
    LocalTets tets{};

    void expect(int) {}
    void add(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
        const std::uint64_t p = numbers[a], q = numbers[b], r = numbers[c], s = numbers[d];
        if (p == q || p == r || p == s || q == r || q == s || r == s) ++tets.collapsed;
        else tets.tets[static_cast<std::size_t>(tets.count++)] = {a, b, c, d};
    }
};

} // namespace

LocalTets split_locally(const WholeCell& cell) {
    Lister lister{cell.corners.data()};
    Splitter(cell.corners.data(), lister).split(cell.kind);
    return lister.tets;
}

CellTets split_cell(const WholeCell& cell) {
    const LocalTets local = split_locally(cell);
    CellTets out;
    out.count = local.count;
    out.collapsed = local.collapsed;
    for (int i = 0; i < local.count; ++i)
        for (std::size_t k = 0; k < 4; ++k)
            out.tets[static_cast<std::size_t>(i)][k] = cell.corners[local.tets[static_cast<std::size_t>(i)][k]];
    return out;
}

} // namespace isotet::core
