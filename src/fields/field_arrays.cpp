// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "base/errors.hpp"

namespace isotet {

namespace {

bool is_among(const std::string& name, const std::vector<std::string>& names) {
    return std::ranges::find(names, name) != names.end();
}

std::vector<std::string> matching(const std::string& name, const std::vector<std::string>& names) {
    const auto match = match_field_name(name, names);
    if (!match) return {};
    return match->parts.empty() ? std::vector<std::string>{match->field} : match->parts;
}

Error no_such_field(const std::string& name, const std::vector<std::string>& names) {
    if (names.empty()) return invalid_argument(fmt::format("there is no field '{}': the grid has none", name));
    return invalid_argument(
        fmt::format("there is no field '{}': the grid has '{}'", name, fmt::join(nearest_first(name, names), "', '")));
}

} // namespace

Result<FieldArrays> arrays_of_field(const std::string& name, const std::vector<std::string>& point,
                                    const std::vector<std::string>& cell) {
    FieldArrays found{matching(name, point), matching(name, cell)};
    if (!found.point.empty() || !found.cell.empty() || name == "x" || name == "y" || name == "z") return found;
    std::vector<std::string> names = point;
    std::ranges::copy_if(cell, std::back_inserter(names), [&](const auto& one) { return !is_among(one, point); });
    if (!looks_like_expression(name)) return no_such_field(name, names);
    const Result<ExpressionNeeds> needs = needs_of_expression(name, names);
    if (!needs) return needs.error();
    for (const std::string& field : needs->fields) {
        if (is_among(field, point)) found.point.push_back(field);
        if (is_among(field, cell)) found.cell.push_back(field);
    }
    found.neighbours = needs->neighbours;
    found.is_expression = true;
    return found;
}

} // namespace isotet
