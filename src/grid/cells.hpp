// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of a grid as tets: reading corners of any index type, and splitting cells into tets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "grid/cell/split.hpp"

namespace isotet::core {

/// Types of which VTK has none: parts of a polyhedron that are stored with their corners in the order given, inside out or
/// not, so that the surface stays closed where the polyhedron cannot be split into upright ones.
constexpr std::uint8_t ordered_tetrahedron = 210, ordered_pyramid = 214;

constexpr bool is_ordered(std::uint8_t vtk_type) {
    return vtk_type == ordered_tetrahedron || vtk_type == ordered_pyramid;
}

/// Nothing for types that are not contoured.
constexpr std::optional<CellKind> kind_of(std::uint8_t vtk_type) {
    if (is_ordered(vtk_type))
        return vtk_type == ordered_pyramid ? CellKind::pyramid : CellKind::tetrahedron;
    switch (static_cast<CellType>(vtk_type)) {
    case CellType::tetrahedron: return CellKind::tetrahedron;
    case CellType::voxel:
    case CellType::hexahedron: return CellKind::hexahedron;
    case CellType::wedge: return CellKind::wedge;
    case CellType::pyramid: return CellKind::pyramid;
    }
    return std::nullopt;
}

/// True for the types that are contoured.
constexpr bool is_contoured(std::uint8_t vtk_type) { return kind_of(vtk_type).has_value(); }

/// Corners of a contoured type; 0 for all others.
constexpr int corners_of(std::uint8_t vtk_type) {
    const auto kind = kind_of(vtk_type);
    return kind ? static_cast<int>(corner_count(*kind)) : 0;
}

/// From the corners of a cell in VTK's order to those of its kind: voxels become hexahedra.
template <class Corners>
void order_as_kind(std::uint8_t vtk_type, Corners& corners) {
    if (vtk_type != static_cast<std::uint8_t>(CellType::voxel)) return;
    std::swap(corners[2], corners[3]);
    std::swap(corners[6], corners[7]);
}

/// Of VTK's pentagonal (15) and hexagonal (16) prisms: how many sides. 0 for all others. Points: those of the bottom,
/// then those of the top in the same order.
constexpr std::uint64_t prism_sides(std::uint8_t vtk_type) { return vtk_type == 15 ? 5 : vtk_type == 16 ? 6 : 0; }

/// A point number or offset as 64 bits; a negative one becomes a huge one.
template <class T>
std::uint64_t widened(T index) {
    if constexpr (std::is_signed_v<T>) return static_cast<std::uint64_t>(std::int64_t{index});
    else return index;
}

/// Reads a column of point numbers or offsets of any integer type.
class IndexColumn {
public:
    IndexColumn() = default;
    explicit IndexColumn(const Array& array) : data_(array.data()), type_(array.type()) {}

    /// Calls f with a pointer to the numbers in their own type.
    template <class F>
    decltype(auto) visit(const F& f) const {
        switch (type_) {
        case ScalarType::int32: return f(static_cast<const std::int32_t*>(data_));
        case ScalarType::uint32: return f(static_cast<const std::uint32_t*>(data_));
        case ScalarType::int64: return f(static_cast<const std::int64_t*>(data_));
        default: return f(static_cast<const std::uint64_t*>(data_));
        }
    }

    std::uint64_t operator[](std::size_t i) const {
        return visit([i](const auto* indices) { return widened(indices[i]); });
    }

private:
    const void* data_ = nullptr;
    ScalarType type_ = ScalarType::int64;
};

/// The cells of a grid. Borrows the grid's arrays.
class ISOTET_API CellReader {
public:
    /// Checks lengths and types of the arrays, not their content (see check_cells).
    static Result<CellReader> open(const Grid& grid);

    std::size_t count() const { return count_; }
    bool only_tets() const { return only_tets_; }
    bool has_types() const { return types_ != nullptr; } ///< else all cells are of one
    std::uint8_t type(std::size_t cell) const { return types_ ? types_[cell] : uniform_type_; }
    std::uint64_t first(std::size_t cell) const { return has_offsets_ ? offsets_[cell] : cell * uniform_corners_; }
    std::uint64_t corner(std::uint64_t position) const { return connectivity_[position]; }
    std::uint64_t connectivity_size() const { return connectivity_size_; }
    std::uint64_t points() const { return points_; }

    /// The tets of a cell, none for a type that is not contoured. Corners in the order of the file (tetrahedra) or of
    /// the splitting; the cell must have passed check_cells().
    CellTets tets(std::size_t cell) const {
        CellTets out;
        if (type(cell) == static_cast<std::uint8_t>(CellType::tetrahedron)) {
            const std::uint64_t start = first(cell);
            out.add(corner(start), corner(start + 1), corner(start + 2), corner(start + 3));
        } else {
            split(cell, out);
        }
        return out;
    }

    /// A cell of a contoured type as it is, voxels as hexahedra.
    WholeCell whole(std::size_t cell) const;

    /// Calls f(cell, its tets) for the cells [begin, end). What tets() gives, faster where all cells are tetrahedra.
    template <class F>
    void for_cells(std::size_t begin, std::size_t end, const F& f) const {
        if (!bare_tets()) {
            for (std::size_t cell = begin; cell < end; ++cell) f(cell, tets(cell));
            return;
        }
        connectivity_.visit([&](const auto* corners) {
            for (std::size_t cell = begin; cell < end; ++cell) {
                const auto* const v = corners + 4 * cell;
                CellTets out;
                out.add(widened(v[0]), widened(v[1]), widened(v[2]), widened(v[3]));
                f(cell, out);
            }
        });
    }

    /// Asks for the point numbers of a cell that will be wanted soon.
    void prefetch(std::size_t cell) const {
        connectivity_.visit([&](const auto* corners) { __builtin_prefetch(corners + first(cell)); });
    }

    /// Nothing but four point numbers for each tetrahedron.
    bool bare_tets() const { return only_tets_ && !has_offsets_; }
    const IndexColumn& connectivity() const { return connectivity_; }
    bool has_offsets() const { return has_offsets_; }
    const IndexColumn& offsets() const { return offsets_; }

    /// Corners of the cell according to the offsets.
    std::uint64_t corners(std::size_t cell) const {
        return has_offsets_ ? offsets_[cell + 1] - offsets_[cell] : uniform_corners_;
    }

private:
    /// Splits a cell that is not a tetrahedron.
    void split(std::size_t cell, CellTets& out) const;

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

/// Whether all coordinates are finite and below 2^91, as in nearly every grid: then the points of each cell need no look.
bool all_points_are_sound(const Grid& grid);

/// Checks the content of all cells: offsets, numbers of corners, point numbers, and the coordinates of the points that
/// contoured cells use (finite, below 2^91). Parallel; one pass.
///
/// Errors   invalid_data, the lowest-numbered cell first; cancelled
ISOTET_API Result<void> check_cells(const Grid& grid, const CellReader& cells, const Progress& progress);

/// The error for a grid of which no tet is left: what cells there are.
Error nothing_to_contour(const Grid& grid, const CellReader& cells);

} // namespace isotet::core
