// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet info`: what a grid file holds.
#include <fmt/format.h>

#include <isotet/field_statistics.hpp>
#include <isotet/grid.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/refine.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "info_chart.hpp"
#include "json_output.hpp"
#include "report.hpp"

namespace isotet::cli {

namespace {

/// What was found out about a file, before it is printed twice.
struct Findings {
    const FileInfo& file;
    std::size_t step = 0;
    const Grid& grid;
    GridReport report;
    bool surveyed = false; ///< whether faces and places were counted, too
};

struct DescribedField {
    const Field& field;
    const char* association;
    std::vector<ComponentStatistics> components;
};

Result<std::vector<DescribedField>> describe_fields(const Grid& grid, const Run& run) {
    std::vector<DescribedField> described;
    for (const Field& field : grid.point_fields) described.push_back({field, "point", {}});
    for (const Field& field : grid.cell_fields) described.push_back({field, "cell", {}});
    for (DescribedField& one : described) {
        auto components = statistics_of(one.field.values, run);
        if (!components) return components.error();
        one.components = *std::move(components);
    }
    return described;
}

/// "75, 0 to 7.4", or each of a few.
std::string times_text(const std::vector<double>& times) {
    constexpr std::size_t max_shown = 10;
    if (times.size() > max_shown)
        return fmt::format("{}, times {} to {}", times.size(), shortest(times.front()), shortest(times.back()));
    std::string list;
    for (const double time : times) list += (list.empty() ? "" : ", ") + shortest(time);
    return fmt::format("{}, time{} {}", times.size(), times.size() == 1 ? "" : "s", list);
}

/// The shortest decimal that reads back in the field's own type.
std::string value_text(double value, ScalarType type) {
    return type == ScalarType::float32 ? fmt::format("{}", static_cast<float>(value)) : shortest(value);
}

std::string range_text(const ComponentStatistics& component, ScalarType type) {
    if (component.lower > component.upper) return "no finite value";
    return fmt::format("{} to {}", value_text(component.lower, type), value_text(component.upper, type));
}

std::string holes_text(const ComponentStatistics& component) {
    std::string text;
    if (component.not_a_number > 0) text = fmt::format("no data {}", grouped(component.not_a_number));
    if (component.infinite > 0)
        text += fmt::format("{}infinite {}", text.empty() ? "" : ", ", grouped(component.infinite));
    return text;
}

/// What it costs to contour a field without refining curved cells.
struct CurvedCost {
    std::string field;
    double bound = 0; ///< of the error, in the unit of the field
    double share = 0; ///< of the field's range
};

struct CurvedFindings {
    std::uint64_t cells = 0, left_out = 0;
    std::vector<CurvedCost> costs; ///< of scalar point fields
};

Result<CurvedFindings> look_at_curved_cells(const Grid& grid, const std::vector<DescribedField>& fields,
                                            const Run& run) {
    CurvedFindings found;
    if (!has_curved_cells(grid.cells)) return found;
    const auto linear = linearize(grid, {}, run);
    if (!linear) return linear.error();
    found.cells = linear->refinement.curved_cells;
    found.left_out = linear->refinement.unknown_cells;
    for (const DescribedField& described : fields) {
        if (described.components.size() != 1 || described.association != std::string_view("point")) continue;
        const auto bound = field_bound(*linear, described.field.values, run);
        if (!bound) return bound.error();
        const double range = described.components[0].upper - described.components[0].lower;
        found.costs.push_back({described.field.name, *bound, range > 0 ? *bound / range : 0});
    }
    return found;
}

std::string curved_table(const CurvedFindings& found) {
    if (found.cells + found.left_out == 0) return {};
    Table table = facts();
    table.row({"curved cells", fmt::format("{}; extract and render refine them to --tolerance", grouped(found.cells))});
    if (found.left_out > 0)
        table.row({"", fmt::format("{} left out: pyramids of degree 3 and above, or above degree 10",
                                   grouped(found.left_out))});
    for (const CurvedCost& cost : found.costs)
        table.row({"", fmt::format("{}: split at their nodes only, off by at most {} ({:.2g} % of the range)",
                                   cost.field, rounded(cost.bound), 100 * cost.share)});
    return table.text();
}

Json json_of(const CurvedFindings& found) {
    if (found.cells + found.left_out == 0) return nullptr;
    Json costs = Json::array();
    for (const CurvedCost& cost : found.costs)
        costs.push_back({{"field", json_text(cost.field)}, {"bound", cost.bound}, {"share_of_range", cost.share}});
    return {{"cells", found.cells}, {"cells_left_out", found.left_out}, {"split_at_nodes", std::move(costs)}};
}

std::string grid_table(const Findings& found, const std::string& path) {
    const GridReport& report = found.report;
    Table table = facts();
    table.row({"file", fmt::format("{} ({})", path, found.file.format)});
    table.row({"points", fmt::format("{} ({})", grouped(report.points), name_of(found.grid.points.type()))});
    table.row({"cells", grouped(report.cells)});
    for (const auto& [type, count] : report.cells_by_type)
        table.row({"", fmt::format("{} {}", grouped(count), name_of_cell_type(type))});
    table.row({"tets", grouped(report.tets)});
    for (const auto& [count, what] :
         {std::pair{report.cells_left_out, "cells left out: their type is not contoured"},
          {report.collapsed_tets, "collapsed tets, dropped"},
          {report.repeated_tets, "repeated tets"},
          {report.negative_tets, "tets of negative volume in the order of the file"},
          {report.inverted_tets, "inverted tets"},
          {report.flat_tets, "flat tets"},
          {report.unused_points, "unused points"},
          {report.duplicate_points, "duplicate points"},
          {report.quads_on_triangles, "quadrilaterals that meet triangles of other cells: the "
                                      "surface may be open there; --split-cells"}}) {
        if (count > 0) table.row({"", fmt::format("{} {}", grouped(count), what)});
    }
    if (found.surveyed) table.row({"boundary faces", grouped(report.boundary_faces)});
    const ScalarType type = found.grid.points.type();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        table.row(
            {axis == 0 ? "bounds" : "", fmt::format("{} {} to {}", "xyz"[axis], value_text(report.lower[axis], type),
                                                    value_text(report.upper[axis], type))});
    }
    const std::vector<double>& times = found.file.times;
    if (!times.empty()) {
        table.row({"time steps", fmt::format("{}; this is step {}, time {}", times_text(times), found.step,
                                             shortest(times[found.step]))});
    }
    return table.text();
}

/// Chosen or not: what --block takes.
std::string block_table(const FileInfo& file) {
    using enum Table::Align;
    Table table({left, right, left, left, right});
    for (const BlockInfo& block : file.blocks)
        table.row({"block", std::to_string(block.number), block.name.empty() ? "-" : block.name, block.kind,
                   fmt::format("{} cell{}", grouped(block.cells), block.cells == 1 ? "" : "s")});
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

Json json_of(const std::vector<BlockInfo>& blocks) {
    Json list = Json::array();
    for (const BlockInfo& block : blocks)
        list.push_back(
            {{"number", block.number}, {"name", json_text(block.name)}, {"kind", block.kind}, {"cells", block.cells}});
    return list;
}

std::string field_table(const std::vector<DescribedField>& fields) {
    using enum Table::Align;
    Table table({left, left, left, right, left, left});
    for (const DescribedField& described : fields) {
        const std::size_t count = described.components.size();
        const Array& values = described.field.values;
        const std::string type = std::string(name_of(values.type())) + (count > 1 ? fmt::format(" x {}", count) : "");
        table.row({"field", described.field.name, described.association, type,
                   count == 1 ? range_text(described.components[0], values.type()) : "",
                   count == 1 ? holes_text(described.components[0]) : ""});
        for (std::size_t c = 0; count > 1 && c < count; ++c) {
            const std::string component = count <= 3 ? std::string(1, "xyz"[c]) : std::to_string(c);
            table.row({"", "  :" + component, "", "", range_text(described.components[c], values.type()),
                       holes_text(described.components[c])});
        }
    }
    return table.text();
}

Json json_of(const std::vector<DescribedField>& fields) {
    Json list = Json::array();
    for (const DescribedField& described : fields) {
        Json ranges = Json::array();
        Json not_a_number = Json::array();
        Json infinite = Json::array();
        for (const ComponentStatistics& component : described.components) {
            const bool none = component.lower > component.upper;
            ranges.push_back(none ? Json(nullptr) : Json::array({component.lower, component.upper}));
            not_a_number.push_back(component.not_a_number);
            infinite.push_back(component.infinite);
        }
        list.push_back({{"name", json_text(described.field.name)},
                        {"association", described.association},
                        {"type", name_of(described.field.values.type())},
                        {"components", described.components.size()},
                        {"range", std::move(ranges)},
                        {"nan", std::move(not_a_number)},
                        {"infinite", std::move(infinite)}});
    }
    return list;
}

Json json_of(const Findings& found, const std::string& path) {
    const GridReport& grid = found.report;
    Json report = json_report("info");
    report["file"] = json_text(path);
    report["format"] = found.file.format;
    report["points"] = grid.points;
    report["cells"] = grid.cells;
    Json by_type = Json::object();
    for (const auto& [type, count] : grid.cells_by_type) by_type[name_of_cell_type(type)] = count;
    report["cells_by_type"] = std::move(by_type);
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
    }
    report["bounds"] = {{"lower", grid.lower}, {"upper", grid.upper}};
    report["times"] = found.file.times;
    report["step"] = found.step;
    return report;
}

} // namespace

Result<ExitCode> run_info(const InfoCommand& command) {
    Console console(command.common);
    const std::string& path = command.grid.file;
    if (Result<void> paths = check_output_paths({path}, {command.common.json}); !paths) return paths.error();
    const Result<GridSource> source = GridSource::open(command.grid, console);
    if (!source) return source.error();
    if (auto paths = check_output_paths(source->info().files, {command.common.json}); !paths) return paths.error();
    const auto steps = choose_steps(source->info(), command.grid, Steps::one, console);
    if (!steps) return steps.error();
    const Result<Grid> grid = source->read({}, steps->front(), console);
    if (!grid) return grid.error();
    Result<GridReport> surveyed = survey(*grid, {.faces = command.survey}, console.run());
    if (!surveyed) return surveyed.error();
    const Findings found{source->info(), steps->front(), *grid, *std::move(surveyed), command.survey};
    const auto fields = describe_fields(*grid, console.run());
    if (!fields) return fields.error();
    const auto curved = look_at_curved_cells(*grid, *fields, console.run());
    if (!curved) return curved.error();
    const auto chart = make_chart(command, *grid, console);
    if (!chart) return chart.error();
    Json report = json_of(found, path);
    report["curved"] = json_of(*curved);
    report["blocks"] = json_of(source->info().blocks);
    report["regions"] = json_of(source->info().regions);
    report["fields"] = json_of(*fields);
    if (*chart) report["chart"] = json_of(**chart);
    return finish(console, command.common,
                  grid_table(found, path) + curved_table(*curved) + block_table(source->info()) +
                      region_table(source->info()) + field_table(*fields) + (*chart ? chart_table(**chart) : ""),
                  std::move(report));
}

} // namespace isotet::cli
