// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where a grid comes from: a file, or memory ("make:kuhn:64:gyroid").
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/linear_cells.hpp>
#include <isotet/jobs/job.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

struct CellChoice;

/// What becomes of cells that have hanging points (hanging_points.hpp).
enum class HangingChoice : std::uint8_t {
    close,       ///< they list them
    interpolate, ///< and the points have the values of the larger cells
    leave,       ///< nothing: the surface is open there, which is noted
    not_sought,  ///< nothing, and none is looked for: where no surface is made
};

/// Which grid, and how it is read.
struct GridOptions {
    std::string file; ///< or "make:SHAPE:SIDE[:FIELDS]"
    std::string format;
    std::optional<double> time;
    std::optional<std::uint64_t> step;
    std::optional<double> merge_points; ///< tolerance
    MergedValues merge_values = MergedValues::lowest;
    HangingChoice hanging_points = HangingChoice::close;
    bool keep_pieces = false;
    bool allow_outside = false;
    bool patches = false; ///< ReadOptions::patches
    bool heads = false;   ///< the grid will not be read: what tells of it need not be kept
    std::string displace;
    std::vector<std::string> blocks;       ///< names or numbers; empty: all
    std::vector<std::string> cells;        ///< "FIELD=LIST" each: others become empty cells, and all keep their numbers
    std::vector<std::string> more_files;   ///< of further time steps
    std::vector<std::string> other_inputs; ///< files that the caller read: no output may be one
};

/// Names of the fields to read; nothing: all of them.
struct FieldsToRead {
    std::optional<std::vector<std::string>> point, cell;
    bool blocks = false; ///< the field of GridSource::cell_names() that no file has, too, where that can be
    friend bool operator==(const FieldsToRead&, const FieldsToRead&) = default;
};

/// What the ending of a name can be.
struct FileKinds {
    bool grid = false, surface = false;
};
FileKinds kinds_of(const std::string& file);

/// "'a', 'b', 'c' and 12 more".
std::string quoted_list(const std::vector<std::string>& names);

/// What a job takes for certain beside a grid that it holds.
struct BesideGrid {
    std::string what; ///< "packing"
    std::uint64_t bytes_a_point = 0;
};

/// How many time steps; which they are says choose_first().
enum class Steps { one, all };

/// A time step that cannot be read, among others that can.
struct BrokenStep {
    std::size_t step = 0;
    Error error;
};

class GridSource {
public:
    /// Finds out what the file holds, or what the grid to make will hold: of several steps the one that the options ask
    /// for, else the first that has the chosen blocks; of the head of a file that will not be read all of them, where it
    /// tells.
    static Result<GridSource> open(const GridOptions& options, Caller& caller);

    const FileInfo& info() const noexcept { return info_; }

    /// All of it is one packed file, GridOptions::file.
    bool is_packed_file() const { return info_.format == "isotet" && options_.more_files.empty(); }

    /// Whether cells of the format can go by without being kept: where they are counted, the head tells how many corners
    /// there are.
    bool may_stream() const { return info_.least.corners > 0 && !info_.least.all_cells; }

    /// From now on info() has the fields of all these steps. Reading one of them passes over those that it does not have, and
    /// looks for hanging points only where cells or points are not those of the step that was read before.
    Result<void> look_at_steps(const std::vector<std::size_t>& steps, Caller& caller);
    /// Of these steps those that could not be looked at.
    const std::vector<BrokenStep>& broken_steps() const noexcept { return broken_; }

    /// Whether a step that was looked at has a field of this name, or a component of it is meant; coordinates all have.
    bool has_field(std::size_t step, const std::string& name) const;

    /// The first step that can be read and has the chosen blocks and the fields that cells are chosen by.
    std::size_t first_step() const noexcept { return first_step_; }
    const std::string& why_first_step() const noexcept {
        return why_first_;
    } ///< ", ..." where that is not step 0; else empty

    /// Those that the options ask for, as choose_first() begins with; of all steps without those that do not have the chosen
    /// blocks or the fields that cells are chosen by, which are noted.
    Result<std::vector<std::size_t>> choose_steps(Steps steps, Caller& caller) const;

    /// Names of the point or the cell fields.
    std::vector<std::string> names(Association association) const;

    /// Names of cell fields, and "block" where the file has blocks and no such field: their numbers, which are read where they
    /// are asked for by name.
    std::vector<std::string> cell_names() const;

    /// Names of numbers of regions and of blocks.
    std::vector<RegionName> region_names() const;

    /// The error for a name that is no field's: those that there are, nearest first.
    Error no_such_field(const std::string& name) const;

    /// The first grid that is read, and what is taken beside it, must fit into memory as far as the head of the file tells: else
    /// none of its arrays is read.
    void require_beside(BesideGrid beside) { beside_ = std::move(beside); }

    /// A step that was read is given out by the next call that reads of the same step no more than these fields and cells.
    void keep(ReadResult read, const FieldsToRead& fields, std::size_t step);

    /// Reads one time step, empties cells that are not chosen, merges points if asked to, closes the grid at hanging points,
    /// and notes what the reader reports, and points that coincide.
    Result<Grid> read(const FieldsToRead& fields, std::size_t step, Caller& caller) const {
        return read(fields, step, caller, caller.run());
    }
    Result<Grid> read(const FieldsToRead& fields, std::size_t step, Caller& caller, const Run& run) const;

    /// The same, with the numbers that its cells have in the file (ReadResult::cell_numbers).
    Result<ReadResult> read_numbered(const FieldsToRead& fields, std::size_t step, Caller& caller) const {
        return read_cells(fields, step, CellsToRead::all, caller, caller.run());
    }

    /// The same, for looking at fields: of a packed file some cells, spread evenly (ReadResult::cells_in_file).
    Result<ReadResult> read_some(const FieldsToRead& fields, std::size_t step, Caller& caller, const Run& run) const;

    /// read_some(), but of files whose cells can be counted while they go by only a sample of these (SurveyedGrid::report).
    Result<SurveyedGrid> read_sample(const FieldsToRead& fields, std::size_t step, Caller& caller,
                                     const Run& run) const;

    /// The same, for what is counted and looked at alone: of the cells only counts and a sample, where that can be done. No
    /// hanging points are looked for then.
    Result<SurveyedGrid> read_surveyed(const FieldsToRead& fields, std::size_t step, Caller& caller) const;

    /// What read_surveyed() gave is given out by its next call for the same step.
    void keep(SurveyedGrid read, std::size_t step);

    /// The same; where that can be done, only the active cells (ReadResult::cells_in_file). Points are never merged and cells
    /// never chosen then; where some of the cells may have hanging points, all are read.
    Result<ReadResult> read_active(const FieldsToRead& fields, std::size_t step, const ReadActiveCells& active,
                                   Caller& caller) const;
    /// The grid of which read_active() gave some cells. Nothing is noted again.
    Result<ReadResult> read_the_rest(const FieldsToRead& fields, std::size_t step, const Run& run) const;

    /// A grid that was read, with empty cells in place of all but these.
    /// `cells`     as GridOptions::cells, all of which must hold
    /// `regions`   of the step; empty: region_names()
    /// Errors      invalid_argument: no cell is left, or `cells` has what the grid does not have
    Result<Grid> only_cells(Grid grid, const std::vector<std::string>& cells,
                            const std::vector<RegionName>& regions) const;

    /// One of info().blocks alone, with all fields, as it is in the file; nothing is noted.
    Result<Grid> read_block(const BlockInfo& block, std::size_t step, Caller& caller) const;

private:
    struct Kept;
    enum class CellsToRead : std::uint8_t { all, some };
    Result<ReadResult> read_cells(const FieldsToRead& fields, std::size_t step, CellsToRead cells, Caller& caller,
                                  const Run& run) const;
    Result<ReadResult> finish(ReadResult read, const FieldsToRead& fields, Caller& caller, const Run& run,
                              bool may_hang = true) const;
    Result<ReadResult> read_unclosed(const FieldsToRead& fields, std::size_t step, CellsToRead cells, Caller& caller,
                                     const Run& run) const;
    Result<void> open_made(const GridOptions& options);
    bool needs_all_cells(const FieldsToRead& fields) const;
    Result<void> take_choices();
    Result<void> find_choices(Caller& caller);
    bool names_blocks(const FieldsToRead& fields) const;
    Result<void> add_blocks(ReadResult& read, const FieldsToRead& fields) const;
    bool hangs_as_a_whole(const Grid& grid, const Run& run) const;
    Result<bool> choose(ReadResult& read, Caller* caller, const Run& run) const;
    void note_choice(std::uint64_t count, std::uint64_t of, Caller& caller) const;
    FieldsToRead and_of_choices(FieldsToRead fields) const;
    bool chooses_while_reading(const FieldsToRead& fields, const ReadActiveCells& active) const;
    Result<ReadResult> read_file(const FieldsToRead& fields, std::size_t step, ReadOptions options,
                                 const Run& run) const;

    void choose_fields(const FieldsToRead& fields, std::size_t step, ReadOptions& options) const;

    Result<void> look_at(std::size_t step, const Run& run);
    Result<FileInfo> inspect_later(const Error& error, Caller& caller);
    std::optional<FileInfo> inspect_first_with_blocks(Caller& caller);
    std::optional<FileInfo> inspect_first_sound(const Error& error, Caller& caller);
    bool lacks_blocks(std::size_t step, const Run& run) const;
    bool lacks_fields_of_choices(std::size_t step, const Run& run) const;
    Result<void> require_room_once(const FieldsToRead& fields, std::size_t step, bool all_cells) const;

    GridOptions options_;
    std::optional<MakeOptions> made_;
    std::shared_ptr<const Grid> surface_;                    ///< where the file is a surface: its triangles as cells
    std::shared_ptr<const std::vector<CellChoice>> choices_; ///< those of GridOptions::cells; null: none
    FileInfo info_;
    bool knows_blocks_ = false; ///< cell_names() has "block"
    std::size_t first_step_ = 0;
    std::string why_first_;
    std::vector<BrokenStep> broken_;
    std::optional<std::size_t> described_; ///< the step whose fields info_ has; nothing: of several
    std::map<std::size_t, std::vector<FieldInfo>> step_fields_; ///< of the steps that were looked at
    ReadOptions read_options_;
    std::shared_ptr<Kept> kept_; ///< shared by copies: given out once
    BesideGrid beside_;
    std::shared_ptr<std::atomic<bool>> has_room_ = std::make_shared<std::atomic<bool>>(); ///< nothing is asked any more
    std::shared_ptr<KnownClosing> closing_; ///< of the last of several steps; shared by copies
};

/// Keeps a step whose file, or what is in it, is wrong, so that the other steps are done; other errors come back, and those of
/// the only step.
Result<void> keep_broken(std::size_t step, Error error, std::size_t steps, std::vector<BrokenStep>& broken);

/// "cells left out, their types are not contoured: 12 triangle, 40 polyhedron"; empty when there are none. Empty
/// cells are not told of.
std::string cells_left_out_note(const Grid& grid, const Run& run);

/// How many cells GridOptions::cells left as empty ones.
std::uint64_t emptied_cells(const Grid& grid, const GridOptions& options, const Run& run);

/// The time of a step; nothing where the file knows no time.
std::optional<double> time_of(const FileInfo& info, std::size_t step);

} // namespace isotet::jobs
