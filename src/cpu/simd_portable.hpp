// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path (plain_cluster.hpp) in portable C++: what the AVX2 and AVX-512 versions must equal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>

#include "core/arithmetic.hpp"
#include "core/bits.hpp"
#include "core/case_table.hpp"
#include "core/local_values.hpp"
#include "core/packed.hpp"
#include "core/storage.hpp"
#include "cpu/record.hpp"

namespace isotet::cpu {

/// A tet that gives triangles.
struct CutTets {
    std::array<std::uint32_t, core::max_cluster_tets + 16> corners; ///< its four local indices
    std::array<std::uint8_t, core::max_cluster_tets + 16> cases;
    std::array<std::uint16_t, core::max_cluster_tets + 16> places; ///< in the cluster
    std::size_t count = 0;
};

/// Edges of the polygons of active tets: lower local index * 128 + higher, four a tet.
using VertexKey = std::uint16_t;

constexpr VertexKey edge_key(core::SeamEdge edge) {
    return static_cast<VertexKey>(edge.lower * core::max_cluster_points + edge.higher);
}

/// Which keys tets use: 1 or 0 for each, and 1 for each row of keys (of a lower local index) in which some were.
struct KeyTable {
    static constexpr std::size_t row_size = core::max_cluster_points;

    void use(VertexKey key) {
        bytes[key] = 1;
        rows[key / row_size] = 1;
    }
    bool has(VertexKey key) const { return bytes[key]; }
    void take_out(VertexKey key) { bytes[key] = 0; }

    alignas(64) std::array<std::uint8_t, row_size * row_size> bytes{};
    alignas(64) std::array<std::uint8_t, row_size> rows{};
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

    /// Bit k of `mask` is set when the ends of own seam k lie on different sides; the words are cleared first. Writes
    /// the keys of these seams, in order, and returns how many there are. May write up to 32 more.
    static std::size_t cross_own_seams(const std::uint8_t* above, std::span<const core::SeamEdge> seams,
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

    /// Writes the ghost seams with ends on different sides, in order, and their places in the list. Returns how many
    /// there are. May write up to 16 more.
    static std::size_t cross_ghost_seams(const std::uint8_t* above, std::span<const core::GhostSeam> seams,
                                         core::GhostSeam* out, std::uint16_t* places) {
        std::size_t count = 0;
        for (std::size_t k = 0; k < seams.size(); ++k) {
            out[count] = seams[k];
            places[count] = static_cast<std::uint16_t>(k);
            count += above[seams[k].edge.lower] ^ above[seams[k].edge.higher];
        }
        return count;
    }

    /// Writes the used keys, ascending, and empties the table. Returns how many there are. May write up to 64 more.
    static std::size_t list_keys(KeyTable& used, VertexKey* out) { return list_keys<Portable>(used, out); }

    /// The same for a `Simd` that has nothing but ones(): which of 64 bytes are 1, the others being 0.
    template <class Simd>
    static std::size_t list_keys(KeyTable& used, VertexKey* out) {
        // How many keys a part of a row has is as good as random, and each guess of a branch that fails costs as much
        // as several keys: parts without any are left out first, without a branch.
        std::array<std::uint64_t, table_size * table_size / 64 + 1> masks;
        std::array<VertexKey, table_size * table_size / 64 + 1> firsts;
        std::size_t parts = 0;
        const std::array<std::uint64_t, 2> rows{Simd::ones(&used.rows[0]), Simd::ones(&used.rows[64])};
        core::for_bits(rows.data(), 2, [&](std::size_t row) {
            for (std::size_t first = table_size * row; first < table_size * (row + 1); first += 64) {
                masks[parts] = Simd::ones(&used.bytes[first]);
                firsts[parts] = static_cast<VertexKey>(first);
                parts += masks[parts] != 0;
                std::fill_n(&used.bytes[first], 64, std::uint8_t{0});
            }
        });
        used.rows.fill(0);
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

    /// The four edges around each active tet.
    static void keys(const CutTets& cut, VertexKey* out) {
        for (std::size_t i = 0; i < cut.count; ++i) {
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

    /// Positions of vertices on edges, 3 numbers each. `positions` are those of packed points, `points` tells these of
    /// local ones. May write one number more.
    template <class Real>
    static void place(const EndPair* ends, const Real* weights, std::size_t n, const core::LocalPoints& points,
                      const Real* positions, Real* out) {
        for (std::size_t i = 0; i < n; ++i, out += 3) {
            const Real* const a = positions + 3 * points[ends[i].below];
            const Real* const b = positions + 3 * points[ends[i].above];
            for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = core::interpolate(a[axis], b[axis], weights[i]);
        }
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
