// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "field_choice.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace isotet::cli {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_coordinate(const std::string& name) { return name == "x" || name == "y" || name == "z"; }

/// "'a', 'b', 'c' and 12 more".
std::string list_of(const std::vector<std::string>& names) {
    constexpr std::size_t most = 12;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
        list += fmt::format("{}'{}'", i ? ", " : "", names[i]);
    if (names.size() > most) list += fmt::format(" and {} more", names.size() - most);
    return list;
}

std::vector<std::string> all_names(const GridSource& source) {
    std::vector<std::string> names = source.names(Association::point);
    add_names(names, source.names(Association::cell));
    return names;
}

Error no_such_field(const GridSource& source, const std::string& name) {
    const std::vector<std::string> names = nearest_first(name, all_names(source));
    const std::string there =
        names.empty() ? "the grid has none; x, y and z are its coordinates" : "the grid has " + list_of(names);
    return {ErrorCode::invalid_argument, fmt::format("there is no field '{}': {}", name, there)};
}

} // namespace

void add_names(std::vector<std::string>& names, const std::vector<std::string>& more) {
    for (const std::string& name : more) {
        if (!has(names, name)) names.push_back(name);
    }
}

Result<FoundField> choose_field(const GridSource& source, const FieldChoice& choice) {
    FoundField found{choice.name, {}, {}};
    if (found.name.empty()) {
        const std::vector<std::string> names = all_names(source);
        if (names.size() != 1) {
            const std::string there = names.empty()
                                          ? "none; -f x, y or z contours a coordinate"
                                          : fmt::format("{}: {}; -f chooses one", names.size(), list_of(names));
            return Error{ErrorCode::invalid_argument, "no field was named, and the grid has " + there};
        }
        found.name = names.front();
    }
    if (const auto match = match_field_name(found.name, source.names(Association::point))) found.point = {match->field};
    if (const auto match = match_field_name(found.name, source.names(Association::cell))) found.cell = {match->field};
    if (found.point.empty() && found.cell.empty() && !is_coordinate(found.name))
        return no_such_field(source, found.name);
    if (choice.cell_field && found.cell.empty()) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("--cell-field was asked for, but '{}' is no cell field", found.name)};
    }
    return found;
}

Result<CarriedFields> choose_carried(const GridSource& source, const std::vector<std::string>& names) {
    const std::vector<std::string> point = source.names(Association::point);
    const std::vector<std::string> cell = source.names(Association::cell);
    CarriedFields carried;
    for (const std::string& name : names) {
        if (name.empty()) continue;
        if (has(point, name)) add_names(carried.point, {name});
        else if (has(cell, name)) add_names(carried.cell, {name});
        else if (const auto match = match_field_name(name, point))
            carried.components.push_back({name, {match->field}, {}});
        else if (is_coordinate(name)) carried.components.push_back({name, {}, {}});
        else if (match_field_name(name, cell)) {
            return Error{
                ErrorCode::invalid_argument,
                fmt::format("--with got '{}', a component of a cell field, but cell fields are carried whole", name)};
        } else return no_such_field(source, name);
    }
    return carried;
}

} // namespace isotet::cli
