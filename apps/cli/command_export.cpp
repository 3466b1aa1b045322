// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet export`: a grid or isosurfaces in a page of one file.
#include <filesystem>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/jobs/range_shares.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "export_grid.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"
#include "output/stopwatch.hpp"
#include "output/text.hpp"
#include "view/export/saved_grid.hpp"
#include "view/export/saved_surfaces.hpp"
#include "view_input.hpp"

namespace isotet::cli {

namespace {

/// Who reads the page need not know in which folder the grid lay.
std::string name_without_folder(const std::string& file) {
    return valid_utf8(std::filesystem::path(file).filename().string());
}

Result<void> check_export(const ExportCommand& command, GridSource& source, Console& console) {
    if (ending_of(command.out) != ".html") return usage_error("OUT is '{}', but a page ends in .html", command.out);
    const bool has_shares = command.range_shares.lower || command.range_shares.upper; // which are known later
    if (!command.range.empty() &&
        (command.range.size() != 2 || (!has_shares && !(command.range[0] < command.range[1]))))
        return usage_error("--between takes two isovalues, the smaller one first, as in 0.1,0.5 or 5%v,95%v");
    if (Result<void> paths = check_output_paths(source.info().files, {command.out, command.common.json}); !paths)
        return paths;
    const Steps steps = command.all_steps ? Steps::all : Steps::one;
    return check_view_fields(source, view_wish(steps, command.field, command.color_by), command.grid, console);
}

/// The steps that are shown: where all are asked for, those that have the fields.
Result<std::vector<std::size_t>> steps_of(const ExportCommand& command, GridSource& source, Console& console) {
    const std::size_t count = source.info().times.size();
    if (!command.all_steps || count < 2) return std::vector<std::size_t>();
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::vector<std::string> names;
    for (const std::string* name : {&command.field.name, &command.color_by})
        if (!name->empty()) add_names(names, {*name});
    return steps_with_fields(source, std::move(all), names, console);
}

/// Nothing: that of the field.
Result<std::optional<ValueRange>> range_of(const ExportCommand& command, const view::ViewerInput& input,
                                           const Run& run) {
    if (command.range.empty()) return std::optional<ValueRange>();
    const SolidRange named{command.range[0], command.range[1]};
    if (!command.range_shares.lower && !command.range_shares.upper)
        return std::optional(ValueRange{named.lower, named.upper});
    const Result<PointField> field = find_field(input.grid, input.state.field, {}, run);
    if (!field) return field.error();
    const Result<SolidRange> range = with_shares(named, command.range_shares, input.grid, *field, run);
    if (!range) return range.error();
    return std::optional(ValueRange{range->lower, range->upper});
}

view::SavedSurfacesOptions options_of(const ExportCommand& command, const view::ViewerInput& input,
                                      const std::vector<std::size_t>& steps, std::optional<ValueRange> range) {
    view::SavedSurfacesOptions options;
    options.file = name_without_folder(command.grid.file);
    options.version = ISOTET_VERSION;
    options.isovalues = input.state.isovalues; // those that were named
    if (command.count) options.count = *command.count;
    options.range = range;
    options.refine = command.refine;
    if (command.max_size) options.max_bytes = *command.max_size;
    options.steps = steps;
    if (steps.empty()) options.steps = {input.state.step.value_or(0)};
    return options;
}

struct ExportTimes {
    double read = 0, extract = 0, write = 0;
};

std::string export_table(const ExportCommand& command, const view::SavedSurfaces& saved, std::size_t steps,
                         const ExportTimes& seconds) {
    Table table = facts();
    table.row({"grid", command.grid.file});
    table.row({"isosurfaces", fmt::format("{} from {} to {}", grouped(saved.isovalues.size()),
                                          rounded(saved.isovalues.front()), rounded(saved.isovalues.back()))});
    if (steps > 1) table.row({"time steps", grouped(steps)});
    table.row({"triangles", grouped(saved.triangles)});
    table.row({"time", fmt::format("read {}, extract and compress {}, write {}", seconds_text(seconds.read),
                                   seconds_text(seconds.extract), seconds_text(seconds.write))});
    table.row({"file", fmt::format("{} ({})", command.out, format_bytes(saved.html.size()))});
    return table.text();
}

Json export_report(const ExportCommand& command, const view::SavedSurfaces& saved, std::size_t steps,
                   const ExportTimes& seconds) {
    Json report = json_report("export");
    report["kind"] = "surfaces";
    report["grid"] = json_text(command.grid.file);
    report["isovalues"] = saved.isovalues;
    report["left_out"] = saved.left_out;
    report["steps"] = steps;
    report["triangles"] = saved.triangles;
    report["boundary"] = saved.boundary;
    report["seconds"] = {{"read", seconds.read}, {"extract", seconds.extract}, {"write", seconds.write}};
    report["file"] = json_text(command.out);
    report["bytes"] = saved.html.size();
    return report;
}

/// Whether the page is to have what fits: the grid, if isosurfaces are not asked for.
bool may_have_grid(const ExportCommand& command) {
    return command.content == PageContent::fitting && command.isovalues.empty() && command.shares.empty() &&
           command.range.empty() && !command.count;
}

} // namespace

Result<ExitCode> run_export(const ExportCommand& command) {
    Console console(command.common);
    const bool may = may_have_grid(command), can = static_cast<bool>(view::check_grid_pages());
    if (may && !can)
        console.note("this isotet was built without WebAssembly: the page has isosurfaces in place of the grid");
    if (command.content == PageContent::grid || (may && can)) {
        const Result<std::optional<ExitCode>> done = run_export_grid(command, console);
        if (!done) return done.error();
        if (*done) return **done;
    }
    GridOptions grid = command.grid;
    if (command.all_steps) grid.step = 0;
    Result<GridSource> source = GridSource::open(grid, console);
    if (!source) return source.error();
    Result<std::vector<std::size_t>> steps = steps_of(command, *source, console);
    if (!steps) return steps.error();
    if (!steps->empty()) grid.step = steps->front(); // is read first
    if (Result<void> checked = check_export(command, *source, console); !checked) return checked.error();

    ExportTimes seconds;
    const Stopwatch reading;
    Result<view::ViewerInput> input = read_view_input({grid, command.field, command.isovalues, command.shares,
                                                       command.color_by, FirstCells::all, !command.range.empty()},
                                                      *source, console, console.run());
    if (!input) return input.error();
    seconds.read = reading.seconds();
    if (command.field.name.empty()) { // the one that was chosen may be missing in others
        steps = steps_with_fields(*source, *std::move(steps), {input->state.field}, console);
        if (!steps) return steps.error();
    }

    const Stopwatch extracting;
    const Result<std::optional<ValueRange>> range = range_of(command, *input, console.run());
    if (!range) return range.error();
    const view::SavedSurfacesOptions options = options_of(command, *input, *steps, *range);
    const view::ReadStep read_step = [&](std::size_t step, const Run& run) {
        return source->read({}, step, console, run);
    };
    const Result<view::SavedSurfaces> saved = view::save_surfaces(*std::move(input), read_step, options, console.run());
    if (!saved) return saved.error();
    console.notes(saved->notes);
    console.note(fmt::format("{} will have {}", command.out, format_bytes(saved->html.size())));
    seconds.extract = extracting.seconds();

    const Stopwatch writing;
    if (Result<void> written = write_text(saved->html, command.out, console.run()); !written) return written.error();
    seconds.write = writing.seconds();
    return finish(console, command.common, export_table(command, *saved, options.steps.size(), seconds),
                  export_report(command, *saved, options.steps.size(), seconds));
}

} // namespace isotet::cli
