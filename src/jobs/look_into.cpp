// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/look_into.hpp>

#include <algorithm>
#include <numeric>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/grid.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/linear_cells.hpp>

#include "fields/fill_values.hpp"
#include "fields/sampled_view.hpp"
#include "grid/patches.hpp"
#include "jobs/extract_notes.hpp"
#include "jobs/refuse.hpp"
#include "jobs/way_out.hpp"

namespace isotet::jobs {

namespace {

/// Which cells have a volume; nothing where all have.
std::vector<std::size_t> solid_cells(const Cells& cells) {
    if (cells.types.type() != ScalarType::uint8) return {};
    const auto types = cells.types.as<std::uint8_t>();
    if (std::ranges::all_of(types, core::has_a_volume)) return {};
    std::vector<std::size_t> solid;
    for (std::size_t cell = 0; cell < types.size(); ++cell)
        if (core::has_a_volume(types[cell])) solid.push_back(cell);
    return solid;
}

Array rows_of(const Array& values, const std::vector<std::size_t>& rows) {
    const std::size_t components = values.components();
    return values.visit([&]<class T>(std::span<const T> from) {
        std::vector<T> to;
        to.reserve(rows.size() * components);
        for (const std::size_t row : rows)
            to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(row * components),
                      from.begin() + static_cast<std::ptrdiff_t>((row + 1) * components));
        return Array::own(std::move(to), components);
    });
}

/// Of cell fields the values of cells with a volume: no surface has others.
Result<std::vector<FieldSummary>> summarize(const Grid& grid, const Run& run) {
    const std::vector<std::size_t> solid = solid_cells(grid.cells);
    std::vector<FieldSummary> summaries;
    for (const auto& [fields, association] :
         {std::pair{&grid.point_fields, Association::point}, {&grid.cell_fields, Association::cell}}) {
        for (const Field& field : *fields) {
            const bool in_part = association == Association::cell && !solid.empty();
            auto components = statistics_of(in_part ? rows_of(field.values, solid) : field.values, run);
            if (!components) return components.error();
            summaries.push_back({field.name, association, field.values.type(), *std::move(components)});
        }
    }
    return summaries;
}

void widen(ComponentStatistics& all, const ComponentStatistics& one) {
    all.lower = std::min(all.lower, one.lower);
    all.upper = std::max(all.upper, one.upper);
    all.not_a_number += one.not_a_number;
    all.infinite += one.infinite;
}

/// Ranges and counts become those of all time steps; fields that only others have come behind.
Result<void> add_other_steps(GridSource& source, GridSummary& summary, Caller& caller) {
    const auto all = source.choose_steps(Steps::all, caller);
    if (!all) return all.error();
    if (auto looked = source.look_at_steps(*all, caller); !looked) return looked;
    for (const std::size_t step : *all) {
        if (step == summary.step) continue;
        const Result<Grid> grid = source.read({}, step, caller);
        if (!grid) return grid.error();
        Result<std::vector<FieldSummary>> fields = summarize(*grid, caller.run());
        if (!fields) return fields.error();
        for (FieldSummary& field : *fields) {
            const auto same = std::ranges::find_if(summary.fields, [&](const FieldSummary& other) {
                return other.name == field.name && other.association == field.association &&
                       other.components.size() == field.components.size();
            });
            if (same == summary.fields.end()) summary.fields.push_back(std::move(field));
            else
                for (std::size_t c = 0; c < field.components.size(); ++c)
                    widen(same->components[c], field.components[c]);
        }
    }
    summary.steps = all->size();
    return {};
}

Result<void> add_blocks(const GridSource& source, GridSummary& summary, Caller& caller) {
    if (summary.file.blocks.empty()) {
        const std::vector<RegionName>& regions = summary.file.regions;
        return refusal("`each_block`: the file has no blocks{}",
                       regions.empty() ? ""
                                       : fmt::format(", only numbers of '{}', which `block` chooses, as '{}'",
                                                     regions.front().field, regions.front().name));
    }
    for (const BlockInfo& block : summary.file.blocks) {
        if (caller.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        const Result<Grid> grid = source.read_block(block, summary.step, caller);
        if (!grid) return grid.error();
        Result<std::vector<FieldSummary>> fields = summarize(*grid, caller.run());
        if (!fields) return fields.error();
        summary.blocks.push_back({count_cells_by_type(grid->cells, caller.run()), *std::move(fields)});
    }
    return {};
}

/// Vectors that are stored as three scalars.
std::vector<VectorSummary> vectors_of(const std::vector<FieldInfo>& fields) {
    std::vector<VectorSummary> vectors;
    for (const Association association : {Association::point, Association::cell}) {
        std::vector<std::string> scalars;
        for (const FieldInfo& field : fields)
            if (field.association == association && field.components == 1) scalars.push_back(field.name);
        for (ComponentGroup& group : component_groups(scalars)) vectors.push_back({std::move(group), association});
    }
    return vectors;
}

Result<GridSummary> look_at_heads(GridSource& source, const GridOptions& options, Caller& caller) {
    GridSummary summary;
    summary.file = source.info();
    summary.step = source.first_step();
    if (options.step || options.time) {
        const Result<StepLook> look = look_at_step_with_fields(source, options, {}, caller);
        if (!look) return look.error();
        summary.step = look->step;
    }
    summary.vectors = vectors_of(summary.file.fields);
    return summary;
}

/// Linear cells, where some are curved; nothing where none is.
Result<std::optional<LinearGrid>> linear_if_curved(const Grid& grid, const Run& run) {
    if (!has_curved_cells(grid.cells)) return std::optional<LinearGrid>();
    Result<LinearGrid> linear = linearize({grid.points, grid.cells, {}, {}}, {}, run);
    if (!linear) return linear.error();
    return std::optional(*std::move(linear));
}

/// survey() of a grid by the linear cells that it has, if it has curved ones.
Result<GridReport> survey_by(const std::optional<LinearGrid>& linear, const Grid& grid, const SurveyOptions& options,
                             const Run& run) {
    if (!linear) return survey(grid, options, run);
    Result<GridReport> report = survey(linear->grid, options, run);
    if (!report) return report;
    report->points = grid.points.tuples();
    report->cells = linear->user_cells;
    report->cells_left_out += linear->refinement.left_out;
    report->cells_by_type.clear();
    for (const auto& [type, count] : count_cells_by_type(grid.cells, run)) report->cells_by_type[type] = count;
    return report;
}

Result<CurvedSummary> look_at_curved_cells(const std::optional<LinearGrid>& linear, const Grid& grid,
                                           const std::vector<FieldSummary>& summaries, const Run& run) {
    CurvedSummary found;
    if (!linear) return found;
    found.cells = linear->refinement.curved_cells;
    found.left_out = linear->refinement.unknown_cells;
    for (std::size_t i = 0; i < grid.point_fields.size(); ++i) { // first in the summaries, in this order
        if (summaries[i].components.size() != 1) continue;
        const auto bound = field_bound(*linear, grid.point_fields[i].values, run);
        if (!bound) return bound.error();
        const double range = summaries[i].components[0].upper - summaries[i].components[0].lower;
        found.costs.push_back({summaries[i].name, *bound, range > 0 ? *bound / range : 0});
    }
    return found;
}

/// Over the range of the field, without numbers that stand for no value.
Result<ContourSpectrum> spectrum_of(const Grid& cells, const PointField& field, std::uint64_t steps, Caller& caller) {
    const Result<FillValues> fill = core::find_fill_values(field, caller.run());
    if (!fill) return fill.error();
    return contour_spectrum_over_range(cells, field, steps, fill->others, caller.run());
}

void note_fill_values(const std::vector<Field>& fields, const char* of, const FieldSummary* summaries, Caller& caller) {
    for (const Field& field : fields) {
        const std::vector<ComponentStatistics>& components = (summaries++)->components;
        if (components.size() != 1) continue;
        core::FillFinder finder;
        finder.add(field.values, {components[0].lower, components[0].upper});
        caller.note(fill_note(field.name, finder.find(), of));
    }
}

Result<std::optional<FieldChart>> make_chart(const InfoJob& job, const Grid& grid, const FirstView& first,
                                             Caller& caller) {
    if (!job.chart) return std::optional<FieldChart>();
    std::string name = job.field.name;
    if (name.empty()) name = first.field;
    if (name.empty())
        return Error{
            ErrorCode::invalid_data,
            "no field has two different values: there is nothing to chart; `field` x, y or z charts a coordinate"};
    Result<PointField> field = find_chosen(grid, name, job.field, caller);
    if (!field) return field.error();
    Grid cells = grid;
    const HangingChoice choice = job.grid.hanging_points;
    if (choice == HangingChoice::close || choice == HangingChoice::interpolate) { // as extraction does
        const Result<ClosedGrid> closed = close_hanging_points(grid, caller.run());
        if (!closed) return closed.error();
        caller.notes(closed->report.notes());
        if (choice == HangingChoice::interpolate) {
            Result<Array> values = closed->interpolated(field->values, caller.run());
            if (!values) return values.error();
            field->values = *std::move(values);
        }
        cells = closed->grid;
    }
    Result<ContourSpectrum> spectrum = spectrum_of(cells, *field, *job.chart, caller);
    if (!spectrum) return spectrum.error();
    return std::optional(FieldChart{name, *std::move(spectrum)});
}

/// Which count of hanging points is right. What extraction closes is known exactly; by places alone points near edges that
/// look at each other count, too, so these are taken where something stays open: faces that do not fit, doubled points.
std::uint64_t count_of(const HangingReport& closed, std::uint64_t by_places, const GridReport& grid) {
    if (closed.curved_cells > 0 && closed.open_faces == 0) return closed.points; // by places nodes count, too
    const bool knows_all = closed.points > 0 && closed.open_faces == 0 && grid.duplicate_points == 0;
    return knows_all ? closed.points : std::max(by_places, closed.points);
}

Result<SurveyedGrid> read_for(const ChoiceWish& wish, const GridSource& source, std::size_t step, Caller& caller) {
    if (wish.surveys) return source.read_surveyed({}, step, caller);
    Result<Grid> grid = source.read({}, step, caller);
    if (!grid) return grid.error();
    SurveyedGrid read;
    read.read.grid = *std::move(grid);
    return read;
}

Result<GridSummary> look_all(const InfoJob& job, Caller& caller) {
    if (auto paths = check_output_paths({job.grid.file}, job.other_outputs); !paths) return paths.error();
    GridOptions options = job.grid;
    options.hanging_points = HangingChoice::not_sought; // cells are counted as the file has them
    options.heads = job.heads;
    Result<GridSource> source = GridSource::open(options, caller);
    if (!source) return source.error();
    if (auto paths = check_output_paths(source->info().files, job.other_outputs); !paths) return paths.error();
    if (job.heads) return look_at_heads(*source, options, caller);
    ChoiceWish wish{Steps::one, job.field, {}};
    wish.also = {};
    wish.needs_view = false;
    wish.surveys = !job.survey && !job.chart && options.cells.empty() && job.field.name.empty();
    const Result<FirstChoice> choice = choose_first(*source, options, wish, caller, caller.run());
    if (!choice) return choice.error();
    GridSummary summary;
    summary.file = source->info();
    summary.step = choice->steps.front();
    const Result<SurveyedGrid> read = read_for(wish, *source, summary.step, caller);
    if (!read) return read.error();
    const Grid* const grid = &read->read.grid;
    summary.point_type = grid->points.type();
    const Result<std::optional<LinearGrid>> linear = linear_if_curved(*grid, caller.run());
    if (!linear) return linear.error();
    Result<GridReport> surveyed =
        read->report ? *read->report : survey_by(*linear, *grid, {.faces = job.survey}, caller.run());
    if (!surveyed) return surveyed.error();
    summary.report = *std::move(surveyed);
    summary.report.cells_left_out -=
        std::min<std::uint64_t>(summary.report.cells_left_out, emptied_cells(*grid, options, caller.run()));
    summary.surveyed = job.survey && summary.report.tets > 0;
    if (summary.surveyed) {
        const Result<std::uint64_t> hanging = count_hanging_points(*grid, caller.run());
        if (!hanging) return hanging.error();
        const Result<ClosedGrid> closed = close_hanging_points(*grid, caller.run());
        if (!closed) return closed.error();
        summary.hanging = closed->report;
        summary.hanging_points = count_of(closed->report, *hanging, summary.report);
    }
    Result<std::vector<FieldSummary>> fields = summarize(*grid, caller.run());
    if (!fields) return fields.error();
    summary.fields = *std::move(fields);
    note_fill_values(grid->point_fields, "point", summary.fields.data(), caller);
    note_fill_values(grid->cell_fields, "cell", summary.fields.data() + grid->point_fields.size(), caller);
    summary.vectors = vectors_of(describe_fields(*grid));
    summary.first = core::first_view_of_sample(*grid, source->info().fields, read->sampled);
    Result<CurvedSummary> curved = look_at_curved_cells(*linear, *grid, summary.fields, caller.run());
    if (!curved) return curved.error();
    summary.curved = *std::move(curved);
    Result<std::optional<FieldChart>> chart = make_chart(job, *grid, summary.first, caller);
    if (!chart) return chart.error();
    summary.chart = *std::move(chart);
    if (job.all_steps)
        if (auto added = add_other_steps(*source, summary, caller); !added) return added.error();
    if (job.each_block)
        if (auto added = add_blocks(*source, summary, caller); !added) return added.error();
    return summary;
}

} // namespace

Result<GridSummary> look_into(const InfoJob& job, Caller& caller) {
    return with_way_out("looking into the file", "`heads`, which says what the head of the file does,",
                        [&] { return look_all(job, caller); });
}

} // namespace isotet::jobs
