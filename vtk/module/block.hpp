// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One vtkUnstructuredGrid, over all executions of a filter: its session and what is shared with it.
#pragma once

#include <map>
#include <optional>
#include <string>

#include <isotet/contour.hpp>
#include <isotet/pieces.hpp>
#include <isotet/solid.hpp>

#include "arrays.hpp"
#include "cells.hpp"
#include "wishes.hpp"

class vtkPolyData;
class vtkUnstructuredGrid;

namespace isotet_vtk {

class Block {
public:
    /// Looks at the grid as it is now.
    /// Errors   invalid_data, invalid_argument: arrays do not fit together
    isotet::Result<void> take(vtkUnstructuredGrid* grid, vtkDataArray* scalars, const Wishes& wishes);

    /// Whether what a frame depends on is new since the last survey(), and whether cells or numbers of points are.
    bool is_new() const { return is_new_; }
    bool is_renumbered() const { return is_renumbered_; }
    bool has_global_ids() const { return !numbers_.empty(); }
    bool has_contoured() const { return cells_.has_contoured(); }
    const SharedCells& cells() const { return cells_; }

    /// As survey_piece(), of the block without its ghost cells: the contoured field first, the carried ones by their
    /// names. Kept while nothing is new.
    isotet::Result<isotet::Survey> survey(const isotet::Run& run);

    /// Surfaces of the wished isovalues, written to `out` with the arrays that vtkContourFilter gives.
    ///
    /// `frame`          of all blocks of all ranks; nothing: this is the only block
    /// `with_numbers`   global ids of points decide where numbers do
    isotet::Result<void> extract(const std::optional<isotet::Frame>& frame, bool with_numbers, const isotet::Run& run,
                                 vtkPolyData* out);

    /// The cells of one solid of the wishes, written to `out` with all arrays of the grid.
    isotet::Result<void> clip(bool polyhedra, const isotet::Run& run, vtkUnstructuredGrid* out);

    /// Lets go of VTK's arrays, which only take() may give back.
    void release();

    /// Of the last extract(): what had to be done, by which method, the bytes of the packed grid, and the
    /// seconds that the library extracted.
    isotet::ContourUpdate update() const { return update_; }
    isotet::Method method() const { return method_; }
    std::uint64_t packed_bytes() const;
    double field_bound() const { return field_bound_; } ///< of curved cells
    const std::vector<std::string>& notes() const { return notes_; }
    double extract_seconds() const { return extract_seconds_; }

private:
    isotet::ContourInput contour_input(bool with_numbers) const;
    isotet::Result<isotet::Solids> solids(const std::optional<isotet::Frame>& frame, bool with_numbers,
                                          const isotet::Run& run) const;
    isotet::Result<void> extract_solids(const std::optional<isotet::Frame>& frame, bool with_numbers,
                                        const isotet::Run& run, vtkPolyData* out);
    isotet::Result<void> set(const std::optional<isotet::Frame>& frame, bool with_numbers, const isotet::Run& run);

    SharedCells cells_;
    SharedArray points_, field_, global_ids_;
    std::map<std::string, SharedArray> carried_, carried_cells_;
    vtkSmartPointer<vtkUnstructuredGrid> grid_;
    vtkSmartPointer<vtkDataArray> scalars_;
    isotet::Grid input_; ///< without ghost cells
    isotet::PointField contoured_;
    std::vector<isotet::Field> point_fields_, cell_fields_;
    isotet::Array numbers_;
    Wishes wishes_;

    bool is_new_ = true, is_renumbered_ = true;
    std::optional<isotet::Survey> survey_;
    std::optional<isotet::Contour> session_;
    isotet::ContourUpdate update_ = isotet::ContourUpdate::grid;
    isotet::Method method_ = isotet::Method::direct;
    double extract_seconds_ = 0, field_bound_ = 0;
    std::vector<std::string> notes_;
};

} // namespace isotet_vtk
