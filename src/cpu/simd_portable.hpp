// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path (plain_cluster.hpp) in portable C++: what the AVX2 and AVX-512 versions must equal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/bits.hpp"
#include "core/case_table.hpp"
#include "core/packed.hpp"
#include "core/storage.hpp"

namespace isotet::cpu {

/// A tet that gives triangles.
struct CutTets {
    std::array<std::uint32_t, core::max_cluster_tets + 16> corners; ///< its four local indices
    std::array<std::uint8_t, core::max_cluster_tets + 16> cases;
    std::array<std::uint16_t, core::max_cluster_tets + 16> places;  ///< in the cluster
    std::size_t count = 0;
};

/// Edges of the polygons of cut tets: lower local index * 128 + higher, four a tet.
using VertexKey = std::uint16_t;

struct Portable {
    static constexpr std::size_t table_size = core::max_cluster_points;

    /// above[k] = 1 where values[k] >= isovalue, else 0, for k < n. Returns true when some value equals the isovalue or is NaN.
    /// May read and write up to the next multiple of 64.
    static bool classify(const float* values, std::size_t n, float isovalue, std::uint8_t* above) {
        bool special = false;
        for (std::size_t k = 0; k < n; ++k) {
            above[k] = values[k] >= isovalue;
            special |= !(values[k] < isovalue || values[k] > isovalue);
        }
        return special;
    }

    /// Appends the cut ones of `n` tets (n <= 32), the first of which stands at `first` in its cluster.
    static void cut(const std::uint8_t* above, const core::StoredTet* tets, std::size_t n, std::size_t first, CutTets& out) {
        for (std::size_t i = 0; i < n; ++i) {
            const auto& v = tets[i].corners;
            const unsigned index = above[v[0]] | above[v[1]] << 1 | above[v[2]] << 2 | above[v[3]] << 3;
            std::memcpy(&out.corners[out.count], &v, 4);
            out.cases[out.count] = static_cast<std::uint8_t>(index);
            out.places[out.count] = static_cast<std::uint16_t>(first + i);
            out.count += index - 1 < 14;
        }
    }

    /// Bit k of `bits` is set when the ends of edge k lie on different sides. `edges` are `stride` bytes apart.
    /// Clears the words first.
    template <std::size_t stride>
    static void crossed(const std::uint8_t* above, const std::uint8_t* edges, std::size_t n, std::uint64_t* bits) {
        std::fill_n(bits, core::words_of_bits(n), std::uint64_t{0});
        for (std::size_t k = 0; k < n; ++k)
            bits[k / 64] |= std::uint64_t(above[edges[stride * k]] ^ above[edges[stride * k + 1]]) << k % 64;
    }

    /// Bit k of `out` is set when word k is not zero; n is a multiple of 64.
    static void nonzero(const std::uint64_t* words, std::size_t n, std::uint64_t* out) {
        std::fill_n(out, n / 64, std::uint64_t{0});
        for (std::size_t k = 0; k < n; ++k) out[k / 64] |= std::uint64_t(words[k] != 0) << k % 64;
    }

    /// The four edges around each cut tet.
    static void keys(const CutTets& cut, VertexKey* out) {
        for (std::size_t i = 0; i < cut.count; ++i) {
            std::uint8_t v[4];
            std::memcpy(v, &cut.corners[i], 4);
            for (const core::CrossedEdge e : core::case_table[cut.cases[i]].polygon) {
                const unsigned a = v[e.above], b = v[e.below];
                *out++ = static_cast<VertexKey>(std::min(a, b) * table_size + std::max(a, b));
            }
        }
    }
};

} // namespace isotet::cpu
