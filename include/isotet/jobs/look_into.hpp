// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is in a grid file: what `isotet info` does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/first_view.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>

namespace isotet::jobs {

struct InfoJob {
    GridOptions grid;
    std::vector<std::string> other_outputs; ///< of the caller: no file of the grid may be one
    bool survey = false;                    ///< also what takes longer than reading
    bool all_steps = false;                 ///< ranges of fields over all time steps: each is read
    bool each_block = false;                ///< cell types and ranges of each block, which is read by itself
    bool heads = false;                     ///< only what the file announces: no values are read, nothing is counted
    FieldChoice field;                      ///< of the chart; empty: that of first_view()
    std::optional<std::uint64_t> chart;     ///< steps; nothing: no chart
};

struct FieldSummary {
    std::string name;
    Association association = Association::point;
    ScalarType type = ScalarType::float32;
    std::vector<ComponentStatistics> components;
};

/// One of FileInfo::blocks.
struct BlockSummary {
    std::map<std::uint8_t, std::uint64_t> cells_by_type; ///< VTK's number -> cells
    std::vector<FieldSummary> fields;
};

/// Scalar fields that are the components of one vector or tensor.
struct VectorSummary {
    ComponentGroup group;
    Association association = Association::point;
};

/// What it costs to contour a field without refining curved cells.
struct CurvedCost {
    std::string field;
    double bound = 0; ///< of the error, in the unit of the field
    double share = 0; ///< of the field's range
};

struct CurvedSummary {
    std::uint64_t cells = 0, left_out = 0;
    std::vector<CurvedCost> costs; ///< of scalar point fields
};

/// Area and volume of a field's isosurfaces.
struct FieldChart {
    std::string field;
    ContourSpectrum spectrum;
};

/// With InfoJob::heads: `file`, `step` and `vectors` alone.
struct GridSummary {
    FileInfo file;
    std::size_t step = 0;
    ScalarType point_type = ScalarType::float32;
    GridReport report;
    bool surveyed = false; ///< whether faces and places were counted, too
    std::uint64_t hanging_points = 0; ///< if so: places in a face or edge of a larger cell
    HangingReport hanging;            ///< if so: which of them extraction closes
    std::size_t steps = 1;            ///< of `fields`: one, or all of the file
    std::vector<FieldSummary> fields;
    std::vector<BlockSummary> blocks; ///< with InfoJob::each_block: one for each of `file`
    std::vector<VectorSummary> vectors;
    FirstView first; ///< what render and view show, and extract contours, where no field is named
    CurvedSummary curved;
    std::optional<FieldChart> chart;
};

/// Reads a step whole, with InfoJob::all_steps the others and with InfoJob::each_block its blocks one by one, and counts; with
/// InfoJob::heads in time by the number of fields, blocks and files, for formats that have such heads (docs/formats.md).
/// Errors   as of reading; invalid_argument: a step or field that there is not; invalid_data: nothing to chart
Result<GridSummary> look_into(const InfoJob& job, Caller& caller);

} // namespace isotet::jobs
