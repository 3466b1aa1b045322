// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets and points in tables, as Buatois, Caumon and Levy (2006) keep them in textures: one texel a tet, its four point
// numbers; one texel a point, x, y, z and value.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "base/buffer.hpp"
#include "packed/packed.hpp"

namespace isotet::core {

/// The isovalues that cut a tet or a face: those above `lower`, up to and with `upper`. A tet with a corner without
/// data has none.
struct CutRange {
    float lower = 0, upper = 0;

    bool holds(float isovalue) const { return lower < isovalue && isovalue <= upper; }
    bool is_empty() const { return !(lower < upper); }
    bool covers(CutRange other) const { return lower <= other.lower && upper >= other.upper; }
    void take_in(CutRange other) {
        if (other.is_empty()) return;
        *this = is_empty() ? other : CutRange{std::min(lower, other.lower), std::max(upper, other.upper)};
    }
};

struct TetTable {
    Buffer<std::array<std::uint32_t, 4>> tets; ///< cluster by cluster, as they are packed
    Buffer<std::array<float, 4>> points;       ///< relative to the origin; stored value, NaN without data
    Buffer<std::uint32_t> first_tet;           ///< of each cluster; one more than there are

    std::size_t clusters() const { return first_tet.size() - 1; }
    std::uint64_t bytes() const { return tets.bytes() + points.bytes(); }

    CutRange range(std::uint32_t tet) const {
        const auto& v = tets[tet];
        return range_of(std::array{value(v[0]), value(v[1]), value(v[2]), value(v[3])});
    }
    /// Of the face opposite a corner.
    CutRange face_range(std::uint32_t tet, unsigned corner) const {
        const auto& v = tets[tet];
        return range_of(std::array{value(v[(corner + 1) % 4]), value(v[(corner + 2) % 4]), value(v[(corner + 3) % 4])});
    }

private:
    float value(std::uint32_t point) const { return points[point][3]; }

    template <std::size_t n>
    static CutRange range_of(const std::array<float, n>& values) {
        CutRange range{values[0], values[0]};
        bool no_data = false;
        for (const float value : values) {
            no_data |= value != value;
            range.lower = value < range.lower ? value : range.lower;
            range.upper = value > range.upper ? value : range.upper;
        }
        return no_data ? CutRange{} : range;
    }
};

/// Writes a packed grid out into tables: 16 bytes a tet, 16 a point. Parallel.
/// Errors   invalid_argument for a grid packed in double, or with cells that are no tets; invalid_data with 2^32 - 1 tets or more
ISOTET_API Result<TetTable> make_tet_table(const Packed& packed);

} // namespace isotet::core
