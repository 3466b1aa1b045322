// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view_input.hpp"

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/number_text.hpp>

namespace isotet::cli {

namespace {

/// What the page shows first where no field is named.
void choose_first_view(const FirstView& first, const ViewStart& start, view::ViewState& state, Console& console) {
    const bool isovalues_are_given = !start.isovalues.empty() || !start.shares.empty();
    FirstView shown = first;
    if (isovalues_are_given || start.isosurfaces_always) shown.draw = FirstDraw::isosurfaces;
    view::take_first_view(shown, state);
    console.note(first.field.empty() ? std::string("no field varies that would be contoured: this is the grid")
                 : shown.draw == FirstDraw::isosurfaces ? note_of_field(first)
                                                        : note_of(first));
}

/// Shares are those of all cells.
Result<void> add_shares(const ViewStart& start, const ReadResult& read, const GridSource& source, Console& console,
                        const Run& run, view::ViewState& state) {
    if (start.shares.empty()) return {};
    const Result<Grid> grid = read.cells_in_file ? source.read({}, read.step, console, run) : read.grid;
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
                          Console& console, const Run& run) {
    const auto statistics = statistics_of(values, run);
    if (!statistics) return statistics.error();
    if (statistics->empty() || !(statistics->front().lower <= statistics->front().upper)) return {};
    const double lower = statistics->front().lower, upper = statistics->front().upper;
    const auto is_outside = [&](double value) { return value < lower || value > upper; };
    std::string outside;
    std::size_t count = 0;
    for (const double value : start.isovalues)
        if (is_outside(value)) outside += (count++ == 0 ? "" : ", ") + shortest(value);
    if (count == 0) return {};
    std::string sentence =
        fmt::format("{} {} outside the range of '{}', {} to {}: no surface is there{}", outside,
                    count == 1 ? "is" : "are", name, rounded(lower), rounded(upper), has_steps ? " at this step" : "");
    if (start.decimal_comma && !is_outside(*start.decimal_comma))
        sentence += fmt::format("; did you mean {}? Commas separate isovalues", shortest(*start.decimal_comma));
    console.note(sentence);
    return {};
}

/// All fields.
Result<ReadResult> read_step(FirstCells cells, const GridSource& source, std::size_t step, Console& console,
                             const Run& run) {
    FieldsToRead all;
    all.blocks = true;
    if (cells == FirstCells::some) return source.read_some(all, step, console, run);
    Result<Grid> grid = source.read(all, step, console, run);
    if (!grid) return grid.error();
    ReadResult result;
    result.grid = *std::move(grid);
    result.step = step;
    return result;
}

} // namespace

ChoiceWish view_wish(Steps steps, const FieldChoice& field, const std::string& color_by) {
    return {steps, field, {color_by}, {}, false};
}

Result<void> check_view_fields(GridSource& source, const ChoiceWish& wish, const GridOptions& grid, Console& console) {
    const auto look = look_at_step_with_fields(source, grid, wish, console);
    if (!look) return look.error();
    if (!wish.field.name.empty())
        if (const Result<FoundField> found = choose_field(source, wish.field); !found) return found.error();
    for (const std::string& name : wish.others)
        if (!name.empty())
            if (const Result<FoundField> found = choose_field(source, {name, false}); !found) return found.error();
    return {};
}

Result<view::ViewerInput> read_view_input(const ViewStart& start, GridSource& source, Console& console,
                                          const Run& run) {
    const Result<FirstChoice> choice =
        choose_first(source, start.grid, view_wish(Steps::one, start.field, start.color_by), console, run);
    if (!choice) return choice.error();
    const std::size_t step = choice->steps.front();
    const std::vector<FieldInfo> fields = source.info().fields;
    Result<ReadResult> read = read_step(start.cells, source, step, console, run);
    if (!read) return read.error();
    const Grid& grid = read->grid;
    view::ViewerInput input;
    if (read->cells_in_file) {
        Result<PackedFile> file = PackedFile::open(start.grid.file, {start.memory.value_or(0)}, run);
        if (!file) return file.error();
        input.packed = *std::move(file);
        input.cells = *read->cells_in_file;
    }
    input.state.field = start.field.name;
    if (input.state.field.empty()) choose_first_view(first_view(grid, fields), start, input.state, console);
    input.state.isovalues = start.isovalues;
    if (!start.isovalues.empty())
        if (const Result<PointField> field = find_field(grid, input.state.field, {}, run); field && !field->averaged)
            if (Result<void> told =
                    note_outside(start, field->values, input.state.field, source.info().times.size() > 1, console, run);
                !told)
                return told.error();
    if (Result<void> added = add_shares(start, *read, source, console, run, input.state); !added) return added.error();
    if (!start.color_by.empty()) input.state.color_by = start.color_by;
    input.regions = read->info.regions.empty() ? source.region_names() : read->info.regions;
    input.times = source.info().times;
    if (input.times.size() > 1) input.state.step = step;
    if (is_of_reservoirs(source.info().format)) input.state.stretch = default_stretch(grid.points);
    input.notes = console.noted_as_told();
    input.grid = std::move(read->grid);
    return input;
}

} // namespace isotet::cli
