// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/first_input.hpp"

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/number_text.hpp>

namespace isotet::view {

namespace {

/// What the page shows first where no field is named.
void choose_first_view(const FirstView& first, const ViewStart& start, ViewState& state, jobs::Caller& caller) {
    const bool isovalues_are_given = !start.isovalues.empty() || !start.shares.empty();
    FirstView shown = first;
    if (isovalues_are_given || start.isosurfaces_always) shown.draw = FirstDraw::isosurfaces;
    take_first_view(shown, state);
    caller.note(first.field.empty() ? std::string("no field varies that would be contoured: this is the grid")
                : shown.draw == FirstDraw::isosurfaces ? jobs::note_of_field(first)
                                                       : jobs::note_of(first));
}

/// Shares are those of all cells.
Result<void> add_shares(const ViewStart& start, const ReadResult& read, const jobs::GridSource& source,
                        jobs::Caller& caller, const Run& run, ViewState& state) {
    if (start.shares.empty()) return {};
    const Result<Grid> grid = read.cells_in_file ? source.read({}, read.step, caller, run) : read.grid;
    if (!grid) return grid.error();
    const Result<PointField> field = find_field(*grid, state.field, {}, run);
    if (!field) return field.error();
    const auto found = isovalues_at(*grid, *field, start.shares, run);
    if (!found) return found.error();
    state.isovalues.insert(state.isovalues.end(), found->begin(), found->end());
    return {};
}

/// Isovalues that no surface can have were not meant.
Result<void> note_outside(const ViewStart& start, const Array& values, const std::string& name, bool has_steps,
                          jobs::Caller& caller, const Run& run) {
    const auto statistics = statistics_of(values, run);
    if (!statistics) return statistics.error();
    if (statistics->empty() || !(statistics->front().lower <= statistics->front().upper)) return {};
    const double lower = statistics->front().lower, upper = statistics->front().upper;
    const auto is_outside = [&](double value) { return value < lower || value > upper; };
    std::string outside;
    std::size_t count = 0;
    for (const double value : start.isovalues)
        if (is_outside(value)) outside += (count++ == 0 ? "" : ", ") + jobs::shortest(value);
    if (count == 0) return {};
    std::string sentence = fmt::format("{} {} outside the range of '{}', {} to {}: no surface is there{}", outside,
                                       count == 1 ? "is" : "are", name, jobs::rounded(lower), jobs::rounded(upper),
                                       has_steps ? " at this step" : "");
    if (start.decimal_comma && !is_outside(*start.decimal_comma))
        sentence += fmt::format("; did you mean {}? Commas separate isovalues", jobs::shortest(*start.decimal_comma));
    caller.note(sentence);
    return {};
}

/// All fields.
Result<ReadResult> read_step(FirstCells cells, const jobs::GridSource& source, std::size_t step, jobs::Caller& caller,
                             const Run& run) {
    jobs::FieldsToRead all;
    all.blocks = true;
    if (cells == FirstCells::some) return source.read_some(all, step, caller, run);
    Result<Grid> grid = source.read(all, step, caller, run);
    if (!grid) return grid.error();
    ReadResult result;
    result.grid = *std::move(grid);
    result.step = step;
    return result;
}

} // namespace

jobs::ChoiceWish view_wish(jobs::Steps steps, const jobs::FieldChoice& field, const std::string& color_by) {
    return {steps, field, {color_by}, {}, false};
}

Result<void> check_view_fields(jobs::GridSource& source, const jobs::ChoiceWish& wish, const jobs::GridOptions& grid,
                               jobs::Caller& caller) {
    const auto look = look_at_step_with_fields(source, grid, wish, caller);
    if (!look) return look.error();
    if (!wish.field.name.empty())
        if (const Result<jobs::FoundField> found = choose_field(source, wish.field); !found) return found.error();
    for (const std::string& name : wish.others)
        if (!name.empty())
            if (const Result<jobs::FoundField> found = choose_field(source, {name, false}); !found)
                return found.error();
    return {};
}

Result<ViewerInput> read_first_input(const ViewStart& start, jobs::GridSource& source, NoteKeeper& caller,
                                     const Run& run) {
    const Result<jobs::FirstChoice> choice =
        choose_first(source, start.grid, view_wish(jobs::Steps::one, start.field, start.color_by), caller, run);
    if (!choice) return choice.error();
    const std::size_t step = choice->steps.front();
    const std::vector<FieldInfo> fields = source.info().fields;
    Result<ReadResult> read = read_step(start.cells, source, step, caller, run);
    if (!read) return read.error();
    const Grid& grid = read->grid;
    ViewerInput input;
    if (read->cells_in_file) {
        Result<PackedFile> file = PackedFile::open(start.grid.file, {start.memory.value_or(0)}, run);
        if (!file) return file.error();
        input.packed = *std::move(file);
        input.cells = *read->cells_in_file;
    }
    input.state.field = start.field.name;
    if (input.state.field.empty()) choose_first_view(first_view(grid, fields), start, input.state, caller);
    input.state.isovalues = start.isovalues;
    if (!start.isovalues.empty())
        if (const Result<PointField> field = find_field(grid, input.state.field, {}, run); field && !field->averaged)
            if (Result<void> told =
                    note_outside(start, field->values, input.state.field, source.info().times.size() > 1, caller, run);
                !told)
                return told.error();
    if (Result<void> added = add_shares(start, *read, source, caller, run, input.state); !added) return added.error();
    if (!start.color_by.empty()) input.state.color_by = start.color_by;
    input.regions = read->info.regions.empty() ? source.region_names() : read->info.regions;
    input.times = source.info().times;
    if (input.times.size() > 1) input.state.step = step;
    if (is_of_reservoirs(source.info().format)) input.state.stretch = default_stretch(grid.points);
    input.notes = caller.notes_so_far();
    input.grid = std::move(read->grid);
    return input;
}

} // namespace isotet::view
