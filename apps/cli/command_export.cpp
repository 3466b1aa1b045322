// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet export`: a grid or isosurfaces in a page of one file.
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/text.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

void add_rows(const view::ExportedSurfaces& surfaces, Table& table) {
    table.row({"isosurfaces", fmt::format("{} from {} to {}", grouped(surfaces.isovalues.size()),
                                          rounded(surfaces.isovalues.front()), rounded(surfaces.isovalues.back()))});
    if (surfaces.steps > 1) table.row({"time steps", grouped(surfaces.steps)});
    table.row({"triangles", grouped(surfaces.triangles)});
    table.row({"time", fmt::format("read {}, extract and compress {}, write {}", seconds_text(surfaces.read_seconds),
                                   seconds_text(surfaces.extract_seconds), seconds_text(surfaces.write_seconds))});
}

void add_rows(const view::ExportedGrid& grid, Table& table) {
    table.row({"cells", grouped(grid.packed.cells)});
    for (const FieldReport& field : grid.packed.fields)
        table.row({"field", fmt::format("{}: {} to {}", field.name, shortest(field.lower), shortest(field.upper))});
    if (grid.packed.steps > 1) table.row({"time steps", grouped(grid.packed.steps)});
    table.row({"packed", format_bytes(grid.packed.bytes)});
}

std::string export_table(const ExportCommand& command, const view::ExportNumbers& numbers) {
    Table table = facts();
    table.row({"grid", command.grid.file});
    std::visit([&](const auto& content) { add_rows(content, table); }, numbers.content);
    table.row({"file", fmt::format("{} ({})", command.out, format_bytes(numbers.bytes))});
    return table.text();
}

void add_keys(const view::ExportedSurfaces& surfaces, Json& report) {
    report["isovalues"] = surfaces.isovalues;
    report["left_out"] = surfaces.left_out;
    report["steps"] = surfaces.steps;
    report["triangles"] = surfaces.triangles;
    report["boundary"] = surfaces.boundary;
    report["seconds"] = {
        {"read", surfaces.read_seconds}, {"extract", surfaces.extract_seconds}, {"write", surfaces.write_seconds}};
}

void add_keys(const view::ExportedGrid& grid, Json& report) {
    report["cells"] = grid.packed.cells;
    report["fields"] = json_texts(view::names_of(grid.packed.fields));
    report["left_out"] = grid.left_out;
    if (grid.rounded) report["rounded_by"] = grid.packed.rounded_by;
    report["steps"] = grid.packed.steps;
    report["packed_bytes"] = grid.packed.bytes;
}

Json export_report(const ExportCommand& command, const view::ExportNumbers& numbers) {
    Json report = json_report("export");
    report["kind"] = std::holds_alternative<view::ExportedGrid>(numbers.content) ? "grid" : "surfaces";
    report["grid"] = json_text(command.grid.file);
    std::visit([&](const auto& content) { add_keys(content, report); }, numbers.content);
    report["file"] = json_text(command.out);
    report["bytes"] = numbers.bytes;
    return report;
}

} // namespace

Result<ExitCode> run_export(const ExportCommand& command) {
    Console console(command.common);
    view::ExportJob job = command;
    job.other_outputs = {command.common.json};
    const Result<view::ExportNumbers> numbers = view::export_page(job, console);
    if (!numbers) return numbers.error();
    return finish(console, command.common, export_table(command, *numbers), export_report(command, *numbers));
}

} // namespace isotet::cli
