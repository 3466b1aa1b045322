// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is done with the cells of a piece that go by.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include <isotet/result.hpp>

#include "base/buffer.hpp"
#include "base/radix_sort.hpp"
#include "io/pieces/cell_places.hpp"
#include "io/pieces/cell_taker.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/join/piece_points.hpp"
#include "io/pieces/join/point_numbers.hpp"
#include "io/pieces/join/repeated_cells.hpp"

namespace isotet::io {

/// Cells all of whose points other pieces have, too, by hashes of their corners.
class SharedHashes {
public:
    /// `cells`   hashes, and numbers in the order of the pieces
    void add(std::vector<core::Keyed> cells);

    /// By piece, of as many cells as `counts` says: 1 for those whose hash another cell has. Empty where there are none.
    ///
    /// Errors   out_of_memory
    Result<std::vector<std::vector<std::uint8_t>>> repeated(std::span<const std::uint64_t> counts);

private:
    std::mutex mutex_;
    std::vector<std::vector<core::Keyed>> parts_;
};

/// Cells of which each may be one of another piece, too: that is known when all are there.
class SharedCells {
public:
    struct Cell {
        std::array<std::int32_t, 8> ascending; ///< its corners; -1 behind the last
        std::array<std::int32_t, 8> corners;
        std::uint8_t type;
        std::uint32_t piece;    ///< in the order in which the first of several stays
        std::uint64_t in_piece; ///< its number there
        std::uint64_t number;   ///< in the joined grid
    };

    void add(const std::vector<Cell>& cells);

    /// Hands those that no earlier piece has to the taker, and tells of the others.
    /// `typed`     the taker takes cells with their types
    /// `dropped`   gets the numbers of the others, in any order
    RepeatedCells settle(CellTaker& taker, bool typed, std::vector<std::uint64_t>& dropped);

private:
    std::mutex mutex_;
    std::vector<Cell> cells_;
};

/// One call for each piece. add() is safe from many threads.
class ActivePass {
public:
    struct Target {
        CellTaker* taker = nullptr; ///< null: uses are looked for, and nothing else
        bool typed = false;         ///< the taker takes cells with their types
        std::uint64_t first = 0;    ///< number of the piece's first cell in the joined grid
        std::uint32_t piece = 0;
        SharedHashes* hashes = nullptr; ///< get all shared cells
        std::uint64_t place = 0;        ///< of the piece's first cell there
        std::uint64_t points = 0;       ///< of the piece
        SharedCells* shared = nullptr;  ///< has those instead of the taker that `repeated` marks
        std::span<const std::uint8_t> repeated{};
        /// How many cells before each block_of_kept are kept: left-out cells have no numbers then. Empty: they have.
        std::span<const std::uint64_t> kept_before{};
    };

    static constexpr std::uint64_t block_of_kept = 4096;

    static constexpr std::uint64_t max_points = std::uint64_t{1} << 30; ///< of the joined grid

    /// `numbers`   of the points in the joined grid; not looked at without a taker
    ActivePass(const Piece& piece, const PieceNumbers& numbers, const Target& target);

    /// Corners from place `first` on, of those of all cells.
    void add(std::uint64_t first, const Array& corners);

    /// When all corners were added. False: a cell has a point that is not there.
    bool finish();

    /// Of the points: without a taker those of left-out cells are told apart, with one all are `kept` or `none`, and
    /// left-out cells do not count.
    std::vector<PointUse> use() const;
    bool uses_all_points() const; ///< with a taker

private:
    template <class Index, class CornersOf>
    void mark_all(std::uint64_t first_cell, std::uint64_t cells, const Index* corners, const CornersOf& corners_of);
    template <class Index, class CornersOf>
    void pass(std::uint64_t first_cell, std::uint64_t cells, const Index* corners, const CornersOf& corners_of);
    template <class Index>
    void pass_block(std::uint64_t first_cell, std::uint64_t cells, const Index* corners);
    template <class Index>
    void mark(std::uint64_t cell, std::span<const Index> corners);
    void see(std::span<const std::uint64_t> points);
    std::uint64_t number_of(std::uint64_t cell) const;
    bool is_left_out(std::uint64_t cell) const { return !piece_.left_out.empty() && piece_.left_out[cell] != 0; }
    void send(std::uint64_t first_cell, std::span<const std::uint8_t> types,
              std::span<const std::int32_t> corners) const;
    SharedCells::Cell shared_cell(std::uint64_t cell, std::span<const std::int32_t> corners) const;

    const Piece& piece_;
    Target target_;
    const CellPlaces& places_;
    std::uint64_t points_;
    core::Buffer<std::uint32_t> numbers_;        ///< in the joined grid, and two bits; with a taker
    core::Buffer<std::uint8_t> kept_, left_out_; ///< 1 for a point of such a cell; without
    std::atomic<bool> broken_{false};
    WholeCells whole_;
};

} // namespace isotet::io
