// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path (plain_cluster.hpp) in portable C++: what the AVX2 and AVX-512 versions must equal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>

#include "base/bits.hpp"
#include "cpu/record.hpp"
#include "grid/cell/case_table.hpp"
#include "grid/cell/cell_cases.hpp"
#include "numbers/arithmetic.hpp"
#include "numbers/storage.hpp"
#include "packed/local_values.hpp"
#include "packed/packed.hpp"

namespace isotet::cpu {

/// Tets that give triangles; and, behind them, polygons of other cells, of which only the last two parts are known.
struct CutTets {
    static constexpr std::size_t room = core::max_cluster_tets + 16;

    std::array<std::uint32_t, room> corners; ///< its four local indices
    std::array<std::uint8_t, room> cases;
    std::array<std::uint8_t, room> triangles; ///< 1 or 2
    std::array<std::uint16_t, room> places;   ///< its first word in the cluster
    std::size_t count = 0;
};

/// Cells of one other kind that give triangles.
struct CutCells {
    static constexpr std::size_t room = core::max_cluster_tets / core::tets_for_a_cell + 16;

    std::array<std::uint64_t, room> corners; ///< its eight local indices
    std::array<std::uint8_t, room> cases;
    std::array<std::uint16_t, room> places; ///< its first word in the cluster
    std::size_t count = 0;
};

/// The polygons of a kind as shuffles of a cell's corners: the corners above of the four edges, then the corners below.
/// One more than there are may be read.
template <core::CellKind kind>
inline constexpr auto polygon_shuffles = [] {
    constexpr auto& cases = core::cases_of<kind>();
    std::array<std::array<std::uint8_t, 8>, cases.polygon_count + 1> bytes{};
    for (std::size_t i = 0; i < cases.polygon_count; ++i)
        for (std::size_t k = 0; k < 4; ++k) {
            bytes[i][k] = cases.all[i].edges[k].above;
            bytes[i][k + 4] = cases.all[i].edges[k].below;
        }
    return bytes;
}();

/// The triangles of each polygon, 1 or 2.
template <core::CellKind kind>
inline constexpr auto polygon_triangles = [] {
    constexpr auto& cases = core::cases_of<kind>();
    std::array<std::uint8_t, cases.polygon_count + 1> counts{};
    for (std::size_t i = 0; i < cases.polygon_count; ++i) counts[i] = cases.all[i].triangles;
    return counts;
}();

/// Where the positions of an edge's ends are, 3 numbers each.
template <class Real>
struct EndPositions {
    const Real *below, *above;
};

/// Edges of the polygons of active tets: lower local index * 128 + higher, four a tet.
using VertexKey = std::uint16_t;

constexpr VertexKey edge_key(core::SeamEdge edge) {
    return static_cast<VertexKey>(edge.lower * core::max_cluster_points + edge.higher);
}

/// Which keys tets use: 1 or 0 for each, and 1 for each part of 64 keys in which some were.
struct KeyTable {
    static constexpr std::size_t row_size = core::max_cluster_points, part_size = 64,
                                 part_count = row_size * row_size / part_size;

    void use(VertexKey key) {
        bytes[key] = 1;
        parts[key / part_size] = 1;
    }
    bool has(VertexKey key) const { return bytes[key]; }
    void take_out(VertexKey key) { bytes[key] = 0; }

    alignas(64) std::array<std::uint8_t, row_size * row_size> bytes{};
    alignas(64) std::array<std::uint8_t, part_count> parts{};
};

/// Of ghost seams, a bit for each that is crossed: how many there are before any of them.
class CrossedBefore {
public:
    static constexpr std::size_t most = core::max_cluster_points * (core::max_cluster_points - 1) / 2;

    explicit CrossedBefore(const std::uint64_t* crossed) : crossed_(crossed) { before_word_[0] = 0; }

    /// Counts the next word; returns how many are before it.
    std::size_t add_word() {
        const std::uint32_t before = before_word_[words_];
        before_word_[words_ + 1] = before + static_cast<std::uint32_t>(std::popcount(crossed_[words_]));
        ++words_;
        return before;
    }
    /// Of those in words that were added, and behind the last.
    std::size_t operator[](std::size_t seam) const {
        const std::uint64_t in_word = crossed_[seam / 64] & ((std::uint64_t{1} << seam % 64) - 1);
        return before_word_[seam / 64] + static_cast<std::size_t>(std::popcount(in_word));
    }

private:
    const std::uint64_t* crossed_;
    std::size_t words_ = 0;
    std::array<std::uint32_t, most / 64 + 2> before_word_;
};

struct Portable {
    static constexpr std::size_t table_size = core::max_cluster_points;

    /// above[k] = 1 where values[k] is above, else 0, for k < n. Returns true when some value is tied or NaN. May read
    /// and write up to the next multiple of 64.
    static bool classify(const float* values, std::size_t n, const core::StoredIsovalue<float>& isovalue,
                         std::uint8_t* above) {
        bool special = false;
        for (std::size_t k = 0; k < n; ++k) {
            above[k] = values[k] >= isovalue.value;
            special |= !(values[k] < isovalue.tied || values[k] > isovalue.tied);
        }
        return special;
    }

    /// Appends the cut ones of `n` tets (n <= 32), the first of which stands at `first` in its cluster.
    static void cut(const std::uint8_t* above, const core::StoredTet* tets, std::size_t n, std::size_t first,
                    CutTets& out) {
        for (std::size_t i = 0; i < n; ++i) {
            const auto& v = tets[i].corners;
            const unsigned index = above[v[0]] | above[v[1]] << 1 | above[v[2]] << 2 | above[v[3]] << 3;
            std::memcpy(&out.corners[out.count], &v, 4);
            out.cases[out.count] = static_cast<std::uint8_t>(index);
            out.places[out.count] = static_cast<std::uint16_t>(first + i);
            out.count += index - 1 < 14;
        }
    }

    /// Appends the cut ones of `n` cells of a kind (n <= 16), the first of which stands at the word `first` of its
    /// cluster. May write up to 8 more.
    template <core::CellKind kind>
    static void cut_cells(const std::uint8_t* above, const core::StoredTet* words, std::size_t n, std::size_t first,
                          CutCells& out) {
        constexpr unsigned all = (1u << core::corner_count(kind)) - 1;
        for (std::size_t i = 0; i < n; ++i) {
            std::uint8_t v[8];
            std::memcpy(v, words + 2 * i, sizeof v);
            unsigned index = 0;
            for (std::size_t k = 0; k < core::corner_count(kind); ++k) index |= unsigned{above[v[k]]} << k;
            std::memcpy(&out.corners[out.count], v, sizeof v);
            out.cases[out.count] = static_cast<std::uint8_t>(index);
            out.places[out.count] = static_cast<std::uint16_t>(first + 2 * i);
            out.count += index - 1 < all - 1;
        }
    }

    /// Appends the polygons of cut cells. `keys` has four for each polygon. May write one more.
    template <core::CellKind kind>
    static void polygons(const CutCells& cells, CutTets& out, VertexKey* keys) {
        for (std::size_t i = 0; i < cells.count; ++i) {
            std::uint8_t v[8];
            std::memcpy(v, &cells.corners[i], sizeof v);
            for (const core::CellPolygon& polygon : core::cases_of<kind>().polygons(cells.cases[i])) {
                VertexKey* const to = keys + 4 * out.count;
                for (std::size_t k = 0; k < 4; ++k) {
                    const unsigned a = v[polygon.edges[k].above], b = v[polygon.edges[k].below];
                    to[k] = static_cast<VertexKey>(std::min(a, b) * table_size + std::max(a, b));
                }
                out.triangles[out.count] = polygon.triangles;
                out.places[out.count++] = cells.places[i];
            }
        }
    }

    /// Bit k of `mask` is set when the ends of seam k lie on different sides; the words are cleared first. Writes
    /// the keys of these seams, in order, and returns how many there are. May write up to 32 more.
    static std::size_t cross_seams(const std::uint8_t* above, std::span<const core::SeamEdge> seams,
                                   std::uint64_t* mask, VertexKey* out) {
        std::fill_n(mask, core::words_of_bits(seams.size()), std::uint64_t{0});
        std::size_t count = 0;
        for (std::size_t k = 0; k < seams.size(); ++k) {
            const std::uint64_t crossed = above[seams[k].lower] ^ above[seams[k].higher];
            mask[k / 64] |= crossed << k % 64;
            out[count] = edge_key(seams[k]);
            count += crossed;
        }
        return count;
    }

    /// The crossed ones of a cluster's ghost seams, with the places of their owners: base[neighbour] + isovalue. May write up
    /// to 7 more.
    static void find_owners(const core::ClusterLinks& links, const std::uint64_t* crossed, const std::uint32_t* base,
                            std::uint32_t isovalue, SharedVertex* out) {
        const core::Neighbour* neighbour = links.neighbours.data();
        std::size_t end = links.ghost_seams.empty() ? 0 : neighbour->ghost_seams;
        core::for_bits(crossed, core::words_of_bits(links.ghost_seams.size()), [&](std::size_t k) {
            while (k >= end) end += (++neighbour)->ghost_seams;
            *out++ = {base[neighbour->cluster] + isovalue, links.seam_index(k)};
        });
    }

    /// Writes the used keys, ascending, and empties the table. Returns how many there are. May write up to 64 more.
    static std::size_t list_keys(KeyTable& used, VertexKey* out) { return list_keys<Portable>(used, out); }

    /// The same for a `Simd` that has nothing but ones(): which of 64 bytes are 1, the others being 0.
    template <class Simd>
    static std::size_t list_keys(KeyTable& used, VertexKey* out) {
        // How many keys a part has is as good as random, and each guess of a branch that fails costs as much as several
        // keys: parts from which all were taken out are left out first, without a branch.
        constexpr std::size_t size = KeyTable::part_size, most = KeyTable::part_count;
        std::array<std::uint64_t, most / 64> used_parts;
        for (std::size_t k = 0; k < used_parts.size(); ++k) used_parts[k] = Simd::ones(&used.parts[64 * k]);
        used.parts.fill(0);
        std::array<std::uint64_t, most + 1> masks;
        std::array<VertexKey, most + 1> firsts;
        std::size_t parts = 0;
        core::for_bits(used_parts.data(), used_parts.size(), [&](std::size_t part) {
            const std::size_t first = size * part;
            masks[parts] = Simd::ones(&used.bytes[first]);
            firsts[parts] = static_cast<VertexKey>(first);
            parts += masks[parts] != 0;
            std::fill_n(&used.bytes[first], size, std::uint8_t{0});
        });
        std::size_t count = 0;
        for (std::size_t part = 0; part < parts; ++part) {
            std::uint64_t bits = masks[part];
            do out[count++] = static_cast<VertexKey>(firsts[part] + std::countr_zero(bits));
            while (bits &= bits - 1);
        }
        return count;
    }
    static std::uint64_t ones(const std::uint8_t* bytes) {
        std::uint64_t bits = 0;
        for (std::size_t k = 0; k < 64; k += 8) {
            std::uint64_t eight;
            std::memcpy(&eight, bytes + k, sizeof eight);
            bits |= (eight * 0x0102040810204080 >> 56) << k; // byte i to bit i
        }
        return bits;
    }

    /// The four edges around each active tet, and its triangles.
    static void keys(CutTets& cut, VertexKey* out) {
        for (std::size_t i = 0; i < cut.count; ++i) {
            cut.triangles[i] = core::case_table[cut.cases[i]].triangles;
            std::uint8_t v[4];
            std::memcpy(v, &cut.corners[i], 4);
            for (const core::ActiveEdge e : core::case_table[cut.cases[i]].polygon) {
                const unsigned a = v[e.above], b = v[e.below];
                *out++ = static_cast<VertexKey>(std::min(a, b) * table_size + std::max(a, b));
            }
        }
    }

    /// Ends of edges, and where the isovalue lies between them. May read and write up to the next multiple of 16.
    template <class Real>
    static void cross(const VertexKey* edges, std::size_t n, const std::uint8_t* above, const Real* values,
                      const core::StoredIsovalue<Real>& isovalue, EndPair* ends, Real* weights) {
        for (std::size_t i = 0; i < n; ++i) {
            // Sides are as good as random: no branch.
            const std::size_t lower = edges[i] / table_size, higher = edges[i] % table_size;
            const std::size_t a = above[lower] ? higher : lower, b = lower ^ higher ^ a;
            ends[i] = {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)};
            weights[i] = core::edge_weight(isovalue, values[a], values[b]);
        }
    }

    /// Positions of vertices on edges, 3 numbers each. May write one number more.
    template <class Real>
    static void place(const EndPositions<Real>* ends, const Real* weights, std::size_t n, Real* out) {
        for (std::size_t i = 0; i < n; ++i, out += 3)
            for (std::size_t axis = 0; axis < 3; ++axis)
                out[axis] = core::interpolate(ends[i].below[axis], ends[i].above[axis], weights[i]);
    }

    template <class Real>
    static void copy(const Real* from, std::size_t n, Real* to) {
        std::copy_n(from, n, to);
    }

    /// Numbers of a surface's vertices from local ones: `first` + those below `listed`; `numbers` holds those of
    /// others, by local number. Before these it has room for `listed` more, which may be written.
    template <class Local, class Index>
    static void number(const Local* local, std::size_t n, std::size_t listed, std::uint64_t first, Index* numbers,
                       Index* out) {
        std::iota(numbers, numbers + listed, static_cast<Index>(first));
        for (std::size_t i = 0; i < n; ++i) out[i] = numbers[local[i]];
    }
};

} // namespace isotet::cpu
