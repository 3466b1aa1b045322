// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet clip`: from a grid file to the cells between isovalues.
#include <cmath>

#include <fmt/format.h>

#include <isotet/jobs/clip_files.hpp>
#include <isotet/jobs/number_text.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::string range_text(const SolidRange& range) {
    if (!std::isfinite(range.upper)) return "above " + shortest(range.lower);
    if (!std::isfinite(range.lower)) return "below " + shortest(range.upper);
    return fmt::format("{} to {}", shortest(range.lower), shortest(range.upper));
}

std::string clip_table(const ClipNumbers& numbers) {
    const bool files = !numbers.steps.empty() && !numbers.steps.front().file.empty();
    const bool times = !numbers.steps.empty() && numbers.steps.front().time.has_value();
    using Align = Table::Align;
    std::vector<Align> columns(7 + (times ? 1 : 0), Align::right);
    if (files) columns.push_back(Align::left);
    Table table(columns);
    std::vector<std::string> head{"points", "cells", "whole", "cut", "polyhedra", "tied points", "clip"};
    if (times) head.insert(head.begin(), "time");
    if (files) head.push_back("file");
    table.row(std::move(head));
    for (const ClipStepNumbers& step : numbers.steps) {
        std::vector<std::string> row{grouped(step.points),           grouped(step.cells),     grouped(step.whole_cells),
                                     grouped(step.cut_cells),        grouped(step.polyhedra), grouped(step.tied_points),
                                     seconds_text(step.clip_seconds)};
        if (times) row.insert(row.begin(), step.time ? shortest(*step.time) : "");
        if (files) row.push_back(step.file);
        table.row(std::move(row));
    }
    Table facts_of_grid = facts();
    facts_of_grid.row(
        {"grid", fmt::format("{} ({}), {}", numbers.grid, numbers.format, counted(numbers.cells, "cell"))});
    if (numbers.cells_left_out > 0)
        facts_of_grid.row({"", fmt::format("{} cells left out", grouped(numbers.cells_left_out))});
    facts_of_grid.row({"field", fmt::format("{} {}, range {} to {}{}", numbers.field.name, range_text(numbers.range),
                                            shortest(numbers.field.lower), shortest(numbers.field.upper),
                                            numbers.averaged ? ", averaged from cells" : "")});
    if (!numbers.collection.empty()) facts_of_grid.row({"series", numbers.collection});
    return table.text() + "\n" + facts_of_grid.text();
}

Json clip_json(const ClipNumbers& numbers) {
    const auto end = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
    Json report = json_report("clip");
    report["grid"] = json_text(numbers.grid);
    report["format"] = numbers.format;
    report["cells"] = numbers.cells;
    report["cells_left_out"] = numbers.cells_left_out;
    report["field"] = json_text(numbers.field.name);
    const bool finite = numbers.field.lower <= numbers.field.upper;
    report["field_range"] = finite ? Json::array({numbers.field.lower, numbers.field.upper}) : Json(nullptr);
    report["range"] = Json::array({end(numbers.range.lower), end(numbers.range.upper)});
    report["method"] = name_of(numbers.method);
    report["seconds"] = {{"read", numbers.read_seconds}};
    Json steps = Json::array();
    for (const ClipStepNumbers& step : numbers.steps)
        steps.push_back({{"time", step.time ? Json(*step.time) : Json(nullptr)},
                         {"points", step.points},
                         {"cells", step.cells},
                         {"whole_cells", step.whole_cells},
                         {"cut_cells", step.cut_cells},
                         {"polyhedra", step.polyhedra},
                         {"flat_pieces", step.flat_pieces},
                         {"folded_pieces", step.folded_pieces},
                         {"tied_points", step.tied_points},
                         {"seconds", {{"clip", step.clip_seconds}, {"write", step.write_seconds}}},
                         {"file", step.file.empty() ? Json(nullptr) : json_text(step.file)}});
    report["steps"] = std::move(steps);
    report["collection"] = numbers.collection.empty() ? Json(nullptr) : json_text(numbers.collection);
    return report;
}

} // namespace

Result<ExitCode> run_clip(const ClipCommand& command) {
    Console console(command.common);
    ClipJob job = command;
    job.other_outputs = {command.common.json};
    job.clip.polyhedra = !command.no_polyhedra;
    const Result<ClipNumbers> done = clip_files(job, console);
    if (!done) return done.error();
    Json report = clip_json(*done);
    const ExitCode status = say_broken_steps(done->broken_steps, report);
    return finish(console, command.common, clip_table(*done), std::move(report), status);
}

} // namespace isotet::cli
