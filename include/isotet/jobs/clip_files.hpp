// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a grid file to grids of the cells between isovalues: what `isotet clip` does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/solid.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/range_shares.hpp>
#include <isotet/write.hpp>

namespace isotet::jobs {

struct ClipJob {
    GridOptions grid;
    bool all_steps = false;
    std::string out;                        ///< with {time} and {step}; empty: only numbers
    std::vector<std::string> other_outputs; ///< of the caller: no grid may overwrite them
    FieldChoice field;
    std::optional<SolidRange> range;
    RangeShares shares; ///< of `range`, each time step its own
    ClipOptions clip;
    std::optional<std::vector<std::string>> with; ///< nothing: all fields
    ContourOptions contour{
        .refine = RefineOptions{}}; ///< of the isosurfaces; of these the job sets surfaces and source cells
    bool refine_averaged = false;   ///< as of ExtractJob
    bool allow_empty = false;       ///< also where no cell is in the range, which else is an error
    Compression compression = Compression::none;
};

/// One clipped grid.
struct ClipStepNumbers {
    std::optional<double> time;
    std::uint64_t points = 0, cells = 0;
    std::uint64_t whole_cells = 0, cut_cells = 0, polyhedra = 0; ///< as ClippedGrid
    std::uint64_t flat_pieces = 0, folded_pieces = 0;            ///< the same
    std::uint64_t tied_points = 0;                               ///< of both ends of the range
    double clip_seconds = 0, write_seconds = 0;
    std::string file; ///< empty without OUT
};

struct ClipNumbers {
    std::string grid, format;
    std::size_t cells = 0; ///< of the last step's grid
    std::uint64_t cells_left_out = 0;
    FieldReport field; ///< of the last step
    SolidRange range;
    bool averaged = false;
    Method method = Method::direct;
    double read_seconds = 0;
    std::vector<ClipStepNumbers> steps;
    std::vector<BrokenStep> broken_steps;
    std::string collection; ///< of a series; empty: none
    RefinementReport refinement = {};
};

/// Reads the steps one after another, clips, and writes each file as soon as it is complete. Besides the fields each has
/// the cell field "source_cell": int64, the cell of the grid that each comes from.
///
/// Memory   one step, and what is made of it
/// Errors   invalid_argument: what is asked for does not fit together or with the file; invalid_data: the range holds no
///          cell of the only step; as of reading, Clipper and writing
Result<ClipNumbers> clip_files(const ClipJob& job, Caller& caller);

} // namespace isotet::jobs
