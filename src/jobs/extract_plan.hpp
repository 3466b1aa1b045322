// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What extract_files() will do, decided and checked before anything large is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

struct ExtractPlan {
    OutputNames names{""};
    bool holds_fields = true; ///< the format of OUT
    std::string collection;   ///< a .pvd file for the series; empty: none
    std::vector<std::size_t> steps;
    FoundField field;
    std::optional<CarriedFields> carried; ///< nothing: all point fields, and all cell fields where all are read
    std::optional<FoundField> color;      ///< an expression that colours surfaces, where no field is called so
    FieldsToRead read;
    bool out_holds_fields = true, out_holds_cell_fields = true;
    std::optional<Region> touched;               ///< by the parts that are kept (find_touched())
    ContourOptions contour;                      ///< but for the device
    std::optional<ReadActiveCells> active_cells; ///< where others need not be read
};

/// Where no field is named, the job has the one that was chosen afterwards.
/// Errors   invalid_argument: OUT, a field, a step or a combination of options is wrong; invalid_data: no field varies
Result<ExtractPlan> plan_extract(ExtractJob& job, GridSource& source, Caller& caller);

/// Whether all time steps go into one file, which shows them one after another.
bool is_animated(const OutputNames& names);

/// Whether the names of outputs tell the steps of the plan apart, or need not.
Result<void> check_names(const ExtractJob& job, const ExtractPlan& plan, const FileInfo& info);

/// The collection of a series that ParaView opens; nothing where there is no series.
Result<std::string> plan_collection(const ExtractJob& job, const ExtractPlan& plan, Caller& caller);

/// Steps, and the field where none is named: the job has it afterwards.
Result<void> choose_first_of(ExtractJob& job, GridSource& source, ExtractPlan& plan, Caller& caller);

/// choose_fields(); of several steps a field may be in some only: in the first, mostly, else all are looked at.
Result<void> choose_fields_of_steps(const ExtractJob& job, GridSource& source, ExtractPlan& plan, Caller& caller);

/// Looks the fields of the plan up in what `source` was looked at for.
/// Errors   invalid_argument: a field is not there
Result<void> choose_fields(const ExtractJob& job, const GridSource& source, ExtractPlan& plan);

/// The isovalues to extract: those given and `shares` (snapped if asked to), --levels of the packed field's range, or its
/// middle; of the range of the other values where some stand for none.
/// Errors   invalid_data: levels of a field without a finite value
Result<std::vector<double>> choose_isovalues(const ExtractJob& job, const std::vector<double>& shares,
                                             const Array& field, const FieldReport& packed, const FillValues& fill,
                                             Caller& caller);

/// Whether surfaces that are written carry a cell field of the grid: one that parts touch need not be.
bool is_carried(const ExtractPlan& plan, const std::string& cell_field);

/// Whether the grid has the arrays of a field that is contoured.
bool has_arrays_of(const FoundField& field, const Grid& grid);

/// The fields of the plan, taken from the grid of one step, and the one that parts touch.
struct StepFields {
    std::vector<Field> point, cell;
};
Result<StepFields> carried_fields(const ExtractPlan& plan, const Grid& grid, const Run& run);

/// What all steps are expected to take, from a look at the first.
///
/// `kept`       part of the file's cells that was looked at
/// `together`   isovalues extracted in one pass
Estimate predict(const ExtractJob& job, const ExtractPlan& plan, const FieldSample& sample, double kept,
                 std::size_t together);

/// An error of reading all cells; where memory ran out, with what would make active ones do.
Error with_cheaper_plan(Error error, const ExtractJob& job, const ExtractPlan& plan);

/// The values that a solid has, of one isovalue.
SolidRange range_for(const SolidChoice& choice, double isovalue);

/// Files that must not be each other: `output` and those of the caller.
std::vector<std::string> with_others(const ExtractJob& job, const std::string& output);

} // namespace isotet::jobs
