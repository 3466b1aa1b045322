// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that ReadActiveCells::chosen chooses, of pieces whose cells go by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "grid/fixed_corners.hpp"
#include "io/pieces/cell_taker.hpp"
#include "io/pieces/join/ordered_pieces.hpp"

namespace isotet::io {

/// Threads   take() is safe from many
class ChosenCells final : public CellTaker {
public:
    /// Nothing where all cells are needed: some have no volume, none or not all that is named is chosen, or a piece does not
    /// have a field as the others have it.
    ///
    /// `first`   by piece, the number of its first cell
    /// `type`    of all cells; nothing: of each its own
    /// Errors    as FieldSource; out_of_memory
    static Result<std::optional<ChosenCells>> find(const OrderedPieces& all, std::span<const CellCondition> conditions,
                                                   const std::vector<std::uint64_t>& first,
                                                   std::optional<CellType> type);

    /// Notes the points of chosen cells, of so many.
    void note_points(std::uint64_t points) { used_.assign(points, 0); }
    void take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) override;

    /// When all cells were taken: leaves values at these points alone. False where all cells are needed: coordinates that
    /// are rounded have other bounds.
    bool leave_values(Grid& grid) const;

    /// Calls with the chosen ones of some cells as take() has them, one run after another.
    template <class Visit>
    void each_run(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners,
                  const Visit& visit) const {
        const std::uint64_t cells = types.empty() ? corners.size() / corners_of_type_ : types.size();
        const auto corners_of = [&](std::uint64_t cell) {
            return types.empty() ? corners_of_type_ : core::fixed_corners_of(types[cell]);
        };
        const std::byte* const bytes = static_cast<const std::byte*>(corners.data());
        for (std::uint64_t cell = 0, at = 0; cell < cells;) {
            std::uint64_t end = cell, place = at;
            for (; end < cells && is_chosen(first + end); ++end) place += corners_of(end);
            if (end > cell) {
                const Array some(corners.type(), bytes + at * size_of(corners.type()), place - at, 1, nullptr);
                visit(first + cell, types.empty() ? types : types.subspan(cell, end - cell), some);
            }
            at = place;
            for (cell = end; cell < cells && !is_chosen(first + cell); ++cell) at += corners_of(cell);
        }
    }

    bool are_all() const { return all_; }
    std::uint64_t count() const { return count_; } ///< of all cells

private:
    bool is_chosen(std::uint64_t number) const {
        return number - origin_ < chosen_.size() && chosen_[number - origin_] != 0;
    }
    void mark(std::uint64_t point);
    std::vector<PointUse> used_points() const;

    std::vector<std::uint8_t> chosen_; ///< by number from `origin_` on
    std::vector<std::uint8_t> used_;   ///< by point
    std::uint64_t origin_ = 0, count_ = 0, corners_of_type_ = 0;
    bool all_ = false;
};

} // namespace isotet::io
