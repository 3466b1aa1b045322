// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The packed grid: the arrays that every engine works on.
//
//   cluster c                                 arrays of all clusters, one after another
//   +-----------------------------+
//   | headers[c]         48 B     |-- first_point --> positions[3 * p], values[p], point_ids[p]   (own points only)
//   | ranges[c]           8 B     |-- first_word  --> cells[w ...], first_group --> group_ranges[g ...]
//   | has_no_data[c]      1 B     |-- first_link  --> links[w ...], 32-bit words:
//   +-----------------------------+      neighbours      2 words each: cluster | ghost points + 65536 * ghost seams
//                                        own seams       2 bytes each: lower, higher local index
//                                        ghost seams     2 bytes each, grouped by neighbour
//                                        ghost points    1 byte each, grouped by neighbour: index among its own points
//                                        seam indices    of ghost seams, 1 byte each (2 where wide_seams): index among
//                                                        the neighbour's own seams
//
// Local indices run ghost points first, then own points, ascending in packed order. A point belongs to the
// lowest-numbered cluster that holds it (its owner), so every neighbour in the table has a lower number.
// A stored tet is one word, four local indices, its first corner that of the lowest user's number. A pyramid, wedge or
// hexahedron is two words, eight local indices, behind its last corner copies of its first. A cluster has its tets
// first, then its pyramids, wedges and hexahedra, one after another. Each kind is looked at in groups of 32 words, the last
// of which may have less. Behind the last words of all, of cells and of links, stand some more that may be read.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>

#include <isotet/frame.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>

#include "base/shared_buffer.hpp"
#include "grid/cell/cell_kind.hpp"
#include "numbers/storage.hpp"

namespace isotet::core {

constexpr std::size_t max_cluster_points = 128;
constexpr std::size_t max_cluster_tets = 1024;
constexpr std::size_t group_size = 32; ///< words

/// How many words more than there are may be read at the end of cells and links.
constexpr std::size_t slack_words = 16;

/// Words that a cell of a kind takes.
constexpr std::size_t words_of(CellKind kind) { return kind == CellKind::tetrahedron ? 1 : 2; }
constexpr std::size_t cells_per_group(CellKind kind) { return group_size / words_of(kind); }

/// Other cells than tets count as so many of them, for what a cluster may hold and give.
constexpr std::size_t tets_for_a_cell = 4;
/// What a cluster with such cells may hold, so that it has no more groups than one of tets.
constexpr std::size_t max_mixed_cluster_tets = max_cluster_tets - cell_kind_count * group_size;

struct ClusterHeader {
    std::uint64_t first_point;
    std::uint64_t first_word;
    std::uint64_t first_link;
    std::uint32_t first_group;
    std::uint16_t own_points;
    std::uint16_t ghost_points;
    std::array<std::uint16_t, cell_kind_count> cells; ///< of each kind
    std::uint16_t neighbours;
    std::uint16_t own_seams;
    std::uint16_t ghost_seams;
    std::uint16_t wide_seams; ///< 1 where some owner of its ghost seams has more than 256 own seams

    std::size_t count(CellKind kind) const { return cells[static_cast<std::size_t>(kind)]; }
    std::size_t tets() const { return cells[0]; }
    std::size_t others() const { return std::size_t{cells[1]} + cells[2] + cells[3]; }
    std::size_t groups(CellKind kind) const {
        return (count(kind) + cells_per_group(kind) - 1) / cells_per_group(kind);
    }
    std::size_t groups() const {
        std::size_t sum = 0;
        for (const CellKind kind : cell_kinds) sum += groups(kind);
        return sum;
    }
    std::size_t words() const { return tets() + 2 * others(); }
    /// No tet gives more than two triangles and four vertices, and no other cell more than so many.
    std::size_t like_tets() const { return tets() + tets_for_a_cell * others(); }
};
static_assert(sizeof(ClusterHeader) == 48);

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

struct StoredTet {
    std::array<std::uint8_t, 4> corners; ///< local indices
};
static_assert(sizeof(StoredTet) == 4);

/// A pyramid, wedge or hexahedron of a cluster.
struct StoredCell {
    CellKind kind;
    std::span<const std::uint8_t> corners; ///< local indices; eight may be read
    std::size_t word;                      ///< its first, counted from the cluster's first
};

constexpr std::size_t words_for(std::size_t bytes) { return (bytes + 3) / 4; }

/// The parts of a cluster's links, in this order.
struct ClusterLinks {
    std::span<const Neighbour> neighbours;
    std::span<const SeamEdge> own_seams, ghost_seams;
    std::span<const std::uint8_t> ghost_points;
    const std::uint8_t* seam_indices; ///< of ghost seams
    bool wide;                        ///< of 16 bits each

    /// Index of ghost seam k among its owner's own seams.
    std::uint32_t seam_index(std::size_t k) const {
        if (!wide) return seam_indices[k];
        std::uint16_t index;
        std::memcpy(&index, seam_indices + 2 * k, sizeof index);
        return index;
    }

    /// Bytes behind the neighbours.
    static std::size_t bytes(const ClusterHeader& h) {
        return sizeof(SeamEdge) * (std::size_t{h.own_seams} + h.ghost_seams) + h.ghost_points +
               (1u + h.wide_seams) * h.ghost_seams;
    }
    static std::size_t words(const ClusterHeader& h) { return 2u * h.neighbours + words_for(bytes(h)); }
};

/// What depends on the precision.
template <class Real>
struct Values {
    SharedBuffer<Real> positions; ///< 3 a point, relative to the origin
    SharedBuffer<Real> values;
    SharedBuffer<Range<Real>> ranges;
};

class StorageCache;
class Residency;

/// Copying shares all arrays. A copy that gets another field or other points gets arrays of its own for them.
struct Packed {
    SharedBuffer<ClusterHeader> headers;
    SharedBuffer<StoredTet> cells; ///< words
    SharedBuffer<GroupRange> group_ranges;
    SharedBuffer<std::uint32_t> links;
    SharedBuffer<std::uint8_t> has_no_data; ///< 1 where the cluster holds a point without data
    SharedBuffer<std::uint32_t> point_ids;  ///< packed point -> user's point; or, from 2^32 user's points on,
    SharedBuffer<std::uint64_t> wide_point_ids;
    SharedBuffer<std::uint32_t> cell_ids; ///< first word of a stored cell -> user's cell, on request; or
    SharedBuffer<std::uint64_t> wide_cell_ids;
    SharedBuffer<std::uint32_t> gradients; ///< octahedral code a point, on request (normal_code.hpp)
    std::variant<Values<float>, Values<double>> reals;

    SharedBuffer<std::uint64_t> point_ranks; ///< by Grid::point_numbers, of grids with other cells than tets: how these
                                             ///< are split
    std::optional<Frame> frame;

    std::array<double, 3> origin{};
    ScalarType point_type = ScalarType::float32; ///< of the user's points, and so of vertices
    Storage storage;
    std::shared_ptr<StorageCache> storage_cache; ///< of fields carried onto surfaces (field_storage.hpp)
    Array field; ///< as the user gave it, to tell false ties; no values, only their type, where
                 ///< what is stored tells them, and of a borrowed array
    std::uint64_t user_points = 0, user_cells = 0;
    PackReport report;
    FieldReport field_report;
    /// Null where all arrays are in memory. Else the grid lies in a file: only headers, ranges and has_no_data are there, and
    /// of the others what was brought (residency.hpp); between the chunks of the file are numbers that no point, word or
    /// group has, so that sizes of arrays are not counts.
    std::shared_ptr<const Residency> residency;

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
    /// What decides how a cell with this point is split.
    std::uint64_t rank_of_point(std::uint64_t packed_point) const {
        return point_ranks.empty() ? user_point(packed_point) : point_ranks[packed_point];
    }
    bool has_cell_ids() const { return !cell_ids.empty() || !wide_cell_ids.empty(); }
    std::uint64_t user_cell(std::uint64_t word) const {
        return wide_cell_ids.empty() ? cell_ids[word] : wide_cell_ids[word];
    }
    std::size_t groups() const {
        return clusters() ? headers[clusters() - 1].first_group + headers[clusters() - 1].groups() : 0;
    }

    ClusterLinks cluster_links(std::size_t cluster) const {
        const ClusterHeader& h = headers[cluster];
        const std::uint32_t* words = links.data() + h.first_link;
        ClusterLinks out;
        // Words are written with memcpy and read as the structs they hold: trivially copyable, same size, no padding.
        out.neighbours = {reinterpret_cast<const Neighbour*>(words), h.neighbours};
        const auto* const seams = reinterpret_cast<const SeamEdge*>(words + 2u * h.neighbours);
        out.own_seams = {seams, h.own_seams};
        out.ghost_seams = {seams + h.own_seams, h.ghost_seams};
        const auto* const points = reinterpret_cast<const std::uint8_t*>(seams + h.own_seams + h.ghost_seams);
        out.ghost_points = {points, h.ghost_points};
        out.seam_indices = points + h.ghost_points;
        out.wide = h.wide_seams;
        return out;
    }
    std::span<const StoredTet> cluster_tets(std::size_t cluster) const {
        const ClusterHeader& h = headers[cluster];
        return {cells.data() + h.first_word, h.tets()};
    }
    /// Calls f(cell) with every cell of a cluster that is no tet.
    template <class F>
    void for_other_cells(std::size_t cluster, const F& f) const {
        const ClusterHeader& h = headers[cluster];
        const auto* const corners = reinterpret_cast<const std::uint8_t*>(cells.data() + h.first_word);
        std::size_t word = h.tets();
        for (std::size_t k = 1; k < cell_kind_count; ++k)
            for (std::size_t i = 0; i < h.count(cell_kinds[k]); ++i, word += 2)
                f(StoredCell{cell_kinds[k], {corners + 4 * word, corner_count(cell_kinds[k])}, word});
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
