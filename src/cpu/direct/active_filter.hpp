// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells that direct extraction of some isovalues needs, kept of cells that come by in pieces.
//
// These are the cells with corners on both sides of an isovalue, and one for each point that must be known to be used
// (points.hpp): with them extraction sees all that it would see with all cells. Gradient normals need all cells at the
// points of these, which a second round keeps.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "ops/direct.hpp"

namespace isotet::cpu {

class ActiveFilter {
public:
    virtual ~ActiveFilter() = default;

    /// The corners from place `first` on, of the corners of all cells. All calls together have each corner once, in any
    /// order, from any thread.
    virtual void add(std::uint64_t first, const Array& corners) = 0;

    /// Whole cells with their types, of filters without a type: each cell once, in any order, from any thread.
    virtual void add_cells(std::uint64_t first_cell, std::span<const std::uint8_t> types, const Array& corners) = 0;

    /// For gradient normals, when all corners were added: they are added once more.
    virtual void start_second_round() = 0;

    /// The cells in their order; nothing where one has a point that is not there, or that no cell may use.
    virtual std::optional<Cells> finish() = 0;

    /// Then, where the request has source cells: their numbers, uint64.
    virtual Array numbers() const = 0;
};

/// `input`   the cells are not looked at
/// `type`    of all cells; nothing: of each its own
/// Cost      two passes over points and values for each isovalue; a byte a point, three where there are several
template <class Real>
std::unique_ptr<ActiveFilter> make_active_filter(const ops::DirectInput& input, const ops::DirectRequest& request,
                                                 std::optional<CellType> type);

} // namespace isotet::cpu
