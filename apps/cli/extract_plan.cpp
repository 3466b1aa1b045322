// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "extract_plan.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <isotet/levels.hpp>

#include "exit_code.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

/// What the format of OUT can hold.
struct Holds {
    bool fields = true;
    bool edge_ends = true; ///< and source cells
};

Result<Holds> holds(const ExtractCommand& command) {
    if (command.out.empty()) return Holds{false, true};
    const Result<Format> format = format_for_writing(command.out, Writes::surface, command.compression);
    if (!format) return format.error();
    const bool vtk = format->name == "vtp" || format->name == "vtk";
    for (const auto& [asked, option] :
         {std::pair{command.edge_ends, "--edge-ends"}, {command.source_cells, "--source-cells"}}) {
        if (asked && !vtk) {
            return usage_error("{} was asked for, but {} holds no such array: .vtp and .vtk do", option, format->name);
        }
    }
    return Holds{format->name != "stl" && format->name != "obj", vtk};
}

Result<void> check_names(const ExtractCommand& command, const ExtractPlan& plan, const FileInfo& info) {
    if (plan.names.none()) return {};
    if (plan.steps.size() > 1 && !plan.names.by_step())
        return usage_error("--all-steps has {} time steps, but OUT, '{}', has neither {{step}} nor {{time}}: there is "
                           "one file for each step",
                           plan.steps.size(), command.out);
    if (!plan.names.by_time()) return {};
    std::set<double> times;
    for (const std::size_t step : plan.steps) {
        const std::optional<double> time = time_of(info, step);
        if (!time)
            return usage_error("OUT, '{}', has {{time}}, but the grid knows no time; {{step}} is its number",
                               command.out);
        if (!times.insert(*time).second)
            return usage_error("several time steps have the time {}, but each needs a file of its own: {{step}} in "
                               "OUT tells them apart",
                               shortest(*time));
    }
    return {};
}

/// The collection of a series that ParaView opens; nothing where there is no series.
Result<std::string> plan_collection(const ExtractCommand& command, const ExtractPlan& plan, Console& console) {
    if (plan.steps.size() < 2 || ending_of(command.out) != ".vtp") return std::string();
    std::string collection = plan.names.collection();
    if (same_file(collection, command.grid.file)) {
        console.note(fmt::format("no collection of the series is written: '{}' is the input", collection));
        return std::string();
    }
    if (auto paths = check_output_paths({command.grid.file}, {collection, command.common.json}); !paths)
        return paths.error();
    return collection;
}

/// --with, or all point fields that the format can hold; nothing means all.
Result<std::optional<CarriedFields>> plan_carried(const ExtractCommand& command, const GridSource& source,
                                                  bool format_holds_fields) {
    if (!command.with && format_holds_fields) return std::optional<CarriedFields>{};
    Result<CarriedFields> carried = choose_carried(source, command.with.value_or(std::vector<std::string>{}));
    if (!carried) return carried.error();
    return std::optional<CarriedFields>{*std::move(carried)};
}

FieldsToRead fields_to_read(const ExtractPlan& plan) {
    FieldsToRead read;
    read.cell = plan.field.cell;
    if (!plan.carried) return read; // all point fields
    read.point = plan.field.point;
    add_names(*read.point, plan.carried->point);
    add_names(*read.cell, plan.carried->cell);
    for (const FoundField& component : plan.carried->components) add_names(*read.point, component.point);
    return read;
}

} // namespace

Result<ExtractPlan> plan_extract(const ExtractCommand& command, const GridSource& source, Console& console) {
    ExtractPlan plan;
    plan.names = OutputNames(command.out);
    const Result<Holds> format = holds(command);
    if (!format) return format.error();

    auto steps = choose_steps(source.info(), command.grid, command.all_steps ? Steps::all : Steps::one, console);
    if (!steps) return steps.error();
    plan.steps = *std::move(steps);
    if (Result<void> names = check_names(command, plan, source.info()); !names) return names.error();
    Result<std::string> collection = plan_collection(command, plan, console);
    if (!collection) return collection.error();
    plan.collection = *std::move(collection);

    Result<FoundField> field = choose_field(source, command.field);
    if (!field) return field.error();
    plan.field = *std::move(field);
    auto carried = plan_carried(command, source, format->fields);
    if (!carried) return carried.error();
    plan.carried = *std::move(carried);
    plan.read = fields_to_read(plan);

    plan.contour.method = command.method;
    if (command.engine == EngineChoice::reference) plan.contour.engine = reference_engine();
    plan.contour.precision = command.precision;
    plan.contour.ties = command.keep_degenerate ? Ties::keep : Ties::merge;
    plan.contour.normals = command.normals;
    plan.contour.edge_ends = command.edge_ends;
    plan.contour.source_cells = command.source_cells;
    plan.contour.split_cells = command.split_cells;
    plan.contour.refine = command.refine;
    plan.contour.exact_vertices = command.exact_vertices;
    return plan;
}

Result<std::vector<double>> choose_isovalues(const ExtractCommand& command, const Array& field,
                                             const FieldReport& packed, Console& console) {
    std::vector<double> isovalues = command.isovalues;
    if (isovalues.empty()) {
        if (!(packed.lower <= packed.upper)) {
            return Error{
                ErrorCode::invalid_data,
                fmt::format("field '{}' has no finite value at the points of the tets: without an isovalue (-i) there "
                            "is nothing to choose one from",
                            packed.name)};
        }
        isovalues = evenly_spaced_levels(packed.lower, packed.upper, std::max<std::uint64_t>(command.levels, 1));
        if (command.levels == 0) {
            console.note(fmt::format("no isovalue was given: {}, the middle of the range {} to {}, was taken",
                                     shortest(isovalues.front()), shortest(packed.lower), shortest(packed.upper)));
        }
    }
    std::vector<double> distinct;
    std::set<double> seen;
    for (double value : isovalues) {
        if (command.snap) value = snap(field, value);
        if (value == 0) value = 0; // -0 equals +0, and is called 0
        if (seen.insert(value).second) {
            distinct.push_back(value);
        } else if (!command.isovalues.empty()) { // levels of a constant field are all the same, too
            console.note(
                fmt::format("the isovalue {} was given more than once: it is extracted once", shortest(value)));
        }
    }
    return distinct;
}

Result<StepFields> carried_fields(const ExtractPlan& plan, const Grid& grid, const Run& run) {
    StepFields fields;
    if (!plan.carried) {
        fields.point = grid.point_fields;
        return fields;
    }
    const auto has = [](const std::vector<std::string>& names, const Field& field) {
        return std::find(names.begin(), names.end(), field.name) != names.end();
    };
    for (const Field& field : grid.point_fields) {
        if (has(plan.carried->point, field)) fields.point.push_back(field);
    }
    for (const Field& field : grid.cell_fields) {
        if (has(plan.carried->cell, field)) fields.cell.push_back(field);
    }
    for (const FoundField& component : plan.carried->components) {
        const Result<PointField> found = find_field(grid, component.name, {}, run);
        if (!found) return found.error();
        fields.point.push_back({component.name, found->values});
    }
    return fields;
}

} // namespace isotet::cli
