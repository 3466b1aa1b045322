// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/clip_files.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <isotet/grid_file.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/write.hpp>

#include "base/stopwatch.hpp"
#include "jobs/extract_plan.hpp"
#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

class ClipRun {
public:
    ClipRun(const ClipJob& job, Caller& caller) : job_(job), caller_(caller) {}

    Result<void> run();
    ClipNumbers take_numbers() { return std::move(numbers_); }

private:
    Result<void> open();
    Result<void> plan();
    Result<std::optional<ContourInput>> load(std::size_t step);
    Result<void> clip_step(std::size_t step);
    Result<void> check_that_some_are_kept(const ClippedGrid& clipped) const;
    Result<void> write(const ClippedGrid& clipped, std::size_t step, ClipStepNumbers& numbers);
    ContourOptions options() const;

    const ClipJob& job_;
    Caller& caller_;
    ExtractJob chosen_; ///< what planning takes: fields, steps, names of outputs
    std::optional<GridSource> source_;
    ExtractPlan plan_;
    std::uint64_t emptied_ = 0; ///< cells that were not chosen
    bool refines_ = true;
    std::vector<CollectionEntry> series_;
    std::vector<std::size_t> skipped_; ///< steps without the field
    ClipNumbers numbers_;
};

Result<void> ClipRun::open() {
    if (!job_.range) return refusal("nothing says which cells to keep: `above`, `below` or `between` does");
    if (auto known = check_placeholders(job_.out, {"{time}", "{step}"}); !known) return known;
    if (!job_.out.empty())
        if (const auto format = format_for_writing(job_.out, Writes::grid, job_.compression); !format)
            return format.error();
    chosen_.grid = job_.grid;
    chosen_.all_steps = job_.all_steps;
    chosen_.out = job_.out;
    chosen_.other_outputs = job_.other_outputs;
    chosen_.field = job_.field;
    chosen_.with = job_.with;
    const std::string fixed = OutputNames(job_.out).fixed() ? job_.out : "";
    if (auto paths = check_output_paths({job_.grid.file}, with_others(chosen_, fixed)); !paths) return paths;
    Result<GridSource> source = GridSource::open(job_.grid, caller_);
    if (!source) return source.error();
    source_ = *std::move(source);
    return check_output_paths(source_->info().files, with_others(chosen_, fixed));
}

Result<void> ClipRun::plan() {
    plan_.names = OutputNames(job_.out);
    plan_.steps.assign(job_.all_steps ? std::max<std::size_t>(source_->info().times.size(), 1) : 1, 0);
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) plan_.steps[i] = i;
    if (auto names = check_names(chosen_, plan_, source_->info()); !names) return names;
    Result<std::string> collection = plan_collection(chosen_, plan_, caller_);
    if (!collection) return collection.error();
    plan_.collection = *std::move(collection);
    if (auto chosen = choose_first_of(chosen_, *source_, plan_, caller_); !chosen) return chosen;
    if (plan_.steps.size() > 1)
        if (auto looked = source_->look_at_steps(plan_.steps, caller_); !looked) return looked;
    if (auto chosen = choose_fields_of_steps(chosen_, *source_, plan_, caller_); !chosen) return chosen;
    if (!plan_.carried) plan_.read.cell.reset();
    numbers_.grid = job_.grid.file;
    numbers_.format = source_->info().format;
    numbers_.range = *job_.range;
    return {};
}

ContourOptions ClipRun::options() const {
    ContourOptions out = job_.contour;
    out.surfaces = plan_.steps.size();
    out.source_cells = true;
    if (!refines_) out.refine.reset();
    return out;
}

/// Nothing: of several steps, this one does not have the field.
Result<std::optional<ContourInput>> ClipRun::load(std::size_t step) {
    const core::Stopwatch reading;
    caller_.detail(fmt::format("reading step {}", step));
    Result<ReadResult> read = source_->read_numbered(plan_.read, step, caller_);
    if (!read) return read.error();
    std::optional<GridPart> part = part_of(*read, false, {});
    Grid* const grid = &read->grid;
    if (plan_.steps.size() > 1 && !has_arrays_of(plan_.field, *grid)) return std::optional<ContourInput>();
    Result<PointField> field = find_chosen(*grid, plan_.field.name, chosen_.field, caller_);
    if (!field) return field.error();
    Result<StepFields> fields = carried_fields(plan_, *grid, caller_.run());
    if (!fields) return fields.error();
    numbers_.read_seconds += reading.seconds();
    numbers_.cells = grid->cells.count();
    emptied_ = emptied_cells(*grid, job_.grid, caller_.run());
    numbers_.averaged = field->averaged;
    refines_ = !field->averaged || job_.refine_averaged;
    if (const std::string note = cells_left_out_note(*grid, caller_.run()); !note.empty()) caller_.note(note);
    grid->point_fields = grid->cell_fields = {};
    std::erase_if(fields->cell, [](const Field& carried) { return carried.name == "source_cell"; });
    return std::optional(ContourInput{std::move(*grid), *std::move(field), std::move(fields->point),
                                      std::move(fields->cell), std::move(part)});
}

Result<void> ClipRun::check_that_some_are_kept(const ClippedGrid& clipped) const {
    if (clipped.grid.cells.count() > 0 || job_.allow_empty || plan_.steps.size() > 1) return {};
    const FieldReport& field = clipped.contour.field;
    if (!(field.lower <= field.upper))
        return Error{ErrorCode::invalid_data, fmt::format("field '{}' has no finite value: no cell is kept; "
                                                          "`allow_empty` writes that nevertheless",
                                                          field.name)};
    return Error{ErrorCode::invalid_data,
                 fmt::format("no cell has values of '{}' in the range that was asked for; the field has {} to {}; "
                             "`allow_empty` writes that nevertheless",
                             field.name, shortest(field.lower), shortest(field.upper))};
}

Result<void> ClipRun::write(const ClippedGrid& clipped, std::size_t step, ClipStepNumbers& numbers) {
    if (job_.out.empty()) return {};
    const core::Stopwatch writing;
    Grid grid = clipped.grid;
    grid.cell_fields.push_back({"source_cell", clipped.source_cells});
    if (!clipped.edge_ends.empty()) {
        grid.point_fields.push_back({"edge_ends", clipped.edge_ends});
        grid.point_fields.push_back({"edge_weights", clipped.edge_weights});
    }
    const std::size_t all = std::max<std::size_t>(source_->info().times.size(), 1);
    numbers.file = plan_.names.name({0, numbers.time, step, all});
    if (!plan_.names.fixed()) {
        std::vector<std::string> others = source_->info().files;
        others.insert(others.end(), {job_.grid.file, plan_.collection});
        others.insert(others.end(), job_.other_outputs.begin(), job_.other_outputs.end());
        if (auto path = check_output_paths(others, {numbers.file}); !path) return path;
    }
    caller_.detail("writing " + numbers.file);
    const auto written = write_grid(grid, numbers.file, {.compression = job_.compression}, caller_.run());
    if (!written) return written.error();
    caller_.notes(written->notes);
    numbers.write_seconds = writing.seconds();
    series_.push_back({numbers.time.value_or(static_cast<double>(series_.size())), 0, numbers.file});
    return {};
}

Result<void> ClipRun::clip_step(std::size_t step) {
    Result<std::optional<ContourInput>> loaded = load(step);
    if (!loaded) return keep_broken(step, loaded.error(), plan_.steps.size(), numbers_.broken_steps);
    if (!*loaded) {
        skipped_.push_back(step);
        return {};
    }
    ContourInput input = **std::move(loaded);
    const core::Stopwatch clipping;
    const Result<SolidRange> range = with_shares(*job_.range, job_.shares, input.grid, input.field, caller_.run());
    if (!range) return range.error();
    numbers_.range = *range;
    caller_.detail("clipping");
    Result<Clipper> clipper = Clipper::create(std::move(input), options(), caller_.run());
    if (!clipper) return clipper.error();
    Result<ClippedGrid> clipped = clipper->clip(*range, job_.clip, caller_.run());
    if (!clipped) return clipped.error();
    caller_.notes(clipped->contour.notes);
    numbers_.field = clipped->contour.field;
    numbers_.method = clipped->contour.method;
    numbers_.cells_left_out = clipped->contour.cells_left_out - std::min(clipped->contour.cells_left_out, emptied_);
    numbers_.refinement = clipped->contour.refinement;
    if (auto some = check_that_some_are_kept(*clipped); !some) return some;
    ClipStepNumbers numbers;
    numbers.time = time_of(source_->info(), step);
    numbers.points = clipped->grid.points.tuples();
    numbers.cells = clipped->grid.cells.count();
    numbers.whole_cells = clipped->whole_cells;
    numbers.cut_cells = clipped->cut_cells;
    numbers.polyhedra = clipped->polyhedra;
    numbers.flat_pieces = clipped->flat_pieces;
    numbers.folded_pieces = clipped->folded_pieces;
    if (clipped->folded_pieces > 0)
        caller_.note(fmt::format("no point sees all faces of {} of the pieces that were split: some of their cells are "
                                 "inside out",
                                 grouped(clipped->folded_pieces)));
    for (const Extraction& surface : clipped->contour.surfaces) numbers.tied_points += surface.report.tied_points;
    numbers.clip_seconds = clipping.seconds();
    if (auto written = write(*clipped, step, numbers); !written) return written;
    numbers_.steps.push_back(std::move(numbers));
    return {};
}

Result<void> ClipRun::run() {
    if (auto opened = open(); !opened) return opened;
    if (auto planned = plan(); !planned) return planned;
    for (const std::size_t step : plan_.steps) {
        if (caller_.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (auto clipped = clip_step(step); !clipped) return clipped;
    }
    if (skipped_.size() + numbers_.broken_steps.size() == plan_.steps.size())
        return numbers_.broken_steps.empty() ? source_->no_such_field(plan_.field.name)
                                             : numbers_.broken_steps.front().error;
    if (!skipped_.empty()) caller_.note(skipped_note(plan_.field.name, skipped_, plan_.steps.size()));
    if (plan_.collection.empty()) return {};
    numbers_.collection = plan_.collection;
    return write_collection(series_, plan_.collection, caller_.run());
}

} // namespace

Result<ClipNumbers> clip_files(const ClipJob& job, Caller& caller) {
    ClipRun run(job, caller);
    if (Result<void> done = run.run(); !done) return done.error();
    return run.take_numbers();
}

} // namespace isotet::jobs
