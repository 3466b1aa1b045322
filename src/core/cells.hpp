// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of a grid as tets: reading corners of any index type, and splitting cells into tets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <isotet/grid.hpp>

namespace isotet::core {

/// Four point numbers.
using Tet = std::array<std::uint64_t, 4>;

/// The tets of one cell: at most six. Tets with a repeated corner are left out and counted.
struct CellTets {
    std::array<Tet, 6> tets;
    int count = 0;
    int collapsed = 0;

    void add(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
        if (a == b || a == c || a == d || b == c || b == d || c == d) ++collapsed;
        else tets[static_cast<std::size_t>(count++)] = {a, b, c, d};
    }
    const Tet* begin() const { return tets.data(); }
    const Tet* end() const { return tets.data() + count; }
};

/// True for the types that are contoured.
bool is_contoured(std::uint8_t vtk_type);

/// Corners of a contoured type; 0 for all others.
int corners_of(std::uint8_t vtk_type);

/// Reads a column of point numbers or offsets of any integer type. Negative numbers become huge ones.
class IndexColumn {
public:
    IndexColumn() = default;
    explicit IndexColumn(const Array& array) : data_(array.data()), type_(array.type()) {}

    std::uint64_t operator[](std::size_t i) const {
        switch (type_) {
        case ScalarType::int32: return static_cast<std::uint64_t>(std::int64_t{static_cast<const std::int32_t*>(data_)[i]});
        case ScalarType::uint32: return static_cast<const std::uint32_t*>(data_)[i];
        case ScalarType::int64: return static_cast<std::uint64_t>(static_cast<const std::int64_t*>(data_)[i]);
        default: return static_cast<const std::uint64_t*>(data_)[i];
        }
    }

private:
    const void* data_ = nullptr;
    ScalarType type_ = ScalarType::int64;
};

/// The cells of a grid. Borrows the grid's arrays.
class CellReader {
public:
    /// Checks lengths and types of the arrays, not their content (see check_cells).
    static Result<CellReader> open(const Grid& grid);

    std::size_t count() const { return count_; }
    bool only_tets() const { return only_tets_; }
    std::uint8_t type(std::size_t cell) const { return types_ ? types_[cell] : uniform_type_; }
    std::uint64_t first(std::size_t cell) const { return has_offsets_ ? offsets_[cell] : cell * uniform_corners_; }
    std::uint64_t corner(std::uint64_t position) const { return connectivity_[position]; }
    std::uint64_t connectivity_size() const { return connectivity_size_; }
    std::uint64_t points() const { return points_; }

    /// The tets of a cell, none for a type that is not contoured. Corners in the order of the file (tetrahedra) or of the
    /// splitting; the cell must have passed check_cells().
    CellTets tets(std::size_t cell) const;

    /// Corners of the cell according to the offsets.
    std::uint64_t corners(std::size_t cell) const {
        return has_offsets_ ? offsets_[cell + 1] - offsets_[cell] : uniform_corners_;
    }

private:
    IndexColumn connectivity_, offsets_;
    const std::uint8_t* types_ = nullptr;
    std::size_t count_ = 0;
    std::uint64_t connectivity_size_ = 0;
    std::uint64_t points_ = 0;
    std::uint64_t uniform_corners_ = 4;
    std::uint8_t uniform_type_ = 10;
    bool has_offsets_ = false;
    bool only_tets_ = false; ///< every cell is a tetrahedron by declaration
};

/// Checks the content of all cells: offsets, numbers of corners, point numbers, and the coordinates of the points that
/// contoured cells use (finite, below 2^91). Parallel; one pass.
///
/// Errors   invalid_data, the lowest-numbered cell first; cancelled
Result<void> check_cells(const Grid& grid, const CellReader& cells, const Progress& progress);

/// The error for a grid of which no tet is left: what cells there are.
Error nothing_to_contour(const Grid& grid, const CellReader& cells);

} // namespace isotet::core
