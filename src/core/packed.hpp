// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The packed grid: the arrays that every engine works on.
//
//   cluster c                                 arrays of all clusters, one after another
//   +-----------------------------+
//   | headers[c]         32 B     |-- first_point --> positions[3 * p], values[p], point_ids[p]   (own points only)
//   | ranges[c]           8 B     |-- first_group --> tets[32 * g ...], group_ranges[g]           (g = first_group ...)
//   | has_no_data[c]      1 B     |-- first_link  --> links[w ...], 32-bit words:
//   +-----------------------------+      neighbours      2 words each: cluster | ghost points + 65536 * ghost seams
//                                        ghost points  1 byte each, grouped by neighbour, padded to a word:
//                                                        index among the neighbour's own points
//                                        own seams       2 bytes each (lower, higher local index), padded to a word
//                                        ghost seams   1 word each, grouped by neighbour:
//                                                        lower + 256 * higher + 65536 * index among the owner's own
//                                                        seams
//
// Local indices run ghost points first, then own points, ascending in packed order. A point belongs to the
// lowest-numbered cluster that holds it (its owner), so every neighbour in the table has a lower number.
// A stored tet is one 32-bit word, four local indices, first corner lowest; the last group of a cluster is padded with
// copies of its last tet, which are never looked at.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <variant>

#include <isotet/grid.hpp>
#include <isotet/pack.hpp>

#include "core/shared_buffer.hpp"

namespace isotet::core {

constexpr std::size_t max_cluster_points = 128;
constexpr std::size_t max_cluster_tets = 1024;
constexpr std::size_t group_size = 32;

struct ClusterHeader {
    std::uint64_t first_point;
    std::uint64_t first_link;
    std::uint32_t first_group;
    std::uint16_t own_points;
    std::uint16_t ghost_points;
    std::uint16_t tets;
    std::uint16_t neighbours;
    std::uint16_t own_seams;
    std::uint16_t ghost_seams;
};
static_assert(sizeof(ClusterHeader) == 32);

/// Smallest and largest stored value over all points with data; lower > upper when there is none.
template <class Real>
struct Range {
    Real lower, upper;
};

/// Like Range, but in 256 steps of the cluster's range (quantize()).
struct GroupRange {
    std::uint8_t lower, upper;
};

struct Neighbour {
    std::uint32_t cluster;
    std::uint16_t ghost_points;
    std::uint16_t ghost_seams;
};
static_assert(sizeof(Neighbour) == 8);

struct SeamEdge {
    std::uint8_t lower, higher; ///< local indices
    friend auto operator<=>(const SeamEdge&, const SeamEdge&) = default;
};
static_assert(sizeof(SeamEdge) == 2);

struct GhostSeam {
    SeamEdge edge;
    std::uint16_t index; ///< among the owner's own seams
};
static_assert(sizeof(GhostSeam) == 4);

struct StoredTet {
    std::array<std::uint8_t, 4> corners; ///< local indices
};
static_assert(sizeof(StoredTet) == 4);

constexpr std::size_t words_for(std::size_t bytes) { return (bytes + 3) / 4; }

/// The four parts of a cluster's links.
struct ClusterLinks {
    std::span<const Neighbour> neighbours;
    std::span<const std::uint8_t> ghost_points;
    std::span<const SeamEdge> own_seams;
    std::span<const GhostSeam> ghost_seams;

    static std::size_t words(const ClusterHeader& h) {
        return 2u * h.neighbours + words_for(h.ghost_points) + words_for(2u * h.own_seams) + h.ghost_seams;
    }
};

/// What depends on the precision.
template <class Real>
struct Values {
    SharedBuffer<Real> positions; ///< 3 a point, relative to the origin
    SharedBuffer<Real> values;
    SharedBuffer<Range<Real>> ranges;
};

/// How values of a field become stored values; see storage.hpp.
struct Storage {
    double offset = 0;
    double scale = 1;
    bool unchanged = true;
};

class StorageCache;

/// Copying shares all arrays. A copy that gets another field or other points gets arrays of its own for them.
struct Packed {
    SharedBuffer<ClusterHeader> headers;
    SharedBuffer<StoredTet> tets; ///< 32 a group
    SharedBuffer<GroupRange> group_ranges;
    SharedBuffer<std::uint32_t> links;
    SharedBuffer<std::uint8_t> has_no_data; ///< 1 where the cluster holds a point without data
    SharedBuffer<std::uint32_t> point_ids;  ///< packed point -> user's point; or, from 2^32 user's points on,
    SharedBuffer<std::uint64_t> wide_point_ids;
    SharedBuffer<std::uint32_t> cell_ids; ///< stored tet (by group and lane) -> user's cell, on request; or
    SharedBuffer<std::uint64_t> wide_cell_ids;
    SharedBuffer<std::uint32_t> gradients; ///< octahedral code a point, on request (normal_code.hpp)
    std::variant<Values<float>, Values<double>> reals;

    std::array<double, 3> origin{};
    Storage storage;
    std::shared_ptr<StorageCache> storage_cache; ///< of fields carried onto surfaces (field_storage.hpp)
    Array field; ///< as the user gave it, to tell false ties; no values, only their type, where
                 ///< what is stored tells them, and of a borrowed array
    std::uint64_t user_points = 0, user_cells = 0;
    PackReport report;
    FieldReport field_report;

    std::size_t clusters() const { return headers.size(); }
    std::size_t points() const { return point_ids.size() + wide_point_ids.size(); }
    bool single() const { return reals.index() == 0; }
    template <class Real>
    const Values<Real>& as() const {
        return std::get<Values<Real>>(reals);
    }
    template <class Real>
    Values<Real>& as() {
        return std::get<Values<Real>>(reals);
    }

    std::uint64_t user_point(std::uint64_t packed_point) const {
        return wide_point_ids.empty() ? point_ids[packed_point] : wide_point_ids[packed_point];
    }
    bool has_cell_ids() const { return !cell_ids.empty() || !wide_cell_ids.empty(); }
    std::uint64_t user_cell(std::uint64_t stored_tet) const {
        return wide_cell_ids.empty() ? cell_ids[stored_tet] : wide_cell_ids[stored_tet];
    }

    ClusterLinks cluster_links(std::size_t cluster) const {
        const ClusterHeader& h = headers[cluster];
        const std::uint32_t* words = links.data() + h.first_link;
        ClusterLinks out;
        // Words are written with memcpy and read as the structs they hold: trivially copyable, same size, no padding.
        out.neighbours = {reinterpret_cast<const Neighbour*>(words), h.neighbours};
        words += 2u * h.neighbours;
        out.ghost_points = {reinterpret_cast<const std::uint8_t*>(words), h.ghost_points};
        words += words_for(h.ghost_points);
        out.own_seams = {reinterpret_cast<const SeamEdge*>(words), h.own_seams};
        words += words_for(2u * h.own_seams);
        out.ghost_seams = {reinterpret_cast<const GhostSeam*>(words), h.ghost_seams};
        return out;
    }
    std::span<const StoredTet> cluster_tets(std::size_t cluster) const {
        const ClusterHeader& h = headers[cluster];
        return {tets.data() + group_size * std::size_t{h.first_group}, h.tets};
    }
};

/// Packed point numbers of all local points of a cluster: ghost points first. Returns how many.
inline std::size_t local_points(const Packed& packed, std::size_t cluster, std::uint64_t* out) {
    const ClusterHeader& h = packed.headers[cluster];
    const ClusterLinks links = packed.cluster_links(cluster);
    std::size_t n = 0;
    for (const Neighbour& neighbour : links.neighbours) {
        const std::uint64_t first = packed.headers[neighbour.cluster].first_point;
        for (std::size_t k = 0; k < neighbour.ghost_points; ++k, ++n) out[n] = first + links.ghost_points[n];
    }
    for (std::size_t k = 0; k < h.own_points; ++k, ++n) out[n] = h.first_point + k;
    return n;
}

/// The power of two that brings the width of a range into [128, 256); 0 for a width of 0. Widths are far from denormals
/// and overflow, and so is the factor.
template <class Real>
Real quantize_factor(Range<Real> range) {
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr int mantissa = std::numeric_limits<Real>::digits - 1, bias = std::numeric_limits<Real>::max_exponent - 1;
    const Real width = range.upper - range.lower;
    if (!(width > 0)) return 0;
    const int exponent = static_cast<int>(std::bit_cast<Bits>(width) >> mantissa) - bias; // width is in [2^e, 2^(e+1))
    return std::bit_cast<Real>(static_cast<Bits>(bias + 7 - exponent) << mantissa);
}

/// Places a value inside the range of a cluster: 0 at the lower end, up to 255 at the upper. Monotone and exact to
/// compute on any device (one subtraction, one multiplication by a power of two), so that
/// `lower <= v <= upper` implies `quantize(lower) <= quantize(v) <= quantize(upper)`.
template <class Real>
std::uint8_t quantize(Real value, Range<Real> range) {
    if (!(value > range.lower)) return 0;
    return static_cast<std::uint8_t>(
        std::min((std::min(value, range.upper) - range.lower) * quantize_factor(range), Real(255)));
}

} // namespace isotet::core
