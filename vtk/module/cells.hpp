// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of a vtkUnstructuredGrid as isotet::Cells, kept while they are the same.
#pragma once

#include <bitset>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "arrays.hpp"

class vtkUnstructuredGrid;

namespace isotet_vtk {

/// Of VTK's ghost marks, those of cells that are left out: of another piece, refined, outside, hidden.
inline constexpr std::uint8_t ghost_bits = 57;
inline constexpr std::uint8_t duplicate_bit = 1; ///< of another piece

class SharedCells {
public:
    /// Shares the arrays of cells, types, faces and ghost marks.
    ///
    /// `refines`  isotet contours curved cells, too, but for pyramids
    /// Cost     nothing while they are the same; else a pass over the types, and over ghost marks where there are some
    /// Errors   invalid_data where arrays do not fit together
    isotet::Result<void> take(vtkUnstructuredGrid* grid, const isotet::Array& points, bool refines);
    void release();

    /// All cells; without those that VTK's ghost marks give to others, or hide.
    const isotet::Cells& all() const { return all_; }
    const isotet::Cells& own() const { return own_; }
    bool has_ghosts() const { return has_ghosts_; }
    bool has_cells_of_other_pieces() const { return has_others_cells_; }
    const isotet::Array& ghosts() const { return marks_; }

    /// Whether the last take() found other cells.
    bool changed() const { return changed_; }

    /// Whether there is a cell that isotet contours, or one that it does not, ghost cells aside.
    bool has_contoured() const;
    bool has_others() const;
    /// The types of the others, VTK's numbers.
    std::vector<std::uint8_t> other_types() const;

private:
    bool is_refined(std::uint8_t type) const;
    bool is_contoured(std::uint8_t type) const;
    isotet::Array contoured_types(const isotet::Array& types) const;
    void share_faces(vtkUnstructuredGrid* grid);
    isotet::Result<void> leave_out_ghosts(const isotet::Array& points);

    SharedArray connectivity_, offsets_, types_, faces_, face_places_, ghosts_;
    isotet::Cells all_, own_;
    isotet::Array marks_;
    std::bitset<256> kinds_;
    bool has_ghosts_ = false, has_others_cells_ = false, changed_ = true, refines_ = false;
};

} // namespace isotet_vtk
