// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/check_files.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <isotet/linear_cells.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/read.hpp>

#include "jobs/surface_record.hpp"
#include "jobs/refuse.hpp"
#include "jobs/step_choice.hpp"

namespace isotet::jobs {

namespace {

/// The grid that a surface came from, with the field whose holes count.
struct Origin {
    Grid grid;
    std::optional<PointField> field;
};

/// The field of which the tets with values count; no name: all count.
FieldChoice field_of(const CheckJob& job, const FileInfo& grid) {
    FieldChoice field = job.field;
    if (field.name.empty() && grid.fields.size() == 1) field.name = grid.fields.front().name;
    return field;
}

/// The step of the time of a surface: its own number where that has it, else one that is printed as it is.
Result<std::size_t> step_of(const SurfaceTime& surface, const std::vector<double>& times, const CheckJob& job) {
    if (surface.step < times.size() && times[surface.step] == surface.time) return surface.step;
    if (const auto step = step_at(times, surface.time)) return step;
    const auto printed = [](double time) { return fmt::format("{:.6g}", time); };
    for (std::size_t step = 0; step < times.size(); ++step)
        if (printed(times[step]) == printed(surface.time)) return step;
    return refusal("{} is of time {}, but {} has {} times: {}; `time` and `step` choose one of them", job.surface,
                   shortest(surface.time), job.grid.file, times.size(), list_of(times));
}

/// Looks at the step that is asked for, else that of which the surface is, where its file tells, else the one that extract
/// takes.
Result<std::size_t> choose_step_of(const CheckJob& job, const SurfaceFile& file, GridSource& source, Caller& caller) {
    const std::vector<double> times = source.info().times;
    const auto time = find_time_record(file.field_data);
    if (time && times.size() > 1 && !job.grid.time && !job.grid.step) {
        const Result<std::size_t> step = step_of(*time, times, job);
        if (!step) return step;
        if (auto looked = source.look_at_steps({*step}, caller); !looked) return looked.error();
        caller.note(
            fmt::format("the file has {} time steps: step {}, time {}, was taken, of which the surface is; `time` "
                        "and `step` choose another",
                        times.size(), *step, shortest(times[*step])));
        return step;
    }
    ChoiceWish wish{Steps::one, field_of(job, source.info()), {}};
    if (wish.field.name.empty()) {
        const auto steps = source.choose_steps(wish.steps, caller);
        return steps ? Result<std::size_t>(steps->front()) : steps.error();
    }
    wish.needs_view = false;
    const auto choice = choose_first(source, job.grid, wish, caller, caller.run());
    if (!choice) return choice.error();
    return choice->steps.front();
}

Result<Origin> read_origin(const CheckJob& job, const SurfaceFile& file, Caller& caller) {
    Result<GridSource> source = GridSource::open(job.grid, caller);
    if (!source) return source.error();
    if (auto paths = check_output_paths(source->info().files, job.other_outputs); !paths) return paths.error();
    const Result<std::size_t> step = choose_step_of(job, file, *source, caller);
    if (!step) return step.error();
    FieldsToRead fields{std::vector<std::string>{}, std::vector<std::string>{}};
    std::optional<FoundField> found;
    if (!job.field.name.empty() || source->info().fields.size() == 1) {
        Result<FoundField> chosen = choose_field(*source, job.field);
        if (!chosen) return chosen.error();
        fields = {chosen->point, chosen->cell};
        found = *std::move(chosen);
    } else if (!source->info().fields.empty()) {
        caller.note(
            "no field was named with `grid`: every tet counts, also where the field has no data; `field` names one");
    }
    Result<Grid> grid = source->read(fields, *step, caller);
    if (!grid) return grid.error();
    Origin origin{*std::move(grid), std::nullopt};
    if (!found) return origin;
    Result<PointField> field = find_chosen(origin.grid, found->name, job.field, caller);
    if (!field) return field.error();
    origin.field = *std::move(field);
    return origin;
}

/// What a surface of several isovalues tells of them.
std::vector<double> isovalues_of(const Surface& surface) {
    std::vector<double> out;
    for (const Field& field : surface.cell_fields) {
        if (field.name != "isovalue" || field.values.components() != 1) continue;
        for (std::size_t i = 0; i < field.values.tuples(); ++i)
            if (const double value = field.values.at(i); out.empty() || out.back() != value) out.push_back(value);
    }
    std::ranges::sort(out);
    const auto repeated = std::ranges::unique(out);
    out.erase(repeated.begin(), repeated.end());
    return out;
}

bool is_default(const RefineOptions& options) {
    const RefineOptions none;
    return options.tolerance == none.tolerance && options.relative_tolerance == none.relative_tolerance &&
           options.geometry_tolerance == none.geometry_tolerance && options.distance == none.distance;
}

bool names_isovalues(const CheckJob& job) { return !job.isovalues.empty() || !job.shares.empty(); }

/// The grid with its curved cells refined as for the surface, where they were.
Result<Origin> refined_origin(Origin origin, const CheckJob& job, const SurfaceFile& file, const Run& run) {
    if (!job.contour.refine || !origin.field || !has_curved_cells(origin.grid.cells)) return origin;
    const std::optional<RefineOptions> recorded = find_refinement_record(file.field_data);
    if (origin.field->averaged && !job.refine_averaged && !recorded) return origin;
    RefineOptions options = recorded && is_default(*job.contour.refine) ? *recorded : *job.contour.refine;
    if (names_isovalues(job)) {
        const auto found = isovalues_at(origin.grid, *origin.field, job.shares, run);
        if (!found) return found.error();
        options.isovalues = job.isovalues;
        options.isovalues.insert(options.isovalues.end(), found->begin(), found->end());
    } else {
        options.isovalues = recorded ? recorded->isovalues : isovalues_of(file.surface);
    }
    if (options.isovalues.empty()) return origin;
    const auto linear = refine(origin.grid, *origin.field, options, run);
    if (!linear) return linear.error();
    auto values = linear->extend(origin.field->values, run);
    if (!values) return values.error();
    origin.field->values = *std::move(values);
    origin.grid = linear->grid;
    return origin;
}

/// Points that the grid does not have are of curved cells that were refined.
Error with_advice(Error error, const CheckJob& job, bool curved) {
    if (curved && error.code == ErrorCode::invalid_data && !names_isovalues(job))
        error.message += "; where curved cells were refined, and the file does not say how, `isovalue` and `tolerance` "
                         "must be given as for extracting, so that the points are derived again";
    return error;
}

/// All surfaces as one, of the format of the first.
Result<SurfaceFile> read_surfaces(const CheckJob& job, Caller& caller) {
    std::vector<std::string> inputs{job.surface, job.grid.file};
    inputs.insert(inputs.end(), job.more.begin(), job.more.end());
    if (Result<void> paths = check_output_paths(inputs, job.other_outputs); !paths) return paths.error();
    Result<SurfaceFile> file = read_surface(job.surface, {job.format}, caller.run());
    if (!file || job.more.empty()) return file;
    std::vector<Surface> parts{std::move(file->surface)};
    for (const std::string& more : job.more) {
        Result<SurfaceFile> other = read_surface(more, {job.format}, caller.run());
        if (!other) return other;
        parts.push_back(std::move(other->surface));
        std::ranges::move(other->notes, std::back_inserter(file->notes));
    }
    file->surface = join(parts, {});
    return file;
}

/// Where hanging points are to be closed, what is open at them is no surface to be called sound: at faces that are not
/// covered, and at curved cells. Where these are refined, what is open at their hanging points cannot be told from what
/// is open at the boundary.
/// `on_curved_cells`   there are such points
void blame_hanging_edges(SurfaceReport& report, bool on_curved_cells) {
    const std::uint64_t open = report.boundary_edges + report.inconsistent_edges;
    const std::uint64_t blamed = on_curved_cells ? open : std::min(open, report.blamed_edges + report.hanging_edges);
    if (blamed == report.blamed_edges) return;
    report.blamed_edges = blamed;
    report.sound = report.clean = false;
}

/// Triangles back to back count as walls also where each has vertices of its own, as where points of the grid were doubled.
Result<void> find_walls(const Surface& surface, SurfaceReport& report, const Run& run) {
    if (!report.closed || report.coincident_vertices == 0) return {};
    Surface bare;
    bare.positions = surface.positions;
    bare.triangles = surface.triangles;
    const Result<SurfaceReport> joined = check(bare, {.weld = true}, run);
    if (!joined) return joined.error();
    report.double_sheets = std::max(report.double_sheets, joined->double_sheets);
    return {};
}

Result<bool> has_hanging_points_on_curved_cells(const Grid& grid, const Run& run) {
    if (!has_curved_cells(grid.cells)) return false;
    const Result<ClosedGrid> found = close_hanging_points(grid, run);
    if (!found) return found.error();
    return found->report.points > 0;
}

} // namespace

Result<CheckedFiles> check_files(const CheckJob& job, Caller& caller) {
    const Result<SurfaceFile> file = read_surfaces(job, caller);
    if (!file) return file.error();
    caller.notes(file->notes);

    CheckOptions options;
    options.closed = job.closed;
    options.weld = file->format == "stl" || !job.more.empty(); // without vertex numbers that say what is the same
    std::optional<Origin> origin;
    bool curved = false, hangs = false;
    if (!job.grid.file.empty()) {
        if (file->surface.edge_ends.empty() && file->surface.vertex_count() > 0)
            return refusal("{} has no point array edge_ends, but `grid` needs it: isotet extract `edge_ends` writes it "
                           "into .vtp and .vtk",
                           job.surface);
        Result<Origin> read = read_origin(job, *file, caller);
        if (!read) return read.error();
        curved = has_curved_cells(read->grid.cells);
        const Result<bool> found = has_hanging_points_on_curved_cells(read->grid, caller.run());
        if (!found) return found.error();
        hangs = *found;
        options.conforming = curved && !hangs; // of refined cells only those near the isovalues are kept
        read = refined_origin(*std::move(read), job, *file, caller.run());
        if (!read) return read.error();
        origin = *std::move(read);
        options.grid = &origin->grid;
        options.split_cells = job.contour.split_cells;
        if (origin->field) options.field = &*origin->field;
    }
    Result<SurfaceReport> report = check(file->surface, options, caller.run());
    if (!report) return with_advice(report.error(), job, curved);
    if (auto found = find_walls(file->surface, *report, caller.run()); !found) return found.error();
    if (job.grid.hanging_points != HangingChoice::leave) blame_hanging_edges(*report, hangs);
    const bool passed = report->sound && (report->clean || !job.strict);
    return CheckedFiles{*std::move(report), file->format, passed};
}

} // namespace isotet::jobs
