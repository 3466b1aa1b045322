// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The boundary of cells that are never in memory as a whole (ReadActiveCells::boundary).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <isotet/array.hpp>
#include <isotet/boundary.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/boundary_search.hpp"
#include "grid/cell_print.hpp"
#include "io/pieces/cell_source.hpp"
#include "io/pieces/cell_taker.hpp"

namespace isotet::io {

/// Hands whole cells to the first round of a search, or to the second.
class BoundaryTaker final : public CellTaker {
public:
    enum class Round : std::uint8_t { add, keep };
    /// `type`   of all cells; nothing: of each its own
    BoundaryTaker(core::BoundarySearch& search, std::optional<CellType> type, Round round)
        : search_(search), type_(type), round_(round) {}

    void take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) override {
        if (round_ == Round::add) types.empty() ? search_.add(*type_, corners) : search_.add(types, corners);
        else types.empty() ? search_.keep(first, *type_, corners) : search_.keep(first, types, corners);
    }

private:
    core::BoundarySearch& search_;
    std::optional<CellType> type_;
    Round round_;
};

/// The boundary, when all cells were kept.
///
/// `points`   of the whole grid
/// Returns    false where all cells are needed: the search says so, or points hang on cells at the boundary
/// Errors     as BoundarySearch::finish()
Result<bool> take_boundary(core::BoundarySearch&& search, const Array& points, StreamedBoundary& boundary,
                           const Progress& progress);

/// Looks at cells while they go by for another purpose, and then once or twice more where the boundary is not known yet.
///
/// Threads   add() is safe from many threads
class BoundaryPass {
public:
    /// Borrows all.
    /// Errors   out_of_memory
    static Result<void> check_memory(const Array& points);
    BoundaryPass(StreamedBoundary& boundary, const Array& points, const CellSource& cells);

    /// A block of CellSource::each_block().
    void add(std::uint64_t first, const Array& corners);

    /// When all blocks were added. False where all cells are needed: some are broken, none has a volume, or as
    /// take_boundary().
    /// Errors   as CellSource and take_boundary()
    Result<bool> finish(const Progress& progress);

private:
    void begin_search();
    /// Hands all cells to a round of the search.
    Result<void> each_cells(BoundaryTaker::Round round, const Progress& progress);
    Result<bool> search(const Progress& progress);
    std::optional<CellType> type() const;

    StreamedBoundary& boundary_;
    const Array& points_;
    const CellSource& cells_;
    std::optional<core::CellPrint> print_;       ///< where steps follow
    std::optional<core::BoundarySearch> search_; ///< where none is known
    WholeCells whole_;
};

} // namespace isotet::io
