// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/med/med_fields.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/common_type.hpp"
#include "io/pieces/named_components.hpp"
#include "io/pieces/node_means.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::string_view no_profile = "MED_NO_PROFILE_INTERNAL";
constexpr std::int64_t max_components = 4096;
constexpr std::size_t letters_of_component = 16, entities_at_once = std::size_t{1} << 14;

std::optional<ScalarType> type_of_field(std::optional<std::int64_t> number) {
    switch (number.value_or(0)) {
    case 4: return ScalarType::float32;
    case 6: return ScalarType::float64;
    case 24:
    case 28: return ScalarType::int32;
    case 26: return ScalarType::int64;
    default: return std::nullopt;
    }
}

/// Of components; empty where they have none.
std::vector<std::string> names_in(std::string_view text, std::size_t components) {
    constexpr std::string_view filling(" \0", 2);
    std::vector<std::string> names(components);
    for (std::size_t i = 0; i < components && i * letters_of_component < text.size(); ++i) {
        const std::string_view name = text.substr(i * letters_of_component, letters_of_component);
        names[i] = name.substr(0, name.find_last_not_of(filling) + 1);
    }
    return names;
}

/// The names of six components end in XX YY ZZ XY XZ YZ.
bool is_tensor_of_med(std::span<const std::string> names) {
    static constexpr std::array<std::string_view, 6> ends{"XX", "YY", "ZZ", "XY", "XZ", "YZ"};
    return std::ranges::equal(names, ends,
                              [](const std::string& name, std::string_view end) { return name.ends_with(end); });
}

const char* kind_of_values(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

} // namespace

MedFields::MedFields(const MedFile& file, MedCells kind) : file_(file), kind_(kind) {
    for (const std::string& name : file.groups("/CHA"))
        for (MedField& field : describe(name)) fields_.push_back(std::move(field));
    for (const MedField& field : fields_)
        for (const MedStep& step : field.steps)
            if (!step.always()) steps_.push_back(step);
    std::ranges::stable_sort(steps_, {}, &MedStep::key);
    const auto repeated = std::ranges::unique(steps_, {}, &MedStep::key);
    steps_.erase(repeated.begin(), repeated.end());
}

std::vector<MedFields::MedField> MedFields::describe(const std::string& name) const {
    const std::string group = "/CHA/" + name;
    MedField field;
    field.name = field.array = name;
    field.mesh = file_.text(group, "MAI");
    field.steps = med_steps(file_, group);
    const auto type = type_of_field(file_.integer(group, "TYP"));
    const auto components = file_.integer(group, "NCO").value_or(0);
    if (!type || components < 1 || components > max_components) return {field};
    field.type = *type;
    field.in_array = static_cast<std::size_t>(components);
    for (const MedStep& step : field.steps)
        for (const std::string& place : file_.groups(step.group)) {
            const std::string cells = place.size() > 4 ? place.substr(4) : std::string();
            const bool read = med_element(cells, kind_) != nullptr;
            if (place == "NOE") field.at_nodes = true;
            else if (place.starts_with("MAI.") && read) field.in_cells = true;
            else if (place.starts_with("NOE.") && read) field.at_cell_nodes = true;
            else field.on_others = true;
        }
    const std::vector<std::string> names = names_in(file_.text(group, "NOM"), field.in_array);
    std::vector<MedField> fields;
    for (NamedComponents& part : fields_of_components(name, names)) {
        MedField& one = fields.emplace_back(field);
        one.name = std::move(part.name);
        one.first = part.first;
        one.components = part.count;
        one.swaps_last = part.count == 6 && is_tensor_of_med(std::span(names).first(6));
    }
    return fields;
}

bool MedFields::belong_to(const std::string& mesh) const {
    return std::ranges::find(fields_, mesh, &MedField::mesh) != fields_.end();
}

void MedFields::announce_all(FileInfo& info, std::optional<std::size_t> only) const {
    for (const MedField& field : fields_) {
        if (only && !step_of(field, *only)) continue;
        const auto drop = [&](std::string reason) { leave_out(info, {"field", field.array, std::move(reason)}); };
        if (field.components == 0) drop("its type or number of components is not known");
        else if (field.at_nodes || field.at_cell_nodes)
            announce(info, {field.name, Association::point, field.type, field.components});
        if (field.in_cells) announce(info, {field.name, Association::cell, field.type, field.components});
        if (field.on_others && field.first == 0 && !field.at_nodes && !field.at_cell_nodes && !field.in_cells)
            drop(kind_ == MedCells::flat ? "it has values on none of the cells that are read"
                                         : "it has values on points, lines and faces only");
    }
}

const MedStep* MedFields::step_of(const MedField& field, std::size_t step) const {
    const MedStep* found = nullptr;
    for (const MedStep& own : field.steps) {
        if (own.always()) found = &own;
        if (step < steps_.size() && own.key() == steps_[step].key()) return &own;
    }
    return found;
}

MedStep MedFields::step_of_mesh(const std::string& mesh, std::size_t step) const {
    for (const MedField& field : fields_) {
        const MedStep* const own = field.mesh == mesh ? step_of(field, step) : nullptr;
        if (!own) continue;
        return {file_.integer(own->group, "RDT").value_or(-1), file_.integer(own->group, "ROR").value_or(-1), 0, {}};
    }
    return {};
}

Result<std::vector<std::uint64_t>> MedFields::read_profile(const std::string& name, std::uint64_t count) const {
    const std::string data_set = "/PROFILS/" + name + "/PFL";
    const auto shape = file_.shape(data_set);
    if (!shape || is_floating(shape->type))
        return file_.wrong(fmt::format("profile \"{}\" is not there", escaped(name)));
    const auto numbers = file_.numbers(data_set, shape->rows);
    if (!numbers) return numbers.error();
    std::vector<std::uint64_t> places(numbers->size());
    bool inside = true;
    numbers->visit([&](auto from) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            places[i] = static_cast<std::uint64_t>(from[i]) - 1;
            inside = inside && places[i] < count;
        }
    });
    if (!inside)
        return file_.wrong(fmt::format("profile \"{}\" has numbers that are not 1 to {}", escaped(name), count));
    return places;
}

Result<std::vector<MedFields::MedPart>> MedFields::parts_of(const MedField& field, const std::string& group,
                                                            std::uint64_t first, std::uint64_t count) const {
    std::vector<MedPart> parts;
    for (const std::string& profile : file_.groups(group)) {
        MedPart part;
        part.first = first;
        part.count = count;
        const std::string inside = group + "/" + profile;
        if (profile != no_profile) {
            auto chosen = read_profile(profile, count);
            if (!chosen) return chosen.error();
            part.chosen = *std::move(chosen);
        }
        const auto points = file_.integer(inside, "NGA").value_or(1);
        constexpr std::int64_t max_points = 100'000;
        if (points < 1 || points > max_points)
            return file_.wrong(fmt::format("\"{}\" has {} values for each of its cells", escaped(inside), points));
        part.per_entity = static_cast<std::uint64_t>(points);
        const std::uint64_t rows = part.entities() * part.per_entity;
        auto values = file_.numbers(inside + "/CO", rows * field.in_array, rows * field.first, rows * field.components);
        if (!values) return values.error();
        part.values = *std::move(values);
        parts.push_back(std::move(part));
    }
    return parts;
}

Result<std::vector<MedFields::MedPart>> MedFields::parts_in_cells(const MedField& field, const MedStep& step,
                                                                  const MedMeshPlace& place, const char* kind) const {
    std::vector<MedPart> all;
    for (const MedCellRun& run : place.runs) {
        const std::string group = fmt::format("{}/{}.{}", step.group, kind, run.element->name);
        auto parts = parts_of(field, group, run.first, run.count);
        if (!parts) return parts.error();
        for (MedPart& part : *parts) {
            part.run = &run;
            all.push_back(std::move(part));
        }
    }
    return all;
}

/// Of several values of an entity the mean.
template <class T>
void MedFields::put(const MedField& field, const MedPart& part, std::vector<T>& values) {
    const std::size_t width = field.components;
    const std::uint64_t entities = part.entities(), points = part.per_entity;
    part.values.visit([&](auto from) {
        const auto put_range = [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = 0; c < width; ++c)
                for (std::size_t i = begin; i < end; ++i) {
                    T& to = values[(part.first + part.entity(i)) * width + field.place_of(c)];
                    const auto own = from.subspan((c * entities + i) * points, points);
                    double sum = 0;
                    for (std::uint64_t g = 0; points > 1 && g < points; ++g) sum += static_cast<double>(own[g]);
                    to = points > 1 ? static_cast<T>(sum / static_cast<double>(points)) : static_cast<T>(own[0]);
                }
        };
        if (part.chosen) put_range(0, entities); // a broken profile may name an entity twice
        else core::parallel_ranges(entities, entities_at_once, put_range);
    });
}

/// Where every entity has one value, in the type of the file.
Array MedFields::joined(const MedField& field, const std::vector<MedPart>& parts, std::uint64_t count) {
    std::uint64_t given = 0;
    bool means = false;
    ScalarType type = parts.front().values.type();
    for (const MedPart& part : parts) {
        if (!part.chosen) given += part.count;
        means = means || part.per_entity > 1;
        type = common_type(type, part.values.type());
    }
    if (means || type != parts.front().values.type()) type = ScalarType::float64;
    if (given != count) type = with_missing(type);
    return Array(type, nullptr, 0, 1, nullptr).visit([&](auto none) {
        using T = std::remove_const_t<typename decltype(none)::value_type>;
        std::vector<T> values(count * field.components,
                              std::is_floating_point_v<T> ? std::numeric_limits<T>::quiet_NaN() : T{});
        for (const MedPart& part : parts) put(field, part, values);
        return Array::own(std::move(values), field.components);
    });
}

Result<Array> MedFields::at_cell_nodes(const MedField& field, const std::vector<MedPart>& parts, const MedMesh& mesh,
                                       const MedMeshPlace& place, std::vector<std::string>& notes) const {
    NodeMeans means(place.points, field.components);
    for (const MedPart& part : parts) {
        const std::size_t width = part.run->element->nodes;
        if (part.per_entity != width)
            return file_.wrong(fmt::format("field \"{}\" has {} values in each cell of {}, which has {} nodes",
                                           escaped(field.name), part.per_entity, part.run->element->name, width));
        const auto nodes = mesh.nodes_of(*part.run, place.points);
        if (!nodes) return nodes.error();
        const std::uint64_t entities = part.entities();
        part.values.visit([&](auto from) {
            for (std::uint64_t i = 0; i < entities; ++i)
                for (std::size_t node = 0; node < width; ++node) {
                    const auto point = static_cast<std::uint64_t>((*nodes)[part.entity(i) * width + node]);
                    means.count(point);
                    for (std::size_t c = 0; c < field.components; ++c)
                        means.add(point, field.place_of(c),
                                  static_cast<double>(from[(c * entities + i) * width + node]));
                }
        });
    }
    if (auto note = means.note(field.name, "each cell (ELNO)"); !note.empty()) notes.push_back(std::move(note));
    return Array::own(means.means(), field.components);
}

/// An array of no component: the field has no values here.
Result<Array> MedFields::at_nodes(const MedField& field, const MedStep& step, const MedMesh& mesh,
                                  const MedMeshPlace& place, std::vector<std::string>& notes) const {
    const auto parts = parts_of(field, step.group + "/NOE", 0, place.points);
    if (!parts) return parts.error();
    if (!parts->empty()) return joined(field, *parts, place.points);
    const auto in_each = parts_in_cells(field, step, place, "NOE");
    if (!in_each) return in_each.error();
    return in_each->empty() ? Result<Array>(Array()) : at_cell_nodes(field, *in_each, mesh, place, notes);
}

Result<Array> MedFields::in_cells(const MedField& field, const MedStep& step, const MedMeshPlace& place,
                                  std::vector<std::string>& notes) const {
    const auto parts = parts_in_cells(field, step, place, "MAI");
    if (!parts) return parts.error();
    if (parts->empty()) return Array();
    std::uint64_t most = 1;
    for (const MedPart& part : *parts) most = std::max(most, part.per_entity);
    if (most > 1)
        notes.push_back(fmt::format("cell field \"{}\" has up to {} values in a cell, at integration points: their "
                                    "mean was taken",
                                    escaped(field.array), most));
    return joined(field, *parts, place.cells);
}

Result<void> MedFields::read(const ReadOptions& options, std::size_t step, const MedMesh& mesh,
                             const MedMeshPlace& place, Grid& grid, Loaded& loaded) const {
    std::vector<std::string> without;
    std::string noted; // once of all fields of an array
    for (const MedField& field : fields_)
        for (const auto association : {Association::point, Association::cell}) {
            const bool of_points = association == Association::point;
            const bool known = of_points ? field.at_nodes || field.at_cell_nodes : field.in_cells;
            if (!known || field.mesh != mesh.name() || !wanted(options, association, field.name)) continue;
            const MedStep* const own = step_of(field, step);
            std::vector<std::string> notes;
            auto values = !own        ? Result<Array>(Array())
                          : of_points ? at_nodes(field, *own, mesh, place, notes)
                                      : in_cells(field, *own, place, notes);
            const std::string of_array = kind_of_values(association) + field.array;
            if (!notes.empty() && std::exchange(noted, of_array) != of_array)
                loaded.notes.insert(loaded.notes.end(), notes.begin(), notes.end());
            if (!values && values.error().code != ErrorCode::invalid_data) return values.error();
            if (!values) leave_out(loaded.info, {kind_of_values(association), field.name, values.error().message});
            else if (values->empty()) without.push_back("\"" + escaped(field.array) + "\"");
            else (of_points ? grid.point_fields : grid.cell_fields).push_back({field.name, *std::move(values)});
        }
    const auto again = std::ranges::unique(without);
    without.erase(again.begin(), again.end());
    if (!without.empty())
        loaded.notes.push_back(fmt::format("step {} has no values of {}", step, fmt::join(without, ", ")));
    return {};
}

} // namespace isotet::io::confined
