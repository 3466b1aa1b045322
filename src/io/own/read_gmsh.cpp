// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MSH files as grids: which fields and times there are, and the arrays of one step.
#include "io/own/read_gmsh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "io/own/read_gmsh_parts.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

using namespace gmsh;

constexpr std::string_view physical_name = "gmsh:physical", geometrical_name = "gmsh:geometrical";

/// The file before its numbers are read. Sections are views into the bytes.
struct Contents {
    File file;
    std::vector<DataSection> data;
    Wants tags; ///< those the file has
    FileInfo info;
    std::vector<std::size_t> step_of;                                                    ///< of each data section
    std::map<std::pair<Association, std::string>, std::vector<std::size_t>> sections_of; ///< of each field
};

/// Times by value; by step number where one field has two sections of one time value.
void find_times(Contents& contents) {
    std::set<double> times, steps;
    std::set<std::tuple<Association, std::string, double, std::int32_t>> seen;
    bool by_step = false;
    for (const DataSection& data : contents.data) {
        times.insert(data.time);
        steps.insert(data.step);
        const auto next =
            seen.lower_bound({data.association, data.name, data.time, std::numeric_limits<std::int32_t>::min()});
        const bool met = next != seen.end() && std::get<0>(*next) == data.association &&
                         std::get<1>(*next) == data.name && std::get<2>(*next) == data.time;
        by_step = by_step || (met && std::get<3>(*next) != data.step);
        seen.insert({data.association, data.name, data.time, data.step});
    }
    const std::set<double>& different = by_step ? steps : times;
    const std::vector<double> all(different.begin(), different.end());
    for (const DataSection& data : contents.data) {
        const auto step = std::lower_bound(all.begin(), all.end(), by_step ? data.step : data.time);
        contents.step_of.push_back(static_cast<std::size_t>(step - all.begin()));
    }
    if (all.size() > 1 || (all.size() == 1 && all.front() != 0)) contents.info.times = all;
}

Result<void> find_fields(Contents& contents) {
    std::vector<FieldInfo>& fields = contents.info.fields;
    for (std::size_t i = 0; i < contents.data.size(); ++i) {
        const DataSection& data = contents.data[i];
        std::vector<std::size_t>& sections = contents.sections_of[{data.association, data.name}];
        sections.push_back(i);
        const DataSection& first = contents.data[sections.front()];
        if (first.components != data.components) {
            return broken(*data.section, fmt::format("{} has {} components, but {} in an earlier section",
                                                     in_quotes(data.name), data.components, first.components));
        }
        if (sections.size() > 1) continue;
        const auto components = static_cast<std::size_t>(data.components);
        fields.push_back({data.name, data.association, ScalarType::float64, components});
    }
    const auto add_tags = [&](std::string_view name) {
        fields.push_back({std::string(name), Association::cell, ScalarType::int32, 1});
    };
    if (contents.tags.physical) add_tags(physical_name);
    if (contents.tags.geometrical) add_tags(geometrical_name);
    return {};
}

Result<Contents> open_contents(std::string_view bytes) {
    auto file = gmsh::open(bytes);
    if (!file) return file.error();
    Contents contents;
    contents.file = std::move(*file);
    auto data = data_sections(contents.file);
    if (!data) return data.error();
    contents.data = std::move(*data);
    for (const DataSection& section : contents.data) {
        if (std::isnan(section.time))
            return broken(*section.section, in_quotes(section.name) + " has a time that is not a number");
    }
    const auto tags = contents.file.version_4 ? tags_of_4(contents.file) : tags_of_2(contents.file);
    if (!tags) return tags.error();
    contents.tags = *tags;
    if (contents.tags.physical) {
        auto names = names_of_volumes(contents.file, physical_name);
        if (!names) return names.error();
        contents.info.regions = *std::move(names);
    }
    contents.info.format = "gmsh";
    find_times(contents);
    if (const auto fields = find_fields(contents); !fields) return fields.error();
    return contents;
}

/// The sections of a field that give its values at `step`: those of the step, or all when the field has one step only.
std::vector<const DataSection*> sections_at(const Contents& contents, const FieldInfo& field, std::size_t step) {
    std::vector<const DataSection*> at_step, all;
    std::set<std::size_t> steps;
    for (const std::size_t i : contents.sections_of.at({field.association, field.name})) {
        all.push_back(&contents.data[i]);
        if (contents.step_of[i] == step) at_step.push_back(&contents.data[i]);
        steps.insert(contents.step_of[i]);
    }
    return steps.size() == 1 ? all : at_step;
}

Result<void> add_data_field(const Contents& contents, const FieldInfo& info, std::size_t step, const Mesh& mesh,
                            Pace& pace, ReadResult& result) {
    const auto sections = sections_at(contents, info, step);
    if (sections.empty()) {
        result.notes.push_back(fmt::format("{} has no values at step {} and is left out", in_quotes(info.name), step));
        return {};
    }
    const bool point = info.association == Association::point;
    const NumberMap& numbers = point ? mesh.nodes : mesh.elements;
    std::vector<double> values(numbers.size() * info.components, std::numeric_limits<double>::quiet_NaN());
    for (const DataSection* section : sections) {
        if (auto read = read_values(contents.file, *section, numbers, pace, values); !read) return read;
    }
    auto& fields = point ? result.grid.point_fields : result.grid.cell_fields;
    fields.push_back({info.name, Array::own(std::move(values), info.components)});
    return {};
}

} // namespace

Result<FileInfo> inspect_gmsh(std::string_view bytes, const Progress&) {
    auto contents = open_contents(bytes);
    if (!contents) return contents.error();
    return std::move(contents->info);
}

Result<ReadResult> parse_gmsh(std::string_view bytes, const ReadOptions& options, const Progress& progress) {
    auto contents = open_contents(bytes);
    if (!contents) return contents.error();
    const auto step = choose_step(contents->info, options);
    if (!step) return step.error();

    Wants wants;
    wants.physical = contents->tags.physical && wanted(options, Association::cell, physical_name);
    wants.geometrical = contents->tags.geometrical && wanted(options, Association::cell, geometrical_name);
    for (const FieldInfo& field : contents->info.fields) {
        const bool has_sections = contents->sections_of.contains({field.association, field.name});
        wants.element_numbers |=
            has_sections && field.association == Association::cell && wanted(options, field.association, field.name);
    }
    Pace pace(progress, bytes.size());
    auto mesh =
        contents->file.version_4 ? read_mesh_4(contents->file, wants, pace) : read_mesh_2(contents->file, wants, pace);
    if (!mesh) return mesh.error();
    if (const auto closed = mesh->elements.close("element"); !closed) return closed.error();

    ReadResult result;
    result.info = contents->info;
    result.step = *step;
    Grid& grid = result.grid;
    grid.points = Array::own(std::move(mesh->points), 3);
    grid.cells = mesh->cells.finish();
    for (const FieldInfo& field : result.info.fields) {
        if (field.type != ScalarType::float64 || !wanted(options, field.association, field.name)) continue;
        if (auto added = add_data_field(*contents, field, *step, *mesh, pace, result); !added) return added.error();
    }
    if (wants.physical) grid.cell_fields.push_back({std::string(physical_name), Array::own(std::move(mesh->physical))});
    if (wants.geometrical) {
        grid.cell_fields.push_back({std::string(geometrical_name), Array::own(std::move(mesh->geometrical))});
    }
    if (contents->file.find("ElementNodeData")) {
        result.notes.emplace_back("$ElementNodeData (values for each corner of each element) is left out");
    }
    return result;
}

} // namespace isotet::io
