// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From tets with corners on both sides to polygons whose corners are edges, numbered as they are found: one thread's
// part of the pass over the cells, and what it leaves for welding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cpu/direct/arena.hpp"
#include "cpu/direct/points.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/orientation.hpp"

namespace isotet::cpu::direct {

/// An active edge by the user's numbers of its ends, `Point` wide; a tied point is an edge to itself.
template <class Point>
struct ActiveEdge {
    Point lower, higher;

    friend bool operator==(const ActiveEdge& a, const ActiveEdge& b) {
        if constexpr (sizeof(Point) == 4) return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
        else return a.lower == b.lower && a.higher == b.higher;
    }
    /// A number whose highest bits are as good as drawn.
    std::uint64_t mixed() const {
        return lower * std::uint64_t{0x9e3779b97f4a7c15} + higher * std::uint64_t{0xc2b2ae3d27d4eb4f};
    }
};

/// A pyramid, wedge or hexahedron by the user's point numbers.
template <class Point>
struct NativeCell {
    core::CellKind kind{};
    std::array<Point, 8> corners{}; ///< as many as the kind has

    NativeCell() = default;
    NativeCell(core::CellKind of_kind, const std::array<Point, 8>& points) : kind(of_kind), corners(points) {}
    explicit NativeCell(const core::WholeCell& cell) : kind(cell.kind) {
        for (std::size_t k = 0; k < core::corner_count(kind); ++k) corners[k] = static_cast<Point>(cell.corners[k]);
    }
};

/// What a batch of active tets leaves. Edges are numbered within the chunk; one that was found by another chunk, or too
/// long ago to be remembered, is found again.
template <class Point>
struct Piece {
    std::uint32_t polygon_count = 0, edges = 0;
    const std::array<std::uint32_t, 4>* polygons =
        nullptr; ///< of each tet, or of other cells; its triangles are 0 1 2 and, if two, 0 2 3
    const std::uint8_t* triangles = nullptr;  ///< 1 or 2
    const std::uint32_t* cells = nullptr;     ///< within the chunk; null when they are not wanted
    const ActiveEdge<Point>* found = nullptr; ///< in the order of their numbers
};

/// The pieces of some consecutive cells.
template <class Point>
struct Chunk {
    std::vector<Piece<Point>> pieces;
    std::uint64_t edges = 0, triangles = 0; ///< how many; later: the number of the first
    std::size_t cutter = 0;                 ///< who did it
};

/// Ranges of equally many point numbers, in which edges are welded by their lower end.
struct Ranges {
    unsigned shift = 0;
    std::size_t count = 1;

    explicit Ranges(std::uint64_t points) {
        constexpr unsigned smallest = 10, most = 12; // 1,024 points at least, 4,096 ranges at most
        while (points >> shift > 1) ++shift;
        shift = std::max(smallest, shift + 1 > most ? shift + 1 - most : 0);
        count = static_cast<std::size_t>(((points ? points - 1 : 0) >> shift) + 1);
    }
    std::size_t of(std::uint64_t point) const { return static_cast<std::size_t>(point >> shift); }
};

/// What all cutters work with. Flags that they raise tell that something must be done over.
struct CutContext {
    const ops::DirectInput& input;
    Sides& sides;
    Ranges ranges;
    bool mostly_negative = false; ///< what is assumed of the grid's tetrahedra
    bool rounds_coordinates = false;
    std::array<double, 3> origin{};
    bool keep_cells = false;
    bool split_cells = false;
    std::atomic<bool> broken{false};   ///< a cell breaks a rule
    std::atomic<bool> saw_flat{false}; ///< a flat tetrahedron was cut, for which `mostly_negative` matters
    Budget budget{};
};

/// Sums over the chunks of a cutter.
struct CutCounts {
    std::uint64_t edges = 0, triangles = 0, coarse_tets = 0, left_out = 0;
};

/// Where an edge was last found. Several share a place in the memory of a cutter: the last one stays.
template <class Point>
struct RememberedEdge {
    ActiveEdge<Point> edge;
    std::uint32_t number, chunk;
};
constexpr unsigned edge_memory_bits = 11;

/// Numbers the edges of a chunk as they are found, and lists the new ones.
template <class Point>
class EdgeNumbers {
public:
    /// `found`   room for the new ones and one more
    EdgeNumbers(std::vector<RememberedEdge<Point>>& memory, std::uint32_t chunk, std::uint32_t next,
                ActiveEdge<Point>* found)
        : memory_(memory.data()), found_(found), end_(found), chunk_(chunk), next_(next) {}

    std::uint32_t of(ActiveEdge<Point> edge) {
        RememberedEdge<Point>& last = memory_[edge.mixed() >> (64 - edge_memory_bits)];
        // Whether an edge is new cannot be predicted: every edge is written, and only new ones count.
        const unsigned is_new = !(last.edge == edge) | (last.chunk != chunk_);
        const std::uint32_t number = is_new ? next_ : last.number;
        last = {edge, number, chunk_};
        *end_ = edge;
        end_ += is_new;
        next_ += is_new;
        return number;
    }
    ActiveEdge<Point>* found() const { return found_; }
    const ActiveEdge<Point>* end() const { return end_; }

private:
    RememberedEdge<Point>* memory_;
    ActiveEdge<Point>*found_, *end_;
    std::uint32_t chunk_, next_;
};

/// Threads: one each.
template <class Point>
class Cutter {
public:
    Cutter(CutContext& context, std::size_t number);

    std::size_t number() const { return number_; }
    const CutCounts& counts() const { return counts_; }
    void leave_out_cell() { ++counts_.left_out; }
    /// Edges found in each range. Welding turns them into places.
    std::vector<Point>& in_range() { return in_range_; }

    /// Gives back the edges of all pieces.
    void drop_found() { found_arena_.clear(); }

    void begin(Chunk<Point>& chunk, std::uint64_t first_cell);
    /// A tet with corners on both sides, points as in the file; `cell` is counted from the chunk's first.
    void add(const std::array<Point, 4>& corners, std::uint32_t cell) {
        for (std::size_t k = 0; k < 4; ++k) corners_[k][pending_] = corners[k];
        cells_[pending_] = cell;
        if (++pending_ == batch) cut();
    }
    void end();

    /// A native cell with corners on both sides that is no tet.
    void add_cell(const NativeCell<Point>& cell, std::uint32_t place) {
        if (pending_) cut();
        for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k) points_.prefetch(cell.corners[k]);
        cell_batch_[pending_cells_] = cell;
        cells_[pending_cells_] = place;
        if (++pending_cells_ == cell_batch_.size()) cut_cells();
    }
    /// As add(), where there are such cells, too: what comes first is cut first.
    void add_tet(const std::array<Point, 4>& corners, std::uint32_t cell) {
        if (pending_cells_) cut_cells();
        add(corners, cell);
    }
    /// Tells that some tets that will be added are of ordered types.
    void expect_ordered() { has_ordered_ = true; }

private:
    static constexpr std::size_t batch = 256;

    void cut();
    void cut_cells();
    std::uint32_t keep_found(const EdgeNumbers<Point>& numbers);
    unsigned unusual_polygon(std::size_t tet, std::array<ActiveEdge<Point>, 4>& polygon);
    bool is_ordered(std::size_t tet) const;
    bool is_odd(std::size_t tet) const;
    bool is_mirrored_flat(std::size_t tet);
    bool is_coarse(std::size_t tet) const;
    bool is_coarse(const NativeCell<Point>& cell) const;

    CutContext& context_;
    std::size_t number_;
    core::PointReader points_;
    BudgetedArena arena_, found_arena_; ///< polygons; edges, which are needed until they are welded
    CutCounts counts_;
    std::vector<Point> in_range_;
    Chunk<Point>* chunk_ = nullptr;
    std::uint64_t first_cell_ = 0;
    std::uint32_t chunks_ = 0; ///< begun
    std::uint32_t edges_ = 0;  ///< of the chunk
    std::vector<RememberedEdge<Point>> memory_;

    // The batch: row k holds corner k of all tets.
    std::size_t pending_ = 0;
    alignas(64) std::array<std::array<Point, batch>, 4> corners_;
    alignas(64) std::array<std::array<Point, batch>, 4> sorted_; ///< twice the point, plus 1 when it is above;
                                                                 ///< ascending
    alignas(64) std::array<std::uint8_t, batch> codes_;
    std::array<std::uint32_t, batch> cells_;
    bool has_ordered_ = false; ///< the batch may have tets of ordered types

    // The batch of other cells; while there are any, there are no tets.
    std::size_t pending_cells_ = 0;
    std::array<NativeCell<Point>, 64> cell_batch_;
};

} // namespace isotet::cpu::direct
