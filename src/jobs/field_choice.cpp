// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/field_choice.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/fields.hpp>
#include <isotet/first_view.hpp>
#include <isotet/linear_cells.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_coordinate(const std::string& name) { return name == "x" || name == "y" || name == "z"; }

std::vector<std::string> all_names(const GridSource& source) {
    std::vector<std::string> names = source.names(Association::point);
    add_names(names, source.names(Association::cell));
    return names;
}

/// The fields to read for a name that find_field() takes; none where it is of no field.
std::vector<std::string> arrays_of(const std::string& name, const std::vector<std::string>& names) {
    const auto match = match_field_name(name, names);
    if (!match) return {};
    return match->parts.empty() ? std::vector<std::string>{match->field} : match->parts;
}

/// The fields that a name stands for that no field has; none where it is that of one component.
std::vector<std::string> parts_of(const std::string& name, const std::vector<std::string>& names) {
    const auto match = match_field_name(name, names);
    return match && !match->component ? match->parts : std::vector<std::string>();
}

/// The fields to read for an expression.
Result<FoundField> find_expression(const GridSource& source, const std::string& text) {
    const auto arrays = arrays_of_field(text, source.names(Association::point), source.names(Association::cell));
    if (!arrays) return arrays.error();
    return FoundField{text, arrays->point, arrays->cell, arrays->neighbours, true};
}

/// The first comma that is in no brackets.
std::size_t comma_between(const std::string& names) {
    int depth = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == '(') ++depth;
        if (names[i] == ')') --depth;
        if (names[i] == ',' && depth <= 0) return i;
    }
    return std::string::npos;
}

/// Adds what one argument of --with names.
Result<void> add_carried(const GridSource& source, const std::string& name, CarriedFields& carried) {
    const std::vector<std::string> point = source.names(Association::point), cell = source.cell_names();
    if (has(point, name)) add_names(carried.point, {name});
    else if (has(cell, name)) add_names(carried.cell, {name});
    else if (const auto arrays = arrays_of(name, point); !arrays.empty())
        carried.components.push_back({name, arrays, {}});
    else if (is_coordinate(name)) carried.components.push_back({name, {}, {}});
    else if (const auto parts = parts_of(name, cell); !parts.empty()) add_names(carried.cell, parts);
    else if (match_field_name(name, cell))
        return refusal("`with` got '{}', a component of a cell field, but cell fields are carried whole", name);
    else if (looks_like_expression(name) && needs_of_expression(name, all_names(source)))
        carried.components.push_back(*find_expression(source, name));
    else if (const std::size_t comma = comma_between(name); comma != std::string::npos) {
        if (auto first = add_carried(source, name.substr(0, comma), carried); !first) return first;
        return add_carried(source, name.substr(comma + 1), carried);
    } else if (looks_like_expression(name)) return find_expression(source, name).error();
    else if (!name.empty()) return source.no_such_field(name);
    return {};
}

} // namespace

void add_names(std::vector<std::string>& names, const std::vector<std::string>& more) {
    for (const std::string& name : more) {
        if (!has(names, name)) names.push_back(name);
    }
}

Result<FoundField> choose_field(const GridSource& source, const FieldChoice& choice) {
    FoundField found{choice.name, {}, {}};
    if (choice.shape) return found;
    if (found.name.empty()) {
        const std::vector<std::string> names = all_names(source);
        if (names.size() != 1) {
            const std::string there =
                names.empty() ? "none; `field` x, y or z contours a coordinate"
                              : fmt::format("{}: {}; `field` chooses one", names.size(), quoted_list(names));
            return refusal("no field was named, and the grid has {}", there);
        }
        found.name = names.front();
    }
    const bool is_field = is_coordinate(found.name) || !arrays_of(found.name, all_names(source)).empty() ||
                          has(source.cell_names(), found.name);
    if (!is_field && looks_like_expression(found.name)) {
        auto expression = find_expression(source, found.name);
        if (!expression) return expression;
        found = *std::move(expression);
        if (choice.cell_field && found.cell.empty())
            return refusal("`cell_field` was asked for, but '{}' has no cell field", found.name);
        return found;
    }
    found.point = arrays_of(found.name, source.names(Association::point));
    found.cell = arrays_of(found.name, source.cell_names());
    if (found.point.empty() && found.cell.empty() && !is_coordinate(found.name))
        return source.no_such_field(found.name);
    if (choice.cell_field && found.cell.empty()) {
        return refusal("`cell_field` was asked for, but '{}' is no cell field", found.name);
    }
    return found;
}

Result<std::vector<std::string>> choose_field_names(const GridSource& source, const std::vector<std::string>& texts,
                                                    FieldChoice choice) {
    std::vector<std::string> names;
    for (const std::string& text : texts) {
        choice.name = text;
        const Result<FoundField> found = choose_field(source, choice);
        const std::size_t comma = found ? std::string::npos : comma_between(text);
        if (found) names.push_back(text);
        else if (comma == std::string::npos) return found.error();
        else {
            auto listed = choose_field_names(source, {text.substr(0, comma), text.substr(comma + 1)}, choice);
            if (!listed) return listed;
            names.insert(names.end(), listed->begin(), listed->end());
        }
    }
    return names;
}

std::string skipped_note(const std::string& field, const std::vector<std::size_t>& skipped, std::size_t steps) {
    return fmt::format("'{}' is not in {} of the {} time steps, which {} skipped: {}", field, skipped.size(), steps,
                       skipped.size() == 1 ? "is" : "are", fmt::join(skipped, ", "));
}

Result<std::vector<std::size_t>> steps_with_fields(GridSource& source, std::vector<std::size_t> steps,
                                                   const std::vector<std::string>& names, Caller& caller) {
    if (steps.size() < 2 || names.empty()) return steps;
    if (auto looked = source.look_at_steps(steps, caller); !looked) return looked.error();
    for (const BrokenStep& broken : source.broken_steps()) {
        caller.note(fmt::format("step {} cannot be read and is left out: {}", broken.step, broken.error.message));
        std::erase(steps, broken.step);
    }
    for (const std::string& name : names) {
        if (const auto found = choose_field(source, {name, false}); !found) return found.error();
        std::vector<std::size_t> skipped;
        for (const std::size_t step : steps)
            if (!source.has_field(step, name)) skipped.push_back(step);
        if (skipped.empty()) continue;
        if (skipped.size() == steps.size())
            return refusal("'{}' is in other time steps than the fields before it", name);
        caller.note(skipped_note(name, skipped, steps.size()));
        std::erase_if(steps, [&](std::size_t step) { return std::ranges::find(skipped, step) != skipped.end(); });
    }
    return steps;
}

Result<CarriedFields> choose_carried(const GridSource& source, const std::vector<std::string>& names) {
    CarriedFields carried;
    for (const std::string& name : names)
        if (auto added = add_carried(source, name, carried); !added) return added.error();
    return carried;
}

bool is_averaged_while_read(const FoundField& field, const FieldChoice& choice) {
    const bool is_one = field.cell.size() == 1 || (field.is_expression && !field.cell.empty());
    return field.point.empty() && is_one && !field.neighbours && !choice.own_centres;
}

Result<PointField> find_chosen(const Grid& grid, const std::string& name, const FieldChoice& choice, Caller& caller) {
    if (choice.shape) return slice_field(grid.points, *choice.shape, caller.run());
    const auto prefer = choice.cell_field || choice.own_centres ? Association::cell : Association::point;
    Result<PointField> field = find_field(grid, name, {prefer, false, choice.own_centres}, caller.run());
    if (!field) return field;
    if (choice.own_centres && !field->averaged)
        return refusal("`centre` own takes a cell field, but '{}' is one of points", name);
    if (choice.own_centres && !has_cells_to_linearize(grid.cells))
        caller.note("`centre` own changes nothing: no cell is a polyhedron");
    if (!field->note.empty()) caller.note(field->note + "; `cell_field` takes the other");
    return field;
}

Result<PointField> read_field(const GridSource& source, std::size_t step, const FieldChoice& choice,
                              const std::string& beside, Caller& caller, Grid& grid) {
    FieldsToRead read;
    std::string name = choice.name;
    const std::size_t fields = source.info().fields.size();
    if (!name.empty() || fields <= 1) {
        const Result<FoundField> found = choose_field(source, choice);
        if (!found) return found.error();
        name = found->name;
        read = {found->point, found->cell};
        if (!beside.empty()) {
            const Result<FoundField> other = choose_field(source, {beside, false});
            if (!other) return other.error();
            add_names(*read.point, other->point);
            add_names(*read.cell, other->cell);
        }
    }
    Result<Grid> all = source.read(read, step, caller);
    if (!all) return all.error();
    grid = *std::move(all);
    if (name.empty()) {
        name = first_view(grid, source.info().fields).field;
        if (name.empty())
            return Error{ErrorCode::invalid_data,
                         fmt::format("none of the {} fields has two different values: there is nothing to contour; "
                                     "`field` x, y or z contours a coordinate",
                                     fields)};
        caller.note(fmt::format("no field was named: '{}' was taken; `field` names another", name));
    }
    return find_chosen(grid, name, choice, caller);
}

} // namespace isotet::jobs
