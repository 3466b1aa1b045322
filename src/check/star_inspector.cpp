// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/star_inspector.hpp"

namespace isotet::checking {

// The triangles around a vertex, joined where they share an edge, are one fan (open or closed) if they are all joined
// and no edge joins more than two.
void StarInspector::inspect_edges(std::uint64_t vertex, std::size_t triangles, Tally& tally, Share& share) {
    std::ranges::sort(spokes_, {}, &Spoke::other);
    leaders_.resize(triangles);
    std::iota(leaders_.begin(), leaders_.end(), std::uint64_t{0});
    std::size_t fans = triangles;
    bool joins_many = false;
    for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
        EdgeUse edge{vertex, spokes_[begin].other, 0, 0};
        for (end = begin; end < spokes_.size() && spokes_[end].other == edge.high; ++end) {
            ++(spokes_[end].outward ? edge.forward : edge.backward);
            const std::uint64_t a = leader(spokes_[begin].in_star), b = leader(spokes_[end].in_star);
            if (a == b) continue;
            leaders_[b] = a;
            --fans;
        }
        joins_many |= end - begin > 2;
        share.proper &= edge.forward == 1 && edge.backward == 1;
        if (edge.high < vertex) continue; // counted there
        --share.euler;
        if (end - begin > 2) {
            ++tally.non_manifold_edges;
            add_to_few(tally.non_manifold_list, edge);
        }
        if (edge.forward == edge.backward) continue;
        ++(end - begin == 1 ? tally.boundary_edges : tally.inconsistent_edges);
        add(tally.unequal_edges, edge);
    }
    if (fans == 1 && !joins_many) return;
    share.proper = false;
    ++tally.touching;
    add_to_few(tally.touching_list, vertex);
}

void StarInspector::inspect_repeats(Tally& tally) {
    std::ranges::stable_sort(
        wings_, [](const Wing& a, const Wing& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    for (std::size_t begin = 0, end = 0; begin < wings_.size(); begin = end) {
        const Wing& first = wings_[begin];
        const Wing* mirrored = nullptr; // the first triangle in the other direction
        std::uint64_t same = 0, opposite = 0;
        for (end = begin; end < wings_.size() && wings_[end].low == first.low && wings_[end].high == first.high;
             ++end) {
            const Wing& wing = wings_[end];
            ++(wing.rising == first.rising ? same : opposite);
            if (wing.rising != first.rising && !mirrored) mirrored = &wing;
            const Wing& earlier = wing.rising == first.rising ? first : *mirrored;
            if (&wing == &earlier) continue;
            ++tally.duplicates;
            add(tally.duplicate_list, {wing.triangle, earlier.triangle});
        }
        if (!mirrored) continue;
        tally.double_sheets += std::min(same, opposite);
        add_to_few(tally.double_sheet_list, {mirrored->triangle, first.triangle});
    }
}

} // namespace isotet::checking
