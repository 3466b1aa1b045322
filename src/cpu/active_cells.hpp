// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The active cells of one cluster, found by the sides of their corners alone, and the triangles of their polygons.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "cpu/cutting.hpp"

namespace isotet::cpu {

/// The groups of a cluster, one after another.
struct Groups {
    const core::StoredTet* const words; ///< of the cluster
    const core::GroupRange* const ranges;
    const std::uint8_t step; ///< the isovalue in steps of the cluster's range
    std::size_t next = 0, next_word = 0;

    /// Calls f(words, cells, first word) for those groups of the next `count` cells, of one kind, that may be cut.
    template <class F>
    void for_hit(core::CellKind kind, std::size_t count, const F& f) {
        const std::size_t at_once = core::cells_per_group(kind);
        for (std::size_t first = 0; first < count; first += at_once, ++next)
            if (ranges[next].lower <= step && step <= ranges[next].upper) {
                const std::size_t word = next_word + core::words_of(kind) * first;
                f(words + word, std::min(at_once, count - first), word);
            }
        next_word += core::words_of(kind) * count;
    }
};

template <class Simd, core::CellKind kind, class Real, class Keep>
void cut_cells(std::size_t count, Groups& groups, CutScratch<Real>& s, const Keep& keep) {
    if (count == 0) return;
    s.cells.count = 0;
    groups.for_hit(kind, count, [&](const core::StoredTet* words, std::size_t n, std::size_t first) {
        Simd::template cut_cells<kind>(s.above.data(), words, n, first, s.cells);
    });
    keep(s.cells, core::corner_count(kind));
    Simd::template polygons<kind>(s.cells, s.cut, s.keys.data());
}

/// Fills scratch.cut and scratch.keys from scratch.above; the tets come first. `keep` takes out those that must not be cut:
/// keep(tets) of CutTets, and keep(cells, corners of each) of CutCells.
template <class Simd, class Real, class Keep>
void cut_all(const Packed& packed, std::size_t cluster, Real isovalue, CutScratch<Real>& s, const Keep& keep) {
    using core::CellKind;
    const core::ClusterHeader& h = packed.headers[cluster];
    Groups groups{packed.cells.data() + h.first_word, packed.group_ranges.data() + h.first_group,
                  core::quantize(isovalue, packed.as<Real>().ranges[cluster])};
    s.cut.count = 0;
    groups.for_hit(CellKind::tetrahedron, h.tets(), [&](const core::StoredTet* tets, std::size_t n, std::size_t first) {
        Simd::cut(s.above.data(), tets, n, first, s.cut);
    });
    keep(s.cut);
    Simd::keys(s.cut, s.keys.data());
    if (h.others() == 0) return;
    cut_cells<Simd, CellKind::pyramid>(h.count(CellKind::pyramid), groups, s, keep);
    cut_cells<Simd, CellKind::wedge>(h.count(CellKind::wedge), groups, s, keep);
    cut_cells<Simd, CellKind::hexahedron>(h.count(CellKind::hexahedron), groups, s, keep);
}

/// Keeps all of them.
struct KeepAll {
    template <class... Cells>
    void operator()(const Cells&...) const {}
};

/// The triangles of all polygons, and the first words of their cells where `tet` is not null.
template <class Real, class Number>
void write_triangles(const CutScratch<Real>& s, const Number* numbers, Number* out, std::uint16_t* tet) {
    const VertexKey* key = s.keys.data();
    for (std::size_t i = 0, n = s.cut.count; i < n; ++i, key += 4) {
        const std::uint64_t a = numbers[key[0]], b = numbers[key[1]], c = numbers[key[2]], d = numbers[key[3]];
        if constexpr (sizeof(Number) == 1) {
            const std::uint64_t corners = a | b << 8 | c << 16 | a << 24 | c << 32 | d << 40;
            std::memcpy(out, &corners, sizeof corners);
        } else {
            const std::uint64_t first = a | b << 16 | c << 32 | a << 48;
            const auto rest = static_cast<std::uint32_t>(c | d << 16);
            std::memcpy(out, &first, sizeof first);
            std::memcpy(out + 4, &rest, sizeof rest);
        }
        const std::size_t triangles = s.cut.triangles[i];
        out += 3 * triangles;
        if (tet) {
            tet[0] = tet[1] = s.cut.places[i];
            tet += triangles;
        }
    }
}

} // namespace isotet::cpu
