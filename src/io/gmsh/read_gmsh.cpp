// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MSH files as grids: which fields and times there are, and the arrays of one step.
#include "io/gmsh/read_gmsh.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "grid/cells.hpp"
#include "grid/patches.hpp"
#include "io/gmsh/read_gmsh_parts.hpp"
#include "io/pieces/join/join.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

using namespace gmsh;

constexpr std::string_view physical_name = "gmsh:physical", geometrical_name = "gmsh:geometrical",
                           partition_name = "gmsh:partition";

/// The file before its numbers are read. Sections are views into the bytes.
struct Contents {
    File file;
    std::vector<DataSection> data;
    Wants tags; ///< those the file has
    FileInfo info;
    std::vector<std::string> notes;
    std::vector<std::size_t> step_of;                                                    ///< of each data section
    std::map<std::pair<Association, std::string>, std::vector<std::size_t>> sections_of; ///< of each field
};

/// Times by value; by step number where one field has two sections of one time value. Fields of one step hold always, and
/// have no say where others have several.
void find_times(Contents& contents) {
    std::set<std::tuple<Association, std::string, double, std::int32_t>> seen;
    bool by_step = false;
    for (const DataSection& data : contents.data) {
        const auto next =
            seen.lower_bound({data.association(), data.name, data.time, std::numeric_limits<std::int32_t>::min()});
        const bool met = next != seen.end() && std::get<0>(*next) == data.association() &&
                         std::get<1>(*next) == data.name && std::get<2>(*next) == data.time;
        by_step = by_step || (met && std::get<3>(*next) != data.step);
        seen.insert({data.association(), data.name, data.time, data.step});
    }
    const auto value_of = [&](const DataSection& data) { return by_step ? data.step : data.time; };
    std::map<std::pair<Association, std::string>, std::set<double>> of_fields;
    for (const DataSection& data : contents.data) of_fields[{data.association(), data.name}].insert(value_of(data));
    std::set<double> several, single;
    for (const auto& [field, values] : of_fields)
        (values.size() > 1 ? several : single).insert(values.begin(), values.end());
    const std::set<double>& times = several.empty() && single.size() == 1 ? single : several;
    const std::vector<double> all(times.begin(), times.end());
    for (const DataSection& data : contents.data) {
        const auto step = std::lower_bound(all.begin(), all.end(), value_of(data));
        contents.step_of.push_back(static_cast<std::size_t>(step - all.begin()));
    }
    if (all.size() > 1 || (all.size() == 1 && all.front() != 0)) contents.info.times = all;
}

/// Sections of one name, time and step are parts of one view, of partitions, say, or views of their own, as where they have
/// more values than the file has nodes or elements: then the second is called NAME_1, and so on.
void name_views(Contents& contents) {
    struct View {
        std::string name;
        std::uint64_t values = 0;
        std::set<std::int32_t> partitions;
        int later = 0;
    };
    const Totals totals = totals_of(contents.file);
    std::map<std::tuple<DataKind, std::string, double, std::int32_t>, View> views;
    std::set<std::string> names, told;
    for (const DataSection& data : contents.data) names.insert(data.name);
    for (DataSection& data : contents.data) {
        View& view = views[{data.kind, data.name, data.time, data.step}];
        if (view.values == 0) view.name = data.name;
        const std::uint64_t most = data.kind == DataKind::node ? totals.nodes : totals.elements;
        const auto count = static_cast<std::uint64_t>(data.count);
        const bool same_part = data.partition > 0 && view.partitions.contains(data.partition);
        if (view.values > 0 && (same_part || count > most || view.values > most - count)) {
            do view.name = fmt::format("{}_{}", data.name, ++view.later);
            while (names.contains(view.name));
            if (told.insert(view.name).second)
                contents.notes.push_back(fmt::format("several views are called {}: one of them was read as {}",
                                                     in_quotes(data.name), in_quotes(view.name)));
            view.values = 0;
            view.partitions.clear();
        }
        view.values += count;
        view.partitions.insert(data.partition);
        data.name = view.name;
    }
}

std::string kind_of_field(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

/// Sections that do not fit the first of their name are left out.
void find_fields(Contents& contents) {
    std::vector<FieldInfo>& fields = contents.info.fields;
    for (std::size_t i = 0; i < contents.data.size(); ++i) {
        const DataSection& data = contents.data[i];
        std::vector<std::size_t>& sections = contents.sections_of[{data.association(), data.name}];
        const DataSection& first = contents.data[sections.empty() ? i : sections.front()];
        if (first.components != data.components || first.kind != data.kind) {
            leave_out(contents.info,
                      {kind_of_field(data.association()), data.name,
                       fmt::format("a section ${} of it has {} components, but the first one is ${} with {}",
                                   data.section->name, data.components, first.section->name, first.components)});
            continue;
        }
        sections.push_back(i);
        if (sections.size() > 1) continue;
        fields.push_back(
            {data.name, data.association(), ScalarType::float64, static_cast<std::size_t>(data.components)});
    }
    const auto add_tags = [&](std::string_view name) {
        fields.push_back({std::string(name), Association::cell, ScalarType::int32, 1});
    };
    if (contents.tags.physical) add_tags(physical_name);
    if (contents.tags.geometrical) add_tags(geometrical_name);
    if (contents.tags.partition) add_tags(partition_name);
}

/// What is there beside the mesh and its data, and what is there again.
void look_at_other_sections(Contents& contents) {
    static const std::set<std::string_view> known{
        "MeshFormat", "PhysicalNames",      "Entities",    "PartitionedEntities", "Nodes", "ParametricNodes",
        "Elements",   "NodeData",           "ElementData", "ElementNodeData",     "NOD",   "ELM",
        "Comments",   "InterpolationScheme"},
        of_no_use{"Periodic", "Parametrizations", "GhostElements"},
        repeated{"NodeData", "ElementData", "ElementNodeData", "InterpolationScheme", "Comments", "MeshFormat"};
    std::map<std::string_view, const Section*> first;
    std::set<std::string> again, differing;
    for (const Section& section : contents.file.sections) {
        const std::string name = "$" + std::string(section.name.substr(0, 40));
        if (of_no_use.contains(section.name))
            leave_out(contents.info, {"section", name, "it does not change the grid"});
        else if (!known.contains(section.name)) leave_out(contents.info, {"section", name, "it is not known"});
        const auto [place, is_first] = first.insert({section.name, &section});
        if (is_first || repeated.contains(section.name) || !known.contains(section.name)) continue;
        const bool is_mesh = section.name.ends_with("Nodes") || section.name == "Elements";
        (is_mesh || section.body == place->second->body ? again : differing).insert(name);
    }
    if (!again.empty())
        contents.notes.push_back(
            fmt::format("{} occur again, as Gmsh writes them before each view that it appends: the "
                        "first were taken",
                        fmt::join(again, ", ")));
    for (const std::string& name : differing)
        contents.notes.push_back(fmt::format("{} occurs again, with other content: the first was taken", name));
}

Result<Contents> open_contents(std::string_view bytes) {
    auto file = gmsh::open(bytes);
    if (!file) return file.error();
    Contents contents;
    contents.info.format = "gmsh";
    contents.file = std::move(*file);
    contents.data = data_sections(contents.file, contents.info);
    const auto tags = tags_of(contents.file);
    if (!tags) return tags.error();
    contents.tags = *tags;
    if (contents.tags.physical) {
        auto names = names_of_groups(contents.file, 3, physical_name);
        if (names) contents.info.regions = *std::move(names);
        else contents.notes.push_back(names.error().message + "; regions have no names");
    }
    name_views(contents);
    find_times(contents);
    find_fields(contents);
    look_at_other_sections(contents);
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

/// Whether sections give its values: else it is one of tags.
bool is_of_data(const FieldInfo& field) { return field.type == ScalarType::float64; }

/// Values at nodes, of each element its own: one of them where they agree, else means, with a note.
Result<Array> corner_values(const std::vector<const DataSection*>& sections, const FieldInfo& info, const Mesh& mesh,
                            Pace& pace, ReadResult& result) {
    NodeMeans means(mesh.nodes.size(), info.components);
    for (const DataSection* section : sections)
        if (auto read = read_corner_values(*section, mesh, pace, means); !read) return read.error();
    if (auto note = means.note(info.name, "each element ($ElementNodeData)"); !note.empty())
        result.notes.push_back(std::move(note));
    return Array::own(means.means(), info.components);
}

Result<Array> data_values(const std::vector<const DataSection*>& sections, const FieldInfo& info, const Mesh& mesh,
                          Pace& pace, ReadResult& result) {
    if (sections.front()->kind == DataKind::element_node) return corner_values(sections, info, mesh, pace, result);
    const bool point = info.association == Association::point;
    const NumberMap& numbers = point ? mesh.nodes : mesh.elements;
    std::vector<double> values(numbers.size() * info.components, std::numeric_limits<double>::quiet_NaN());
    std::uint64_t replaced = 0;
    for (const DataSection* section : sections)
        if (auto read = read_values(*section, numbers, pace, values, replaced); !read) return read.error();
    if (replaced > 0)
        result.notes.push_back(fmt::format("{} {} has {} values twice, which differ: the last ones were taken",
                                           kind_of_field(info.association), in_quotes(info.name), replaced));
    return Array::own(std::move(values), info.components);
}

/// A field whose values are broken is left out, and no longer announced.
Result<void> add_data_field(const Contents& contents, const FieldInfo& info, std::size_t step, const Mesh& mesh,
                            Pace& pace, ReadResult& result) {
    const auto sections = sections_at(contents, info, step);
    if (sections.empty()) {
        result.notes.push_back(fmt::format("{} has no values at step {} and is left out", in_quotes(info.name), step));
        return {};
    }
    auto values = data_values(sections, info, mesh, pace, result);
    if (values) {
        auto& fields = info.association == Association::point ? result.grid.point_fields : result.grid.cell_fields;
        fields.push_back({info.name, *std::move(values)});
        return {};
    }
    if (values.error().code != ErrorCode::invalid_data) return values.error();
    leave_out(result.info, {kind_of_field(info.association), info.name, values.error().message});
    std::erase_if(result.info.fields, [&](const FieldInfo& field) {
        return field.name == info.name && field.association == info.association;
    });
    return {};
}

/// Elements of physical surfaces.
Result<BoundaryPatches> physical_surfaces(const File& file, const Grid& grid,
                                          const std::vector<std::int32_t>& physical) {
    core::PatchList list;
    if (const auto names = names_of_groups(file, 2, physical_name)) // what is wrong with them has been noted
        for (const RegionName& name : *names) list.name(name.number, name.name);
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    for (std::size_t cell = 0; cell < cells->count(); ++cell) {
        if (!core::is_flat_cell(cells->type(cell)) || physical[cell] <= 0) continue;
        for (std::uint64_t k = 0; k < cells->corners(cell); ++k)
            list.point(static_cast<std::int64_t>(cells->corner(cells->first(cell) + k)));
        list.end_face(physical[cell]);
    }
    return list.finish();
}

/// Physical groups of volumes and surfaces by name or number.
std::vector<std::pair<std::int32_t, std::int32_t>> chosen_groups(const File& file,
                                                                 const std::vector<std::string>& blocks) {
    std::vector<std::pair<std::int32_t, std::int32_t>> groups;
    for (const std::int32_t dimension : {3, 2}) {
        const auto names = names_of_groups(file, dimension, physical_name); // what is wrong with them has been noted
        for (const std::string& block : blocks) {
            std::int32_t number = 0;
            if (parse_number(block, number)) groups.emplace_back(dimension, number);
            for (const RegionName& region : names ? *names : std::vector<RegionName>())
                if (region.name == block) groups.emplace_back(dimension, static_cast<std::int32_t>(region.number));
        }
    }
    return groups;
}

/// A file of one partition may have a layer of elements of others; old files repeat those that are in several groups.
Result<ReadResult> without_left_out(ReadResult result, const Mesh& mesh) {
    std::vector<std::uint8_t> left_out = mesh.left_out;
    std::vector<std::string> notes = result.notes;
    Loaded loaded;
    loaded.info = std::move(result.info);
    loaded.step = result.step;
    loaded.notes = std::move(result.notes);
    Piece& piece = loaded.pieces.emplace_back();
    left_out.resize(result.grid.cells.count());
    piece.grid = std::move(result.grid);
    piece.left_out = std::move(left_out);
    auto rest = join(std::move(loaded), {});
    if (!rest || mesh.repeats == 0) return rest;
    notes.push_back(fmt::format("{} elements are there again for another physical group: the first was taken; `block` "
                                "takes all of a group",
                                mesh.repeats));
    rest->notes = std::move(notes); // those of join() speak of ghost cells
    return rest;
}

} // namespace

Result<FileInfo> inspect_gmsh(std::string_view bytes, const Progress&, std::optional<std::size_t> step) {
    auto contents = open_contents(bytes);
    if (!contents) return contents.error();
    FileInfo info = contents->info;
    if (step)
        std::erase_if(info.fields, [&](const FieldInfo& field) {
            return is_of_data(field) && sections_at(*contents, field, *step).empty();
        });
    return info;
}

Result<ReadResult> parse_gmsh(std::string_view bytes, const ReadOptions& options, const Progress& progress) {
    auto contents = open_contents(bytes);
    if (!contents) return contents.error();
    const auto step = choose_step(contents->info, options);
    if (!step) return step.error();

    Wants wants;
    wants.all_groups = !options.blocks.empty();
    wants.groups = chosen_groups(contents->file, options.blocks);
    wants.physical = contents->tags.physical && wanted(options, Association::cell, physical_name);
    const bool wants_patches = options.patches && contents->tags.physical, wants_physical = wants.physical;
    wants.physical = wants.physical || wants_patches;
    wants.geometrical = contents->tags.geometrical && wanted(options, Association::cell, geometrical_name);
    wants.partition = contents->tags.partition && wanted(options, Association::cell, partition_name);
    for (const DataSection& data : contents->data) {
        if (data.kind == DataKind::node || !wanted(options, data.association(), data.name)) continue;
        wants.element_numbers = true;
        wants.element_points = wants.element_points || data.kind == DataKind::element_node;
    }
    Pace pace(progress, bytes.size());
    auto mesh = read_mesh(contents->file, wants, pace);
    if (!mesh) return mesh.error();

    ReadResult result;
    result.info = contents->info;
    result.notes = contents->notes;
    result.step = *step;
    Grid& grid = result.grid;
    grid.points = Array::own(std::move(mesh->points), 3);
    grid.cells = mesh->cells.finish();
    for (const FieldInfo& field : contents->info.fields) {
        if (!is_of_data(field) || !wanted(options, field.association, field.name)) continue;
        if (auto added = add_data_field(*contents, field, *step, *mesh, pace, result); !added) return added.error();
    }
    const auto add_tags = [&](bool is_wanted, std::string_view name, std::vector<std::int32_t>& tags) {
        if (is_wanted) grid.cell_fields.push_back({std::string(name), Array::own(std::move(tags))});
    };
    if (wants_patches) {
        auto patches = physical_surfaces(contents->file, grid, mesh->physical);
        if (!patches) return patches.error();
        grid.patches = *std::move(patches);
    }
    add_tags(wants_physical, physical_name, mesh->physical);
    add_tags(wants.geometrical, geometrical_name, mesh->geometrical);
    add_tags(wants.partition, partition_name, mesh->partition);
    return mesh->left_out.empty() ? std::move(result) : without_left_out(std::move(result), *mesh);
}

} // namespace isotet::io
