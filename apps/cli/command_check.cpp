// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet check`: is the surface what it should be?
#include <map>

#include <fmt/format.h>

#include <isotet/jobs/check_files.hpp>
#include <isotet/jobs/number_text.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/packed_report.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

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

std::string check_table(const CheckedFiles& checked, const CheckJob& job) {
    const SurfaceReport& report = checked.report;
    Table table = facts();
    const std::string others = job.more.empty() ? "" : fmt::format(" and {} more", job.more.size());
    table.row({"surface", fmt::format("{}{} ({})", job.surface, others, checked.format)});
    table.row({"vertices", grouped(report.vertices)});
    table.row({"triangles", grouped(report.triangles)});
    table.row({"closed", !report.closed             ? "no"
                         : report.double_sheets > 0 ? "yes, but for walls: double sheets"
                                                    : "yes"});
    const auto count = [&](const char* what, std::uint64_t number, const std::string& remark = {}) {
        table.row({what, grouped(number) + (remark.empty() ? "" : " (" + remark + ")")});
    };
    count("boundary edges", report.boundary_edges);
    count("inconsistent edges", report.inconsistent_edges);
    if (job.closed || !job.grid.file.empty()) count("edges not allowed", report.blamed_edges, "of both kinds above");
    if (report.hanging_edges > 0)
        count("edges at hanging points", report.hanging_edges, report.sound ? "the grid's doing" : "of these");
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
    const std::string unclean = report.hanging_edges > 0
                                    ? fmt::format("sound, but open at hanging points: {} edge{}",
                                                  grouped(report.hanging_edges), report.hanging_edges == 1 ? "" : "s")
                                : job.strict ? "sound, but not clean"
                                             : "sound";
    const bool judges_edges = job.closed || !job.grid.file.empty();
    table.row({"verdict", (!report.sound  ? "not sound"
                           : report.clean ? "sound and clean"
                                          : unclean) +
                              std::string(report.boundary_edges > 0 && !judges_edges
                                              ? " (boundary edges are judged with --grid or --closed only)"
                                              : "")});
    return table.text();
}

std::string findings_table(const std::vector<Finding>& findings, bool passed) {
    Table table = facts();
    for (const Finding& finding : findings) {
        table.row({finding.what, fmt::format("at {}, {}, {}", shortest(finding.where[0]), shortest(finding.where[1]),
                                             shortest(finding.where[2]))});
    }
    return table.empty()
               ? ""
               : fmt::format("\n{}\n{}", passed ? "some places, for information:" : "some places:", table.text());
}

Json check_json(const CheckedFiles& checked, const CheckJob& job) {
    const SurfaceReport& report = checked.report;
    Json json = json_report("check");
    json["file"] = json_text(job.surface);
    json["more_files"] = Json::array();
    for (const std::string& more : job.more) json["more_files"].push_back(json_text(more));
    json["format"] = checked.format;
    json["vertices"] = report.vertices;
    json["triangles"] = report.triangles;
    json["closed"] = report.closed;
    json["boundary_edges"] = report.boundary_edges;
    json["non_manifold_edges"] = report.non_manifold_edges;
    json["inconsistent_edges"] = report.inconsistent_edges;
    json["blamed_edges"] = report.blamed_edges;
    json["hanging_edges"] = report.hanging_edges;
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

} // namespace

namespace {

/// A packed file itself: broken ones are errors.
Result<ExitCode> check_packed(const CheckCommand& command, Console& console) {
    const auto file = PackedFile::open(command.surface, {}, console.run());
    if (!file) return file.error();
    if (auto checked = file->check(console.run()); !checked) return checked.error();
    Table verdict = facts();
    verdict.row({"verdict", "sound: checksums, numbers and ranges of all chunks, fields and steps"});
    Json report = packed_json(file->info(), command.surface, "check");
    report["sound"] = true;
    return finish(console, command.common, packed_table(file->info(), command.surface) + verdict.text(),
                  std::move(report));
}

} // namespace

Result<ExitCode> run_check(const CheckCommand& command) {
    Console console(command.common);
    if (PackedFile::is_one(command.surface)) return check_packed(command, console);
    CheckJob job = command;
    job.other_outputs = {command.common.json};
    const Result<CheckedFiles> checked = check_files(job, console);
    if (!checked) return checked.error();
    return finish(console, command.common,
                  check_table(*checked, job) + findings_table(checked->report.findings, checked->passed),
                  check_json(*checked, job), checked->passed ? ExitCode::done : ExitCode::check_failed);
}

} // namespace isotet::cli
