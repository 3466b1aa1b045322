// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a grid file to a packed file: what `isotet pack` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/pack.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

struct PackJob {
    GridOptions grid;
    bool all_steps = false;
    bool append =
        false; ///< OUT is there, with the same cells: steps are added, as PackedWriter::append(), also where points
               ///< have moved. Fields, precision, source cells and gradients are those of the file
    std::string out;                        ///< .isotet
    std::vector<std::string> other_outputs; ///< of the caller: OUT may not be one
    std::vector<std::string>
        fields; ///< as choose_field_names(); empty: all point fields of one or three components, or if
                ///< there are none the one that is shown first. A vector is packed as its components
                ///< and its magnitude
    std::vector<std::string> cell_fields; ///< packed as they are; source cells are packed, too
    bool coordinates_do = false;          ///< where the grid has no field
    bool scalars_only = false; ///< no vectors, and what is left out is not noted: for callers that say it themselves
    bool cell_field = false;   ///< as FieldChoice
    PackOptions pack;
    std::optional<int>
        value_bits; ///< 1 to 24: values are rounded to multiples of the smallest power of two that is at least the
                    ///< range of the step's field over 2^value_bits; files compress better then
    std::optional<std::uint64_t> memory; ///< of the program while packing: what needs more lies in files
                                         ///< (scratch_memory.hpp). Nothing: half of what is free where a scratch
                                         ///< folder is named, else no limit
    std::string scratch;                 ///< the folder of these files; empty: that of OUT
};

/// What was done.
struct PackNumbers {
    std::string grid, format;
    std::size_t cells = 0;
    PackReport pack;
    std::vector<FieldReport> fields; ///< of the last step
    std::vector<double> rounded_by;  ///< with `value_bits`, of each field: the largest change of a value
    std::size_t steps = 1;
    std::uint64_t curved_cells = 0;  ///< that were split at their nodes
    std::uint64_t bytes = 0;         ///< of the file
    std::uint64_t scratch_bytes = 0; ///< at most in scratch files
    double read_seconds = 0, pack_seconds = 0, write_seconds = 0;
};

/// Packs the grid once and saves it with all fields and steps. Polyhedra and quadratic cells are made linear first, these
/// split at their nodes.
///
/// Guarantees   the same file for any limit of memory
/// Errors   invalid_argument: a field or step is not there, source cells are asked for of cells that are made linear;
///          invalid_data: a step has other cells than the first, or its points turn a cell over; as of reading, Contour and save_packed();
///          out_of_memory: `memory` is below the least; cannot_write: the scratch folder has no room
Result<PackNumbers> pack_file(const PackJob& job, Caller& caller);

} // namespace isotet::jobs
