// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// boundary_of() of cells that are never in memory as a whole.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "grid/cell_sums.hpp"

namespace isotet::core {

struct FoundBoundary {
    Surface surface;
    Cells cells;                             ///< those that have its faces, and others around them
    std::vector<std::uint64_t> numbers = {}; ///< theirs in the whole grid, with keep_numbers()
};

/// Finds the boundary of linear cells that go by twice, in blocks of any order: first sums say at which points there may be
/// faces of the boundary, then the cells there are kept.
///
/// Memory    17 bytes a point, and the cells that are kept: of 100 tets inside about 6
/// Threads   add() and keep() are safe from many threads
class ISOTET_API BoundarySearch {
public:
    /// `points`   of the whole grid
    explicit BoundarySearch(const Array& points);
    ~BoundarySearch();

    /// Whole cells, by their corners: point numbers of 32 or 64 bits. Types are the contoured ones, vertices, lines,
    /// triangles, pixels and quadrilaterals.
    void add(CellType type, const Array& corners);
    void add(std::span<const std::uint8_t> types, const Array& corners);
    /// Cells [begin, end) of a grid with the same points.
    void add(const Grid& grid, const CellReader& cells, std::size_t begin, std::size_t end);

    /// When all cells were added. False where boundary_of() would report an error: cells are broken, or none has a volume.
    bool look();

    /// The same cells again; `first`: how many come before.
    void keep(std::uint64_t first, CellType type, const Array& corners);
    void keep(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners);
    void keep(std::uint64_t first, const CellReader& cells, std::size_t begin, std::size_t end);

    /// When all were. False where finish() needs all cells in memory: those that are kept take more than limit_kept(), or
    /// have points that were not there at first, as where a file is written to meanwhile.
    bool has_kept_all() const { return !broken_ && kept_bytes_ <= most_kept_; }
    void limit_kept(std::uint64_t bytes) { most_kept_ = bytes; } ///< else a quarter of the free memory
    void keep_numbers() { numbered_ = true; }                    ///< before the first keep()

    /// Then, if it has.
    ///
    /// Guarantees   the surface is that of boundary_of()
    /// Errors       as boundary_of()
    Result<FoundBoundary> finish(const Progress& progress) &&;

    /// The same after look(), of the grid with all cells, of which none need be kept.
    Result<Surface> finish(const Grid& grid, const CellReader& cells, const Progress& progress) &&;

    static std::uint64_t bytes(std::uint64_t points) { return points * FaceSums::bytes_per_point; }

private:
    /// Kept cells of a block.
    struct Run {
        std::uint64_t first;
        std::vector<std::uint32_t> narrow; ///< corners, where point numbers have 32 bits
        std::vector<std::uint64_t> wide;   ///< else
        std::vector<std::uint8_t> types;   ///< empty: tetrahedra
        std::vector<std::uint64_t> numbers = {};

        std::size_t corners() const { return narrow.size() + wide.size(); }
        std::size_t cells() const { return types.empty() ? corners() / 4 : types.size(); }
        std::size_t bytes() const {
            return sizeof narrow[0] * narrow.size() + sizeof wide[0] * wide.size() + types.size() +
                   sizeof numbers[0] * numbers.size();
        }
    };

    template <class Index>
    bool is_kept(const CellReader& cells, std::size_t cell, std::span<const Index> corners);
    template <class Index, class Number>
    void keep_cells(const CellReader& cells, const Index* corners, std::size_t begin, std::size_t end,
                    std::vector<Number>& kept, Run& run);
    FoundBoundary join_runs();
    Result<Surface> find(const Grid& grid, const CellReader& cells, const Progress& progress);

    Grid block_; ///< points alone
    bool points_are_sound_ = false;
    bool wide_; ///< point numbers
    bool numbered_ = false;
    std::atomic<bool> broken_{false};
    CellSums sums_;
    Buffer<std::uint8_t> doubted_; ///< by point
    std::atomic<std::uint64_t> kept_bytes_{0};
    std::uint64_t most_kept_;
    std::mutex mutex_;
    std::vector<Run> runs_; ///< under the mutex
};

} // namespace isotet::core
