// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which points of pieces their cells use, and where they lie.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "grid/cells.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io {

enum class PointUse : std::uint8_t {
    none,     ///< no cell has it
    left_out, ///< only cells that are left out have it
    kept      ///< a cell that stays has it
};

/// The corners of a piece's cells, whatever the types of its arrays; those of a checked piece are in range.
class PieceCells {
public:
    explicit PieceCells(const Cells& cells);
    std::size_t count() const { return count_; }
    std::uint64_t corners() const { return corners_; } ///< of all cells
    std::uint8_t type(std::size_t cell) const { return types_ ? types_[cell] : uniform_type_; }
    std::uint64_t begin(std::size_t cell) const { return has_offsets_ ? offsets_[cell] : cell * uniform_corners_; }
    std::uint64_t corner(std::uint64_t position) const { return connectivity_[position]; }
    bool are_uniform() const { return !has_offsets_; }
    const core::IndexColumn& connectivity() const { return connectivity_; }

private:
    core::IndexColumn connectivity_, offsets_;
    const std::uint8_t* types_;
    std::size_t count_;
    std::uint64_t corners_;
    std::uint8_t uniform_type_;
    std::uint64_t uniform_corners_;
    bool has_offsets_;
};

/// Checks that the arrays of a piece fit together, not what is in them.
///
/// Errors   invalid_data
Result<void> check_shape(const Piece& piece);

/// Checks a piece: its shape, corners that are among its points. Parallel, one pass over the corners.
///
/// Errors   invalid_data
Result<std::vector<PointUse>> check_piece(const Piece& piece);

struct Box {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 3> lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};

    bool is_empty() const { return !(lower[0] <= upper[0]); }
    void add(const Box& other);
    bool holds(const std::array<double, 3>& place, double margin) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!(place[axis] >= lower[axis] - margin && place[axis] <= upper[axis] + margin)) return false;
        return true;
    }
    bool meets(const Box& other, double margin) const;
    auto operator<=>(const Box&) const = default;
};

/// Around the finite points that cells use; around all where `use` is empty.
Box box_of(const Array& points, std::span<const PointUse> use);

} // namespace isotet::io
