// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet check`: is the surface what it should be?
#include <map>

#include <fmt/format.h>

#include <isotet/check.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/read.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "json_output.hpp"
#include "report.hpp"

namespace isotet::cli {

namespace {

/// The grid that a surface came from, with the field whose holes count.
struct Origin {
    Grid grid;
    std::optional<PointField> field;
};

Result<Origin> read_origin(const CheckCommand& command, Console& console) {
    const Result<GridSource> source = GridSource::open(command.grid, console);
    if (!source) return source.error();
    if (auto paths = check_output_paths(source->info().files, {command.common.json}); !paths) return paths.error();
    const auto steps = choose_steps(source->info(), command.grid, Steps::one, console);
    if (!steps) return steps.error();
    FieldsToRead fields{std::vector<std::string>{}, std::vector<std::string>{}};
    std::optional<FoundField> found;
    if (!command.field.name.empty() || source->info().fields.size() == 1) {
        Result<FoundField> chosen = choose_field(*source, command.field);
        if (!chosen) return chosen.error();
        fields = {chosen->point, chosen->cell};
        found = *std::move(chosen);
    } else if (!source->info().fields.empty()) {
        console.note(
            "no field was named with --grid: every tet counts, also where the field has no data; `field` names one");
    }
    Result<Grid> grid = source->read(fields, steps->front(), console);
    if (!grid) return grid.error();
    Origin origin{*std::move(grid), std::nullopt};
    if (!found) return origin;
    Result<PointField> field = find_chosen(origin.grid, found->name, command.field, console);
    if (!field) return field.error();
    origin.field = *std::move(field);
    return origin;
}

/// "3 x 0, 1 x 2": how often each genus occurs, for surfaces of many components.
std::string genus_text(const std::vector<std::int64_t>& genus) {
    std::map<std::int64_t, std::size_t> counts;
    for (const std::int64_t value : genus) ++counts[value];
    std::string text;
    for (const auto& [value, count] : counts) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ",
                            count == 1 ? std::to_string(value) : fmt::format("{} x {}", grouped(count), value));
    }
    return text.empty() ? "no closed, manifold, oriented component" : text;
}

std::string check_table(const SurfaceReport& report, const SurfaceFile& file, const CheckCommand& command) {
    Table table = facts();
    const std::string others = command.more.empty() ? "" : fmt::format(" and {} more", command.more.size());
    table.row({"surface", fmt::format("{}{} ({})", command.surface, others, file.format)});
    table.row({"vertices", grouped(report.vertices)});
    table.row({"triangles", grouped(report.triangles)});
    table.row({"closed", report.closed ? "yes" : "no"});
    const auto count = [&](const char* what, std::uint64_t number, const std::string& remark = {}) {
        table.row({what, grouped(number) + (remark.empty() ? "" : " (" + remark + ")")});
    };
    count("boundary edges", report.boundary_edges);
    count("inconsistent edges", report.inconsistent_edges);
    if (command.closed || !command.grid.file.empty())
        count("edges not allowed", report.blamed_edges, "of both kinds above");
    count("equal-corner triangles", report.equal_corner_triangles);
    count("repeated triangles", report.duplicate_triangles,
          report.duplicate_triangles == report.blamed_duplicates
              ? ""
              : grouped(report.blamed_duplicates) + " not explained by the grid");
    count("zero-area triangles", report.zero_area_triangles);
    count("non-manifold edges", report.non_manifold_edges);
    count("double sheets", report.double_sheets);
    count("touching vertices", report.touching_vertices);
    count("coincident vertices", report.coincident_vertices);
    if (report.unused_vertices > 0) count("unused vertices", report.unused_vertices);
    if (report.collapsed_by_welding > 0)
        count("collapsed by welding", report.collapsed_by_welding, "counted, no defect");
    count("components", report.components);
    table.row({"Euler characteristic", std::to_string(report.euler)});
    table.row({"genus", genus_text(report.genus)});
    table.row({"area", rounded(report.area)});
    table.row({"volume", report.closed ? rounded(report.volume) : "not closed"});
    const std::string unclean = command.strict ? "sound, but not clean" : "sound";
    table.row({"verdict", !report.sound ? "not sound" : report.clean ? "sound and clean" : unclean});
    return table.text();
}

std::string findings_table(const std::vector<Finding>& findings, bool sound) {
    Table table = facts();
    for (const Finding& finding : findings) {
        table.row({finding.what, fmt::format("at {}, {}, {}", shortest(finding.where[0]), shortest(finding.where[1]),
                                             shortest(finding.where[2]))});
    }
    return table.empty() ? "" : fmt::format("\n{}\n{}", sound ? "for information:" : "found:", table.text());
}

Json check_json(const SurfaceReport& report, const SurfaceFile& file, const CheckCommand& command) {
    Json json = json_report("check");
    json["file"] = json_text(command.surface);
    json["more_files"] = Json::array();
    for (const std::string& more : command.more) json["more_files"].push_back(json_text(more));
    json["format"] = file.format;
    json["vertices"] = report.vertices;
    json["triangles"] = report.triangles;
    json["closed"] = report.closed;
    json["boundary_edges"] = report.boundary_edges;
    json["non_manifold_edges"] = report.non_manifold_edges;
    json["inconsistent_edges"] = report.inconsistent_edges;
    json["blamed_edges"] = report.blamed_edges;
    json["equal_corner_triangles"] = report.equal_corner_triangles;
    json["zero_area_triangles"] = report.zero_area_triangles;
    json["duplicate_triangles"] = report.duplicate_triangles;
    json["blamed_duplicates"] = report.blamed_duplicates;
    json["double_sheets"] = report.double_sheets;
    json["touching_vertices"] = report.touching_vertices;
    json["coincident_vertices"] = report.coincident_vertices;
    json["unused_vertices"] = report.unused_vertices;
    json["collapsed_by_welding"] = report.collapsed_by_welding;
    json["components"] = report.components;
    json["euler"] = report.euler;
    json["genus"] = report.genus;
    json["area"] = report.area;
    json["volume"] = report.closed ? Json(report.volume) : Json(nullptr);
    json["sound"] = report.sound;
    json["clean"] = report.clean;
    Json findings = Json::array();
    for (const Finding& finding : report.findings)
        findings.push_back({{"what", json_text(finding.what)}, {"where", finding.where}});
    json["findings"] = std::move(findings);
    return json;
}

/// All surfaces as one, of the format of the first.
Result<SurfaceFile> read_surfaces(const CheckCommand& command, Console& console) {
    std::vector<std::string> inputs{command.surface, command.grid.file};
    inputs.insert(inputs.end(), command.more.begin(), command.more.end());
    if (Result<void> paths = check_output_paths(inputs, {command.common.json}); !paths) return paths.error();
    Result<SurfaceFile> file = read_surface(command.surface, {command.format}, console.run());
    if (!file || command.more.empty()) return file;
    std::vector<Surface> parts{std::move(file->surface)};
    for (const std::string& more : command.more) {
        Result<SurfaceFile> other = read_surface(more, {command.format}, console.run());
        if (!other) return other;
        parts.push_back(std::move(other->surface));
    }
    file->surface = join(parts, {});
    return file;
}

} // namespace

Result<ExitCode> run_check(const CheckCommand& command) {
    Console console(command.common);
    const Result<SurfaceFile> file = read_surfaces(command, console);
    if (!file) return file.error();

    CheckOptions options;
    options.closed = command.closed;
    options.weld = file->format == "stl" || !command.more.empty(); // without vertex numbers that say what is the same
    std::optional<Origin> origin;
    if (!command.grid.file.empty()) {
        if (file->surface.edge_ends.empty()) {
            return usage_error("{} has no point array edge_ends, but --grid needs it: isotet extract --edge-ends "
                               "writes it into .vtp and .vtk",
                               command.surface);
        }
        Result<Origin> read = read_origin(command, console);
        if (!read) return read.error();
        origin = *std::move(read);
        options.grid = &origin->grid;
        options.split_cells = command.split_cells;
        if (origin->field) options.field = &*origin->field;
    }
    const Result<SurfaceReport> report = check(file->surface, options, console.run());
    if (!report) return report.error();

    const bool passed = report->sound && (report->clean || !command.strict);
    const std::string text = check_table(*report, *file, command) + findings_table(report->findings, passed);
    return finish(console, command.common, text, check_json(*report, *file, command),
                  passed ? ExitCode::done : ExitCode::check_failed);
}

} // namespace isotet::cli
