// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One cluster at one isovalue: which of its tets are cut, which edges they cross, which tied points they use.
// Count and emit both need it; it is cheap enough to be done twice.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/bits.hpp"
#include "core/case_table.hpp"
#include "core/local_values.hpp"
#include "core/storage.hpp"
#include "ops/extraction.hpp"

namespace isotet::cpu {

using core::Packed;
using core::max_cluster_points;

/// A square matrix of bits over local points: bit (lower, higher). Rows that are not empty are remembered.
class EdgeMatrix {
public:
    void add(std::uint8_t a, std::uint8_t b) {
        const std::uint8_t lower = std::min(a, b), higher = std::max(a, b);
        core::set_bit(rows_[lower].data(), higher);
        core::set_bit(used_rows_.data(), lower);
    }
    bool test(core::SeamEdge e) const { return core::test_bit(rows_[e.lower].data(), e.higher); }
    void remove(core::SeamEdge e) { rows_[e.lower][e.higher / 64] &= ~(std::uint64_t{1} << e.higher % 64); }

    std::uint32_t count() const {
        std::size_t n = 0;
        core::for_bits(used_rows_.data(), words, [&](std::size_t row) { n += core::count_bits(rows_[row].data(), words); });
        return static_cast<std::uint32_t>(n);
    }
    /// Calls f(lower, higher) for every bit, ascending.
    template <class F>
    void for_edges(F&& f) const {
        core::for_bits(used_rows_.data(), words, [&](std::size_t row) {
            core::for_bits(rows_[row].data(), words, [&](std::size_t column) { f(row, column); });
        });
    }
    void clear() {
        core::for_bits(used_rows_.data(), words, [&](std::size_t row) { rows_[row].fill(0); });
        used_rows_.fill(0);
    }

private:
    static constexpr std::size_t words = core::words_of_bits(max_cluster_points);
    std::array<std::array<std::uint64_t, words>, max_cluster_points> rows_{};
    std::array<std::uint64_t, words> used_rows_{};
};

/// Scratch memory of one thread, reused for one cluster after another.
template <class Real>
class CutCluster {
public:
    static constexpr std::size_t words = core::words_of_bits(max_cluster_points);

    /// A tet that gives triangles: its place in the cluster and its case.
    struct CutTet {
        std::uint16_t tet;
        std::uint8_t index;
    };

    /// Fills everything below for a cluster.
    void cut(const Packed& packed, std::size_t cluster, Real isovalue, Ties ties) {
        edges.clear();
        used_tied.fill(0);
        cut_count = 0;
        triangles = 0;
        points = core::load_values(packed, cluster, values.data());
        const bool merge = ties == Ties::merge;
        classify(isovalue, merge);
        const core::Range<Real> range = packed.as<Real>().ranges[cluster];
        if (!(range.lower < isovalue)) return; // nothing below: no tet is cut
        if (!has_tied_ && !has_no_data_) cut_tets<false>(packed, cluster, isovalue, range, merge);
        else cut_tets<true>(packed, cluster, isovalue, range, merge);
    }

    bool is_above(std::size_t local) const { return flags_[local] & above_flag; }
    bool is_tied(std::size_t local) const { return flags_[local] & tied_flag; }
    /// One end below, the other above (Ties::merge: strictly), both with data.
    bool is_crossed(core::SeamEdge e) const {
        const unsigned a = flags_[e.lower], b = flags_[e.higher];
        return ((a ^ b) & above_flag) && !((a | b) & no_data_flag) && !((a | b) & tied_flag);
    }
    bool has_tied() const { return has_tied_; }
    std::size_t own_with(Real isovalue, std::size_t foreign_points) const {
        return static_cast<std::size_t>(std::count(values.begin() + foreign_points, values.begin() + points, isovalue));
    }

    std::array<Real, max_cluster_points> values;
    std::size_t points = 0;
    EdgeMatrix edges;                            ///< crossed edges that triangles use, tied ends left out
    std::array<std::uint64_t, words> used_tied{}; ///< tied local points that triangles use
    std::array<CutTet, core::max_cluster_tets> cut_tet;
    std::size_t cut_count = 0;
    std::uint32_t triangles = 0;

private:
    // Flags of a point, spaced so that four of them shifted by 0 to 3 make three nibbles of a tet.
    static constexpr unsigned above_flag = 0x001, no_data_flag = 0x010, tied_flag = 0x100;

    void classify(Real isovalue, bool merge) {
        unsigned seen = 0;
        for (std::size_t k = 0; k < points; ++k) {
            const Real value = values[k];
            unsigned flags = value >= isovalue ? above_flag : 0u;
            if (core::is_nan(value)) flags |= no_data_flag;
            if (merge && value == isovalue) flags |= tied_flag;
            flags_[k] = static_cast<std::uint16_t>(flags);
            seen |= flags;
        }
        has_tied_ = seen & tied_flag;
        has_no_data_ = seen & no_data_flag;
    }

    template <bool general>
    void cut_tets(const Packed& packed, std::size_t cluster, Real isovalue, core::Range<Real> range, bool merge) {
        const auto tets = packed.cluster_tets(cluster);
        const core::GroupRange* groups = packed.group_ranges.data() + packed.headers[cluster].first_group;
        const std::uint8_t step = core::quantize(isovalue, range);
        for (std::size_t begin = 0; begin < tets.size(); begin += core::group_size, ++groups) {
            if (groups->lower > step || step > groups->upper) continue;
            const std::size_t end = std::min(begin + core::group_size, tets.size());
            for (std::size_t i = begin; i < end; ++i) {
                const auto& v = tets[i].corners;
                const unsigned flags = flags_[v[0]] | flags_[v[1]] << 1 | flags_[v[2]] << 2 | flags_[v[3]] << 3;
                const unsigned index = flags & 15;
                if (index - 1 >= 14) continue;
                if constexpr (general) {
                    if (!add_general(v, flags, merge)) continue;
                } else {
                    const core::TetCase& c = core::case_table[index];
                    for (const core::CrossedEdge e : c.polygon) edges.add(v[e.above], v[e.below]);
                    triangles += c.triangles;
                }
                cut_tet[cut_count++] = {static_cast<std::uint16_t>(i), static_cast<std::uint8_t>(index)};
            }
        }
    }

    /// A tet with both above and below corners, among which may be tied points and points without data.
    bool add_general(const std::array<std::uint8_t, 4>& v, unsigned flags, bool merge) {
        if (flags & 0x0f0) return false;
        const unsigned index = flags & 15, tied = flags >> 8;
        const int tied_count = std::popcount(tied), above_count = std::popcount(index & ~tied);
        if (merge && above_count == 0 && tied_count != 3) return false;
        const core::TetCase& c = core::case_table[index];
        for (const core::CrossedEdge e : c.polygon)
            if (!(tied >> e.above & 1)) edges.add(v[e.above], v[e.below]);
        for (std::size_t k = 0; k < 4; ++k)
            if (tied >> k & 1) core::set_bit(used_tied.data(), v[k]);
        triangles += tied == 0 ? c.triangles : 1;
        return true;
    }

    std::array<std::uint16_t, max_cluster_points> flags_;
    bool has_tied_ = false, has_no_data_ = false;
};

} // namespace isotet::cpu
