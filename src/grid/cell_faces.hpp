// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The faces of polyhedra, as a grid carries them (Cells::faces).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "grid/cells.hpp"

namespace isotet::core {

inline constexpr std::uint8_t polyhedron_type = 42; ///< VTK's number

/// True for the types that are split by their faces. Those of polyhedra are listed, those of prisms follow from the
/// type.
constexpr bool is_polyhedral(std::uint8_t vtk_type) {
    return vtk_type == polyhedron_type || prism_sides(vtk_type) > 0;
}

/// Reads the faces of polyhedra. Borrows the grid's arrays.
class ISOTET_API FaceReader {
public:
    /// Checks types and lengths of the arrays, not their content (see check_faces).
    ///
    /// Errors   invalid_data
    static Result<FaceReader> open(const Cells& cells);

    /// False: no cell has faces.
    bool has_faces() const { return has_faces_; }
    std::uint64_t begin(std::size_t cell) const { return has_faces_ ? offsets_[cell] : 0; }
    std::uint64_t end(std::size_t cell) const { return has_faces_ ? offsets_[cell + 1] : 0; }
    std::uint64_t at(std::uint64_t position) const { return stream_[position]; }
    std::uint64_t size() const { return size_; }

private:
    IndexColumn stream_, offsets_;
    std::uint64_t size_ = 0;
    bool has_faces_ = false;
};

/// True for polyhedra that have their faces, and prisms.
inline bool is_polyhedron(const CellReader& cells, const FaceReader& faces, std::size_t cell) {
    const std::uint8_t type = cells.type(cell);
    return type == polyhedron_type ? faces.begin(cell) < faces.end(cell) : prism_sides(type) > 0;
}

/// What is wrong with the part of `faces` that a cell has, in a grid of so many points; empty: nothing.
ISOTET_API std::string fault_of_faces(const FaceReader& faces, std::size_t cell, std::uint64_t points);

/// Checks the content: parts that follow one another, faces that fill them, point numbers in range, in the connectivity of
/// polyhedra too. Parallel; one pass.
///
/// Errors   invalid_data, the lowest-numbered cell first; cancelled
ISOTET_API Result<void> check_faces(const Grid& grid, const CellReader& cells, const Progress& progress);

} // namespace isotet::core
