// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet info`: what a grid file holds.
#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/contour.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/jobs/many_files.hpp>
#include <isotet/jobs/number_text.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "each_file.hpp"
#include "output/info_chart.hpp"
#include "output/json_output.hpp"
#include "output/packed_report.hpp"
#include "output/report.hpp"
#include "output/text.hpp"

namespace isotet::cli {

namespace {

/// "75, 0 to 7.4", or each of a few.
std::string times_text(const std::vector<double>& times) {
    constexpr std::size_t max_shown = 10;
    const std::vector<std::string> texts = told_apart(times);
    if (times.size() > max_shown) return fmt::format("{}, times {} to {}", times.size(), texts.front(), texts.back());
    return fmt::format("{}, time{} {}", times.size(), times.size() == 1 ? "" : "s", fmt::join(texts, ", "));
}

std::string range_of(const ComponentStatistics& component) {
    if (component.lower > component.upper) return "no finite value";
    return rounded_range(component.lower, component.upper);
}

std::string holes_text(const ComponentStatistics& component) {
    std::string text;
    if (component.not_a_number > 0) text = fmt::format("no data {}", grouped(component.not_a_number));
    if (component.infinite > 0)
        text += fmt::format("{}infinite {}", text.empty() ? "" : ", ", grouped(component.infinite));
    return text;
}

std::string curved_table(const CurvedSummary& found) {
    if (found.cells + found.left_out == 0) return {};
    Table table = facts();
    table.row({"curved cells", fmt::format("{}; extract and render refine them to --tolerance", grouped(found.cells))});
    if (found.left_out > 0)
        table.row({"", fmt::format("{} left out: Bezier pyramids, or above degree 10", grouped(found.left_out))});
    for (const CurvedCost& cost : found.costs)
        table.row({"", fmt::format("{}: split at their nodes only, off by at most {} ({:.2g} % of the range)",
                                   cost.field, rounded(cost.bound), 100 * cost.share)});
    return table.text();
}

Json json_of(const CurvedSummary& found) {
    if (found.cells + found.left_out == 0) return nullptr;
    Json costs = Json::array();
    for (const CurvedCost& cost : found.costs)
        costs.push_back({{"field", json_text(cost.field)}, {"bound", cost.bound}, {"share_of_range", cost.share}});
    return {{"cells", found.cells}, {"cells_left_out", found.left_out}, {"split_at_nodes", std::move(costs)}};
}

/// Polyhedra among the cells that are left out.
std::size_t open_polyhedra(const GridReport& report) {
    std::size_t of_other_types = 0;
    for (const auto& [type, count] : report.cells_by_type)
        if (!Contour::contours(type)) of_other_types += count;
    constexpr std::uint8_t polyhedron = 42;
    const auto polyhedra = report.cells_by_type.find(polyhedron);
    if (polyhedra == report.cells_by_type.end() || report.cells_left_out < of_other_types) return 0;
    return std::min(polyhedra->second, report.cells_left_out - of_other_types);
}

/// ", 12 nearly, points up to 0.01 beside"; empty where all match.
std::string nearly_matched(const HangingReport& report) {
    if (report.near_faces == 0) return "";
    return fmt::format(", {} nearly, points up to {} beside them", grouped(report.near_faces),
                       rounded(report.largest_distance));
}

std::string grid_table(const GridSummary& found, const std::string& path) {
    const GridReport& report = found.report;
    Table table = facts();
    table.row({"file", fmt::format("{} ({})", path, found.file.format)});
    table.row({"points", fmt::format("{} ({})", grouped(report.points), name_of(found.point_type))});
    table.row({"cells", grouped(report.cells)});
    for (const auto& [type, count] : report.cells_by_type)
        table.row({"", fmt::format("{} {}", grouped(count), name_of_cell_type(type))});
    table.row({"tets", grouped(report.tets)});
    for (const auto& [count, what] :
         {std::pair{report.cells_left_out - open_polyhedra(report), "cells left out: their type is not contoured"},
          {open_polyhedra(report), "polyhedra left out: their faces do not close"},
          {report.collapsed_tets, "collapsed tets, dropped"},
          {report.repeated_tets, "repeated tets"},
          {report.negative_tets, "tets of negative volume in the order of the file"},
          {report.inverted_tets, "inverted tets"},
          {report.flat_tets, "flat tets"},
          {report.unused_points, "unused points"},
          {report.duplicate_points, "duplicate points"},
          {report.quads_on_triangles, "quadrilaterals that meet triangles of other cells: the "
                                      "surface may be open there; --split-cells"},
          {found.hanging_points, "hanging points, in a face or edge of a larger cell"},
          {found.hanging.cells, "cells that list them for extraction"},
          {found.hanging.curved_cells, "of these above degree 1: they are linear between their points"},
          {found.hanging.open_faces, "faces on smaller ones that do not cover them: the surface may be open there"}}) {
        if (count > 0) table.row({"", fmt::format("{} {}", grouped(count), what)});
    }
    if (found.hanging.points > 0)
        table.row({"levels", fmt::format("{} apart; {} faces matched{}", found.hanging.levels,
                                         grouped(found.hanging.faces), nearly_matched(found.hanging))});
    if (found.surveyed) table.row({"boundary faces", grouped(report.boundary_faces)});
    for (std::size_t axis = 0; axis < 3; ++axis)
        table.row({axis == 0 ? "bounds" : "",
                   fmt::format("{} {}", "xyz"[axis], rounded_range(report.lower[axis], report.upper[axis]))});
    const std::vector<double>& times = found.file.times;
    if (!times.empty()) {
        table.row({"time steps", fmt::format("{}; this is step {}, time {}", times_text(times), found.step,
                                             told_apart(times)[found.step])});
    }
    if (found.steps > 1)
        table.row({"", fmt::format("ranges of fields are those of all {} time steps", grouped(found.steps))});
    return table.text();
}

/// "isosurfaces of p: its name".
std::string first_table(const FirstView& first) {
    Table table = facts();
    const auto text = [&] {
        if (first.empty) return std::string("nothing: no cell can be contoured");
        switch (first.draw) {
        case FirstDraw::isosurfaces: return fmt::format("isosurfaces of {}: {}", first.field, text_of(first.reason));
        case FirstDraw::field_on_boundary:
            return fmt::format("the boundary, coloured by {}: {}", first.field,
                               first.rough  ? "it jumps from cell to cell"
                               : first.flat ? "its cells are flat"
                                            : "the grid is one cell thick");
        case FirstDraw::regions_on_boundary:
            return fmt::format("the boundary, coloured by {}: no field varies that would be contoured", first.field);
        case FirstDraw::boundary: break;
        }
        return std::string("the boundary: no field varies that would be contoured");
    };
    table.row({"shown first", text()});
    return table.text();
}

Json json_of(const FirstView& first) {
    constexpr std::array<const char*, 4> draws{"isosurfaces", "field_on_boundary", "regions_on_boundary", "boundary"};
    return {{"draw", draws[static_cast<std::size_t>(first.draw)]},
            {"field", first.field.empty() ? Json(nullptr) : Json(json_text(first.field))},
            {"why", text_of(first.reason)}};
}

/// Chosen or not: what --block takes.
std::string block_table(const FileInfo& file) {
    using enum Table::Align;
    Table table({left, right, left, left, right});
    for (const BlockInfo& block : file.blocks)
        table.row(
            {"block", std::to_string(block.number), block.name.empty() ? "-" : block.name, block.kind,
             block.cells == 0 ? "" : fmt::format("{} cell{}", grouped(block.cells), block.cells == 1 ? "" : "s")});
    return table.text();
}

std::string region_table(const FileInfo& file) {
    using enum Table::Align;
    Table table({left, left, right, left});
    for (const RegionName& region : file.regions)
        table.row({"region", region.field, std::to_string(region.number), region.name});
    return table.text();
}

Json json_of(const std::vector<RegionName>& regions) {
    Json list = Json::array();
    for (const RegionName& region : regions)
        list.push_back(
            {{"field", json_text(region.field)}, {"number", region.number}, {"name", json_text(region.name)}});
    return list;
}

Json json_of(const BlockInfo& block) {
    return {{"number", block.number}, {"name", json_text(block.name)}, {"kind", block.kind}, {"cells", block.cells}};
}

Json json_of(const std::vector<BlockInfo>& blocks) {
    Json list = Json::array();
    for (const BlockInfo& block : blocks) list.push_back(json_of(block));
    return list;
}

const char* name_of(Association association) { return association == Association::point ? "point" : "cell"; }

/// "float32 x 3".
std::string type_text(ScalarType type, std::size_t components) {
    return std::string(name_of(type)) + (components > 1 ? fmt::format(" x {}", components) : "");
}

/// What the file announces.
std::string heads_table(const GridSummary& found, const std::string& path) {
    Table table = facts();
    table.row({"file", fmt::format("{} ({})", path, found.file.format)});
    if (found.file.cells > 0) table.row({"cells", grouped(found.file.cells)});
    if (!found.file.times.empty()) table.row({"time steps", times_text(found.file.times)});
    for (const LeftOut& item : found.file.left_out)
        table.row({"left out", fmt::format("{} '{}': {}", item.what, item.name, with_options(item.reason))});
    return table.text();
}

std::string field_table(const std::vector<FieldInfo>& fields) {
    using enum Table::Align;
    Table table({left, left, left, left});
    for (const FieldInfo& field : fields)
        table.row({"field", field.name, name_of(field.association), type_text(field.type, field.components)});
    return table.text();
}

Json json_of(const std::vector<FieldInfo>& fields) {
    Json list = Json::array();
    for (const FieldInfo& field : fields)
        list.push_back({{"name", json_text(field.name)},
                        {"association", name_of(field.association)},
                        {"type", name_of(field.type)},
                        {"components", field.components}});
    return list;
}

std::string field_table(const std::vector<FieldSummary>& fields) {
    using enum Table::Align;
    Table table({left, left, left, right, left, left});
    for (const FieldSummary& described : fields) {
        const std::size_t count = described.components.size();
        table.row({"field", described.name, name_of(described.association), type_text(described.type, count),
                   count == 1 ? range_of(described.components[0]) : "",
                   count == 1 ? holes_text(described.components[0]) : ""});
        for (std::size_t c = 0; count > 1 && c < count; ++c) {
            const std::string component = count <= 3 ? std::string(1, "xyz"[c]) : std::to_string(c);
            table.row({"", "  :" + component, "", "", range_of(described.components[c]),
                       holes_text(described.components[c])});
        }
    }
    return table.text();
}

/// Of blocks that were looked into: what cells they have, and their fields.
std::string each_block_table(const GridSummary& found) {
    std::string text;
    for (std::size_t i = 0; i < found.blocks.size(); ++i) {
        const BlockInfo& block = found.file.blocks[i];
        Table cells = facts();
        cells.row({"", ""});
        cells.row({fmt::format("{} {}", block.kind, block.number), block.name.empty() ? "-" : block.name});
        for (const auto& [type, count] : found.blocks[i].cells_by_type)
            cells.row({"", fmt::format("{} {}", grouped(count), name_of_cell_type(type))});
        text += cells.text() + field_table(found.blocks[i].fields);
    }
    return text;
}

std::string vector_table(const std::vector<VectorSummary>& vectors) {
    using enum Table::Align;
    Table table({left, left, left, left});
    for (const auto& [group, association] : vectors)
        table.row({"vector", group.name, name_of(association), fmt::format("{}", fmt::join(group.parts, ", "))});
    return table.text();
}

Json json_of(const std::vector<VectorSummary>& vectors) {
    Json list = Json::array();
    for (const auto& [group, association] : vectors) {
        Json parts = Json::array();
        for (const std::string& part : group.parts) parts.push_back(json_text(part));
        list.push_back(
            {{"name", json_text(group.name)}, {"association", name_of(association)}, {"fields", std::move(parts)}});
    }
    return list;
}

Json json_of(const std::vector<FieldSummary>& fields) {
    Json list = Json::array();
    for (const FieldSummary& described : fields) {
        Json ranges = Json::array();
        Json not_a_number = Json::array();
        Json infinite = Json::array();
        for (const ComponentStatistics& component : described.components) {
            const bool none = component.lower > component.upper;
            ranges.push_back(none ? Json(nullptr) : Json::array({component.lower, component.upper}));
            not_a_number.push_back(component.not_a_number);
            infinite.push_back(component.infinite);
        }
        list.push_back({{"name", json_text(described.name)},
                        {"association", name_of(described.association)},
                        {"type", name_of(described.type)},
                        {"components", described.components.size()},
                        {"range", std::move(ranges)},
                        {"nan", std::move(not_a_number)},
                        {"infinite", std::move(infinite)}});
    }
    return list;
}

Json by_type(const auto& counts) {
    Json report = Json::object();
    for (const auto& [type, count] : counts) report[name_of_cell_type(type)] = count;
    return report;
}

/// With --each-block: with what was found in them.
Json blocks_of(const GridSummary& found) {
    Json list = json_of(found.file.blocks);
    for (std::size_t i = 0; i < found.blocks.size(); ++i) {
        list[i]["cells_by_type"] = by_type(found.blocks[i].cells_by_type);
        list[i]["fields"] = json_of(found.blocks[i].fields);
    }
    return list;
}

Json json_of(const GridSummary& found, const std::string& path) {
    const GridReport& grid = found.report;
    Json report = json_report("info");
    report["file"] = json_text(path);
    report["format"] = found.file.format;
    report["points"] = grid.points;
    report["cells"] = grid.cells;
    report["cells_by_type"] = by_type(grid.cells_by_type);
    report["cells_left_out"] = grid.cells_left_out;
    report["tets"] = grid.tets;
    report["collapsed_tets"] = grid.collapsed_tets;
    report["negative_tets"] = grid.negative_tets;
    report["inverted_tets"] = grid.inverted_tets;
    report["flat_tets"] = grid.flat_tets;
    report["unused_points"] = grid.unused_points;
    if (found.surveyed) {
        report["repeated_tets"] = grid.repeated_tets;
        report["duplicate_points"] = grid.duplicate_points;
        report["boundary_faces"] = grid.boundary_faces;
        report["quads_on_triangles"] = grid.quads_on_triangles;
        report["hanging_points"] = found.hanging_points;
        report["hanging"] = {
            {"points", found.hanging.points},         {"levels", found.hanging.levels},
            {"cells", found.hanging.cells},           {"faces", found.hanging.faces},
            {"near_faces", found.hanging.near_faces}, {"largest_distance", found.hanging.largest_distance},
            {"open_faces", found.hanging.open_faces}, {"curved_cells", found.hanging.curved_cells}};
    }
    report["bounds"] = {{"lower", grid.lower}, {"upper", grid.upper}};
    report["times"] = found.file.times;
    report["step"] = found.step;
    report["steps_of_ranges"] = found.steps;
    return report;
}

/// With --heads: what the file announces.
TableAndJson report_heads(const std::string& path, const GridSummary& found) {
    Json report = json_report("info");
    report["file"] = json_text(path);
    report["format"] = found.file.format;
    report["cells"] = found.file.cells > 0 ? Json(found.file.cells) : Json(nullptr);
    report["times"] = found.file.times;
    report["blocks"] = json_of(found.file.blocks);
    report["regions"] = json_of(found.file.regions);
    report["fields"] = json_of(found.file.fields);
    report["vectors"] = json_of(found.vectors);
    return {heads_table(found, path) + block_table(found.file) + region_table(found.file) +
                field_table(found.file.fields) + vector_table(found.vectors),
            std::move(report)};
}

Result<TableAndJson> report_on(const InfoJob& job, Console& console) {
    const std::string& path = job.grid.file;
    const bool needs_cells = job.survey || job.chart || !job.grid.cells.empty();
    if (!needs_cells && PackedFile::is_one(path)) {
        const auto file = PackedFile::open(path, {}, console.run());
        if (!file) return file.error();
        return TableAndJson{packed_table(file->info(), path), packed_json(file->info(), path, "info")};
    }
    const Result<GridSummary> found = look_into(job, console);
    if (!found) return found.error();
    if (job.heads) return report_heads(path, *found);
    Json report = json_of(*found, path);
    report["curved"] = json_of(found->curved);
    report["blocks"] = blocks_of(*found);
    report["regions"] = json_of(found->file.regions);
    report["fields"] = json_of(found->fields);
    report["vectors"] = json_of(found->vectors);
    report["first_view"] = json_of(found->first);
    if (found->chart) report["chart"] = cli::json_of(*found->chart);
    return TableAndJson{grid_table(*found, path) + curved_table(found->curved) + block_table(found->file) +
                            region_table(found->file) + field_table(found->fields) + vector_table(found->vectors) +
                            first_table(found->first) + each_block_table(*found) +
                            (found->chart ? chart_table(*found->chart) : ""),
                        std::move(report)};
}

} // namespace

Result<ExitCode> run_info(const InfoCommand& command) {
    Console console(command.common);
    InfoJob job = command;
    job.other_outputs = {command.common.json};
    if (!are_time_steps(job.grid)) {
        std::vector<InfoJob> jobs;
        for (const GridOptions& grid : each_file(job.grid)) jobs.emplace_back(job).grid = grid;
        return do_each(jobs, "info", console, command.common,
                       [&](const InfoJob& one) { return report_on(one, console); });
    }
    Result<TableAndJson> found = report_on(job, console);
    if (!found) return found.error();
    return finish(console, command.common, found->table, std::move(found->json));
}

} // namespace isotet::cli
